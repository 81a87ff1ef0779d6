// Lines of the console on their way out. A line is put together in one block and goes into the port's ring as a whole,
// so that no record comes in between; whoever writes one has been called with room for it.

#ifndef STILLSPIN_FIRMWARE_CONSOLE_OUTPUT_H
#define STILLSPIN_FIRMWARE_CONSOLE_OUTPUT_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/interfaces/text_port.h"
#include "firmware/text/packed_text.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// Power-on state.
void output_reset(void);

/// An empty line to write into; there is only one.
octet_writer_t* line_begin(void);

/// Sends the line with a line end; what did not fit is missing, and three points say so.
void line_end(void);

/// Sends what is in the line as it is.
void line_flush(void);

/// A line of one text.
void line_of(packed_text_t text);

/// For a command that was not carried out: people read why, programs read how many there have been (request LINK).
void count_refusal(void);
void line_end_refused(void);
void line_refused(packed_text_t text);

/// Ends a line that says why not, or gives it this text where the command was carried out.
void line_answer(bool done, packed_text_t text);

#if defined(__cplusplus)
}
#endif

#endif
