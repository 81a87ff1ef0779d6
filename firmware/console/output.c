#include "firmware/console/output.h"

#include "firmware/api/status.h"
#include "hal/hal_sci.h"

#define RESERVED 5u  // three points and the line's end

static uint16_t block[TEXT_LINE_MAX];
static octet_writer_t line;

void output_reset(void) { feature_status.refusals = 0; }

octet_writer_t* line_begin(void) {
  line = octet_writer(block, TEXT_LINE_MAX - RESERVED);
  return &line;
}

void line_flush(void) { (void)hal_sci_write(block, line.count); }

void line_end(void) {
  line.room = TEXT_LINE_MAX;
  if (line.full) put_text(&line, "...");
  put_text(&line, "\r\n");
  line_flush();
}

void line_of(packed_text_t text) {
  put_packed(line_begin(), text);
  line_end();
}

void count_refusal(void) { feature_status.refusals++; }

void line_end_refused(void) {
  count_refusal();
  line_end();
}

void line_refused(packed_text_t text) {
  put_packed(line_begin(), text);
  line_end_refused();
}

void line_answer(bool done, packed_text_t text) {
  if (done) {
    put_packed(&line, text);
    line_end();
  } else {
    line_end_refused();
  }
}
