// The console: a person's view of the drive, over any terminal program (docs/console.md).
//
// A command answers with a line at once, or with a job: a function that is called with 0, 1, 2 .. in rounds of the
// background loop, writes one line at most each time and returns false when it is through. It is called only when the
// port's ring has room for a line beside the answer to a record. What is typed meanwhile is kept; Ctrl-C ends the job,
// and so does more than can be kept.

#ifndef STILLSPIN_FIRMWARE_CONSOLE_CONSOLE_H
#define STILLSPIN_FIRMWARE_CONSOLE_CONSOLE_H

#include <stdbool.h>
#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

typedef bool console_job_t(uint16_t step);

void console_reset(void);

/// Whether console_octet may be called.
bool console_takes(void);

#define CONSOLE_BREAK 0x200u  // as a character: what was typed and is not obeyed yet is forgotten

/// A character from the port, with room for EDITOR_ECHO_MAX or OUTPUT_LINE to be sent back; a break needs none.
void console_octet(uint16_t octet);

/// Background level.
void console_service(void);

/// A machine has introduced itself: no unasked text from here until someone types. Records alone say nothing, a
/// terminal may send some beside its text to keep the guard alive.
void console_give_way(void);

/// For commands: the job that answers. `until_key`: it waits for something, and any character ends it.
void console_run(console_job_t* job, bool until_key);

#if defined(__cplusplus)
}
#endif

#endif
