// The one parameter table. Console, bus, storage, host tools and documentation read it; nothing is listed twice.
//
// PARAMETER(id, name, unit, q, decimals, minimum, maximum, default, access, meaning)
//   id        stable for ever; a number is never used again
//   q         fractional bits of the value in the firmware (int32_t)
//   minimum, maximum, default: whole numbers in units of 10^-decimals, so that every compiler makes the same constant;
//             those that the board decides are named, see hal/hal_board.h
//   access    STOPPED: only while the power stage is off; ALWAYS: at any time
// No include guard: it is included with different meanings of PARAMETER.

// Machine (nameplate of motor A)
PARAMETER(1, pole_pairs, "", 0, 0, 1, 20, 4, STOPPED, "pole pairs")
PARAMETER(2, stator_resistance, "ohm", 24, 4, 10, 200000, 3200, STOPPED, "stator resistance of a phase")
PARAMETER(3, inductance_d, "mH", 20, 3, 50, 200000, 4900, STOPPED, "d-axis inductance")
PARAMETER(4, inductance_q, "mH", 20, 3, 50, 200000, 7800, STOPPED, "q-axis inductance, at least that of the d-axis")
PARAMETER(5, magnet_flux, "Vs", 28, 5, 200, 90000, 16000, STOPPED, "magnet flux linkage (peak, amplitude invariant)")
PARAMETER(6, inertia, "kgm2", 24, 6, 100, 500000, 4550, STOPPED, "inertia of rotor and load")
PARAMETER(7, friction, "Nms", 24, 5, 0, 50000, 300, STOPPED, "viscous friction")
PARAMETER(8, current_limit, "A", 20, 2, 50, 10000, 1400, STOPPED, "largest phase current, peak")
PARAMETER(9, speed_limit, "rpm", 8, 0, 10, 6000, 3300, STOPPED, "largest speed reference")
PARAMETER(520, rated_current, "A", 20, 2, 0, 10000, 0, ALWAYS,
          "rated phase current of the motor, peak; 0: not set, half of current_limit is used")

// Inverter
PARAMETER(20, dead_time, "us", 16, 2, BOARD_DEAD_TIME_LEAST, 500, BOARD_DEAD_TIME, STOPPED,
          "dead band of the gate signals")
PARAMETER(21, turn_on_delay, "us", 16, 2, 0, 200, BOARD_TURN_ON_DELAY, STOPPED, "turn-on delay of driver and device")
PARAMETER(22, turn_off_delay, "us", 16, 2, 0, 200, BOARD_TURN_OFF_DELAY, STOPPED, "turn-off delay of driver and device")
PARAMETER(23, device_drop, "V", 16, 3, 0, 5000, 950, STOPPED, "on-state drop of a device at small current")
PARAMETER(24, device_resistance, "ohm", 24, 4, 0, 10000, 350, STOPPED, "on-state resistance of a device")
PARAMETER(25, drop_band, "A", 20, 2, 1, 200, 20, ALWAYS, "current below which its sign is not trusted")
PARAMETER(26, current_full_scale, "A", 20, 2, 100, 20000, BOARD_CURRENT_RANGE, STOPPED,
          "current at ADC code 4096 (zero is 2048)")
PARAMETER(27, link_full_scale, "V", 16, 1, 100, 20000, BOARD_LINK_RANGE, STOPPED, "DC-link voltage at ADC code 4096")
PARAMETER(28, link_minimum, "V", 16, 1, 100, 10000, 1500, STOPPED, "DC-link voltage below which the drive faults")
PARAMETER(29, link_maximum, "V", 16, 1, 100, 15000, 4200, STOPPED, "DC-link voltage above which the drive faults")
PARAMETER(30, trip_current, "A", 20, 2, 50, 19400, 1800, STOPPED, "software over-current limit on a sampled phase")

