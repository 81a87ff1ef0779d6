// A person at a terminal: what the console's tests have in common.

#ifndef STILLSPIN_TESTS_FIRMWARE_CONSOLE_HPP
#define STILLSPIN_TESTS_FIRMWARE_CONSOLE_HPP

#include "tests/firmware/terminal.hpp"

namespace stillspin::test {

class Console : public Terminal {
 protected:
  const std::string kVersion = std::string("stillspin 0.1.0, protocol 1, edition ") + edition_name + "\r\n";
  static bool has(const std::string& where, const std::string& what) { return where.find(what) != std::string::npos; }
};

}  // namespace stillspin::test

#endif
