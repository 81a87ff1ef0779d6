#include "firmware/base/edition.h"

bool edition_leaves_out(const rows_t* left_out, uint16_t row) {
  while (left_out->count > 0u && (uint16_t)(row - left_out->first) >= left_out->count) left_out++;
  return left_out->count > 0u;
}