// Excitation
PARAMETER(
    40, excitation, "", 0, 0, 0, 5, 3, STOPPED,
    "0 centred, 1 extended, 2 alternating, 3 as the source wants, 4 long zero vector, 5 as 2, cheapest pair above")
PARAMETER(41, pulse_time, "us", 16, 2, 1500, 4700, 4200, ALWAYS, "mean pulse of the alternating layout")
PARAMETER(42, window_minimum, "us", 16, 2, 500, 3000, 1800, ALWAYS, "T_min, shortest extended vector")
PARAMETER(43, window_maximum, "us", 16, 2, 500, 4000, 3000, ALWAYS, "longest extended vector, bounds the ripple")
PARAMETER(44, zero_time, "us", 16, 2, 0, 5000, 0, ALWAYS, "zero vector kept beside the extended ones")
PARAMETER(45, settle_time, "us", 16, 2, 400, 2500, 1050, ALWAYS, "from an edge at the motor to the first sample")

// Position and speed
PARAMETER(60, position_source, "", 0, 0, 0, 8, 4, STOPPED,
          "0 encoder, 1 paper, 2 observer and AVV, 3 AVV alone, 4 observer alone; and flux: 5 CONV, 6 PP-01, 7 PP-02, "
          "8 active")
PARAMETER(61, blend_low, "rpm", 16, 1, 50, 10000, 600, STOPPED,
          "mechanical speed below which the low-speed estimator is used")
PARAMETER(62, blend_high, "rpm", 16, 1, 60, 20000, 1000, STOPPED, "mechanical speed above which AVV is used")
PARAMETER(63, avv_bandwidth_long, "rad/s", 8, 0, 10, 600, 200, ALWAYS, "bandwidth of AVV's observer, long windows")
PARAMETER(64, avv_bandwidth_short, "rad/s", 8, 0, 10, 600, 100, ALWAYS, "bandwidth of AVV's observer, short windows")
PARAMETER(65, adapt_time, "ms", 8, 0, 20, 30000, 150, ALWAYS,
          "time constant of the adaptation of admittances and sensors; 30000 is off")
PARAMETER(66, observer_noise, "mA", 8, 1, 10, 10000, 1000, ALWAYS, "rms noise of a current difference over a window")
PARAMETER(67, observer_load_rate, "Nm", 20, 2, 1, 10000, 100, ALWAYS, "load change per 10 ms that the observer expects")
PARAMETER(75, observer_load_quiet, "Nm", 20, 2, 1, 10000, 5, ALWAYS,
          "observer_load_rate at a crawl, while the load seems steady")
PARAMETER(77, observer_load_step, "Nm", 20, 2, 1, 10000, 200, ALWAYS,
          "load step that the observer looks for at a crawl; at speed twice that, if the map is known")
PARAMETER(76, cogging_order, "", 0, 0, 0, 60, 6, ALWAYS, "cogging periods per electrical turn; 0 learns none")
PARAMETER(68, observer_windows, "", 0, 0, 0, 1, 1, ALWAYS,
          "windows given to the deviation observer: 0 zero vectors only, 1 all")
PARAMETER(69, zvv_proportional, "rad/s", 8, 1, 1, 2000, 40, ALWAYS, "Kp of the paper's ZVV observer")
PARAMETER(70, zvv_integral, "rad/s2", 8, 1, 0, 20000, 40, ALWAYS, "Ki of the paper's ZVV observer")
PARAMETER(71, id_low_speed, "A", 20, 2, -1000, 1000, 0, ALWAYS,
          "d-axis current below the blend, makes the ZVV deviation observable")
PARAMETER(74, drift_time, "ms", 8, 0, 50, 30000, 2000, ALWAYS,
          "time constant of the adaptation of resistance and flux; 30000 is off")
PARAMETER(78, inertia_adapt, "", 0, 0, 0, 1, 1, ALWAYS,
          "learn the inertia from run-ups under a large torque; needs the map")
