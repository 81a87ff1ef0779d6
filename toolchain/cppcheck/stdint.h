// The C28x's widths by their C types, for cppcheck: by its own tables uint16_t would be 2 characters, which are a long
// there.

#ifndef STILLSPIN_TOOLCHAIN_CPPCHECK_STDINT_H
#define STILLSPIN_TOOLCHAIN_CPPCHECK_STDINT_H

typedef int int16_t;
typedef unsigned int uint16_t;
typedef long int32_t;
typedef unsigned long uint32_t;
typedef long long int64_t;
typedef unsigned long long uint64_t;

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
