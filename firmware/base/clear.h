// Zero for what is too large to be assigned: an empty constant to copy would have as many words of flash.

#ifndef STILLSPIN_FIRMWARE_BASE_CLEAR_H
#define STILLSPIN_FIRMWARE_BASE_CLEAR_H

#include <stddef.h>

/// Puts what is `count` characters long (on the C28x: words) to zero, which is 0, false or NULL for every type there.
/// Where a character is an octet these are whole words of 16 bits, too.
void clear(void* at, size_t count);

#endif