PARAMETER(73, encoder_counts, "", 0, 0, 16, 65536, 4096, STOPPED, "counts of the reference encoder per turn")

// Control
PARAMETER(80, current_bandwidth, "rad/s", 0, 0, 100, 2600, 1800, STOPPED, "bandwidth of the current loop")
PARAMETER(81, speed_law, "", 0, 0, 0, 1, 0, STOPPED, "0 predictive, 1 PI")
PARAMETER(82, speed_alpha, "A2s2", 8, 0, 1, 100000, 200, STOPPED, "weight of the predicted speed error, per rad^2")
PARAMETER(83, speed_trajectory, "ms", 8, 1, 20, 2000, 70, STOPPED, "time constant of the speed reference trajectory")
PARAMETER(84, speed_pi_bandwidth, "rad/s", 8, 1, 10, 2000, 200, STOPPED, "natural frequency of the PI speed loop")
PARAMETER(85, speed_pi_damping, "", 12, 2, 30, 300, 80, STOPPED, "damping of the PI speed loop")
PARAMETER(86, speed_ramp, "rpm/s", 8, 0, 0, 100000, 3000, ALWAYS, "slope of the speed reference, 0 for a step")
PARAMETER(90, position_hold, "1/s", 8, 1, 0, 200, 50, ALWAYS,
          "how fast the shaft is brought back to where it stood, at a speed reference of zero; 0 lets it creep")
PARAMETER(87, voltage_use, "%", 16, 1, 500, 1000, 900, ALWAYS,
          "share of Vdc/sqrt(3) that field weakening leaves to the voltage")
PARAMETER(88, weakening_limit, "A", 20, 2, 0, 10000, 1200, STOPPED, "largest field-weakening current")
PARAMETER(89, weakening_gain, "A/V", 20, 4, 0, 1000, 20, ALWAYS, "integral gain of field weakening per millisecond")

PARAMETER(330, mtpa, "", 0, 0, 0, 1, 0, ALWAYS, "1 adds the d-axis current that gives the most torque per ampere")
PARAMETER(331, current_divider, "", 0, 0, 1, 2, 1, STOPPED,
          "PWM periods per step of the current control; 2 allows current_bandwidth up to 2080")
PARAMETER(332, current_corner, "", 0, 0, 0, 1, 0, STOPPED,
          "corner of the current controllers' integrator: 0 a quarter of current_bandwidth, 1 the machine's R/L")

// I-F start: a current vector that turns open-loop until the position source can take over
PARAMETER(340, start_method, "", 0, 0, 0, 1, 0, STOPPED,
          "how a standing shaft is started: 0 by its saliency, 1 turned by a current vector (I-F)")
PARAMETER(341, if_current, "A", 20, 2, 20, 10000, 800, STOPPED, "length of the current vector")
PARAMETER(342, if_align, "ms", 0, 0, 10, 5000, 500, STOPPED, "time that the current vector rests before it turns")
PARAMETER(343, if_acceleration, "rpm/s", 8, 0, 10, 100000, 500, STOPPED, "acceleration of the current vector")
PARAMETER(344, if_speed, "rpm", 8, 0, 10, 6000, 300, STOPPED,
          "speed of the vector at which the position source takes over")
PARAMETER(345, if_time, "ms", 0, 0, 100, 10000, 2000, STOPPED,
          "time for the source to agree with the vector before the fault")

