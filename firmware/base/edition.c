#include "firmware/base/edition.h"

bool rows_have(const rows_t* rows, uint16_t row) {
  while (rows->count > 0u && (uint16_t)(row - rows->first) >= rows->count) rows++;
  return rows->count > 0u;
}
