// Who gets what comes over the serial port and is no record, and what both sides of the port leave room for.

#ifndef STILLSPIN_FIRMWARE_INTERFACES_TEXT_PORT_H
#define STILLSPIN_FIRMWARE_INTERFACES_TEXT_PORT_H

#include <stdbool.h>
#include <stdint.h>

#define TEXT_LINE_MAX 208u       // characters of a line of text, with its end
#define RECORD_ON_WIRE_MAX 258u  // octets of an answer, with both zeros

#define TEXT_BREAK 0x200u  // as an octet: what came before and was not acted upon is forgotten

typedef struct {
  bool (*takes)(void);            // whether there is room for one more
  void (*octet)(uint16_t octet);  // may send TEXT_LINE_MAX back; a break sends nothing
  void (*give_way)(void);         // a machine has introduced itself: nothing unasked until text comes again
} text_port_t;

/// That of the edition, NULL where text is for nobody (editions/).
extern const text_port_t* const edition_text_port;

#endif
