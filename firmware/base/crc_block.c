// Beside crc.c, which is resident: not all editions want it.

#include "firmware/base/crc.h"

uint32_t crc32_add_all(uint32_t crc, const uint16_t* octets, uint16_t count) {
  for (uint16_t k = 0; k < count; k++) crc = crc32_add(crc, octets[k]);
  return crc;
}
