// What tests see and set of the drive, by names of the field. Where it lies in the drive stands here alone: who moves a
// member moves one line.

#ifndef STILLSPIN_TESTS_FIRMWARE_INSIDE_HPP
#define STILLSPIN_TESTS_FIRMWARE_INSIDE_HPP

extern "C" {
#include "firmware/api/status.h"
#include "firmware/drive/inertia.h"
#include "firmware/drive/position.h"
#include "firmware/drive/signals.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"
#include "firmware/sources/observer/observer.h"
#include "firmware/start/step.h"
}

namespace stillspin::test::inside {

// State, configuration, and the groups as a whole.
inline auto& config() { return drive.config; }
inline auto& config_valid() { return drive.config_valid; }
inline auto& conflict() { return drive.conflict; }
inline auto& conflict_known() { return drive.conflict_known; }
inline auto& control() { return drive.control; }
inline auto& estimate() { return drive.estimate; }
inline auto& fault() { return drive.fault; }
inline auto& heartbeat() { return drive.heartbeat; }
int32_t& heat_sink_q8();  // board_derating_test.cpp
// Of current and speed, of voltage and time, and as the signal has them.
inline auto& limits() { return drive.control.limits; }
inline auto& modulation_limits() { return drive.modulation.limits; }
inline std::int32_t all_limits() { return drive_signals().limit; }
inline auto& loading() { return feature_status.loading; }
inline auto& model() { return drive.estimate.model; }
inline auto& periods() { return drive.periods; }
inline auto& samples() { return drive.samples; }
inline auto& schedule() { return drive.schedule; }
inline auto& sensor_trim() { return drive.estimate.trim; }
inline auto& settled_at() { return drive.settled_at; }
inline auto& sliced() { return drive.modulation.sliced; }
inline auto& source() { return drive.source; }
inline auto& start_found() { return starting; }
inline drive_state_t state() { return drive.state; }
/// As the states themselves do, whatever it was in before: no flags, the first period.
inline void be_in(drive_state_t state) { drive_enter(&drive, state); }
inline auto& supervision() { return drive.supervision; }
inline auto& time_ms() { return drive.time_ms; }
inline auto& wiring() { return feature_status.wiring; }
inline auto& zero_current_a_q8() { return drive.zero_current_a_q8; }
inline auto& zero_current_b_q8() { return drive.zero_current_b_q8; }

// What has been asked for, and not been carried out.
inline bool start_requested() { return drive_start_is_asked(); }
inline bool stop_requested() { return drive.request.stop; }
inline bool coast_requested() { return drive.request.coast; }
inline bool reset_requested() { return drive.request.reset; }
inline bool reload_requested() { return drive.request.reload; }
/// What is to begin: a start, or a feature's state in its place; null for none.
inline const state_request_t* state_requested() { return drive.request.begin; }
// In the place of who asks, and of who carries it out.
inline void request_reload() { drive.request.reload = true; }
inline void withdraw_stop() { drive.request.stop = false; }
inline void withdraw_reload() { drive.request.reload = false; }
inline void withdraw_state() { drive.request.begin = nullptr; }
// The two halves of a speed command, for what may come between them.
inline void write_speed_request(std::int32_t rpm_q16) { drive.request.speed_rpm_q16 = rpm_q16; }
inline void mark_speed_request() { drive.request.speed = true; }

// What the state in hand says to the other steps.
inline auto& gates_off() { return drive.flags.gates_off; }
inline auto& invalid_periods() { return drive.flags.invalid; }
inline auto& is_caught() { return drive.flags.caught; }
inline auto& is_frozen() { return drive.flags.frozen; }
inline auto& is_open_loop() { return drive.flags.open_loop; }
inline auto& is_over() { return drive.flags.over; }
inline auto& is_shorted() { return drive.flags.shorted; }
inline auto& spins() { return drive.flags.spins; }
inline auto& start_phase() { return starting.phase; }
inline auto& state_behind() { return drive.flags.behind; }
inline auto& unseen() { return drive.flags.unseen; }
inline auto& wants_exclusive() { return drive.flags.wants_exclusive; }

// What falls on the period.
inline auto& is_exclusive() { return drive.schedule.exclusive; }
inline auto& is_scheduled_turning() { return drive.schedule.turning; }
inline auto& judges_synchronism() { return drive.schedule.judges; }
inline auto& renews_covariance() { return drive.schedule.renews; }
inline auto& scheduled_period() { return drive.schedule.period; }
inline auto& scheduled_slot() { return drive.schedule.slot; }
inline auto& scheduled_task() { return drive.schedule.task; }
inline auto& skips_windows() { return drive.schedule.skips; }

// The last period's windows.
inline auto& frames() { return drive.estimate.frames; }
inline auto& link_end_q16() { return drive.samples.link_end_q16; }
inline auto& link_q16() { return drive.samples.link_q16; }
inline auto& ripple_q16() { return drive.samples.ripple_q16; }
inline auto& sensor_scale() { return drive.samples.scale; }
inline auto& window_count() { return drive.samples.count; }
inline auto& windows() { return drive.samples.windows; }

// Angle and speed.
inline auto& avv() { return drive.estimate.avv; }
inline auto& avv_angle_bam() { return drive.estimate.avv.observer.angle_bam; }
inline auto& avv_error_bam() { return drive.estimate.avv.error_bam; }
inline auto& avv_information() { return drive.estimate.avv.regression.information; }
inline auto& avv_speed_bpp() { return drive.estimate.avv.observer.speed_bpp; }
inline auto& blend() { return drive.estimate.blend; }
inline auto& blend_region() { return drive.estimate.blend.region; }
inline auto& blend_share_q15() { return drive.estimate.blend.share_q15; }
inline auto& deviation_q20() { return source_deviation_q20; }
inline auto& high_speed_estimate() { return drive.estimate.high; }
inline auto& is_near() { return drive.estimate.avv.is_near; }
inline auto& low_speed_estimate() { return drive.estimate.low; }
inline auto& observer() { return drive.estimate.observer; }
inline auto& seen() { return drive.estimate.seen; }
inline auto& selected() { return drive.estimate.selected; }
inline auto& torque_accel_q8() { return drive.estimate.torque_accel_q8; }

// Speed and current control.
inline auto& braking_headroom_q20() { return drive.control.braking_headroom_q20; }
inline auto& command_dq_q16() { return drive.control.command_q16; }
inline auto& command_rpm_q16() { return drive.control.command_rpm_q16; }
inline auto& current_controller() { return drive.control.current; }
inline auto& current_dq_q20() { return drive.estimate.measured_q20; }
inline auto& current_limit_q20() { return drive.control.current_limit_q20; }
inline auto& feed_forward_q16() { return drive.control.references.feed_forward_q16; }
inline auto& field_weakening() { return drive.control.weakening; }
inline auto& headroom_q20() { return drive.control.headroom_q20; }
inline auto& loop_is_closed() { return drive.control.references.closed; }
inline auto& per_torque_constant() { return drive.control.per_torque_constant; }
inline auto& position_hold() { return drive.control.position_hold; }
inline auto& ramped_bpp() { return drive.control.ramp.value; }
inline auto& reference_dq_q20() { return drive.control.references.current_q20; }
inline auto& speed_controller() { return drive.control.speed; }
inline auto& speed_ramp() { return drive.control.ramp; }
inline auto& speed_ready() { return drive.control.speed_ready; }
inline auto& spin_d_q20() { return drive.control.references.spin_d_q20; }
inline auto& target_bpp() { return drive.control.target_bpp; }
inline auto& weakening_q20() { return drive.control.weakening.id_q20; }

// The modulator.
inline auto& modulation() { return drive.modulation; }
inline auto& modulated_q16() { return drive.modulation.command_q16; }
inline auto& modulator() { return drive.modulation.state; }
inline auto& patterns() { return drive.modulation.patterns; }
inline auto& running_pattern() { return drive.modulation.patterns[drive.modulation.running]; }
inline auto& sampled_pattern() { return drive.modulation.patterns[drive.modulation.sampled]; }

// What protection has counted.
inline auto& diverged_periods() { return drive.supervision.diverged_periods; }
inline auto& judged_at() { return drive.supervision.judged_at; }
inline auto& judged_bam() { return drive.supervision.judged_bam; }
inline auto& missing_windows() { return drive.supervision.missing; }
inline auto& overruns() { return drive.modulation.overrun; }
inline auto& stopping_periods() { return drive.supervision.stopping_periods; }
inline auto& synchronism() { return drive.supervision.synchronism; }

// The steps of the control interrupt, as that has them.
inline void estimate_step() { drive_estimate(&drive, &drive.estimate); }
inline void protect_step() {
  const drive_fault_t fault = drive_protect(&drive, &drive.supervision, &drive.estimate.observer.residual);
  if (fault != FAULT_NONE) drive_trip(&drive, fault);
}
inline void speed_step() { drive_control_speed(&drive, &drive.control, &drive.estimate); }
inline void current_step() { drive_control_current(&drive, &drive.control); }
inline void modulate_step() { drive_modulate(&drive, &drive.modulation, &drive.control.current); }
inline void match_inertia() { drive_match_inertia(&drive, &drive.estimate, &drive.control.speed); }

// Where the estimators begin.
inline void preset(std::uint32_t angle_bam, std::int32_t speed_bpp) {
  position_preset(&drive, &drive.estimate, angle_bam, speed_bpp);
}
inline void preset_axis(std::uint32_t angle_bam, std::int32_t speed_bpp) {
  position_preset_axis(&drive.estimate, angle_bam, speed_bpp);
}
inline void keep_position() { position_keep(&drive, &drive.estimate); }
inline void transfer_position() { position_bumpless_transfer(&drive.estimate); }

inline std::int32_t signal(std::uint16_t place, std::uint16_t known) { return signal_look(place)(&drive, known); }

}  // namespace stillspin::test::inside

#endif
