// Octets as the link's tests write them down.

#ifndef STILLSPIN_TESTS_FIRMWARE_LINK_OCTETS_HPP
#define STILLSPIN_TESTS_FIRMWARE_LINK_OCTETS_HPP

#include <cstdint>
#include <string>
#include <vector>

namespace stillspin::test {

using Octets = std::vector<std::uint16_t>;

inline Octets from_text(const std::string& text) { return Octets(text.begin(), text.end()); }

inline std::uint16_t length(const Octets& o) { return static_cast<std::uint16_t>(o.size()); }

}  // namespace stillspin::test

#endif
