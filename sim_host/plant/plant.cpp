#include "sim_host/plant/plant.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sim_host/plant/adc.hpp"
#include "sim_host/plant/gates.hpp"
#include "sim_host/plant/ledger.hpp"
#include "sim_host/plant/load_profile.hpp"
#include "sim_host/plant/sensors.hpp"
#include "sim_host/plant/trajectory.hpp"

namespace stillspin::plant {
namespace {

const PlantConfig& validated(const PlantConfig& config) {
  config.validate();
  return config;
}

void check_index(const char* what, int index) {
  if (index >= 0 && index <= 2) return;
  throw std::invalid_argument(std::string("plant: ") + what + " " + std::to_string(index) + " is outside 0..2");
}

/// Largest magnitude of the three phase values.
double largest(const AlphaBeta& x) {
  const std::array<double, 3> i = phases(x);
  return std::max(std::fabs(i[0]), std::max(std::fabs(i[1]), std::fabs(i[2])));
}

}  // namespace

struct Plant::Impl {
  explicit Impl(const PlantConfig& c)
      : config(validated(c)),
        trajectory(c),
        gates(c.inverter.turn_on_delay, c.inverter.turn_off_delay),
        sensors(c, trajectory.start_current()),
        adc(c.adc) {}

  void move_to(Tick t);
  void integrate_to(Tick t);
  void settle(Tick t);
  void edges(Tick t);
  Tick next_edge() const;
  void start_segment(Tick t);
  void look_ahead(Tick edge);
  void pass_edges();
  void commit();
  template <typename Change>
  void transition(const Fired& fired, Change change);
  void cut();
  void set_leg(int k);
  const State& present();
  const std::array<double, 3>& sensed();

  PlantConfig config;
  Trajectory trajectory;
  Gates gates;
  LoadProfile load;
  Tick load_end = kNever;
  Sensors sensors;
  Adc adc;
  Ledger ledger;
  std::array<bool, 3> open{};
  std::optional<ShootThrough> shoot_through;
  PlantStats stats;
  Tick now = 0;
  bool looked_ahead = false;  // with all edges known so far
  double peak = 0.0;          // A, over committed segments since last asked

