#include "firmware/base/crc.h"

#define POLYNOMIAL16 0x1021uL

// What the four bits that leave the register put back into it.
static const uint32_t table32[16] = {0x00000000uL, 0x1DB71064uL, 0x3B6E20C8uL, 0x26D930ACuL, 0x76DC4190uL, 0x6B6B51F4uL,
                                     0x4DB26158uL, 0x5005713CuL, 0xEDB88320uL, 0xF00F9344uL, 0xD6D6A3E8uL, 0xCB61B38CuL,
                                     0x9B64C2B0uL, 0x86D3D2D4uL, 0xA00AE278uL, 0xBDBDF21CuL};

uint16_t crc16_add(uint16_t crc, uint16_t octet) {
  uint32_t sum = crc;  // wide enough for what is shifted out
  // Four bits times this polynomial, whose ones are far enough apart for a product without carries.
  sum = (sum << 4) ^ (((sum >> 12) ^ (octet >> 4)) & 15u) * POLYNOMIAL16;
  sum = (sum << 4) ^ (((sum >> 12) ^ octet) & 15u) * POLYNOMIAL16;
  return (uint16_t)(sum & 0xFFFFu);
}

uint32_t crc32_add(uint32_t crc, uint16_t octet) {
  uint32_t sum = crc ^ (octet & 0xFFu);
  sum = (sum >> 4) ^ table32[sum & 15u];
  return (sum >> 4) ^ table32[sum & 15u];
}

uint16_t crc16(const uint16_t* octets, uint16_t count) {
  uint16_t crc = CRC16_BEGIN;
  for (uint16_t k = 0; k < count; k++) crc = crc16_add(crc, octets[k]);
  return crc;
}
