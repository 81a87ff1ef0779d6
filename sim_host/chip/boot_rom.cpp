#include "sim_host/chip/boot_rom.hpp"

#include "hal/f2808/registers.h"
#include "hal/f2808/target.h"
#include "sim_host/chip/core.hpp"

namespace stillspin::chip {
namespace {

constexpr std::uint32_t kPort = SCI_BASE(1);
constexpr std::uint32_t kEntryRam = 0x000000;
constexpr std::uint32_t kEntryOtp = 0x3D7800;
constexpr unsigned kReservedWords = 8;
constexpr std::uint16_t kLoopCycles = 20;  // of a loop that waits for an octet, beside its access

constexpr std::uint16_t bits(unsigned value) { return static_cast<std::uint16_t>(value); }

void write_protected(std::uint32_t address, unsigned value) {
  target_eallow();
  target_write16(address, bits(value));
  target_edis();
}

unsigned mode() {
  const std::uint32_t low = target_read32(REG_GPADAT), high = target_read32(REG_GPBDAT);
  return (low >> 18 & 1u) << 2 | (low >> 29 & 1u) << 1 | (high >> 2 & 1u);
}

void read_passwords() {
  for (unsigned n = 0; n < kPasswordWords; ++n) (void)target_read16(REG_PSWD(n));
}

// ---- the serial loader -----------------------------------------------------------------------------------

void set_up_port() {
  write_protected(REG_LOSPCP, 2);  // LSPCLK is SYSCLKOUT / 4
  write_protected(REG_PCLKCR0, PCLKCR0_SCIAENCLK_MASK);
  target_write16(kPort + SCI_FFTX, SCI_FFTX_SCIRST_MASK);
  target_write16(kPort + SCI_FFRX, 0);
  target_write16(kPort + SCI_CCR, 7);  // 8N1
  target_write16(kPort + SCI_CTL1, SCI_CTL1_RXENA_MASK | SCI_CTL1_TXENA_MASK);
  target_write16(kPort + SCI_CTL2, 0);
  target_write16(kPort + SCI_HBAUD, 0);
  target_write16(kPort + SCI_LBAUD, 1);
  target_write16(kPort + SCI_CTL1, SCI_CTL1_RXENA_MASK | SCI_CTL1_TXENA_MASK | SCI_CTL1_SWRESET_MASK);
  target_eallow();
  target_write32(REG_GPAMUX2, target_read32(REG_GPAMUX2) | 1u << 24 | 1u << 26);  // GPIO28, GPIO29
  target_edis();
}

std::uint16_t receive() {
  while ((target_read16(kPort + SCI_RXST) & SCI_RXST_RXRDY_MASK) == 0) target_elapse(kLoopCycles);
  const auto octet = bits(target_read16(kPort + SCI_RXBUF) & SCI_RXBUF_RXDT_MASK);
  target_write16(kPort + SCI_TXBUF, octet);
  return octet;
}

std::uint16_t receive_word() {
  const std::uint16_t low = receive();
  return bits(low | static_cast<unsigned>(receive()) << 8);
}

std::uint32_t receive_address() {
  const std::uint32_t high = receive_word();
  return high << 16 | receive_word();
}

void lock_to_the_rate() {
  target_write16(kPort + SCI_FFCT, SCI_FFCT_ABDCLR_MASK | SCI_FFCT_CDC_MASK);
  while ((target_read16(kPort + SCI_FFCT) & SCI_FFCT_ABD_MASK) == 0) target_elapse(kLoopCycles);
  target_write16(kPort + SCI_FFCT, SCI_FFCT_ABDCLR_MASK);
  receive();
}

std::uint32_t load_from_port() {
  set_up_port();
  lock_to_the_rate();
  if (receive_word() != kBootKey) return kFlashEntry;
  for (unsigned n = 0; n < kReservedWords; ++n) receive_word();
  const std::uint32_t entry = receive_address();
  while (const std::uint16_t size = receive_word()) {
    const std::uint32_t to = receive_address();
    for (std::uint32_t n = 0; n < size; ++n) target_write16(to + n, receive_word());
  }
  return entry;
}

std::uint32_t choose_entry() {
  switch (mode()) {
    case 0b111:
      return kFlashEntry;
    case 0b110:
      return load_from_port();
    case 0b010:
      return kEntryRam;
    case 0b001:
      return kEntryOtp;
    default:
      Core::running().model_error("boot ROM: this loader is not modelled, mode pins", mode());
      return kFlashEntry;
  }
}

}  // namespace

void boot_rom() {
  write_protected(REG_WDCR, 5u << WDCR_WDCHK_LSB | WDCR_WDDIS_MASK);
  read_passwords();
  const std::uint32_t entry = choose_entry();
  write_protected(REG_WDCR, 5u << WDCR_WDCHK_LSB);
  write_protected(REG_WDKEY, 0x55);
  write_protected(REG_WDKEY, 0xAA);
  Core::running().jump(entry);
}

}  // namespace stillspin::chip