// Saturation: incremental inductances at i_d = 0 and i_q = 1/4 .. 4/4 of map_current
PARAMETER(110, map_current, "A", 20, 2, 100, 10000, 1400, STOPPED, "i_q of the inductance map's last point")
PARAMETER(111, lqq_1, "%", 16, 2, 2000, 15000, 10000, STOPPED, "share of inductance_q at 1/4 of map_current")
PARAMETER(112, lqq_2, "%", 16, 2, 2000, 15000, 10000, STOPPED, "share of inductance_q at 2/4 of map_current")
PARAMETER(113, lqq_3, "%", 16, 2, 2000, 15000, 10000, STOPPED, "share of inductance_q at 3/4 of map_current")
PARAMETER(114, lqq_4, "%", 16, 2, 2000, 15000, 10000, STOPPED, "share of inductance_q at map_current")
PARAMETER(115, ldd_1, "%", 16, 2, 2000, 15000, 10000, STOPPED, "share of inductance_d at 1/4 of map_current")
PARAMETER(116, ldd_2, "%", 16, 2, 2000, 15000, 10000, STOPPED, "share of inductance_d at 2/4 of map_current")
PARAMETER(117, ldd_3, "%", 16, 2, 2000, 15000, 10000, STOPPED, "share of inductance_d at 3/4 of map_current")
PARAMETER(118, ldd_4, "%", 16, 2, 2000, 15000, 10000, STOPPED, "share of inductance_d at map_current")
PARAMETER(119, ldq_1, "mH", 20, 4, -1000000, 1000000, 0, STOPPED, "mutual inductance at 1/4 of map_current")
PARAMETER(120, ldq_2, "mH", 20, 4, -1000000, 1000000, 0, STOPPED, "mutual inductance at 2/4 of map_current")
PARAMETER(121, ldq_3, "mH", 20, 4, -1000000, 1000000, 0, STOPPED, "mutual inductance at 3/4 of map_current")
PARAMETER(122, ldq_4, "mH", 20, 4, -1000000, 1000000, 0, STOPPED, "mutual inductance at map_current")
PARAMETER(123, map_known, "", 0, 0, 0, 1, 0, STOPPED, "1: the inductance map is the machine's, even where it is flat")

// Commissioning
PARAMETER(130, sensor_mismatch, "%", 16, 3, -5000, 5000, 0, STOPPED,
          "gain of current sensor a above the mean of both, that of b as much below")
PARAMETER(131, spin_speed, "rpm", 8, 0, 300, 2000, 600, STOPPED, "speed of the commissioning's spin")

// Start and supervision
PARAMETER(100, polarity_current, "A", 20, 2, 20, 10000, 300, STOPPED, "current of the polarity test")
PARAMETER(101, divergence_limit, "deg", 16, 0, 10, 90, 45, ALWAYS,
          "disagreement of the estimators that counts as divergence")
PARAMETER(102, divergence_time, "ms", 0, 0, 1, 1000, 15, ALWAYS, "time above divergence_limit before the fault")
PARAMETER(103, polarity_check, "", 0, 0, 0, 1, 1, STOPPED,
          "test the polarity of the magnet at start, and by the back-EMF once the shaft turns")
PARAMETER(522, wiring_check, "", 0, 0, 0, 1, 1, STOPPED,
          "look at the start whether phases and current sensors are wired as they should be; needs flying_start")
PARAMETER(160, stop_time, "ms", 0, 0, 10, 60000, 1000, ALWAYS,
          "time to standstill after a stop has brought the reference to zero; longer is a fault")
PARAMETER(521, stall_time, "ms", 0, 0, 0, 60000, 2000, ALWAYS,
          "time at the current limit with a shaft that does not follow, before the fault; 0: no such fault")
PARAMETER(161, synchronism_floor, "V", 16, 1, 5, 1000, 40, ALWAYS,
          "EMF error allowed at any speed, see synchronism_time")
PARAMETER(162, synchronism_share, "%", 8, 0, 10, 100, 60, ALWAYS, "share of the EMF added to synchronism_floor")
PARAMETER(163, synchronism_time, "ms", 0, 0, 1, 1000, 5, ALWAYS,
          "time of an EMF error at its limit, or of estimators a quarter turn apart, before the fault")
PARAMETER(164, link_regulation, "V", 16, 1, 100, 15000, 4050, ALWAYS,
          "DC-link voltage above which braking is reduced, to nothing two thirds of the way to link_maximum")

