// The 12-bit converter of the F2808 with its two sequencers.
//
// Timing, in ADCCLK (TI SPRS230/SPRS357D tables, ACQ = ADCTRL1.ACQ_PS):
//     trigger to start of sampling        2.5
//     sample window                       1 + ACQ        the sample is taken at its end ("hold")
//     hold to first result                4 (A), in simultaneous mode 5 for B
//     from one hold to the next           2 + ACQ sequential, 3 + ACQ simultaneous (a pair An, Bn)
// So a burst of four pairs at 12.5 MHz (8 ticks) holds at 28, 52, 76, 100 ticks after the trigger and ends at 140.
// ADCCLK = HSPCLK / (2 ADCCLKPS, or 1 if 0) / (CPS + 1), taken over at the start of a sequence. Its phase is not
// modelled: the 2.5 count from the trigger itself, and half an ADCCLK of an odd number of ticks is rounded up.
//
// Sequencers: SEQ1 has CONV00..07 and RESULT0..7, SEQ2 CONV08..15 and RESULT8..15, cascaded (SEQ_CASC) one of all 16.
// In simultaneous mode CONVxx names the pair, its results go to two registers, and a pointer turns back to the first
// CONV when its result registers are full (after 4 pairs, 8 when cascaded). The pointer stays where a sequence ended
// until RST_SEQn is written. A running sequence is never interrupted; a trigger that comes meanwhile waits (one for
// each sequencer, shown by SOC_SEQn), a second one is lost; SEQ1 goes first. A waiting sequence starts when the running
// one ends, with the full trigger-to-sample time.
//
// Codes are 0 until the band gap and the core have been powered for 5 ms.
// Not modelled: internal calibration, external trigger pin, external reference, emulation halt.

#ifndef STILLSPIN_SIM_HOST_CHIP_ADC_HPP
#define STILLSPIN_SIM_HOST_CHIP_ADC_HPP

#include <cstdint>

#include "sim_host/chip/adc_sequencer.hpp"
#include "sim_host/chip/peripheral.hpp"

namespace stillspin::chip {

class Adc final : public Peripheral {
 public:
  static constexpr Tick kPowerUpTicks = kTicksPerSecond / 200;  // 5 ms

  /// Counts since construction, for tests and reports.
  struct Statistics {
    std::uint64_t sequences = 0;         // completed
    std::uint64_t delayed_triggers = 0;  // had to wait for a running sequence
    std::uint64_t lost_triggers = 0;     // came while one was already waiting
    std::uint64_t aborted = 0;           // sequences ended by RST_SEQn, RESET or the clock gate
  };

  explicit Adc(ChipServices& services) : services_(services) {}

  void reset(Tick t) override;
  std::uint16_t read(std::uint16_t offset, Tick t) override;
  void write(std::uint16_t offset, std::uint16_t value, Tick t) override;
  Tick next_event() const override { return next_event_; }
  void run_event(Tick t) override;
  void clocks_changed(Tick t) override;

  /// RESULTn, right-justified, as a read at t finds it.
  std::uint16_t result(unsigned n, Tick t) {
    if (first_ready_ <= t) store_results(t);
    return results_[n];
  }

  /// The pulse that the ePWM bank sent: SOCA (true) or SOCB.
  void start_of_conversion(bool soca, Tick t);

  /// Erratum of silicon revisions 0, A, B (SPRZ171): in simultaneous mode Bn reads high by An/256. Off by default.
  void set_crosstalk(bool on) { crosstalk_ = on; }

  const Statistics& statistics() const { return statistics_; }

 private:
  struct Timing {  // ticks, fixed at the start of a sequence
    Tick trigger_to_hold = 0;
    Tick hold_to_hold = 0;
    Tick hold_to_a = 0;
    Tick hold_to_b = 0;
    bool simultaneous = false;
  };
  struct Conversion {
    Tick ready = 0;
    std::uint16_t code = 0;
    std::uint8_t index = 0;
  };
  static constexpr int kMaxInFlight = 32;  // a sequence of 16 pairs

  bool cascaded() const;
  AdcSequencer& sequencer(int n) { return sequencers_[n]; }
  void trigger(int n, Tick t);
  void start(int n, Tick t);
  void start_waiting(Tick t);
  void hold(Tick t);
  void end_of_sequence(Tick t);
  void abort(int n, Tick t);
  void reset_sequencer(int n, Tick t);
  void set_interrupt_flag(int n, Tick t);
  std::uint16_t convert(int channel, Tick t);
  void queue_result(int index, int code, Tick ready);
  void store_results(Tick t);
  void drop_results();
  Timing timing() const;
  void write_control1(std::uint16_t value, Tick t);
  void write_control2(std::uint16_t value, Tick t);
  void write_control3(std::uint16_t value, Tick t);
  void write_status(std::uint16_t value);
  std::uint16_t read_control2() const;
  std::uint16_t read_status() const;
  std::uint16_t read_sequence_status() const;
  bool powered(Tick t) const;

  ChipServices& services_;
  AdcSequencer sequencers_[2];
  int active_ = -1;    // index of the running sequencer
  int remaining_ = 0;  // SEQ_CNTR: conversions (pairs) still to be held, minus one
  bool all_held_ = false;
  Timing timing_;
  Tick next_event_ = kNever;
  Conversion in_flight_[kMaxInFlight];  // of the running sequence, in the order in which they become ready
  int first_in_flight_ = 0;
  int in_flight_end_ = 0;
  Tick first_ready_ = kNever;
  std::uint16_t results_[16] = {};  // codes 0..4095, brought up to date when somebody looks or a sequence ends

  std::uint16_t control1_ = 0;
  std::uint16_t control2_ = 0;  // enables and modes; the SOC and RST bits live in the sequencers
  std::uint16_t control3_ = 0;
  std::uint16_t max_conversions_ = 0;
  std::uint16_t channel_select_[4] = {};
  std::uint16_t interrupt_flags_ = 0;  // ADCST bits INT_SEQ1, INT_SEQ2
  std::uint16_t reference_ = 0;
  std::uint16_t offset_trim_ = 0;
  Tick powered_since_ = kNever;
  bool crosstalk_ = false;
  Statistics statistics_;
};

}  // namespace stillspin::chip

#endif
