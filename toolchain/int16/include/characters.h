// The C28x's character: 16 bits wide, and sizeof and offsetof count words. Force-included for a compiler with a 16-bit
// int; string literals and the sizeof without parentheses are compile.py's.

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#undef CHAR_BIT
#undef CHAR_MAX
#undef CHAR_MIN
#define CHAR_BIT 16
#define CHAR_MAX 32767
#define CHAR_MIN (-32767 - 1)
#define char int
#define sizeof(x) (sizeof(x) / 2u)
#undef offsetof
#define offsetof(type, member) (__builtin_offsetof(type, member) / 2u)
