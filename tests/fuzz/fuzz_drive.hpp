// The drive under a search: every state as the drive's own interrupt has reached it, and time that passes fast.
//
// The control interrupt is the firmware's own, on the windows of a machine at rest. One is played for a step of time
// instead of ten for a millisecond: the one in which the tasks of the millisecond have their turn. The background level
// is the caller's, but for background_step.

#ifndef STILLSPIN_TESTS_FUZZ_FUZZ_DRIVE_HPP
#define STILLSPIN_TESTS_FUZZ_FUZZ_DRIVE_HPP

#include <cstdint>
#include <string>

#include "tests/firmware/fake_hal.hpp"

namespace stillspin::test {

constexpr int kDriveStates = DRIVE_COMMISSION + 1;

/// Power-on of the whole firmware with a memory that has never been written, READY.
void fuzz_power_on();

/// Puts the drive into a state; time, requests and parameters stay.
void fuzz_put_into(drive_state_t state);

/// A fault that comes now; `which` may be anything.
void fuzz_fault(unsigned which);

/// `ms` of the drive's time, at the end of which the control interrupt comes.
void fuzz_pass(int ms);

/// Names a parameter that is out of its range; empty when there is none.
std::string fuzz_parameter_out_of_range();

}  // namespace stillspin::test

#endif
