// One quadrature encoder module (eQEP), as far as a motor drive uses it.
//
// The world counts the quadrature edges; the position counter is brought up to date when somebody looks: at a register
// access and at the unit timer's events. QPOSCNT runs from 0 to QPOSMAX and wraps. In the index modes the index pulse,
// which lies at every multiple of QPOSMAX + 1 edges since power-on, puts it on its absolute place (0 forward, QPOSMAX
// backward); before the first index it counts from where it was.
//     QEPCTL.PCRM  0 index resets, 1 wrap at QPOSMAX, 2 first index resets then wrap, 3 unit timer resets
//     QEPCTL.QCLM  1: QPOSLAT takes QPOSCNT at each unit timer event; 0: when the CPU reads QPOSCNT
// The unit timer counts SYSCLKOUT and gives an event each QUPRD cycles.
//
// What laziness costs: an index that was passed forth and back between two looks is not seen, and the flags PCO, PCU,
// QDC and IEL rise when somebody looks, not at the edge; UTO is exact.
// Not modelled: strobe, position compare, edge capture, watchdog, direction-count modes, pin polarity (QAP, QBP, QIP).
// Source: TI SPRU790 (eQEP), from memory.

#ifndef STILLSPIN_SIM_HOST_CHIP_EQEP_HPP
#define STILLSPIN_SIM_HOST_CHIP_EQEP_HPP

#include <cstdint>

#include "sim_host/chip/peripheral.hpp"

namespace stillspin::chip {

class EQep final : public Peripheral {
 public:
  /// `instance` 1 or 2; nothing is wired to eQEP2, its counter stands still.
  EQep(ChipServices& services, int instance) : services_(services), instance_(instance) {}

  void reset(Tick t) override;
  std::uint16_t read(std::uint16_t offset, Tick t) override;
  void write(std::uint16_t offset, std::uint16_t value, Tick t) override;
  Tick next_event() const override { return next_event_; }
  void run_event(Tick t) override;
  void clocks_changed(Tick t) override;

 private:
  std::int64_t edges(Tick t) const;
  std::int64_t counts() const { return static_cast<std::int64_t>(position_max_) + 1; }
  bool enabled() const;
  void look(Tick t);
  void pass_index(std::int64_t from, std::int64_t to);
  void move(std::int64_t by);
  void set_flag(unsigned mask, Tick t);
  void send_interrupt(Tick t);
  void write_control(std::uint16_t value, Tick t);
  void write_wide(std::uint16_t offset, std::uint16_t value, Tick t);
  void settle_unit_timer(Tick t);
  void schedule_unit_timer();
  std::uint32_t unit_timer(Tick t) const;
  std::uint32_t* wide_register(std::uint16_t offset);

  ChipServices& services_;
  int instance_;

  std::uint32_t position_ = 0;          // QPOSCNT
  std::uint32_t position_init_ = 0;     // QPOSINIT
  std::uint32_t position_max_ = 0;      // QPOSMAX
  std::uint32_t position_compare_ = 0;  // QPOSCMP, stored
  std::uint32_t index_latch_ = 0;       // QPOSILAT
  std::uint32_t strobe_latch_ = 0;      // QPOSSLAT
  std::uint32_t position_latch_ = 0;    // QPOSLAT
  std::uint32_t unit_period_ = 0;       // QUPRD
  std::uint16_t decoder_ = 0;           // QDECCTL
  std::uint16_t control_ = 0;           // QEPCTL
  std::uint16_t capture_ = 0;           // QCAPCTL, stored
  std::uint16_t compare_control_ = 0;   // QPOSCTL, stored
  std::uint16_t interrupt_enable_ = 0;  // QEINT
  std::uint16_t flags_ = 0;             // QFLG
  std::uint16_t status_ = 0;            // QEPSTS without the direction
  bool forward_ = true;
  bool index_seen_ = false;
  std::int64_t last_edges_ = 0;

  std::uint32_t unit_count_ = 0;  // QUTMR at unit_anchor_
  Tick unit_anchor_ = 0;
  Tick sysclk_period_ = 1;
  bool clocked_ = false;
  Tick next_event_ = kNever;
};

}  // namespace stillspin::chip

#endif
