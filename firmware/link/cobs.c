#include "firmware/link/cobs.h"

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
    }
    // A full block says nothing of a zero; one at the very end of the data needs no empty block behind it.
    if (octet == 0u || (code == BLOCK_FULL && k + 1u < count)) {
      to[code_at] = code;
      code_at = end++;
      code = 1;
    }
  }
  to[code_at] = code;
  return end;
}

uint16_t cobs_decode(uint16_t* octets, uint16_t count) {
  uint16_t from = 0;
  uint16_t end = 0;
  if (count == 0u) return COBS_MALFORMED;
  while (from < count) {
    const uint16_t code = octets[from++] & 0xFFu;
    if (code == 0u || (uint32_t)from + code - 1u > count) return COBS_MALFORMED;
    for (uint16_t k = 1; k < code; k++) {
      const uint16_t octet = octets[from++] & 0xFFu;
      if (octet == 0u) return COBS_MALFORMED;
      octets[end++] = octet;
    }
    if (code != BLOCK_FULL && from < count) octets[end++] = 0;
  }
  return end;
}
