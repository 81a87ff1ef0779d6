// The job that answers a command when a line at once does not: a function that is called with 0, 1, 2 .. in rounds of
// the background loop, writes one line at most each time and returns false when it is through.

#ifndef STILLSPIN_FIRMWARE_CONSOLE_JOB_H
#define STILLSPIN_FIRMWARE_CONSOLE_JOB_H

#include <stdbool.h>
#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

typedef bool console_job_t(uint16_t step);

typedef struct {
  console_job_t* function;  // NULL: none is under way
  uint16_t step;            // to be done next
  bool ends_by_key;
} console_work_t;

extern console_work_t console_work;

/// For commands. `until_key`: it waits for something, and any character ends it.
void console_run(console_job_t* job, bool until_key);

#if defined(__cplusplus)
}
#endif

#endif
