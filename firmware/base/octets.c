#include "firmware/base/octets.h"

octet_writer_t octet_writer(uint16_t* octets, uint16_t room) {
  const octet_writer_t w = {octets, 0, room, false};
  return w;
}

void put_u8(octet_writer_t* w, uint16_t value) {
  if (w->count < w->room) {
    w->octets[w->count++] = value & 0xFFu;
  } else {
    w->full = true;
  }
}

void put_u16(octet_writer_t* w, uint16_t value) {
  put_u8(w, value);
  put_u8(w, value >> 8);
}

void put_u32(octet_writer_t* w, uint32_t value) {
  put_u16(w, (uint16_t)(value & 0xFFFFuL));
  put_u16(w, (uint16_t)(value >> 16));
}

void put_i32(octet_writer_t* w, int32_t value) { put_u32(w, (uint32_t)value); }

void put_text(octet_writer_t* w, const char* text) {
  for (; *text != '\0'; text++) put_u8(w, (uint16_t)*text);
}

octet_reader_t octet_reader(const uint16_t* octets, uint16_t count) {
  const octet_reader_t r = {octets, count, 0, false};
  return r;
}

uint16_t take_u8(octet_reader_t* r) {
  if (r->at < r->count) return r->octets[r->at++] & 0xFFu;
  r->short_of = true;
  return 0;
}

uint16_t take_u16(octet_reader_t* r) {
  const uint16_t low = take_u8(r);
  return (uint16_t)(low | (uint16_t)(take_u8(r) << 8));
}

uint32_t take_u32(octet_reader_t* r) {
  const uint32_t low = take_u16(r);
  return low | ((uint32_t)take_u16(r) << 16);
}

int32_t take_i32(octet_reader_t* r) { return (int32_t)take_u32(r); }
