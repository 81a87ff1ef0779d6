// Parameters of excitation, position, control and supervision: rows of a table, see dictionary/parameter_list.h.

PLACE(30)
// Excitation
PARAMETER(40, excitation, NONE, 0, 0, 0, 5, 3, STOPPED,
          "0 centred, 1 extended, 2 alternating, 3 by source, 4 long zero vector, 5 as 2, cheapest pair above")
PARAMETER(41, pulse_time, US, 16, 2, 1500, 4700, 4200, ALWAYS, "mean pulse of the alternating layout")
PARAMETER(42, window_minimum, US, 16, 2, 500, 3000, 1800, ALWAYS, "T_min, shortest extended vector")
PARAMETER(43, window_maximum, US, 16, 2, 500, 4000, 3000, ALWAYS, "longest extended vector, bounds the ripple")
PARAMETER(44, zero_time, US, 16, 2, 0, 5000, 0, ALWAYS, "zero vector kept beside the extended ones")
PARAMETER(45, settle_time, US, 16, 2, 400, 2500, 1050, ALWAYS, "from an edge at the motor to the first sample")

PLACE(40)
// Position and speed
PARAMETER(60, position_source, NONE, 0, 0, 0, 8, 4, STOPPED,
          "0 encoder, 1 paper, 2 observer and AVV, 3 AVV alone, 4 observer alone; and flux: 5 CONV, 6 PP-01, 7 PP-02, "
          "8 active")
PARAMETER(61, blend_low, RPM, 16, 1, 50, 10000, 600, STOPPED,
          "mechanical speed below which the low-speed estimator is used")
PARAMETER(62, blend_high, RPM, 16, 1, 60, 20000, 1000, STOPPED, "mechanical speed above which AVV is used")
PARAMETER(63, avv_bandwidth_long, RAD_PER_S, 8, 0, 10, 600, 200, ALWAYS, "bandwidth of AVV's observer, long windows")
PARAMETER(64, avv_bandwidth_short, RAD_PER_S, 8, 0, 10, 600, 100, ALWAYS, "bandwidth of AVV's observer, short windows")
PARAMETER(65, adapt_time, MS, 8, 0, 20, 30000, 150, ALWAYS,
          "time constant of the adaptation of inverse inductances and sensors; 30000: off")
PARAMETER(66, observer_noise, MA, 8, 1, 10, 10000, 1000, ALWAYS, "rms error of the current change over 33 us")
PARAMETER(67, observer_load_rate, NM, 20, 2, 1, 10000, 100, ALWAYS, "load change per 10 ms that the observer expects")
PARAMETER(75, observer_load_quiet, NM, 20, 2, 1, 10000, 5, ALWAYS,
          "observer_load_rate at a crawl, while the load seems steady")
PARAMETER(77, observer_load_step, NM, 20, 2, 1, 10000, 200, ALWAYS,
          "load step to look for at a crawl; at speed twice that, if the map is known")
PARAMETER(76, cogging_order, NONE, 0, 0, 0, 60, 6, ALWAYS, "cogging periods per electrical turn; 0 learns none")
PARAMETER(68, observer_windows, NONE, 0, 0, 0, 1, 1, ALWAYS,
          "windows given to the deviation observer: 0 zero vectors only, 1 all")

PLACE(60)
PARAMETER(74, drift_time, MS, 8, 0, 50, 30000, 2000, ALWAYS,
          "time constant of the adaptation of resistance and flux; 30000: off")
PARAMETER(78, inertia_adapt, NONE, 0, 0, 0, 1, 1, ALWAYS, "learn the inertia under a large torque; needs the map")

