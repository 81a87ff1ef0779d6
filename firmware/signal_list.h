// The drive's signals that tools may look at. SIGNAL(name, unit, q, meaning): an int32_t member of drive_signals_t with
// q fractional bits; angles are binary angles (unit "turn", q 32). They belong to one run of the control interrupt. No
// include guard: it is included with different meanings of SIGNAL.

SIGNAL(state, "", 0, "state of the drive, drive_state_t")
SIGNAL(fault, "", 0, "latched fault, drive_fault_t")
SIGNAL(limit, "", 0, "what holds the drive back, bits of drive_limit_t")
SIGNAL(angle, "turn", 32, "electrical angle in use, at the start of the period")
SIGNAL(speed, "rpm", 16, "mechanical speed in use")
SIGNAL(angle_low, "turn", 32, "electrical angle of the low-speed estimator")
SIGNAL(angle_avv, "turn", 32, "electrical angle of the AVV estimator")
SIGNAL(weight, "", 15, "share of the low-speed estimator in the blend")
SIGNAL(speed_reference, "rpm", 16, "speed reference after the ramp")
SIGNAL(current_d, "A", 20, "measured d-axis current, mean of the period")
SIGNAL(current_q, "A", 20, "measured q-axis current")
SIGNAL(current_d_reference, "A", 20, "d-axis current reference")
SIGNAL(current_q_reference, "A", 20, "q-axis current reference")
SIGNAL(voltage_d, "V", 16, "d-axis voltage command")
SIGNAL(voltage_q, "V", 16, "q-axis voltage command")
SIGNAL(link_voltage, "V", 16, "DC-link voltage")
SIGNAL(load_torque, "Nm", 16, "estimated load torque")
SIGNAL(windows, "", 0, "windows sampled in the last period")
