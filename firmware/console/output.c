#include "firmware/console/output.h"

#include "firmware/api/status.h"
#include "hal/hal_sci.h"

#define RESERVED 5u  // three points and the line's end

static struct {
  octet_writer_t line;
  uint16_t block[TEXT_LINE_MAX];
} self;

void output_reset(void) { feature_status.refusals = 0; }

octet_writer_t* line_begin(void) {
  self.line = octet_writer(self.block, TEXT_LINE_MAX - RESERVED);
  return &self.line;
}

void line_flush(void) { (void)hal_sci_write(self.block, self.line.count); }

void line_end(void) {
  self.line.room = TEXT_LINE_MAX;
  if (self.line.full) put_text(&self.line, "...");
  put_text(&self.line, "\r\n");
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
    put_packed(&self.line, text);
    line_end();
  } else {
    line_end_refused();
  }
}