PLACE(80)
// Control
PARAMETER(80, current_bandwidth, RAD_PER_S, 0, 0, 100, 2600, 1800, STOPPED, "bandwidth of the current loop")
PARAMETER(81, speed_law, NONE, 0, 0, 0, 1, 0, STOPPED, "0 predictive, 1 PI")
PARAMETER(82, speed_alpha, A2S2, 14, 0, 1, 100000, 200, STOPPED, "weight of the predicted speed error, per rad^2")
PARAMETER(83, speed_trajectory, MS, 8, 1, 20, 2000, 70, STOPPED, "time constant of the speed reference trajectory")
PARAMETER(84, speed_pi_bandwidth, RAD_PER_S, 8, 1, 10, 2000, 200, STOPPED, "natural frequency of the PI speed loop")
PARAMETER(85, speed_pi_damping, NONE, 12, 2, 30, 6000, 80, STOPPED, "damping of the PI speed loop")
PARAMETER(86, speed_ramp, RPM_PER_S, 8, 0, 0, 100000, 3000, ALWAYS, "slope of the speed reference, 0 for a step")
PARAMETER(90, position_hold, PER_S, 8, 1, 0, 200, 50, ALWAYS,
          "how fast a shaft at rest is brought back; 0 lets it creep")
PARAMETER(87, voltage_use, PERCENT, 16, 1, 500, 1000, 900, ALWAYS,
          "share of the largest voltage that field weakening leaves")
PARAMETER(88, weakening_limit, A, 20, 2, 0, 10000, 1200, STOPPED, "largest field-weakening current")
PARAMETER(89, weakening_gain, A_PER_V, 20, 4, 0, 1000, 20, ALWAYS, "integral gain of field weakening per millisecond")

PLACE(90)
PARAMETER(330, mtpa, NONE, 0, 0, 0, 1, 0, ALWAYS, "1 adds the d-axis current that gives the most torque per ampere")
PARAMETER(331, current_divider, NONE, 0, 0, 1, 2, 1, STOPPED, "PWM periods per step of the current control")
PARAMETER(332, current_corner, NONE, 0, 0, 0, 1, 0, STOPPED,
          "corner of the current integrator: 0 current_bandwidth / 4, at least R/L; 1 R/L")

PLACE(145)
PARAMETER(101, divergence_limit, DEG, 16, 0, 10, 90, 45, ALWAYS,
          "disagreement of the estimators that counts as divergence")
PARAMETER(102, divergence_time, MS, 0, 0, 1, 1000, 15, ALWAYS, "time above divergence_limit before the fault")
PARAMETER(103, polarity_check, NONE, 0, 0, 0, 1, 1, STOPPED,
          "test the polarity of the magnet at start, and by the back-EMF once the shaft turns")

PLACE(160)
PARAMETER(160, stop_time, MS, 0, 0, 10, 60000, 1000, ALWAYS,
          "longest time to standstill after a stop has brought the reference to zero")
PARAMETER(521, stall_time, MS, 0, 0, 0, 60000, 2000, ALWAYS,
          "time at the current limit with a shaft that does not follow, before the fault; 0: none")
PARAMETER(161, synchronism_floor, V, 16, 1, 5, 1000, 40, ALWAYS, "EMF error allowed at any speed, see synchronism_time")
PARAMETER(162, synchronism_share, PERCENT, 8, 0, 10, 100, 60, ALWAYS, "share of the EMF added to synchronism_floor")
PARAMETER(163, synchronism_time, MS, 0, 0, 1, 1000, 5, ALWAYS,
          "time of an EMF error at its limit, or of estimators a quarter turn apart, before the fault")
PARAMETER(164, link_regulation, V, 16, 1, 100, 15000, 4050, ALWAYS, "DC-link voltage above which braking is reduced")

PLACE(180)
PARAMETER(152, saturation_d, PERCENT_PER_A, 24, 3, -10000, 10000, 0, STOPPED,
          "change of the incremental Ldd per ampere of i_d")
PARAMETER(153, hold_time, MS, 0, 0, 0, 5000, 0, STOPPED,
          "time after the start that the shaft is held stiffly, for a brake to open; needs the map")
