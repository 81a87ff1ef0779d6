// Numbers as octets in little-endian order, and text, written into and read from a block of words that hold an octet
// each. The formats of the link, of the bus and of the store are these calls and never a structure in memory, whose
// layout is the compiler's and, on the DSP, knows no octets.
//
// Both keep on after the end: a writer that is full drops what does not fit and says so, a reader gives zeros.

#ifndef STILLSPIN_FIRMWARE_BASE_OCTETS_H
#define STILLSPIN_FIRMWARE_BASE_OCTETS_H

#include <stdbool.h>
#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

typedef struct {
  uint16_t* octets;
  uint16_t count;  // written so far
  uint16_t room;   // of the block
  bool full;       // something did not fit
} octet_writer_t;

typedef struct {
  const uint16_t* octets;
  uint16_t count;  // of the block
  uint16_t at;     // read so far
  bool short_of;   // something was asked for behind the end
} octet_reader_t;

octet_writer_t octet_writer(uint16_t* octets, uint16_t room);
void put_u8(octet_writer_t* w, uint16_t value);
void put_u16(octet_writer_t* w, uint16_t value);
void put_u32(octet_writer_t* w, uint32_t value);
void put_i32(octet_writer_t* w, int32_t value);
/// A string without its end.
void put_text(octet_writer_t* w, const char* text);

octet_reader_t octet_reader(const uint16_t* octets, uint16_t count);
uint16_t take_u8(octet_reader_t* r);
uint16_t take_u16(octet_reader_t* r);
uint32_t take_u32(octet_reader_t* r);
int32_t take_i32(octet_reader_t* r);

/// True when everything was there and nothing is left.
static inline bool octets_fit(const octet_reader_t* r) { return !r->short_of && r->at == r->count; }

static inline uint16_t octets_left(const octet_reader_t* r) { return (uint16_t)(r->count - r->at); }

#if defined(__cplusplus)
}
#endif

#endif