// The start
PARAMETER(150, flying_start, "", 0, 0, 0, 1, 1, STOPPED, "look for a turning shaft before the start")
PARAMETER(151, start_current, "A", 20, 2, 20, 10000, 1000, STOPPED,
          "d-axis current that tells the polarity by saturation")
PARAMETER(152, saturation_d, "%/A", 24, 3, -10000, 10000, 0, STOPPED, "change of the incremental Ldd per ampere of i_d")
PARAMETER(153, hold_time, "ms", 0, 0, 0, 5000, 0, STOPPED,
          "for how long after the start a standing shaft is held stiffly, for a brake to open; needs the map")

// Encoder as reference, hysteresis control
PARAMETER(170, encoder_trim, "deg", 16, 2, -18000, 18000, 0, ALWAYS,
          "added to the electrical angle of the encoder: a deliberate angle error")
PARAMETER(171, current_law, "", 0, 0, 0, 1, 0, STOPPED, "0 PI with space vectors, 1 hysteresis; 1 needs the encoder")
PARAMETER(172, hysteresis_band, "A", 20, 3, 20, 5000, 400, ALWAYS,
          "half width of the hysteresis, where the adaptation begins")
PARAMETER(173, hysteresis_frequency, "kHz", 16, 2, 0, 2500, 1000, ALWAYS,
          "mean switching frequency that the hysteresis adapts to; 0 keeps the band")
PARAMETER(174, slice_time, "us", 16, 2, 500, 2000, 500, STOPPED,
          "interval of the hysteresis' decisions, a whole part of 100 us")

// Position by the stator flux
PARAMETER(300, flux_cutoff, "rad/s", 8, 1, 20, 1500, 20, STOPPED,
          "lowest cut-off of the low-pass that integrates the flux")
PARAMETER(301, flux_bandwidth, "rad/s", 8, 0, 10, 600, 100, ALWAYS, "bandwidth of the observer behind the stator flux")
PARAMETER(303, flux_low, "rpm", 16, 1, 10, 20000, 3500, STOPPED,
          "mechanical speed below which the observer is used, not the stator flux")
PARAMETER(304, flux_high, "rpm", 16, 1, 20, 30000, 5000, STOPPED,
          "mechanical speed above which the stator flux is used")
PARAMETER(302, flux_adapt, "", 0, 0, 0, 3, 1, ALWAYS,
          "the stator flux learns: 0 nothing, 1 the q-axis inductance by the torque, 2 the magnet's flux, 3 both")

PARAMETER(305, flux_beside, "", 0, 0, 0, 4, 0, STOPPED,
          "a stator-flux method beside position_source 0, looking on: 0 none, 1 CONV, 2 PP-01, 3 PP-02, 4 active")

PARAMETER(306, flux_plain, "", 0, 0, 0, 1, 0, STOPPED,
          "1 CONV, PP-01 and active flux on the low-pass alone at flux_cutoff, uncorrected, to compare")

// Serial port
PARAMETER(200, baud_rate, "Bd", 0, 0, 9600, 400000, 115200, STOPPED,
          "bit rate of the serial port; saved, it applies from the next power-on")
PARAMETER(201, link_timeout, "ms", 0, 0, 50, 60000, 1000, ALWAYS,
          "longest silence of the client that guards the motor, then link_reaction")
PARAMETER(202, link_reaction, "", 0, 0, 1, 2, 1, ALWAYS, "when the guard hears nothing: 1 stop, 2 coast")

// CAN bus
PARAMETER(220, can_node, "", 0, 0, 1, 31, 1, STOPPED, "number on the CAN bus, added to the messages' identifiers")
PARAMETER(221, can_rate, "kbit/s", 0, 0, 0, 1000, 500, STOPPED,
          "1000, 500, 250, 125, 100, 50, 20 or 10; with 0 or any other value the bus is off")
