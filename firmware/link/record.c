#include "firmware/link/record.h"

#include "firmware/base/crc.h"
#include "firmware/link/cobs.h"

uint16_t record_seal(uint16_t* octets, uint16_t count) {
  const uint16_t crc = crc16(octets, count);
  octets[count] = crc & 0xFFu;
  octets[count + 1u] = crc >> 8;
  return (uint16_t)(count + 2u);
}

uint16_t record_open(const uint16_t* octets, uint16_t count) {
  if (count < RECORD_MIN || count > RECORD_MAX) return 0;
  const uint16_t before = (uint16_t)(count - 2u);
  const uint16_t crc = (uint16_t)((octets[before] & 0xFFu) | (uint16_t)(octets[before + 1u] << 8));
  return (crc16(octets, before) == crc) ? before : 0u;
}

uint16_t record_to_wire(uint16_t* record, uint16_t count, uint16_t* wire) {
  const uint16_t sealed = record_seal(record, count);
  wire[0] = 0;
  const uint16_t encoded = cobs_encode(record, sealed, &wire[1]);
  wire[encoded + 1u] = 0;
  return (uint16_t)(encoded + 2u);
}
