// Words of a period against those of the period before: most hardly change, so one octet is enough for most.
//
// Up to eight words have an octet before them whose bit k says that word k is another one. Each of these is its
// difference modulo 65536, folded so that small ones of either sign are small (0, -1, 1, -2 .. as 0, 1, 2, 3 ..),
// seven bits an octet from the lowest on, bit 7 on all but the last.

#ifndef STILLSPIN_FIRMWARE_HIL_DELTA_H
#define STILLSPIN_FIRMWARE_HIL_DELTA_H

#include <stdint.h>

#include "firmware/base/octets.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// Writes words[0..count) as they differ from before[0..count).
void delta_put(octet_writer_t* w, const uint16_t* words, const uint16_t* before, uint16_t count);

/// The reverse. A reader that runs dry gives the words of before.
void delta_take(octet_reader_t* r, uint16_t* words, const uint16_t* before, uint16_t count);

#if defined(__cplusplus)
}
#endif

#endif
