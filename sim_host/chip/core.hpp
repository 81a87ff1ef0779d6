// The inside of the virtual chip: time, event order, bus and CPU. Not for users of the chip, see chip.hpp.
//
// Split over core.cpp (life cycle, events, services), cpu.cpp (interrupts, IDLE, time), bus.cpp (register accesses,
// with bus_can.cpp and bus_memory.cpp) and target.cpp (the firmware's C functions, which reach the core that runs on
// their thread).
//
// The fast path of an access: add its cost to now_, compare with horizon_, decode, test for an interrupt. horizon_ is
// the last tick that can be reached without an event or the end of the run.

#ifndef STILLSPIN_SIM_HOST_CHIP_CORE_HPP
#define STILLSPIN_SIM_HOST_CHIP_CORE_HPP

#include <array>
#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "sim_host/chip/adc.hpp"
#include "sim_host/chip/chip.hpp"
#include "sim_host/chip/code_cpu.hpp"
#include "sim_host/chip/coroutine.hpp"
#include "sim_host/chip/cpu_timers.hpp"
#include "sim_host/chip/ecan.hpp"
#include "sim_host/chip/epwm.hpp"
#include "sim_host/chip/eqep.hpp"
#include "sim_host/chip/flash_control.hpp"
#include "sim_host/chip/gpio.hpp"
#include "sim_host/chip/i2c.hpp"
#include "sim_host/chip/interrupts.hpp"
#include "sim_host/chip/memory.hpp"
#include "sim_host/chip/peripheral.hpp"
#include "sim_host/chip/recording.hpp"
#include "sim_host/chip/sci.hpp"
#include "sim_host/chip/system_control.hpp"
#include "sim_host/chip/watchdog.hpp"

namespace stillspin::chip {

constexpr std::uint16_t kRevisionC = 3;  // the last one that the errata SPRZ171 name

class Core final : public ChipServices {
 public:
  Core(World& world, Chip::Firmware firmware);
  ~Core() = default;
  Core(const Core&) = delete;
  Core& operator=(const Core&) = delete;

  /// Makes `core` the one that the target_* functions of this thread reach; gives back the one before.
  static Core* set_current(Core* core);
  static Core& running();

  // ---- for Chip
  void run_until(Tick t);
  Tick now() const { return now_; }
  Statistics statistics() const;
  void set_revision(std::uint16_t revision);
  void block_adc_triggers(bool on) { adc_blocked_ = on; }
  void hold_interrupts(bool on) { interrupts_.set_held(on); }
  void fail(Failure failure);
  const std::string& error() const { return error_; }
  void pins_changed() { pins_dirty_ = world_touched_ = true; }
  void stop_can_transmission();
  bool is_idle() const { return idle_; }
  std::uint16_t inspect(std::uint32_t address);
  Memory& memory() { return memory_; }
  void on_jump(Chip::Jump jump) { jump_ = std::move(jump); }
  c28x::Core& execute_code();
  void replace_flash_library(const FlashLibrary& places);
  const InVain& in_vain();
  Recording& recording() {
    if (recording_ == nullptr) recording_ = std::make_unique<Recording>();
    return *recording_;
  }
  bool raise_from_outside(unsigned vector) { return interrupts_.raise(vector); }

  // ---- for the firmware (target_*)
  std::uint16_t read16(std::uint32_t address);
  void write16(std::uint32_t address, std::uint16_t value);
  std::uint32_t read32(std::uint32_t address);
  void write32(std::uint32_t address, std::uint32_t value);
  void set_eallow(bool on);
  void set_interrupts_masked(bool masked);
  std::uint16_t read_ier();
  void write_ier(std::uint16_t mask);
  void clear_ifr();
  void set_vector(std::uint16_t vector, Isr isr);
  void idle();
  void elapse(std::uint16_t cycles);

  // ---- for what is no firmware but the manufacturer's: boot ROM, flash library
  void jump(std::uint32_t entry);
  void pass(Tick ticks);

