// Records a run of the virtual drive at the boundary of hal/f2808/target.h, for replay.c.
//
// Usage: stillspin_isr_record FILE RPM LOAD SHAFT [NAME=VALUE]...     a start with the shaft at SHAFT (rpm), then RPM,
// then LOAD (N m) as a step. NAME is a firmware parameter, or one of
//   scope       it records
//   link        V of the source that feeds the link
//   then        rpm, the next reference while the load is on
//   stop        the command at that time
//   commission  instead of all that; RPM and LOAD mean nothing
// The linker puts the functions here in the place of the target's and of the commands (-Wl,--wrap).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "firmware/commissioning/outcome.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"
#include "hal/f2808/target.h"
#include "sim_host/bench/commission.hpp"
#include "sim_host/bench/run.hpp"
#include "tests/m3/trace.h"

extern "C" {
#include "tests/m3/scope_run.h"
}

extern "C" void __real_target_elapse(std::uint16_t cycles);  // NOLINT: the name is the linker's

namespace {

constexpr unsigned kVectors = 128;

std::FILE* file = nullptr;
bool inside_chip = false;  // the firmware is inside an access: who calls it now is the host
std::array<target_isr_t, kVectors> vectors{};

void log(trace_kind_t kind, std::uint32_t address = 0, std::uint32_t value = 0) {
  const trace_record_t r = {static_cast<std::uint32_t>(kind) << 24 | address, value};
  if (std::fwrite(&r, sizeof r, 1, file) != 1) std::abort();
}

// Cycles of code that the image has no call for: they pass when the next access begins, where interrupts can come on
// the other machine, too.
std::uint32_t owed = 0;

void pass() {
  while (owed > 0) {
    const auto cycles = static_cast<std::uint16_t>(std::min<std::uint32_t>(owed, 0xFFFF));
    owed -= cycles;
    __real_target_elapse(cycles);
  }
}

class Access {
 public:
  explicit Access(bool inside = true) : before_(inside_chip) {
    inside_chip = inside;
    if (inside) pass();
  }
  ~Access() { inside_chip = before_; }
  Access(const Access&) = delete;
  Access& operator=(const Access&) = delete;

 private:
  bool before_;
};

template <std::size_t vector>
void interrupt() {
  const Access outside(false);
  log(TRACE_INTERRUPT, vector);
  vectors[vector]();
  const drive_signals_t signals = drive_signals();
  log(TRACE_RETURN, vector,
      trace_hash(reinterpret_cast<const std::int32_t*>(&signals), sizeof signals / sizeof(std::int32_t)));
}

template <std::size_t... vector>
constexpr std::array<target_isr_t, kVectors> make_interrupts(std::index_sequence<vector...>) {
  return {interrupt<vector>...};
}
constexpr auto interrupts = make_interrupts(std::make_index_sequence<kVectors>());

}  // namespace

// The names are the linker's.
// NOLINTBEGIN
#define WRAP_CPU(name)       \
  void __real_##name(void);  \
  void __wrap_##name(void) { \
    {                        \
      const Access access;   \
      __real_##name();       \
    }                        \
    log(TRACE_CPU);          \
  }
#define WRAP_READ(name, type, kind)           \
  type __real_##name(std::uint32_t address);  \
  type __wrap_##name(std::uint32_t address) { \
    type value;                               \
    {                                         \
      const Access access;                    \
      value = __real_##name(address);         \
    }                                         \
    log(kind, address, value);                \
    return value;                             \
  }
#define WRAP_WRITE(name, type, kind)                      \
  void __real_##name(std::uint32_t address, type value);  \
  void __wrap_##name(std::uint32_t address, type value) { \
    {                                                     \
      const Access access;                                \
      __real_##name(address, value);                      \
    }                                                     \
    log(kind, address, value);                            \
  }
#define WRAP_VALUE(name, kind)              \
  void __real_##name(std::uint16_t value);  \
  void __wrap_##name(std::uint16_t value) { \
    {                                       \
      const Access access;                  \
      __real_##name(value);                 \
    }                                       \
    log(kind, 0, value);                    \
  }
#define WRAP_COMMAND(name, kind) \
  void __real_##name(void);      \
  void __wrap_##name(void) {     \
    if (inside_chip) log(kind);  \
    __real_##name();             \
  }

