// Writes values.h's set into a slot, with the unknown entries of the slot that counts so far, and makes it valid.
//
// Order: every page with the magic left blank, then a reading back with its check, then the magic.

#ifndef STILLSPIN_FIRMWARE_STORE_WRITER_H
#define STILLSPIN_FIRMWARE_STORE_WRITER_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/store/store.h"

typedef enum { WRITER_GOES_ON = 0, WRITER_DONE = 1, WRITER_FAILED = 2 } writer_result_t;

/// `so_far` is a scan's. False when its unknown entries leave too little room.
bool writer_begin(const store_report_t* so_far);

writer_result_t writer_step(void);

/// Of the slot that has been written.
void writer_report(store_report_t* report);

/// 0..100.
uint16_t writer_progress(void);

#endif