  // ---- for the peripherals
  void raise_interrupt(unsigned vector, Tick t) override;
  void start_of_conversion(bool soca, Tick t) override;
  void pwm_outputs(int module, bool a, bool b, Tick t) override;
  std::uint16_t sample(int channel, Tick t) override;
  std::int64_t encoder_edges(Tick t) override;
  Tick serial_reaches(Tick t, bool level) override;
  void serial_frame(const SerialFrame& frame, Tick t) override;
  void i2c_pins(bool sda, bool scl, Tick t) override;
  bool sda_level(Tick t) override { return gpio_.sda_level(t); }
  bool scl_level(Tick t) override { return gpio_.scl_level(t); }
  Tick sysclk_period() const override { return system_.sysclk_period(); }
  unsigned hspclk_divider() const override { return system_.hspclk_divider(); }
  unsigned lspclk_divider() const override { return system_.lspclk_divider(); }
  bool epwm_clock(int module) const override { return system_.epwm_clock(module); }
  bool adc_clock() const override { return system_.adc_clock(); }
  bool eqep_clock(int instance) const override { return system_.eqep_clock(instance); }
  bool sci_clock() const override { return system_.sci_clock(); }
  bool i2c_clock() const override { return system_.i2c_clock(); }
  void model_error(const char* text, std::int64_t value) override;

 private:
  friend class CodeCpu;

  // In the order in which they run at one tick.
  enum Source : unsigned { kWorldCall, kSystem, kEPwm, kAdc, kEQep1, kSci, kI2c, kECanA, kTimers, kWatchdog, kSources };

  // Life cycle (core.cpp).
  static void firmware_entry(void* core);
  void reset(Tick t, bool by_watchdog);
  void reset_peripherals(Tick t);
  void resume_firmware();
  void check_outcome();
  [[noreturn]] void leave_firmware();
  void request_reset();
  void fail_with_current_exception();

  // Time and events (core.cpp).
  void spend(Tick cycles) {
    const Tick target = now_ + cycles * period_;
    if (target <= horizon_) {
      now_ = target;
    } else {
      advance(target);
    }
  }
  void advance(Tick target);
  void wait_for_interrupt(Tick target, bool taken);
  template <typename Wake>
  bool run_events(Tick last, Wake wake);
  void run_event(Source source);
  void run_world();
  void run_watchdog();
  void after_world();
  void look_at_pins();
  void update_trips();
  void apply(unsigned system_effects);
  // Notes when a source next wants to run and keeps the earliest at hand; at one tick the lower source goes first.
  // ePWM and ADC change with almost every event, the others seldom: their earliest is kept separately.
  void set_due(Source source, Tick due) {
    if (due_[source] == due) return;
    due_[source] = due;
    if (source != kEPwm && source != kAdc) find_rest();
    find_next();
  }
  void find_next() {
    Source first = due_[kAdc] < due_[kEPwm] ? kAdc : kEPwm;
    const Tick rest = due_[rest_source_];
    if (rest < due_[first] || (rest == due_[first] && rest_source_ < first)) first = rest_source_;
    next_source_ = first;
    next_event_ = due_[first];
    horizon_ = next_event_ - 1 < limit_ ? next_event_ - 1 : limit_;
  }
  void find_rest();
  void check_flash_waits();

  // CPU (cpu.cpp).
  void spend_instruction();
  void finish_access() {
    if (stop_) leave_firmware();
    if (interrupts_.deliverable()) take_interrupts();
  }
  void take_interrupts();
  void take_interrupt();
  void run_isr(unsigned vector);
  void trap(unsigned vector);
  bool is_failing() const {
    if (failure_ == Failure::kHalted) return true;
    return failure_ != Failure::kNone && depth_ == (failure_ == Failure::kInterruptHangs ? 1u : 0u);
  }
  [[noreturn]] void go_on_failing();

