// Parts of the status that other commands say, too.

#ifndef STILLSPIN_FIRMWARE_CONSOLE_STATUS_TEXT_H
#define STILLSPIN_FIRMWARE_CONSOLE_STATUS_TEXT_H

#include "firmware/base/octets.h"
#include "firmware/text/packed_text.h"

/// State, speed, current, DC link, and limits where there are any: a line.
void put_overview(octet_writer_t* w);

/// Two currents with what stands before each, and their unit.
void put_current_pair(octet_writer_t* w, packed_text_t before, int32_t first_q20, packed_text_t between,
                      int32_t second_q20);

#endif
