// Reads one slot from the memory, entry by entry, and checks it. One slot at a time.

#ifndef STILLSPIN_FIRMWARE_STORE_READER_H
#define STILLSPIN_FIRMWARE_STORE_READER_H

#include <stdint.h>

#include "firmware/store/slot.h"

typedef enum {
  READER_WAITS = 0,
  READER_ENTRY = 1,  // one has been given
  READER_VALID = 2,  // that was all, and the check is right
  READER_BAD = 3,    // no header that fits, or the check is wrong
  READER_FAILED = 4  // the memory cannot be read
} reader_result_t;

/// Begins with the header of slot 0 or 1, whose magic is not looked at.
void reader_begin(uint16_t slot);

/// To be called again until it is none of WAITS and ENTRY.
reader_result_t reader_step(slot_entry_t* entry);

const slot_header_t* reader_header(void);

/// Share of the slot that has been read, 0..100.
uint16_t reader_progress(void);

#endif
