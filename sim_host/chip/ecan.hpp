// eCAN-A: the CAN controller with 32 mailboxes, at its registers and towards the bus (can_line.hpp).
//
// Modelled: mailboxes with acceptance masks, overwrite protection and lost messages, order of transmission by TPL and
// number, withdrawal (TRR), time stamps, configuration by the CCR/CCE handshake, bit timing from SYSCLKOUT, error
// counters, error passive, bus-off and its two ways back (ABO; CCR), interrupt flags and lines, pins that must be
// routed both in the GPIO and in TIOC/RIOC.
//
// Control registers take 32-bit accesses only. A narrow read gives 0 there, a narrow write puts its word into both
// halves: the manuals say "corrupts" without saying how, and this is a way that no program survives by luck. Mailbox
// memory takes either.
//
// CCE is granted when the module is not inside of a frame and the line is recessive. Leaving configuration needs a bit
// timing and then 11 recessive bits; after bus-off it needs 128 times 11, with CCR = 0 (which the module sets itself)
// unless ABO is set. The counters are cleared on entering configuration and at the end of bus-off.
//
// Erratum (SPRZ171, all revisions), when a test asks for it: transmission stops until CCR has been set, CCE seen, and
// CCR cleared; reception goes on.
//
// Not modelled: 16-mailbox mode (its use ends the run), self test, power-down, automatic answers to remote frames,
// remote requests, MOTO time-outs (registers only), CDR, emulation suspend. Source: SPRUEU1, from memory where it
// could not be read; SPRU357 for the error counters.

#ifndef STILLSPIN_SIM_HOST_CHIP_ECAN_HPP
#define STILLSPIN_SIM_HOST_CHIP_ECAN_HPP

#include <array>
#include <cstdint>

#include "hal/f2808/registers.h"
#include "sim_host/chip/can_line.hpp"
#include "sim_host/chip/peripheral.hpp"

namespace stillspin::chip {

class ECan final : public CanNode {
 public:
  /// `line` may be nullptr: a pin with nothing behind it.
  ECan(ChipServices& services, CanLine* line) : services_(services), line_(line) {}
  ~ECan();
  ECan(const ECan&) = delete;
  ECan& operator=(const ECan&) = delete;

  void reset(Tick t);
  static bool is_protected(std::uint16_t offset);
  std::uint32_t read32(std::uint16_t offset, Tick t);  // even offset
  void write32(std::uint16_t offset, std::uint32_t value, Tick t);
  std::uint16_t read16(std::uint16_t offset, Tick t);
  void write16(std::uint16_t offset, std::uint16_t value, Tick t);
  Tick next_event() const { return next_event_; }
  void run_event(Tick t);
  void clocks_changed(Tick t);
  /// Both pins belong to the module.
  void set_routed(bool routed, Tick t);

  /// The erratum strikes now.
  void stop_transmission(Tick t);
  /// Narrow accesses to control registers since power-on.
  std::uint64_t narrow_accesses() const { return narrow_accesses_; }

  std::int64_t can_bit_time() const override { return active_ && connected() ? bit_time_ : 0; }
  const CanFrame* can_offer() override;
  bool can_error_passive() const override { return errors_.passive(); }
  bool can_acknowledges() const override { return true; }
  void can_busy(std::int64_t t, bool mine) override;
  void can_quiet(std::int64_t since, std::int64_t t) override;
  void can_sent(std::int64_t t) override;
  void can_received(const CanFrame& frame, std::int64_t t) override;
  void can_failed(CanError error, bool mine, std::int64_t t) override;

 private:
  struct Mailbox {
    std::uint32_t id, control, low, high;
  };
  enum class Mode { kConfigured, kEntering, kRunning };  // CCE is kConfigured

  bool connected() const { return line_ != nullptr && routed_; }
  std::uint32_t control(std::uint32_t address) const { return control_[offset_of(address) / 2]; }
  std::uint32_t& control(std::uint32_t address) { return control_[offset_of(address) / 2]; }
  static constexpr std::uint16_t offset_of(std::uint32_t address) {
    return static_cast<std::uint16_t>(address - REG_CANME);
  }

  // Registers (ecan_registers.cpp).
  std::uint32_t* memory(std::uint16_t offset);
  std::uint32_t error_status() const;
  std::uint32_t time_stamp(Tick t) const;
  std::uint32_t interrupt_flags(unsigned line) const;
  void write_control(std::uint16_t offset, std::uint32_t value, Tick t);
  void write_memory(std::uint16_t offset, std::uint32_t value, std::uint32_t mask, Tick t);
  void write_master(std::uint32_t value, Tick t);
  void write_timing(std::uint32_t value, Tick t);
  void clear_mailbox_flags(std::uint32_t address, std::uint32_t value);
  void take_back(std::uint32_t mailboxes, Tick t);
  void raise_global(std::uint32_t flag, Tick t);
  void raise_mailbox(unsigned n, Tick t);

  // Configuration, bus and mailboxes (ecan.cpp).
  void soft_reset(Tick t);
  void steer(Tick t);
  void enter_configuration(Tick t);
  void leave_configuration(Tick t);
  void start_waiting(unsigned sequences, Tick t);
  void schedule(Tick t);
  void count_quiet(Tick t);
  void become_active(Tick t);
  void go_bus_off(Tick t);
  void set_active(bool active, Tick t);
  void announce(Tick t);
  void end_own_frame(bool sent, Tick t);
  void note_error(CanError error);
  void watch_levels(bool was_warning, bool was_passive, Tick t);
  int next_to_send() const;
  void load_offer(const Mailbox& box);
  int place_for(const CanFrame& frame, bool& overwrites) const;
  bool accepts(unsigned n, const CanFrame& frame) const;
  void store(unsigned n, const CanFrame& frame, Tick t);

  ChipServices& services_;
  CanLine* line_;
  bool attached_ = false;
  bool routed_ = false;
  std::uint64_t narrow_accesses_ = 0;

  std::array<std::uint32_t, 32> control_{};  // by offset / 2
  std::array<std::uint32_t, 32> mask_{};
  std::array<std::uint32_t, 32> stamp_{};
  std::array<std::uint32_t, 32> time_out_{};
  std::array<Mailbox, 32> mailbox_{};
  CanErrorCounters errors_;
  std::uint32_t flags_[2] = {0, 0};  // global interrupt flags of the two lines

  Mode mode_ = Mode::kConfigured;
  bool active_ = false;  // takes part
  bool bus_off_ = false;
  bool stopped_ = false;    // the erratum
  bool in_frame_ = false;   // of anybody
  bool quiet_ = true;       // the line is recessive ...
  Tick quiet_since_ = 0;    // ... and has been since
  unsigned sequences_ = 0;  // of 11 recessive bits still to be seen
  unsigned counted_ = 0;    // of them in this quiet time
  int sending_ = -1;        // mailbox
  CanFrame offer_;

  Tick bit_time_ = 0;
  std::uint32_t stamp_base_ = 0;
  Tick stamp_anchor_ = 0;
  Tick dead_attempt_ = 0;  // end of the present attempt without a line
  Tick next_event_ = kNever;
};

}  // namespace stillspin::chip

#endif
