// Widths of the C28x, alignments of this computer: the front end then lays structures out as the native back end does.

#ifndef STILLSPIN_TOOLCHAIN_INT16_INCLUDE_STDINT_H
#define STILLSPIN_TOOLCHAIN_INT16_INCLUDE_STDINT_H

typedef int int16_t;
typedef unsigned int uint16_t;
typedef long int32_t __attribute__((aligned(4)));
typedef unsigned long uint32_t __attribute__((aligned(4)));
typedef long long int64_t __attribute__((aligned(8)));
typedef unsigned long long uint64_t __attribute__((aligned(8)));
typedef unsigned int uintptr_t;
typedef int intptr_t;

#define INT16_MIN (-32767 - 1)
#define INT16_MAX 32767
#define UINT16_MAX 65535u
#define INT32_MIN (-2147483647L - 1L)
#define INT32_MAX 2147483647L
#define UINT32_MAX 4294967295uL
#define INT64_MIN (-9223372036854775807LL - 1LL)
#define INT64_MAX 9223372036854775807LL
#define UINT64_MAX 18446744073709551615uLL

#endif
