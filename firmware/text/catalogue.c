#include "firmware/text/catalogue.h"

#include "firmware/base/edition.h"

// The texts of each kind: they follow each other, and the kinds do as in catalogue_list.h, behind which the faults are.
static const struct {
  uint16_t first, end;
} texts[CATALOGUES] = {
    [CATALOGUE_STATE] = {TEXT_STATE_0, TEXT_LIMIT_0},
    [CATALOGUE_FAULT] = {TEXT_FAULT_0, TEXT_REMEDY_0},
    [CATALOGUE_LIMIT] = {TEXT_LIMIT_0, TEXT_VERDICT_0},
    [CATALOGUE_VERDICT] = {TEXT_VERDICT_0, TEXT_PHASE_0},
    [CATALOGUE_PHASE] = {TEXT_PHASE_0, TEXT_STORE_0},
    [CATALOGUE_STORE] = {TEXT_STORE_0, TEXT_STATUS_0},
    [CATALOGUE_STATUS] = {TEXT_STATUS_0, TEXT_START_0},
    [CATALOGUE_START] = {TEXT_START_0, TEXT_COMMISSIONING_0},
    [CATALOGUE_REMEDY] = {TEXT_REMEDY_0, TEXT_REMEDY_0 + (TEXT_REMEDY_0 - TEXT_FAULT_0)},  // each fault has one
    [CATALOGUE_COMMISSIONING] = {TEXT_COMMISSIONING_0, TEXT_SCOPE_0},
    [CATALOGUE_SCOPE] = {TEXT_SCOPE_0, TEXT_CAN_0},
    [CATALOGUE_CAN] = {TEXT_CAN_0, TEXT_BOARD_0},
    [CATALOGUE_BOARD] = {TEXT_BOARD_0, TEXT_SELFTEST_0},
    [CATALOGUE_SELFTEST] = {TEXT_SELFTEST_0, TEXT_WIRING_0},
    [CATALOGUE_WIRING] = {TEXT_WIRING_0, TEXT_LOOK_0},
    [CATALOGUE_LOOK] = {TEXT_LOOK_0, TEXT_FAULT_0},
};

static bool is_of_fault(uint16_t kind) {
  return kind == (uint16_t)CATALOGUE_FAULT || kind == (uint16_t)CATALOGUE_REMEDY;
}

bool message_is_left_out(uint16_t kind, uint16_t code) {
  if (is_of_fault(kind)) return rows_have(edition_faults_left_out, code);
  return kind < CATALOGUES && ((edition_words_left_out >> kind) & 1u) != 0u;
}

bool message_is_known(uint16_t kind, uint16_t code) {
  return kind < CATALOGUES && code < (uint16_t)(texts[kind].end - texts[kind].first);
}

bool message_exists(uint16_t kind, uint16_t code) {
  return message_is_known(kind, code) && !message_is_left_out(kind, code);
}

void put_message(octet_writer_t* w, catalogue_t kind, uint16_t code) {
  if (message_exists((uint16_t)kind, code)) {
    put_packed(w, (packed_text_t)(texts[kind].first + code));
  } else {
    put_u8(w, '?');
  }
}
