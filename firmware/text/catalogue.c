#include "firmware/text/catalogue.h"

#include "firmware/base/edition.h"

// The texts of each kind, the first one and how many: they follow each other, and the kinds do as in catalogue_list.h,
// behind which the faults are.
#define FIRST_BITS 10u
#define TEXTS(first, end) (uint16_t)(TEXT_##first##_0 | (TEXT_##end##_0 - TEXT_##first##_0) << FIRST_BITS)
static const uint16_t texts[CATALOGUES] = {
    [CATALOGUE_STATE] = TEXTS(STATE, LIMIT),
    [CATALOGUE_FAULT] = TEXTS(FAULT, REMEDY),
    [CATALOGUE_LIMIT] = TEXTS(LIMIT, VERDICT),
    [CATALOGUE_VERDICT] = TEXTS(VERDICT, PHASE),
    [CATALOGUE_PHASE] = TEXTS(PHASE, STORE),
    [CATALOGUE_STORE] = TEXTS(STORE, STATUS),
    [CATALOGUE_STATUS] = TEXTS(STATUS, START),
    [CATALOGUE_START] = TEXTS(START, COMMISSIONING),
    [CATALOGUE_REMEDY] =
        (uint16_t)(TEXT_REMEDY_0 | (TEXT_REMEDY_0 - TEXT_FAULT_0) << FIRST_BITS),  // each fault has one
    [CATALOGUE_COMMISSIONING] = TEXTS(COMMISSIONING, SCOPE),
    [CATALOGUE_SCOPE] = TEXTS(SCOPE, CAN),
    [CATALOGUE_CAN] = TEXTS(CAN, BOARD),
    [CATALOGUE_BOARD] = TEXTS(BOARD, SELFTEST),
    [CATALOGUE_SELFTEST] = TEXTS(SELFTEST, WIRING),
    [CATALOGUE_WIRING] = TEXTS(WIRING, LOOK),
    [CATALOGUE_LOOK] = TEXTS(LOOK, FAULT),
};
typedef char first_fits[(TEXT_REMEDY_0 >> FIRST_BITS == 0) ? 1 : -1];
typedef char faults_fit[((TEXT_REMEDY_0 - TEXT_FAULT_0) >> (16u - FIRST_BITS) == 0) ? 1 : -1];  // no kind has more

static bool is_of_fault(uint16_t kind) {
  return kind == (uint16_t)CATALOGUE_FAULT || kind == (uint16_t)CATALOGUE_REMEDY;
}

bool message_is_left_out(uint16_t kind, uint16_t code) {
  if (is_of_fault(kind)) return rows_have(edition_faults_left_out, code);
  return kind < CATALOGUES && ((edition_words_left_out >> kind) & 1u) != 0u;
}

bool message_is_known(uint16_t kind, uint16_t code) { return kind < CATALOGUES && code < texts[kind] >> FIRST_BITS; }

bool message_exists(uint16_t kind, uint16_t code) {
  return message_is_known(kind, code) && !message_is_left_out(kind, code);
}

void put_message(octet_writer_t* w, catalogue_t kind, uint16_t code) {
  if (message_exists((uint16_t)kind, code)) {
    put_packed(w, (packed_text_t)((texts[kind] & ((1u << FIRST_BITS) - 1u)) + code));
  } else {
    put_u8(w, '?');
  }
}
