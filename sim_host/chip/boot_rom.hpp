// What the boot ROM does between a reset and its jump: mode pins, passwords, serial loader.
//
// GPIO18, GPIO29, GPIO34 = 111 jump to the flash entry, 010 to M0, 001 to OTP, 110 the loader at SCI-A: autobaud on 'A'
// or 'a', which is echoed; key 0x08AA, else the flash entry; eight words that are not used; entry point; blocks of
// size, address and data up to a size of 0. Words come low octet first, two-word numbers high word first, and every
// octet is echoed at once. There is no check sum, no check of addresses and no time-out. The watchdog is off while the
// ROM works and on again when it jumps.
// Not modelled: the loaders at SPI, I2C, eCAN and the parallel port (they end the run), what the CPU's modes are.
// Source: the published source of the 2833x boot ROM, whose SCI loader is the 280x's (SPRU722); see docs/flash.md.

#ifndef STILLSPIN_SIM_HOST_CHIP_BOOT_ROM_HPP
#define STILLSPIN_SIM_HOST_CHIP_BOOT_ROM_HPP

#include <cstdint>

namespace stillspin::chip {

inline constexpr int kBootPins[] = {18, 29, 34};
inline constexpr std::uint16_t kBootKey = 0x08AA;

/// To be a chip's firmware; what it jumps to is Chip::on_jump's business.
void boot_rom();

}  // namespace stillspin::chip

#endif
