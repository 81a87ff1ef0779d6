// What the C28x core is connected to. Addresses count 16-bit words; 22 bits of them reach a bus.
//
// The core reads and writes memory that was mapped (Core::map) by itself; everything else is asked of the bus,
// registers of peripherals above all.

#ifndef STILLSPIN_SIM_HOST_CHIP_C28X_BUS_HPP
#define STILLSPIN_SIM_HOST_CHIP_C28X_BUS_HPP

#include <cstdint>

namespace stillspin::c28x {

class Bus {
 public:
  virtual ~Bus() = default;

  virtual std::uint16_t read(std::uint32_t address) = 0;
  virtual void write(std::uint32_t address, std::uint16_t value) = 0;

  /// A 32-bit access at an even address is one access of a peripheral: registers that change between the halves need
  /// it.
  virtual std::uint32_t read_pair(std::uint32_t address) {
    const std::uint32_t low = read(address);
    return low | static_cast<std::uint32_t>(read(address + 1)) << 16;
  }
  virtual void write_pair(std::uint32_t address, std::uint32_t value) {
    write(address, static_cast<std::uint16_t>(value));
    write(address + 1, static_cast<std::uint16_t>(value >> 16));
  }

  /// The address of the routine of a CPU interrupt vector. `listed` is what the CPU's own table has; a chip with an
  /// interrupt expansion answers from that.
  virtual std::uint32_t vector(unsigned number, std::uint32_t listed) {
    static_cast<void>(number);
    return listed;
  }

  /// The I/O space of IN, OUT and UOUT, which an F2808 has no use for: it reads as ones.
  virtual std::uint16_t read_port(std::uint16_t port) {
    static_cast<void>(port);
    return 0xFFFF;
  }
  virtual void write_port(std::uint16_t port, std::uint16_t value) {
    static_cast<void>(port);
    static_cast<void>(value);
  }
};

}  // namespace stillspin::c28x

#endif
