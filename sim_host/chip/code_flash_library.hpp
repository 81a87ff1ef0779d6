// TI's flash library in a program that is executed: its functions are carried out on the chip's cells, since the
// registers that its machine code would work with are published nowhere.

#ifndef STILLSPIN_SIM_HOST_CHIP_CODE_FLASH_LIBRARY_HPP
#define STILLSPIN_SIM_HOST_CHIP_CODE_FLASH_LIBRARY_HPP

#include <cstdint>
#include <vector>

namespace stillspin::c28x {
class Core;
}

namespace stillspin::chip {

class Core;

/// Addresses of Flash2808_Erase, Flash2808_Program, Flash2808_Verify and of the variable Flash_CPUScaleFactor; 0 for
/// what a program has not.
struct FlashLibrary {
  std::uint32_t erase = 0;
  std::uint32_t program = 0;
  std::uint32_t verify = 0;
  std::uint32_t scale = 0;

  std::vector<std::uint32_t> functions() const;

  /// Carries out the one at the program counter, with its arguments where TI's compiler passes them, and returns to the
  /// caller as LRETR does. The callback is not called and no interrupt is taken meanwhile.
  void carry_out(Core& chip, c28x::Core& cpu) const;
};

}  // namespace stillspin::chip

#endif
