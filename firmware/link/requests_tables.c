// What the drive has: parameters, signals and words, so that no host keeps a list of its own.

#include <stddef.h>

#include "firmware/base/crc.h"
#include "firmware/base/edition.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/dictionary/version.h"
#include "firmware/drive/signals.h"
#include "firmware/link/request_rows.h"
#include "firmware/text/catalogue.h"
#include "hal/hal_board.h"
#include "hal/hal_flash.h"
#include "hal/hal_image.h"

static void put_parameter(octet_writer_t* w, const parameter_info_t* p) {
  put_u16(w, p->id);
  put_u8(w, parameter_q(p));
  put_u8(w, parameter_decimals(p));
  put_u8(w, (uint16_t)p->access);
  put_u8(w, 0);  // flags, for later
  put_i32(w, parameter_minimum(p));
  put_i32(w, parameter_maximum(p));
  put_i32(w, parameter_initial(p));
  put_name(w, p);
  put_u8(w, 0);
  put_packed(w, parameter_unit(p));
  put_u8(w, 0);
  put_packed(w, parameter_meaning(p));
}

// What it needs stands in two bits: 0 nothing, 1 the rotor, 2 the frame, 3 the heat sink.
static void put_signal(octet_writer_t* w, const signal_info_t* s) {
  put_u8(w, (uint16_t)(signal_q(s) | (uint16_t)(s->needs - (s->needs >> 2)) << 6));
  put_packed(w, s->name);
  put_u8(w, 0);
  put_packed(w, signal_unit(s));
  put_u8(w, 0);
  put_packed(w, signal_meaning(s));
}

// The tables' check sum, taken piece by piece: all parameters as put_parameter gives them, all signals, all words.
typedef struct {
  uint32_t crc;
  uint16_t stage;   // 0: parameters and signals, then one for each kind of words
  uint16_t at;      // in the words of a kind, or in parameters and signals counted through
  uint16_t scales;  // that it was begun with: formats and ranges in it follow from them
} sum_t;
static sum_t sum;

static bool is_complete(void) { return sum.stage > CATALOGUES; }

void requests_reset(void) {
  static const sum_t nothing = {0};
  sum = nothing;
  sum.crc = CRC32_BEGIN;
  sum.scales = unit_scales();
}

static void next_stage(void) {
  sum.at = 0;
  sum.stage++;
}

static void next_words(octet_writer_t* piece) {
  const uint16_t kind = (uint16_t)(sum.stage - 1u);
  if (!message_is_known(kind, sum.at)) {
    next_stage();
    return;
  }
  if (message_exists(kind, sum.at)) put_message(piece, (catalogue_t)kind, sum.at);
  sum.at++;
}

void requests_service(uint16_t* scratch) {
  if (sum.scales != unit_scales()) requests_reset();
  if (is_complete()) return;
  octet_writer_t piece = octet_writer(scratch, RECORD_BODY_MAX);
  if (sum.stage > 0u) {
    next_words(&piece);
  } else if (sum.at < parameter_count()) {
    put_parameter(&piece, parameter_info(sum.at++));
  } else {
    const uint16_t place = (uint16_t)(sum.at++ - parameter_count());
    const signal_info_t* const s = signal_info(place);
    if (s == NULL) {
      next_stage();
    } else if (!signal_is_left_out(place)) {
      put_signal(&piece, s);
    }
  }
  sum.crc = crc32_add_all(sum.crc, piece.octets, piece.count);
}

static uint16_t faults(void) {
  uint16_t count = 0;
  while (message_is_known(CATALOGUE_FAULT, count)) count++;
  return count;
}

// The commit that the image was built from, low word first, and whether there were changes beside it; zeros where the
// program does not come from an image.
static void put_build(octet_writer_t* w) {
  const bool is_known = hal_flash_read(HAL_FLASH_IMAGE_IDENTITY) == HAL_IMAGE_MARK;
  for (uint32_t k = HAL_IMAGE_REVISION; k <= HAL_IMAGE_CHANGED; k++) {
    put_u16(w, is_known ? hal_flash_read(HAL_FLASH_IMAGE_IDENTITY + k) : 0u);
  }
}

static answer_status_t request_identity(request_t* r) {
  if (!is_complete()) return ANSWER_BUSY;
  put_u16(&r->answer, LINK_PROTOCOL);
  put_u16(&r->answer, parameter_count());
  put_u16(&r->answer, signal_count());
  put_u16(&r->answer, faults());
  put_u32(&r->answer, crc32_end(sum.crc));
  put_text(&r->answer, FIRMWARE_NAME);
  put_u8(&r->answer, 0);
  put_text(&r->answer, BOARD_NAME);
  put_u8(&r->answer, 0);
  put_build(&r->answer);
  put_text(&r->answer, edition_name);
  return ANSWER_OK;
}

static answer_status_t request_parameter_info(request_t* r) {
  const parameter_info_t* const p = parameter_info(take_u16(&r->body));
  if (p == NULL) return ANSWER_RANGE;
  put_parameter(&r->answer, p);
  return ANSWER_OK;
}

static answer_status_t request_signal_info(request_t* r) {
  const uint16_t place = take_u16(&r->body);
  const signal_info_t* const s = signal_info(place);
  if (s == NULL) return ANSWER_RANGE;
  if (signal_is_left_out(place)) return ANSWER_EDITION;
  put_signal(&r->answer, s);
  return ANSWER_OK;
}

static answer_status_t request_words(request_t* r) {
  const uint16_t kind = take_u8(&r->body);
  if (kind >= CATALOGUES) return ANSWER_UNKNOWN;
  const uint16_t code = take_u8(&r->body);
  if (!message_is_known(kind, code)) return ANSWER_RANGE;
  if (message_is_left_out(kind, code)) return ANSWER_EDITION;
  put_message(&r->answer, (catalogue_t)kind, code);
  return ANSWER_OK;
}

const request_row_t table_requests[] = {{REQUEST_IDENTITY, REQUEST_BODY(0u, 0u), request_identity},
                                        {REQUEST_PARAMETER_INFO, REQUEST_BODY(2u, 2u), request_parameter_info},
                                        {REQUEST_SIGNAL_INFO, REQUEST_BODY(2u, 2u), request_signal_info},
                                        {REQUEST_WORDS, REQUEST_BODY(2u, 2u), request_words},
                                        REQUEST_ROWS_END};
