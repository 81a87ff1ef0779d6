// The console: a person's view of the drive, over any terminal program (docs/console.md).
//
// A command answers with a line at once, or with a job (console/job.h), which is called only when the port's ring has
// room for a line beside the answer to a record. What is typed meanwhile is kept; Ctrl-C ends the job, and so does more
// than can be kept.

#ifndef STILLSPIN_FIRMWARE_CONSOLE_CONSOLE_H
#define STILLSPIN_FIRMWARE_CONSOLE_CONSOLE_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/interfaces/text_port.h"

#if defined(__cplusplus)
extern "C" {
#endif

void console_reset(void);

extern const text_port_t console_text_port;

/// Background level.
void console_service(void);

#if defined(__cplusplus)
}
#endif

#endif
