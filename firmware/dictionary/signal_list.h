// The signals that every drive has, things that tools may look at. SIGNAL(name, unit, q, of, value, meaning): `value`
// is where the drive `d` has it between two runs of the control interrupt; an int32_t with q fractional bits; angles
// are binary angles (unit "turn", q 32). What is said of the ROTOR is known only with its angle (speed_known), what is
// said in the FRAME of the control only while the power stage is on, what is said of the HEAT_SINK only where its
// sensor is in use: 0 else, whatever the estimators make of nothing. What the drive ASKED for, and what held it back,
// is 0 with the power stage off, whatever it was. What is said of the DRIVE is always known. Those of a feature are in
// a list of its folder, and a signals.c beside it (drive/signal_looks.h); the build joins all rows (all_signals.h):
// PLACE(number) says where those that follow stand in the table, smaller ones first, what has none last. No include
// guard: it is included with different meanings of SIGNAL.

PLACE(10)
SIGNAL(state, NONE, 0, DRIVE, d->state, "state of the drive")
SIGNAL(fault, NONE, 0, DRIVE, d->fault, "latched fault")
SIGNAL(limit, NONE, 0, ASKED, d->control.limits | d->modulation.limits, "active limits, one bit each")
SIGNAL(angle, TURN, 32, ROTOR, d->estimate.selected.angle_bam, "electrical angle in use, at the start of the period")
SIGNAL(speed, RPM, 16, ROTOR, SIGNAL_RPM(d->estimate.selected.speed_bpp), "mechanical speed in use")
SIGNAL(angle_low, TURN, 32, ROTOR, d->estimate.low.angle_bam, "electrical angle of the low-speed estimator")
SIGNAL(angle_avv, TURN, 32, ROTOR, d->estimate.high.angle_bam, "electrical angle of the AVV estimator")
SIGNAL(weight, NONE, 15, DRIVE, d->estimate.blend.share_q15, "share of the low-speed estimator in the blend")
SIGNAL(speed_reference, RPM, 16, ASKED, SIGNAL_RPM(d->control.ramp.value), "speed reference after the ramp")
SIGNAL(current_d, A, 20, FRAME, d->estimate.measured_q20.d, "measured d-axis current, mean of the period")
SIGNAL(current_q, A, 20, FRAME, d->estimate.measured_q20.q, "measured q-axis current")
SIGNAL(current_d_reference, A, 20, ASKED, d->control.references.current_q20.d, "d-axis current reference")
SIGNAL(current_q_reference, A, 20, ASKED, d->control.references.current_q20.q, "q-axis current reference")
SIGNAL(voltage_d, V, 16, DRIVE, d->control.command_q16.d, "d-axis voltage command")
SIGNAL(voltage_q, V, 16, DRIVE, d->control.command_q16.q, "q-axis voltage command")
SIGNAL(voltage_alpha, V, 16, ASKED, d->modulation.command_q16.alpha,
       "alpha-axis mean voltage for the next period, device drops added")
SIGNAL(voltage_beta, V, 16, ASKED, d->modulation.command_q16.beta, "beta-axis mean voltage for the next period")

PLACE(17)
SIGNAL(link_voltage, V, 16, DRIVE, d->samples.link_q16, "DC-link voltage")
SIGNAL(load_torque, NM, 16, ROTOR,
       q_mul_sat(d->estimate.selected.load_accel_q8, d->estimate.model.torque_per_accel_q24, 24),
       "estimated load torque")
SIGNAL(windows, NONE, 0, DRIVE, d->samples.count, "current windows sampled in the last period")

PLACE(30)
SIGNAL(current_a, A, 20, DRIVE, phase_current(d, false),
       "current of phase a as its sensor reads it, with the gates off as well")
SIGNAL(current_b, A, 20, DRIVE, phase_current(d, true), "current of phase b, as current_a")
SIGNAL(speed_known, NONE, 0, DRIVE, (known & KNOWN_ROTOR) != 0u,
       "1: angle and speed are the rotor's; 0: unknown, the shaft may turn")
