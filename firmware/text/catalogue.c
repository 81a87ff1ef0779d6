#include "firmware/text/catalogue.h"

#include "firmware/base/edition.h"

// The kind of each row of catalogue_list.h.
#define WORDS(kind, code, text) CATALOGUE_##kind,
static const uint16_t kinds[] = {
#include "firmware/text/catalogue_list.h"
};
#undef WORDS

#define ROWS ((uint16_t)(sizeof kinds / sizeof kinds[0]))
#define FAULTS ((uint16_t)TEXT_REMEDY_0 - (uint16_t)TEXT_FAULT_0)

// The place of a word in catalogue_list.h; ROWS when there is none.
static uint16_t row_of(uint16_t kind, uint16_t code) {
  uint16_t k = 0;
  while (k < ROWS && kinds[k] != kind) k++;
  k = (uint16_t)(k + code);
  return (k < ROWS && kinds[k] == kind) ? k : ROWS;
}

static bool is_of_fault(uint16_t kind) {
  return kind == (uint16_t)CATALOGUE_FAULT || kind == (uint16_t)CATALOGUE_REMEDY;
}

bool message_is_left_out(uint16_t kind, uint16_t code) {
  if (is_of_fault(kind)) return rows_have(edition_faults_left_out, code);
  return kind < CATALOGUES && ((edition_words_left_out >> kind) & 1u) != 0u;
}

bool message_is_known(uint16_t kind, uint16_t code) {
  if (is_of_fault(kind)) return code < FAULTS;
  return code < ROWS && row_of(kind, code) < ROWS;
}

bool message_exists(uint16_t kind, uint16_t code) {
  return message_is_known(kind, code) && !message_is_left_out(kind, code);
}

void put_message(octet_writer_t* w, catalogue_t kind, uint16_t code) {
  if (!message_exists((uint16_t)kind, code)) {
    put_u8(w, '?');
    return;
  }
  uint16_t text = (uint16_t)TEXT_STATE_0;
  if (is_of_fault((uint16_t)kind)) {
    text = (uint16_t)((kind == CATALOGUE_FAULT ? (uint16_t)TEXT_FAULT_0 : (uint16_t)TEXT_REMEDY_0) + code);
  } else {
    text = (uint16_t)(text + row_of((uint16_t)kind, code));
  }
  put_packed(w, (packed_text_t)text);
}
