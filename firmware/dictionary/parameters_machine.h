// Parameters of machine and inverter: rows of parameter_list.h.

// Machine (nameplate of motor A)
PARAMETER(1, pole_pairs, NONE, 0, 0, 1, 30, 4, STOPPED, "pole pairs")
PARAMETER(10, current_scale, NONE, 0, 0, -6, 6, 0, STOPPED,
          "power of two that scales all currents, 0 for sensors of 20 to 40 A; set it first")
PARAMETER(11, voltage_scale, NONE, 0, 0, -6, 6, 0, STOPPED,
          "power of two that scales all voltages, 0 for sensors of 225 to 450 V; set it first")
PARAMETER(2, stator_resistance, OHM, 24, 4, 10, 200000, 3200, STOPPED, "stator resistance of a phase")
PARAMETER(3, inductance_d, MH, 20, 3, 50, 200000, 4900, STOPPED, "d-axis inductance")
PARAMETER(4, inductance_q, MH, 20, 3, 50, 200000, 7800, STOPPED, "q-axis inductance, at least that of the d-axis")
PARAMETER(5, magnet_flux, VS, 28, 5, 200, 90000, 16000, STOPPED, "magnet flux linkage, peak")
PARAMETER(6, inertia, KGM2, 24, 6, 10, 500000, 4550, STOPPED, "inertia of rotor and load")
PARAMETER(7, friction, NMS, 24, 5, 0, 50000, 300, STOPPED, "viscous friction")
PARAMETER(8, current_limit, A, 20, 2, 50, 10000, 1400, STOPPED, "largest phase current, peak")
PARAMETER(9, speed_limit, RPM, 8, 0, 10, 20000, 3300, STOPPED, "largest speed reference")
PARAMETER(520, rated_current, A, 20, 2, 0, 10000, 0, ALWAYS,
          "rated phase current of the motor, peak; 0: not set, half of current_limit is used")

// Inverter
PARAMETER(20, dead_time, US, 16, 2, BOARD_DEAD_TIME_LEAST, 500, BOARD_DEAD_TIME, STOPPED,
          "dead band of the gate signals")
PARAMETER(21, turn_on_delay, US, 16, 2, 0, 200, BOARD_TURN_ON_DELAY, STOPPED, "turn-on delay of driver and device")
PARAMETER(22, turn_off_delay, US, 16, 2, 0, 200, BOARD_TURN_OFF_DELAY, STOPPED, "turn-off delay of driver and device")
PARAMETER(23, device_drop, V, 16, 3, 0, 5000, 950, STOPPED, "on-state drop of a device at small current")
PARAMETER(24, device_resistance, OHM, 24, 4, 0, 10000, 350, STOPPED, "on-state resistance of a device")
PARAMETER(25, drop_band, A, 20, 2, 1, 200, 20, ALWAYS, "current below which its sign is not trusted")
PARAMETER(26, current_full_scale, A, 20, 2, 100, 20000, BOARD_CURRENT_RANGE, STOPPED,
          "current at ADC code 4096 (zero is 2048)")
PARAMETER(27, link_full_scale, V, 16, 1, 100, 20000, BOARD_LINK_RANGE, STOPPED, "DC-link voltage at ADC code 4096")
PARAMETER(28, link_minimum, V, 16, 1, 100, 10000, 1500, STOPPED, "DC-link voltage below which the drive faults")
PARAMETER(29, link_maximum, V, 16, 1, 100, 15000, 4200, STOPPED, "DC-link voltage above which the drive faults")
PARAMETER(30, trip_current, A, 20, 2, 50, 19400, 1800, STOPPED, "software over-current limit on a sampled phase")
