// Zero for what is too large to be assigned: an empty constant to copy would have as many words of flash.

#ifndef STILLSPIN_FIRMWARE_BASE_CLEAR_H
#define STILLSPIN_FIRMWARE_BASE_CLEAR_H

#include <stddef.h>

/// Puts what is `count` characters long to zero, which is 0, false or NULL for every type there. It has a number of 32
/// bits in it, and so, by its alignment, a whole number of these for its size.
void clear(void* at, size_t count);

#endif
