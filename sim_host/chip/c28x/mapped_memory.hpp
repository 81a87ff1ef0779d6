// The memory of the C28x core: what was mapped it reads and writes by itself, the rest is the bus's.

#ifndef STILLSPIN_SIM_HOST_CHIP_C28X_MAPPED_MEMORY_HPP
#define STILLSPIN_SIM_HOST_CHIP_C28X_MAPPED_MEMORY_HPP

#include <array>
#include <cstdint>

#include "sim_host/chip/c28x/bus.hpp"
#include "sim_host/chip/c28x/registers.hpp"

namespace stillspin::c28x {

class MappedMemory {
 public:
  explicit MappedMemory(Bus& bus) : bus_(bus) {}

  static constexpr std::uint32_t kPage = 1024;

  /// `first` and `words` are multiples of kPage; `memory` has to live as long. Writes to what is not writable go to the
  /// bus.
  void map(std::uint32_t first, std::uint32_t words, std::uint16_t* memory, bool writable) {
    for (std::uint32_t offset = 0; offset < words; offset += kPage) {
      readable_[(first + offset) / kPage] = memory + offset;
      writable_[(first + offset) / kPage] = writable ? memory + offset : nullptr;
    }
  }

  std::uint16_t read16(std::uint32_t address) {
    const std::uint32_t a = address & kProgramMask;
    const std::uint16_t* page = readable_[a / kPage];
    return page != nullptr ? page[a % kPage] : bus_.read(a);
  }
  /// 32-bit accesses are at even addresses: the lowest bit does not count.
  std::uint32_t read32(std::uint32_t address) {
    const std::uint32_t a = address & (kProgramMask - 1);
    const std::uint16_t* page = readable_[a / kPage];
    return page != nullptr ? joined(page[a % kPage + 1], page[a % kPage]) : bus_.read_pair(a);
  }
  void write16(std::uint32_t address, std::uint16_t value) {
    const std::uint32_t a = address & kProgramMask;
    std::uint16_t* page = writable_[a / kPage];
    if (page != nullptr) page[a % kPage] = value;
    if (page == nullptr) bus_.write(a, value);
  }
  void write32(std::uint32_t address, std::uint32_t value) {
    const std::uint32_t a = address & (kProgramMask - 1);
    std::uint16_t* page = writable_[a / kPage];
    if (page == nullptr) return bus_.write_pair(a, value);
    page[a % kPage] = low_half(value);
    page[a % kPage + 1] = high_half(value);
  }

  /// Where the core reads this word by itself; nullptr where the bus does.
  const std::uint16_t* readable_word(std::uint32_t address) const {
    const std::uint16_t* page = readable_[(address & kProgramMask) / kPage];
    return page == nullptr ? nullptr : page + address % kPage;
  }

  Bus& bus() { return bus_; }

 private:
  static constexpr std::uint32_t kPages = (kProgramMask + 1) / kPage;

  Bus& bus_;
  std::array<const std::uint16_t*, kPages> readable_{};
  std::array<std::uint16_t*, kPages> writable_{};
};

}  // namespace stillspin::c28x

#endif
