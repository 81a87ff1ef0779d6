#include "sim_host/plant/plant_engine.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace stillspin::plant {
namespace {

const PlantConfig& validated(const PlantConfig& config) {
  config.validate();
  return config;
}

}  // namespace

void check_index(const char* what, int index) {
  if (index >= 0 && index <= 2) return;
  throw std::invalid_argument(std::string("plant: ") + what + " " + std::to_string(index) + " is outside 0..2");
}

Plant::Impl::Impl(const PlantConfig& c)
    : config(validated(c)),
      trajectory(c),
      gates(c.inverter.turn_on_delay, c.inverter.turn_off_delay),
      sensors(c, trajectory.start_current()),
      adc(c.adc) {
  for (const bool cut : {false, true}) {
    legs[cut] = {Leg::make(c.inverter, false, false, cut), Leg::make(c.inverter, false, true, cut),
                 Leg::make(c.inverter, true, false, cut)};
  }
}

void Plant::Impl::refuse(Tick t) const {
  throw std::invalid_argument("plant: time went back from tick " + std::to_string(now) + " to tick " +
                              std::to_string(t));
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

void Plant::Impl::integrate_on(Tick t) {
  do {
    start_segment(kNever);
    look_ahead(next_edge());
    looked_ahead = true;
    if (trajectory.covers(t)) return;
    trajectory.locate();
    if (trajectory.covers(t)) return;
    commit();
  } while (!(looked_ahead && trajectory.covers(t)));
}

/// Past all edges before t that change something, but no further: the next gate command may come at t.
void Plant::Impl::settle(Tick t) {
  for (start_segment(t); std::min(gates.next(), load_end) < t; start_segment(t)) {
    const Tick next = next_edge();
    if (next >= t) return;
    look_ahead(next);
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
  if (trajectory.model().clamp != Clamp::kNone) return transition({}, change);
  change();  // does not touch the voltages of legs that conduct
  std::array<double, 3> jump;
  if (!trajectory.model().switch_legs(trajectory.state(), changed, jump)) return transition({}, [] {});
  renew(jump);
}

/// Edges inside the segment just committed: they change nothing but what a later event will find.
void Plant::Impl::pass_edges() {
  if (gates.next() >= trajectory.tick()) return;
  const std::array<bool, 3> changed = gates.apply(trajectory.tick() - 1);
  for (int k = 0; k < 3; ++k) {
    if (changed[k]) set_leg(k);
  }
}

/// Both devices on (shoot-through): as if both were off.
void Plant::Impl::set_leg(int k) {
  const bool upper = gates.upper(k), lower = gates.lower(k);
  trajectory.model().legs[k] = legs[open[k]][upper != lower ? 1 + upper : 0];
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
  const AlphaBeta i0 = trajectory.origin_current(), d0 = trajectory.origin_slope();
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

void Plant::Impl::sense() {
  integrate_to(now);
  const double s = trajectory.offset(now);
  present_sensed = phases(
      sensors.filtered(trajectory.origin_current(), trajectory.origin_slope(), trajectory.current_at_offset(s), s) +
      sensors.ringing(now));
  has_sensed = true;
}

}  // namespace stillspin::plant
