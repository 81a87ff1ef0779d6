#include "firmware/console/suggest/suggest.h"

#include "firmware/console/job.h"
#include "firmware/console/output.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"

#define NAMES_A_STEP 2u
#define MOST 4u
#define SHORTEST_PART 2u

static struct {
  word_t wanted;
  uint16_t kind;  // name_kind_t
  uint16_t found;
  packed_text_t near[MOST];
} self;

bool suggest_is_near(packed_text_t name, const word_t* word) {
  packed_reader_t here;  // before the first character that differs
  packed_reader_t behind = packed_reader(name);
  const uint16_t* rest = word->text;
  uint16_t left = word->count;
  uint16_t c;
  for (;; rest++, left--) {
    here = behind;
    c = text_small(packed_next(&behind));
    if (left == 0u || c == 0u || c != text_small(*rest)) break;
  }
  if (c == 0u) return left == 1u || word->count >= left + SHORTEST_PART;
  // The word lacks a character, has another one, or one too many.
  if (packed_rest_is(&behind, rest, left)) return true;
  if (left > 0u) {
    const uint16_t fewer = (uint16_t)(left - 1u);
    if (packed_rest_is(&behind, rest + 1, fewer) || packed_rest_is(&here, rest + 1, fewer)) return true;
  }
  if (left > 1u && c == text_small(rest[1])) {  // or two are exchanged
    c = text_small(packed_next(&behind));
    if (c != 0u && c == text_small(rest[0]) && packed_rest_is(&behind, rest + 2, (uint16_t)(left - 2u))) return true;
  }
  return word->count >= SHORTEST_PART && packed_occurs(name, word->text, word->count);
}

static void say(void) {
  if (self.found == 0u) {
    say_no_such_name((name_kind_t)self.kind, &self.wanted);
    return;
  }
  octet_writer_t* const w = put_no_such_name((name_kind_t)self.kind, &self.wanted);
  for (uint16_t k = 0; k < self.found; k++) {
    put_packed(w, (k == 0u) ? SAY_did_you_mean : SAY_comma);
    put_packed(w, self.near[k]);
  }
  put_u8(w, '?');
  line_end_refused();
}

static bool look(uint16_t step) {
  packed_text_t name = (packed_text_t)(first_names[self.kind] + step * NAMES_A_STEP);
  for (uint16_t k = 0; k < NAMES_A_STEP; k++, name++) {
    if (name == first_names[self.kind + 1u] || self.found == MOST) {
      say();
      return false;
    }
    if (name_is_here(name) && suggest_is_near(name, &self.wanted)) self.near[self.found++] = name;
  }
  return true;
}

void suggest_names(name_kind_t kind, const word_t* word) {
  self.kind = (uint16_t)kind;
  self.wanted = *word;
  self.found = 0;
  console_run(look, false);
}
