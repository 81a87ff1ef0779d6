// The firmware's packed texts as strings.

#ifndef STILLSPIN_SIM_HOST_BENCH_TEXTS_HPP
#define STILLSPIN_SIM_HOST_BENCH_TEXTS_HPP

#include <cstdint>
#include <string>

#include "firmware/dictionary/units.h"
#include "firmware/text/catalogue.h"

namespace stillspin::bench {

/// What `write` puts into an octet writer.
template <typename Write>
std::string written(Write write) {
  std::uint16_t block[256];
  octet_writer_t writer = octet_writer(block, 256);
  write(&writer);
  return std::string(block, block + writer.count);
}

inline std::string text_of(packed_text_t text) {
  return written([=](octet_writer_t* w) { put_packed(w, text); });
}

/// A unit's text.
inline const char* unit_name(unit_t unit) {
#define UNIT(unit, text, current, voltage) text,
  static const char* const names[] = {
#include "firmware/dictionary/unit_list.h"
  };
#undef UNIT
  return names[unit];
}

/// What the drive's number means.
inline std::string words_of(catalogue_t kind, std::uint16_t code) {
  return written([=](octet_writer_t* w) { put_message(w, kind, code); });
}

}  // namespace stillspin::bench

#endif
