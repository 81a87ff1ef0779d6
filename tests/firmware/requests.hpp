// What a machine asks over the link: with answers to commands and parameters.

#ifndef STILLSPIN_TESTS_FIRMWARE_REQUESTS_HPP
#define STILLSPIN_TESTS_FIRMWARE_REQUESTS_HPP

#include "tests/firmware/terminal.hpp"

namespace stillspin::test {

enum { OK, UNKNOWN, RANGE, RUNNING, LENGTH, BUSY, STATE, CONFLICT, EDITION };

class Requests : public Terminal {
 protected:
  Answer give(unsigned code, std::int32_t argument = 0) {
    return ask(REQUEST_COMMAND, little(code, 1) + little(static_cast<std::uint32_t>(argument), 4));
  }
  Answer set(std::uint16_t id, std::int32_t raw) {
    return ask(REQUEST_PARAMETER_SET, little(id, 2) + little(static_cast<std::uint32_t>(raw), 4));
  }
};

}  // namespace stillspin::test

#endif
