// The program as a whole: what has to happen before its first function in RAM may be called, and what it says of
// itself.

#ifndef STILLSPIN_HAL_HAL_IMAGE_H
#define STILLSPIN_HAL_HAL_IMAGE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// The first word of an image that is complete; an update programs it last.
#define HAL_IMAGE_MARK 0x5AA5u
#define HAL_IMAGE_FORMAT 1u    // of hal_image_identity_t: raised when a member changes its meaning
#define HAL_IMAGE_REVISION 5u  // places of members, in words, for who has the flash
#define HAL_IMAGE_CHANGED 7u
#define HAL_IMAGE_SUM_END 10u
#define HAL_IMAGE_SUM 12u
#define HAL_IMAGE_EDITION_WORDS 8u
#define HAL_IMAGE_WORDS 22u  // all of it

// At a fixed place in the image, for whoever has the file or the flash and not the running drive. Words only, so that
// every compiler lays it out alike; of two words the low one comes first.
typedef struct {
  uint16_t mark;
  uint16_t format;
  uint16_t version[3];   // of the project: major, minor, patch
  uint16_t revision[2];  // first 32 bits of the commit's name; 0: built from an unknown one
  uint16_t changed;      // bit 0: there were changes beside the commit; bit 1: no program, a demonstration
  uint16_t tables[2];    // first 32 bits of the SHA-256 of the lists of parameters, signals and faults
  // CRC-32 (firmware/base/crc.h) of the words from HAL_FLASH_START to before sum_end, low octet first; words that
  // nothing was linked to count as erased, and so does the sum. The linked file gets both (toolchain/stamp_image.py),
  // and has ones until then.
  uint16_t sum_end[2];
  uint16_t sum[2];
  uint16_t edition[HAL_IMAGE_EDITION_WORDS];  // its name, two characters a word, the low octet first; zeros behind it
} hal_image_identity_t;

extern const hal_image_identity_t image_identity;

// Copies what runs from RAM out of the flash. Before anything else.
void hal_image_copy_ram_code(void);

#ifdef __cplusplus
}
#endif

#endif
