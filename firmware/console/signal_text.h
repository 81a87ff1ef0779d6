// Signals in lines of the console.

#ifndef STILLSPIN_FIRMWARE_CONSOLE_SIGNAL_TEXT_H
#define STILLSPIN_FIRMWARE_CONSOLE_SIGNAL_TEXT_H

#include "firmware/base/octets.h"
#include "firmware/console/words_of_line.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"

/// The place behind the last one.
enum {
  SIGNAL_NONE = 0
#define SIGNAL(name, unit, q, of, value, meaning) +1
#include "firmware/dictionary/all_signals.h"
#undef SIGNAL
};

/// Place of a signal in the table; SIGNAL_NONE when there is none of that name.
uint16_t signal_find(const word_t* name);

/// As many decimals as its format is worth.
uint16_t signal_decimals(const signal_info_t* s);

/// A raw value of it, and with its unit.
void put_signal_number(octet_writer_t* w, const signal_info_t* s, int32_t raw);
void put_signal_value(octet_writer_t* w, const signal_info_t* s, int32_t raw);

/// Its value now, with its unit.
void put_signal(octet_writer_t* w, uint16_t place);

/// Name, value and meaning.
void put_signal_row(octet_writer_t* w, uint16_t place);

#endif
