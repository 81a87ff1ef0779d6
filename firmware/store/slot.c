#include "firmware/store/slot.h"

#include "firmware/base/octets.h"

void slot_pack_u32(uint32_t value, uint16_t* octets) {
  octet_writer_t w = octet_writer(octets, 4);
  put_u32(&w, value);
}

uint32_t slot_unpack_u32(const uint16_t* octets) {
  octet_reader_t r = octet_reader(octets, 4);
  return take_u32(&r);
}

void slot_pack_header(const slot_header_t* header, uint16_t* octets) {
  octet_writer_t w = octet_writer(octets, SLOT_HEADER);
  put_u32(&w, header->magic);
  put_u16(&w, header->version);
  put_u16(&w, header->count);
  put_u32(&w, header->sequence);
  put_u16(&w, header->length);
  put_u16(&w, 0);
}

void slot_unpack_header(const uint16_t* octets, slot_header_t* header) {
  octet_reader_t r = octet_reader(octets, SLOT_HEADER);
  header->magic = take_u32(&r);
  header->version = take_u16(&r);
  header->count = take_u16(&r);
  header->sequence = take_u32(&r);
  header->length = take_u16(&r);
}

void slot_pack_entry(const slot_entry_t* entry, uint16_t* octets) {
  octet_writer_t w = octet_writer(octets, SLOT_ENTRY);
  put_u16(&w, entry->id);
  put_u8(&w, entry->q);
  put_u8(&w, 0);
  put_i32(&w, entry->raw);
}

void slot_unpack_entry(const uint16_t* octets, slot_entry_t* entry) {
  octet_reader_t r = octet_reader(octets, SLOT_ENTRY);
  entry->id = take_u16(&r);
  entry->q = take_u8(&r);
  (void)take_u8(&r);
  entry->raw = take_i32(&r);
}

bool slot_is_plausible(const slot_header_t* header) {
  return header->magic == SLOT_MAGIC && header->length <= SLOT_LENGTH_MAX;
}

bool slot_is_blank(const uint16_t* header_octets) {
  for (uint16_t k = 0; k < SLOT_HEADER; k++) {
    if (header_octets[k] != 0xFFu) return false;
  }
  return true;
}

bool slot_is_newer(uint32_t sequence, uint32_t than) { return (sequence - than - 1u) < 0x7FFFFFFFuL; }
