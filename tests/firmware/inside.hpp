// What tests see and set of the drive, by names of the field. Where it lies in the drive stands here alone: who moves a
// member moves one line.

#ifndef STILLSPIN_TESTS_FIRMWARE_INSIDE_HPP
#define STILLSPIN_TESTS_FIRMWARE_INSIDE_HPP

extern "C" {
#include "firmware/api/status.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"
#include "firmware/sources/sources.h"
#include "firmware/start/step.h"
}

namespace stillspin::test::inside {

// State, requests, configuration, and the groups as a whole.
inline auto& config() { return drive.config; }
inline auto& config_valid() { return drive.config_valid; }
inline auto& conflict() { return drive.conflict; }
inline auto& conflict_known() { return drive.conflict_known; }
inline auto& control() { return drive.control; }
inline auto& fault() { return drive.fault; }
inline auto& flags() { return drive.flags; }
inline auto& heartbeat() { return drive.heartbeat; }
int32_t& heat_sink_q8();  // board_derating_test.cpp
inline auto& limits() { return drive.limits; }
inline auto& loading() { return feature_status.loading; }
inline auto& model() { return drive.model; }
inline auto& periods() { return drive.periods; }
inline auto& position() { return drive.position; }
inline auto& request() { return drive.request; }
inline auto& samples() { return drive.samples; }
inline auto& schedule() { return drive.schedule; }
inline auto& sensor_trim() { return drive.trim; }
inline auto& settled_at() { return drive.settled_at; }
inline auto& sliced() { return drive.sliced; }
inline auto& source() { return drive.source; }
inline auto& start_found() { return starting; }
inline auto& state() { return drive.state; }
inline auto& supervision() { return drive.supervision; }
inline auto& time_ms() { return drive.time_ms; }
inline auto& wiring() { return drive.wiring; }
inline auto& zero_current_a_q8() { return drive.zero_current_a_q8; }
inline auto& zero_current_b_q8() { return drive.zero_current_b_q8; }

// The last period's windows.
inline auto& frames() { return drive.position.frames; }
inline auto& link_end_q16() { return drive.samples.link_end_q16; }
inline auto& link_q16() { return drive.samples.link_q16; }
inline auto& ripple_q16() { return drive.samples.ripple_q16; }
inline auto& sensor_scale() { return drive.samples.scale; }
inline auto& window_count() { return drive.samples.count; }
inline auto& windows() { return drive.samples.windows; }

// Angle and speed.
inline auto& avv() { return drive.position.avv; }
inline auto& blend() { return drive.position.blend; }
inline auto& deviation_q20() { return source_deviation_q20; }
inline auto& high_speed_estimate() { return drive.position.high; }
inline auto& is_near() { return drive.position.is_near; }
inline auto& low_speed_estimate() { return drive.position.low; }
inline auto& observer() { return drive.position.observer; }
inline auto& seen() { return drive.position.seen; }
inline auto& selected() { return drive.position.selected; }
inline auto& torque_accel_q8() { return drive.position.torque_accel_q8; }

// Speed and current control.
inline auto& braking_headroom_q20() { return drive.control.braking_headroom_q20; }
inline auto& command_dq_q16() { return drive.control.command_q16; }
inline auto& command_rpm_q16() { return drive.control.command_rpm_q16; }
inline auto& current_controller() { return drive.control.current; }
inline auto& current_dq_q20() { return drive.control.measured_q20; }
inline auto& current_limit_q20() { return drive.control.current_limit_q20; }
inline auto& feed_forward_q16() { return drive.control.references.feed_forward_q16; }
inline auto& field_weakening() { return drive.control.weakening; }
inline auto& headroom_q20() { return drive.control.headroom_q20; }
inline auto& loop_is_closed() { return drive.control.references.closed; }
inline auto& per_torque_constant() { return drive.control.per_torque_constant; }
inline auto& position_hold() { return drive.control.position_hold; }
inline auto& reference_dq_q20() { return drive.control.references.current_q20; }
inline auto& speed_controller() { return drive.control.speed; }
inline auto& speed_ramp() { return drive.control.ramp; }
inline auto& speed_ready() { return drive.control.speed_ready; }
inline auto& target_bpp() { return drive.control.target_bpp; }
inline auto& weakening_q20() { return drive.control.weakening_q20; }

// The modulator.
inline auto& modulated_q16() { return drive.modulation.command_q16; }
inline auto& modulator() { return drive.modulation.state; }
inline auto& running_pattern() { return drive.modulation.patterns[drive.modulation.running]; }
inline auto& sampled_pattern() { return drive.modulation.patterns[drive.modulation.sampled]; }

// What protection has counted.
inline auto& diverged_periods() { return drive.supervision.diverged_periods; }
inline auto& judged_at() { return drive.supervision.judged_at; }
inline auto& judged_bam() { return drive.supervision.judged_bam; }
inline auto& missing_windows() { return drive.supervision.missing; }
inline auto& overruns() { return drive.supervision.overrun; }
inline auto& stopping_periods() { return drive.supervision.stopping_periods; }
inline auto& synchronism() { return drive.supervision.synchronism; }

inline std::int32_t signal(std::uint16_t place, std::uint16_t known) { return signal_look(place)(&drive, known); }

}  // namespace stillspin::test::inside

#endif
