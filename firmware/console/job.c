#include "firmware/console/job.h"

console_work_t console_work;

void console_run(console_job_t* job, bool until_key) {
  console_work.function = job;
  console_work.step = 0;
  console_work.ends_by_key = until_key;
}