extern "C" {

WRAP_READ(target_read16, std::uint16_t, TRACE_READ16)
WRAP_READ(target_read32, std::uint32_t, TRACE_READ32)
WRAP_WRITE(target_write16, std::uint16_t, TRACE_WRITE16)
WRAP_WRITE(target_write32, std::uint32_t, TRACE_WRITE32)
WRAP_CPU(target_eallow)
WRAP_CPU(target_edis)
WRAP_CPU(target_enable_interrupts)
WRAP_CPU(target_disable_interrupts)
WRAP_CPU(target_clear_ifr)
WRAP_VALUE(target_write_ier, TRACE_WRITE_IER)
WRAP_VALUE(target_elapse, TRACE_ELAPSE)
WRAP_COMMAND(drive_command_start, TRACE_COMMAND_START)
WRAP_COMMAND(drive_command_stop, TRACE_COMMAND_STOP)
WRAP_COMMAND(drive_command_commission, TRACE_COMMAND_COMMISSION)

void __wrap_hal_profile_step(std::uint16_t cycles) { owed += cycles; }

std::uint16_t __real_target_read_ier(void);
std::uint16_t __wrap_target_read_ier(void) {
  std::uint16_t value;
  {
    const Access access;
    value = __real_target_read_ier();
  }
  log(TRACE_READ_IER, 0, value);
  return value;
}

void __real_target_set_vector(std::uint16_t vector, target_isr_t isr);
void __wrap_target_set_vector(std::uint16_t vector, target_isr_t isr) {
  vectors.at(vector) = isr;
  {
    const Access access;
    __real_target_set_vector(vector, interrupts[vector]);
  }
  log(TRACE_SET_VECTOR, vector);
}

void __real_target_idle(void);
void __wrap_target_idle(void) {
  {
    const Access access;
    __real_target_idle();
  }
  log(TRACE_IDLE);
}

void __real_drive_command_speed(std::int32_t rpm_q16);
void __wrap_drive_command_speed(std::int32_t rpm_q16) {
  if (inside_chip) log(TRACE_COMMAND_SPEED, 0, static_cast<std::uint32_t>(rpm_q16));
  __real_drive_command_speed(rpm_q16);
}

parameter_result_t __real_parameter_set(std::uint16_t id, std::int32_t raw);
parameter_result_t __wrap_parameter_set(std::uint16_t id, std::int32_t raw) {
  if (inside_chip) log(TRACE_PARAMETER, id, static_cast<std::uint32_t>(raw));
  return __real_parameter_set(id, raw);
}

}  // extern "C"
// NOLINTEND

namespace {

void begin_scope_once(double) {
  static bool begun = false;
  if (begun) return;
  begun = true;
  log(TRACE_SCOPE);
  scope_run_begin();
}

// What a word of the command line says: a parameter, or what else is done with the drive.
class Wish {
 public:
  explicit Wish(const std::map<std::string, double>& words) : parameters_(words) {}

  /// Takes a word that is no parameter; false where it was not said.
  bool take(const std::string& name, double& value) {
    const auto found = parameters_.find(name);
    if (found == parameters_.end()) return false;
    value = found->second;
    parameters_.erase(found);
    return true;
  }
  const std::map<std::string, double>& parameters() const { return parameters_; }

 private:
  std::map<std::string, double> parameters_;
};

std::map<std::string, double> words_of(int argc, char** argv) {
  std::map<std::string, double> words;
  for (int k = 5; k < argc; k++) {
    const std::string word = argv[k];
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) throw std::invalid_argument(word + ": not NAME=VALUE");
    words[word.substr(0, equals)] = std::atof(word.c_str() + equals + 1);
  }
  return words;
}

stillspin::bench::Setup setup_of(Wish& wish, double shaft_rpm) {
  stillspin::bench::Setup setup;
  setup.nominal = stillspin::plant::PlantConfig();  // the inverter of profile bench
  setup.nominal.initial.speed = shaft_rpm * std::acos(-1.0) / 30.0;
  setup.solver = 1;
  wish.take("link", setup.nominal.link.source_voltage);
  return setup;
}

std::string run_once(Wish& wish, char** argv) {
  constexpr double kHeld = 0.25;  // s under load
  stillspin::bench::RunRequest r;
  const double rpm = std::atof(argv[2]), shaft = std::atof(argv[4]);
  double value = 0.0;
  r.setup = setup_of(wish, shaft);
  r.commands = {{0.0, "speed_ref_rpm", rpm}};
  const double settled = 0.1 + std::abs(rpm - shaft) / 10000.0;
  r.load = {{settled, 0.0}, {settled + 0.005, std::atof(argv[3])}};
  r.duration = settled + kHeld;
  if (wish.take("then", value)) {
    r.commands.push_back({r.duration, "speed_ref_rpm", value});
    r.duration += kHeld + std::abs(rpm - value) / 10000.0;
  }
  if (wish.take("stop", value)) {
    r.commands.push_back({r.duration, "stop", 0.0});
    r.duration += kHeld + std::abs(rpm) / 10000.0;
  }
  if (wish.take("scope", value)) r.on_period = begin_scope_once;
  r.parameters = wish.parameters();
  r.parameters.emplace("speed_ramp", 15000.0);
  const stillspin::bench::RunResult result = run(r);
  return result.completed ? "" : result.reason;
}

std::string commission_once(Wish& wish, char** argv) {
  stillspin::bench::CommissionRequest r;
  r.setup = setup_of(wish, std::atof(argv[4]));
  r.parameters = wish.parameters();
  const stillspin::bench::CommissionResult result = commission(r);
  return result.completed ? "" : result.reason;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: %s FILE RPM LOAD SHAFT [NAME=VALUE]...\n", argv[0]);
    return 2;
  }
  file = std::fopen(argv[1], "wb");
  if (file == nullptr) {
    std::perror(argv[1]);
    return 1;
  }
  try {
    Wish wish(words_of(argc, argv));
    double value = 0.0;
    const std::string failed = wish.take("commission", value) ? commission_once(wish, argv) : run_once(wish, argv);
    if (!failed.empty()) throw std::runtime_error(failed);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
  log(TRACE_END);
  return std::fclose(file) == 0 ? 0 : 1;
}