PARAMETER(222, can_timeout, "ms", 0, 0, 10, 10000, 200, ALWAYS,
          "longest silence of the bus that started the drive, then can_reaction")
PARAMETER(223, can_reaction, "", 0, 0, 0, 2, 1, ALWAYS, "when commands are missing: 0 nothing, 1 stop, 2 coast")
PARAMETER(224, can_status_period, "ms", 0, 0, 0, 10000, 10, ALWAYS, "period of the STATUS message; 0 sends none")
PARAMETER(225, can_telemetry_period, "ms", 0, 0, 0, 10000, 20, ALWAYS,
          "period of TELEMETRY_1 and TELEMETRY_2; 0 sends none")
PARAMETER(226, can_recovery, "ms", 0, 0, 1, 10000, 100, ALWAYS, "time from bus-off to the next attempt")

// Functions of the board (board/functions.h)
PARAMETER(400, bootstrap_time, "ms", 16, 1, 0, 200, BOARD_BOOTSTRAP_TIME, STOPPED,
          "lower devices on before the first pulse, for the bootstrap capacitors; 0 where there are none")
PARAMETER(401, precharge_voltage, "V", 16, 1, 0, 15000, 0, STOPPED,
          "DC-link voltage at which the precharge relay closes; 0 where there is none")
PARAMETER(402, precharge_time, "ms", 0, 0, 10, 60000, 2000, ALWAYS, "time for the DC link to reach precharge_voltage")
PARAMETER(403, brake_voltage, "V", 16, 1, 0, 15000, 0, STOPPED,
          "DC-link voltage that switches the brake resistor on; 0 where there is none")
PARAMETER(404, brake_hysteresis, "V", 16, 1, 10, 1000, 100, ALWAYS,
          "the brake resistor is switched off so far below brake_voltage")
PARAMETER(405, brake_share, "%", 16, 0, 1, 100, 20, ALWAYS,
          "share of the time that the brake resistor may be on, over 8 s")
PARAMETER(410, temperature_limit, "C", 8, 0, 0, 130, 0, ALWAYS,
          "heat-sink temperature of the fault; 0 where there is no sensor")
PARAMETER(411, temperature_derating, "C", 8, 0, 0, 130, 70, ALWAYS,
          "heat-sink temperature from which the current limit falls, to half at temperature_limit")
PARAMETER(412, overload_current, "A", 20, 2, -100, 10000, -100, ALWAYS,
          "continuous phase current, peak, to which overload lowers the limit; below 0: rated_current, 0: no check")
PARAMETER(413, overload_time, "ms", 0, 0, 100, 600000, 60000, ALWAYS,
          "time constant of the winding, or of the inverter where that is shorter")
PARAMETER(420, emergency_stop, "", 0, 0, 0, 1, 0, STOPPED,
          "1: an emergency-stop contact is wired and switches the gates off")
PARAMETER(421, gate_feedback, "", 0, 0, 0, 1, 0, STOPPED, "1: the gate enable's output is wired back and watched")
PARAMETER(430, speed_input, "", 0, 0, 0, 2, 0, STOPPED,
          "speed and run switch at the board: 0 not used, 1 from 0 V, 2 live zero at 10 %")
PARAMETER(431, speed_input_dead, "%", 16, 1, 0, 500, 20, ALWAYS,
          "share of the speed input's lower end that means standstill")
PARAMETER(432, speed_input_loss, "", 0, 0, 1, 2, 1, ALWAYS, "when the speed input's live zero is lost: 1 stop, 2 coast")
PARAMETER(433, speed_input_full, "rpm", 8, 0, 10, 6000, 2000, ALWAYS, "speed at the upper end of the speed input")
PARAMETER(440, reference_input, "", 0, 0, 0, 1, 0, STOPPED,
          "1: ground and reference are wired to the ADC, for the self-test")
