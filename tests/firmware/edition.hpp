// The edition whose tables the tests' drive has: the same tests are linked with each edition's (CMakeLists.txt).

#ifndef STILLSPIN_TESTS_FIRMWARE_EDITION_HPP
#define STILLSPIN_TESTS_FIRMWARE_EDITION_HPP

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

extern "C" {
#include "firmware/base/edition.h"
}

namespace stillspin::test {

extern const char* const features_left_out[];  // nullptr behind the last one

/// The first of these features that the edition has not, or nothing.
inline std::string missing_of(std::initializer_list<std::string> features) {
  for (const std::string& feature : features) {
    for (const char* const* gone = features_left_out; *gone != nullptr; ++gone) {
      if (feature == *gone) return feature;
    }
  }
  return "";
}

}  // namespace stillspin::test

/// What a test is about, features by their folders in firmware/: where the edition has not all of them it is left out.
#define NEEDS(...)                                                                        \
  if (const std::string gone = stillspin::test::missing_of({__VA_ARGS__}); !gone.empty()) \
  GTEST_SKIP() << gone << " is not in this edition"

#endif