  // Bus (bus.cpp).
  std::uint16_t read_word(std::uint32_t address);
  std::uint16_t bus_read(std::uint32_t address);
  void bus_write(std::uint32_t address, std::uint16_t value);
  bool protection_stops(std::uint32_t address);
  bool gate_stops(bool clocked, std::uint32_t address);
  void note_unmodelled(std::uint32_t address, bool write);
  std::uint16_t read_identity(std::uint32_t address) const;
  void write_system(std::uint16_t offset, std::uint16_t value);
  std::uint16_t read_system(std::uint16_t offset) const;
  void write_epwm(std::uint32_t address, std::uint16_t value);
  std::uint16_t read_epwm(std::uint32_t address);
  void write_gpio(std::uint32_t address, std::uint16_t value);
  void write_flash(std::uint32_t address, std::uint16_t value);
  void write_adc(std::uint32_t address, std::uint16_t value);
  void write_eqep1(std::uint32_t address, std::uint16_t value);
  void write_sci(std::uint32_t address, std::uint16_t value);
  std::uint16_t read_gpio(std::uint16_t offset);
  std::uint16_t read_sci(std::uint32_t address);
  void write_i2c(std::uint32_t address, std::uint16_t value);
  std::uint16_t read_i2c(std::uint32_t address);
  std::uint16_t read_can16(std::uint32_t address);
  std::uint32_t read_can32(std::uint32_t address);
  void write_can(std::uint32_t address, std::uint32_t value, bool wide);
  Tick read_cycles(std::uint32_t address) const;
  Tick memory_cycles(std::uint32_t address) const;
  std::uint16_t read_memory(std::uint32_t address);
  void write_memory(std::uint32_t address, std::uint16_t value);
  std::uint16_t inspect_memory(std::uint32_t address);

  // A look from outside, while it lasts: nobody counts what it touches.
  class Inspection {
   public:
    explicit Inspection(Core& core) : core_(core), before_(core.statistics_) { core_.inspecting_ = true; }
    ~Inspection() {
      core_.inspecting_ = false;
      core_.statistics_ = before_;
    }
    Inspection(const Inspection&) = delete;
    Inspection& operator=(const Inspection&) = delete;

   private:
    Core& core_;
    const Statistics before_;
  };

  // Touched at every access: kept together.
  Tick now_ = 0;
  Tick horizon_ = -1;
  Tick period_ = 2 * kOscillatorPeriod;  // SYSCLKOUT
  bool stop_ = false;                    // a reset or an error waits: leave the firmware
  bool world_touched_ = false;           // its next call may have moved
  bool pins_dirty_ = false;
  bool eallow_ = false;
  bool idle_ = false;
  bool inspecting_ = false;
  std::uint16_t revision_ = kRevisionC;
  Interrupts interrupts_;
  Tick limit_ = 0;
  Tick next_event_ = kNever;
  Source next_source_ = kWorldCall;
  Source rest_source_ = kWorldCall;  // the earliest besides ePWM and ADC
  std::array<Tick, kSources> due_{};
  Statistics statistics_;

  World& world_;
  Chip::Firmware firmware_;
  Chip::Jump jump_;
  SystemControl system_;
  Watchdog watchdog_;
  CpuTimers timers_;
  Gpio gpio_;
  FlashControl flash_;
  EPwmBank epwm_;
  Adc adc_;
  EQep eqep1_;
  Sci sci_;
  I2c i2c_;
  ECan ecan_;

  unsigned depth_ = 0;  // nested interrupts
  Failure failure_ = Failure::kNone;
  unsigned trips_ = 0;
  bool adc_blocked_ = false;
  std::int64_t encoder_held_ = 0;
  Tick release_ = 0;  // end of the reset pulse
  bool reset_requested_ = false;
  std::string error_;
  std::exception_ptr exception_;
  Coroutine coroutine_;
  std::unique_ptr<CodeCpu> code_;
  std::unique_ptr<Recording> recording_;  // nothing is noted without
  Memory memory_;                         // large: behind what every access touches
};

}  // namespace stillspin::chip

#endif
