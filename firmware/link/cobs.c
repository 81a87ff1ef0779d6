#include "firmware/link/cobs.h"

#include <stdbool.h>

#define BLOCK_FULL 0xFFu

uint16_t cobs_encode(const uint16_t* from, uint16_t count, uint16_t* to) {
  uint16_t code_at = 0;
  uint16_t code = 1;
  uint16_t end = 1;
  for (uint16_t k = 0; k < count; k++) {
    const uint16_t octet = from[k] & 0xFFu;
    if (octet != 0u) {
      to[end++] = octet;
      code++;
      // A full block says nothing of a zero; one at the very end of the data needs no empty block behind it.
      if (code < BLOCK_FULL || k + 1u == count) continue;
    }
    to[code_at] = code;
    code_at = end++;
    code = 1;
  }
  to[code_at] = code;
  return end;
}

uint16_t cobs_decode(uint16_t* octets, uint16_t count) {
  uint16_t end = 0;
  uint16_t left = 0;         // of the block
  bool zero_behind = false;  // of the block before, if there is another
  if (count == 0u) return COBS_MALFORMED;
  for (uint16_t from = 0; from < count; from++) {
    const uint16_t octet = octets[from] & 0xFFu;
    if (octet == 0u) return COBS_MALFORMED;
    if (left > 0u) {
      octets[end++] = octet;
      left--;
    } else {
      if (zero_behind) octets[end++] = 0;
      zero_behind = octet != BLOCK_FULL;
      left = (uint16_t)(octet - 1u);
    }
  }
  return (left == 0u) ? end : COBS_MALFORMED;
}
