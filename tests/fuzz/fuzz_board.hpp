// What both searches say of the drive's parameters.

#ifndef STILLSPIN_TESTS_FUZZ_FUZZ_BOARD_HPP
#define STILLSPIN_TESTS_FUZZ_FUZZ_BOARD_HPP

#include <string>

namespace stillspin::test {

/// Complains about a parameter that is out of its range; empty when there is none.
std::string fuzz_complaint_of_parameters();

}  // namespace stillspin::test

#endif
