// What a Cortex-M3 compiler needs to take the drive's C for that of the C28x (cl2000 beside this file).
//
// bool has a word there; the C28x's own keywords mean nothing here; its instructions make no code.

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#undef bool
#define bool unsigned short
#define __cregister
#define __interrupt
#define __asm(text) ((void)0)
