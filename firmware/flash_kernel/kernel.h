// The flash kernel: a program of its own that the boot ROM's serial loader puts into RAM, to erase and program the
// drive's sectors by requests from a host. Records as the drive's (link/record.h), of other types; see docs/flash.md.
//
// What it holds to, whatever the host asks
//  * Sector A is never erased or written.
//  * The image's mark (hal_image.h) is taken away before the first sector is erased, and put there only when the CRC-32
//    over all of sectors B to D is the one that the host gives: a board whose mark is there has a whole image.
//  * The same request may come twice; every one does the same then.

#ifndef STILLSPIN_FIRMWARE_FLASH_KERNEL_KERNEL_H
#define STILLSPIN_FIRMWARE_FLASH_KERNEL_KERNEL_H

#include <stdint.h>

#include "firmware/link/record.h"

#if defined(__cplusplus)
extern "C" {
#endif

#define KERNEL_PROTOCOL 1u
#define KERNEL_BAUD 115200uL
#define KERNEL_WORDS_MAX 112u  // in one request to write

enum {
  KERNEL_INFO = 0x30,    //                            protocol, part, revision u16, locked u8, identity 10 x u16, entry
                         //                            2 x u16
  KERNEL_ERASE = 0x31,   // sector u8
  KERNEL_WRITE = 0x32,   // address u32, words u16 ..
  KERNEL_CHECK = 0x33,   // address u32, count u32     crc u32
  KERNEL_SEAL = 0x34,    // crc u32
  KERNEL_RESTART = 0x35  //                            then the chip resets itself
};

// First octet of an answer; 0 to 6 mean what they mean to the drive.
enum {
  KERNEL_OK = 0,
  KERNEL_UNKNOWN = 1,
  KERNEL_RANGE = 2,  // sector A, no flash, the mark
  KERNEL_LENGTH = 4,
  KERNEL_STATE = 6,  // the image is sealed: erase first; or its CRC is another one
  KERNEL_FLASH = 8,  // the flash did not do it: code u16, address u32
  KERNEL_LOCKED = 9  // the board has passwords
};

/// Answers `count` octets of a request (type, tag, body) in `answer`, which has room for RECORD_MAX - 2. Returns how
/// many octets the answer has.
uint16_t kernel_answer(const uint16_t* request, uint16_t count, uint16_t* answer);

/// From the boot ROM's jump on; never returns.
void flash_kernel_main(void);

#if defined(__cplusplus)
}
#endif

#endif
