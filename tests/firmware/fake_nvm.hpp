// The memory under the store: octets in an array, a job that takes a few steps, and a power supply that can be cut at
// any octet of any job and in any page's write cycle.

#ifndef STILLSPIN_TESTS_FIRMWARE_FAKE_NVM_HPP
#define STILLSPIN_TESTS_FIRMWARE_FAKE_NVM_HPP

#include <cstdint>
#include <functional>
#include <vector>

#include "hal/hal_nvm.h"

namespace stillspin::test {

class FakeNvm {
 public:
  std::vector<std::uint8_t> memory = std::vector<std::uint8_t>(HAL_NVM_SIZE, 0xFF);
  std::vector<unsigned> wear = std::vector<unsigned>(HAL_NVM_SIZE / HAL_NVM_PAGE, 0);
  bool absent = false;
  bool write_protected = false;
  int latency = 2;  // steps that are BUSY

  /// Octets that have gone over the bus, and pages that have been written.
  long octets = 0;
  long pages = 0;

  /// The power goes before octet number n (counted by `octets`), or in the write cycle of page number n; -1 never. What
  /// is left of the page then: `torn(k, before, after)` is its octet k.
  long cut_at_octet = -1;
  long cut_at_page = -1;
  std::function<std::uint8_t(unsigned, std::uint8_t, std::uint8_t)> torn;
  bool powered = true;

  /// Octet number n (counted by `octets`) is read wrong; job number n is not acknowledged, or not taken; -1 never.
  long wrong_at_octet = -1;
  long jobs = 0;
  long deaf_job = -1, refused_job = -1;
  long deaf_jobs = 1;  // so many in a row

  /// Octets that do not take what is written to them.
  std::vector<unsigned> dead;

  hal_nvm_state_t state = NVM_IDLE;
  std::uint16_t address = 0, count = 0;
  std::uint16_t* read = nullptr;
  const std::uint16_t* write = nullptr;
  int left = 0;

  bool begin(std::uint16_t where, std::uint16_t* in, const std::uint16_t* out, std::uint16_t n);
  hal_nvm_state_t step();

 private:
  bool deaf = false;  // the job under way
  bool pass_octets();
  void write_page();
};

extern FakeNvm nvm;

}  // namespace stillspin::test

#endif
