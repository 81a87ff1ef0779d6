// The parameters of machine and inverter, as every drive has them. Console, bus, storage, host tools and documentation
// read them; nothing is listed twice. Those of a feature are in a list of its folder; the build joins all of them
// (all_parameters.h).
//
// PARAMETER(id, name, unit, q, decimals, minimum, maximum, default, access, meaning)
//   id        stable for ever; a number is never used again
//   unit      of unit_list.h; what a current, a voltage or both are in is in units of the formats (units.h)
//   q         fractional bits of the value in the firmware (int32_t)
//   minimum, maximum, default: whole numbers in units of 10^-decimals, so that every compiler makes the same constant;
//             those that the board decides are named, see hal/hal_board.h
//   access    STOPPED: only while the power stage is off; ALWAYS: at any time
// PLACE(number) says where the rows that follow stand in the table of all: smaller ones come first, and what has none
// last. No include guard: it is included with different meanings of PARAMETER.

PLACE(10)
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
PARAMETER(520, rated_current, A, 20, 2, 0, 10000, 0, ALWAYS, "rated phase current, peak; 0: half of current_limit")

PLACE(20)
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

PLACE(110)
// Saturation: incremental inductances at i_d = 0 and i_q = 1/4 .. 4/4 of map_current
PARAMETER(110, map_current, A, 20, 2, 100, 10000, 1400, STOPPED, "i_q of the inductance map's last point")
PARAMETER(111, lqq_1, PERCENT, 16, 2, 2000, 15000, 10000, STOPPED, "share of inductance_q at 1/4 of map_current")
PARAMETER(112, lqq_2, PERCENT, 16, 2, 2000, 15000, 10000, STOPPED, "share of inductance_q at 2/4 of map_current")
PARAMETER(113, lqq_3, PERCENT, 16, 2, 2000, 15000, 10000, STOPPED, "share of inductance_q at 3/4 of map_current")
PARAMETER(114, lqq_4, PERCENT, 16, 2, 2000, 15000, 10000, STOPPED, "share of inductance_q at map_current")
PARAMETER(115, ldd_1, PERCENT, 16, 2, 2000, 15000, 10000, STOPPED, "share of inductance_d at 1/4 of map_current")
PARAMETER(116, ldd_2, PERCENT, 16, 2, 2000, 15000, 10000, STOPPED, "share of inductance_d at 2/4 of map_current")
PARAMETER(117, ldd_3, PERCENT, 16, 2, 2000, 15000, 10000, STOPPED, "share of inductance_d at 3/4 of map_current")
PARAMETER(118, ldd_4, PERCENT, 16, 2, 2000, 15000, 10000, STOPPED, "share of inductance_d at map_current")
PARAMETER(119, ldq_1, MH, 20, 4, -1000000, 1000000, 0, STOPPED, "mutual inductance at 1/4 of map_current")
PARAMETER(120, ldq_2, MH, 20, 4, -1000000, 1000000, 0, STOPPED, "mutual inductance at 2/4 of map_current")
PARAMETER(121, ldq_3, MH, 20, 4, -1000000, 1000000, 0, STOPPED, "mutual inductance at 3/4 of map_current")
PARAMETER(122, ldq_4, MH, 20, 4, -1000000, 1000000, 0, STOPPED, "mutual inductance at map_current")
PARAMETER(123, map_known, NONE, 0, 0, 0, 1, 0, STOPPED, "1: the inductance map is the machine's, even where it is flat")
PARAMETER(124, saliency_current, A, 20, 2, 0, 10000, 0, STOPPED, "current up to which the saliency is there; 0: all")

PLACE(120)
// Commissioning
PARAMETER(130, sensor_mismatch, PERCENT, 16, 3, -5000, 5000, 0, STOPPED,
          "gain of current sensor a above the mean of both, that of b as much below")
