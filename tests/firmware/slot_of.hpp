// A slot of the parameter store as a firmware would have written it.

#ifndef STILLSPIN_TESTS_FIRMWARE_SLOT_OF_HPP
#define STILLSPIN_TESTS_FIRMWARE_SLOT_OF_HPP

#include <cstdint>
#include <vector>

extern "C" {
#include "firmware/base/crc.h"
#include "firmware/store/slot.h"
}

namespace stillspin::test {

inline std::vector<std::uint16_t> slot_of(std::uint16_t version, std::uint32_t sequence,
                                          const std::vector<slot_entry_t>& entries) {
  std::vector<std::uint16_t> octets(SLOT_HEADER);
  const slot_header_t header = {SLOT_MAGIC, version, static_cast<std::uint16_t>(entries.size()), sequence,
                                static_cast<std::uint16_t>(entries.size() * SLOT_ENTRY)};
  slot_pack_header(&header, octets.data());
  for (const slot_entry_t& entry : entries) {
    octets.resize(octets.size() + SLOT_ENTRY);
    slot_pack_entry(&entry, octets.data() + octets.size() - SLOT_ENTRY);
  }
  std::uint32_t crc = CRC32_BEGIN;
  for (std::size_t k = SLOT_MAGIC_OCTETS; k < octets.size(); ++k) crc = crc32_add(crc, octets[k]);
  octets.resize(octets.size() + SLOT_CHECK);
  slot_pack_u32(crc32_end(crc), octets.data() + octets.size() - SLOT_CHECK);
  return octets;
}

}  // namespace stillspin::test

#endif