  // What has already been evaluated at the present.
  bool has_present = false, has_sensed = false;
  State present_state;
  std::array<double, 3> present_sensed;
};

void Plant::Impl::move_to(Tick t) {
  if (t < now) {
    throw std::invalid_argument("plant: time went back from tick " + std::to_string(now) + " to tick " +
                                std::to_string(t));
  }
  if (t != now) has_present = has_sensed = false;
  now = t;
}

/// The next edge at which a segment must end: half of the gates' edges change nothing, because the diode of the other
/// device carries the current before and after.
Tick Plant::Impl::next_edge() const {
  const Model& model = trajectory.model();
  if (gates.next() >= load_end || model.clamp != Clamp::kNone) return std::min(gates.next(), load_end);
  Tick next = load_end;
  for (int k = 0; k < 3; ++k) {
    next = std::min(next, model.legs[k].perfect ? gates.next() : gates.next(k, model.direction[k] > 0));
  }
  return next;
}

/// Until a segment covers t. An edge at t itself is left for later, since nothing but the leg voltage shows it.
void Plant::Impl::integrate_to(Tick t) {
  while (!(looked_ahead && trajectory.covers(t))) {
    start_segment(kNever);
    look_ahead(next_edge());
    looked_ahead = true;
    if (trajectory.covers(t)) return;
    trajectory.locate();
    if (trajectory.covers(t)) return;
    commit();
  }
}

/// Past all edges before t that change something, but no further: the next gate command may come at t.
void Plant::Impl::settle(Tick t) {
  for (start_segment(t); next_edge() < t; start_segment(t)) {
    look_ahead(next_edge());
    commit();
  }
}

/// Edges that are due where it starts, if before t.
void Plant::Impl::start_segment(Tick t) {
  for (;;) {
    const Tick due = std::min(gates.next(), load_end);
    if (due > trajectory.tick() || due >= t) return;
    edges(due);
  }
}

void Plant::Impl::look_ahead(Tick edge) {
  const Tick end = std::min(edge, trajectory.tick() + config.solver.max_segment);
  if (trajectory.ahead() && !trajectory.ends_after(end)) return;
  stats.discarded += trajectory.ahead();
  trajectory.look_ahead(end);
}

void Plant::Impl::edges(Tick t) {
  const std::array<bool, 3> changed = gates.apply(t);
  const LoadProfile::Piece piece = load.at(t);
  load_end = piece.end;
  for (int k = 0; k < 3 && !shoot_through; ++k) {
    if (gates.upper(k) && gates.lower(k)) shoot_through = ShootThrough{t, k};
  }
  const auto change = [&] {
    trajectory.model().load_start = piece.torque;
    trajectory.model().load_slope = piece.slope;
    for (int k = 0; k < 3; ++k) {
      if (changed[k]) set_leg(k);
    }
  };
  transition({}, change);
}

/// Edges inside the segment just committed: they change nothing but what a later event will find.
void Plant::Impl::pass_edges() {
  if (gates.next() >= trajectory.tick()) return;
  const std::array<bool, 3> changed = gates.apply(trajectory.tick() - 1);
  for (int k = 0; k < 3; ++k) {
    if (changed[k]) set_leg(k);
  }
}

void Plant::Impl::set_leg(int k) {
  const bool both = gates.upper(k) && gates.lower(k);
  trajectory.model().legs[k] = Leg::make(config.inverter, gates.upper(k) && !both, gates.lower(k) && !both, open[k]);
}

/// Something changes at the start of the current segment; leg voltages that jump by it make the sensors ring.
template <typename Change>
void Plant::Impl::transition(const Fired& fired, Change change) {
  const std::array<double, 3> before = trajectory.leg_voltages();
  change();
  trajectory.model().resolve(trajectory.state(), fired);
  trajectory.restart();
  looked_ahead = false;
  std::array<double, 3> step = trajectory.leg_voltages();
  for (int k = 0; k < 3; ++k) step[k] -= before[k];
  sensors.excite(trajectory.tick(), trajectory.fraction(), step);
}

/// An event decides anew which legs conduct and has to know all edges before it: the segment then ends at the first of
/// them. (Not before: until the event is past, an edge that prevents it may still come.)
void Plant::Impl::commit() {
  looked_ahead = false;
  trajectory.locate();
  if (trajectory.has_event() && trajectory.ends_after(gates.next())) {
    ++stats.discarded;
    trajectory.look_ahead(gates.next());
    trajectory.locate();
  }
  if (config.solver.ledger) ledger.book(trajectory, trajectory.length());
  const AlphaBeta i0 = trajectory.start_current(), d0 = trajectory.start_slope();
  const double h = trajectory.length();
  const bool has_event = trajectory.has_event();
  const Fired fired = trajectory.fired();
  trajectory.commit();
  pass_edges();
  const AlphaBeta i1 = trajectory.start_current();
  sensors.commit(i0, d0, i1, h);
  peak = std::max(peak, largest(i1));
  ++stats.segments;
  if (!has_event) return;
  ++stats.events;
  transition(fired, [] {});
}

/// Ends the segment at the present, so that something can change there.
void Plant::Impl::cut() {
  integrate_to(now);
  if (!trajectory.at(now)) {
    if (trajectory.ends_after(now)) trajectory.look_ahead(now);
    commit();
  }
  has_present = has_sensed = false;
}

const State& Plant::Impl::present() {
  integrate_to(now);
  if (!has_present) present_state = trajectory.at_offset(trajectory.offset(now));
  has_present = true;
  return present_state;
}

/// What the current sensors see at the present, before their gains and offsets.
const std::array<double, 3>& Plant::Impl::sensed() {
  if (has_sensed) return present_sensed;
  const AlphaBeta i = trajectory.current(present());
  present_sensed =
      phases(sensors.filtered(trajectory.start_current(), trajectory.start_slope(), i, trajectory.offset(now)) +
             sensors.ringing(now));
  has_sensed = true;
  return present_sensed;
}

Plant::Plant(const PlantConfig& config) : impl_(std::make_unique<Impl>(config)) {}
Plant::~Plant() = default;
Plant::Plant(Plant&&) noexcept = default;
Plant& Plant::operator=(Plant&&) noexcept = default;

void Plant::set_gate(Tick t, int leg, bool upper, bool lower) {
  check_index("leg", leg);
  impl_->move_to(t);
  impl_->settle(t);
  impl_->gates.set(t, leg, upper, lower);
  impl_->looked_ahead = false;
}

void Plant::advance(Tick t) {
  impl_->move_to(t);
  impl_->integrate_to(t);
}

Tick Plant::now() const { return impl_->now; }

double Plant::current_sensor(int phase) const {
  check_index("phase", phase);
  return impl_->sensors.reading(phase, impl_->now, impl_->sensed()[phase]);
}

std::uint16_t Plant::adc_code(Tick t, AdcInput input) {
  impl_->move_to(t);
  switch (input) {
    case AdcInput::kCurrentA:
      return impl_->adc.current(0, current_sensor(0));
    case AdcInput::kCurrentB:
      return impl_->adc.current(1, current_sensor(1));
    case AdcInput::kCurrentC:
      return impl_->config.sensor.count < 3 ? std::uint16_t{0} : impl_->adc.current(2, current_sensor(2));
    case AdcInput::kLinkVoltage: {
      const State& y = impl_->present();
      const Trajectory& trajectory = impl_->trajectory;
      return impl_->adc.link_voltage(trajectory.model().link_voltage(trajectory.offset(t), y));
    }
    case AdcInput::kTemperature:
      break;
  }
  return impl_->adc.temperature();
}

PlantState Plant::state() const {
  const State& y = impl_->present();
  const Trajectory& trajectory = impl_->trajectory;
  const Model& model = trajectory.model();
  const double t = trajectory.offset(impl_->now);
  State ignored;
  Probe p;
  model.derive(t, y, ignored, p);
  PlantState s;
  s.tick = impl_->now;
  s.current = p.current;
  s.current_d = y[kId];
  s.current_q = y[kIq];
  s.flux_d = p.flux.d;
  s.flux_q = p.flux.q;
  const double angle = trajectory.angle() + y[kAngle];
  const double turn = std::floor(angle / (2.0 * kPi) + 0.5);
  s.angle_e = angle - 2.0 * kPi * turn;
  s.angle_m = (angle + 2.0 * kPi * static_cast<double>(trajectory.turns())) / impl_->config.machine.pole_pairs;
  s.speed_m = y[kSpeed];
  s.torque = p.torque;
  s.cogging = p.cogging;
  s.load = p.load;
  s.link_voltage = model.link.stiff ? p.source_voltage : y[kLink];
  s.leg_voltage = p.leg_voltage;
  return s;
}

std::int64_t Plant::encoder_count(Tick t) {
  impl_->move_to(t);
  const State& y = impl_->present();
  const Trajectory& trajectory = impl_->trajectory;
  const double turns = static_cast<double>(trajectory.turns()) + (trajectory.angle() + y[kAngle]) / (2.0 * kPi);
  return static_cast<std::int64_t>(std::floor(turns * impl_->config.encoder_counts / impl_->config.machine.pole_pairs));
}

double Plant::take_peak_current(Tick t) {
  impl_->move_to(t);
  const State& y = impl_->present();
  const double here = largest(impl_->trajectory.current(y));
  const double result = std::max(impl_->peak, here);
  impl_->peak = 0.0;
  return result;
}

double Plant::peak_current() const { return impl_->peak; }

void Plant::set_load(std::vector<LoadPoint> points) {
  impl_->cut();
  impl_->load.set(std::move(points));
  impl_->load_end = impl_->now;  // an edge: the new piece begins here
  impl_->looked_ahead = false;
}

void Plant::set_locked(bool locked) {
  impl_->cut();
  const bool coulomb = std::max(impl_->config.mechanics.coulomb_friction, impl_->config.mechanics.stiction) > 0.0;
  impl_->trajectory.model().shaft = locked ? Shaft::kLocked : coulomb ? Shaft::kTurning : Shaft::kFree;
  impl_->transition({}, [] {});
}

void Plant::inject(const Fault& fault) {
  check_index("fault index", fault.index);
  impl_->cut();
  const auto k = static_cast<std::size_t>(fault.index);
  switch (fault.kind) {
    case FaultKind::kOpenPhase:
      impl_->open[k] = true;
      impl_->transition({}, [&] { impl_->set_leg(fault.index); });
      break;
    case FaultKind::kSensorStuck:
      impl_->sensors.stick(fault.index, fault.value);
      break;
    case FaultKind::kSensorDrift:
      impl_->sensors.drift(fault.index, impl_->now, fault.value);
      break;
    case FaultKind::kSensorGain:
      impl_->sensors.scale(fault.index, fault.value);
      break;
    case FaultKind::kLinkSag:
      if (!(fault.value >= 0.0 && fault.value <= 2.0)) {
        throw std::invalid_argument("plant: link sag factor " + std::to_string(fault.value) + " is outside 0..2");
      }
      impl_->transition({}, [&] { impl_->trajectory.model().sag = fault.value; });
      break;
  }
}

void Plant::clear_faults() {
  impl_->cut();
  impl_->sensors.repair();
  impl_->open = {};
  impl_->transition({}, [&] {
    impl_->trajectory.model().sag = 1.0;
    for (int k = 0; k < 3; ++k) impl_->set_leg(k);
  });
}

std::optional<ShootThrough> Plant::shoot_through() const { return impl_->shoot_through; }

EnergyLedger Plant::energy() const {
  const State& y = impl_->present();
  const Trajectory& trajectory = impl_->trajectory;
  Ledger ledger = impl_->ledger;
  if (impl_->config.solver.ledger) ledger.book(trajectory, trajectory.offset(impl_->now));
  return ledger.read(trajectory.model(), y);
}

PlantStats Plant::stats() const {
  PlantStats s = impl_->stats;
  s.grazing = impl_->trajectory.grazing();
  return s;
}

const PlantConfig& Plant::config() const { return impl_->config; }

}  // namespace stillspin::plant
