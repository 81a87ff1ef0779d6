#include "firmware/hil/delta.h"

#define GROUP 8u
#define SEVEN_BITS 0x7Fu
#define MORE 0x80u

static void put_difference(octet_writer_t* w, uint16_t difference) {
  const uint16_t sign = (difference & 0x8000u) != 0u ? 0xFFFFu : 0u;
  uint16_t folded = (uint16_t)((((uint32_t)difference << 1) & 0xFFFFuL) ^ sign);
  while (folded > SEVEN_BITS) {
    put_u8(w, (uint16_t)((folded & SEVEN_BITS) | MORE));
    folded >>= 7;
  }
  put_u8(w, folded);
}

// Three octets are enough for 16 bits; what goes on beyond them is no difference of ours and ends there.
static uint16_t take_difference(octet_reader_t* r) {
  uint32_t folded = 0;
  uint16_t octet = MORE;
  for (uint16_t shift = 0; shift < 21u && (octet & MORE) != 0u; shift += 7u) {
    octet = take_u8(r);
    folded |= (uint32_t)(octet & SEVEN_BITS) << shift;
  }
  const uint16_t sign = (folded & 1u) != 0u ? 0xFFFFu : 0u;
  return (uint16_t)(((folded >> 1) & 0xFFFFuL) ^ sign);
}

void delta_put(octet_writer_t* w, const uint16_t* words, const uint16_t* before, uint16_t count) {
  for (uint16_t from = 0; from < count; from += GROUP) {
    uint16_t changed = 0;
    for (uint16_t bit = 0; bit < GROUP; bit++) {
      const uint16_t k = (uint16_t)(from + bit);
      if (k < count && words[k] != before[k]) changed = (uint16_t)(changed | (1u << bit));
    }
    put_u8(w, changed);
    for (uint16_t k = from; k < count && k < from + GROUP; k++) {
      if (words[k] != before[k]) put_difference(w, (uint16_t)(words[k] - before[k]));
    }
  }
}

void delta_take(octet_reader_t* r, uint16_t* words, const uint16_t* before, uint16_t count) {
  for (uint16_t from = 0; from < count; from += GROUP) {
    uint16_t changed = take_u8(r);
    for (uint16_t k = from; k < count && k < from + GROUP; k++) {
      const bool differs = (changed & 1u) != 0u;
      words[k] = differs ? (uint16_t)(before[k] + take_difference(r)) : before[k];
      changed >>= 1;
    }
  }
}
