// Parameters of the start, the inductance map, commissioning and supervision: rows of parameter_list.h.

// I-F start: a current vector that turns open-loop until the position source can take over
PARAMETER(340, start_method, NONE, 0, 0, 0, 1, 0, STOPPED,
          "start of a standing shaft: 0 by its saliency, 1 turned by a current vector (I-F)")
PARAMETER(341, if_current, A, 20, 2, 20, 10000, 800, STOPPED, "length of the current vector")
PARAMETER(342, if_align, MS, 0, 0, 10, 5000, 500, STOPPED, "time that the current vector rests before it turns")
PARAMETER(343, if_acceleration, RPM_PER_S, 8, 0, 10, 100000, 500, STOPPED, "acceleration of the current vector")
PARAMETER(344, if_speed, RPM, 8, 0, 10, 6000, 300, STOPPED,
          "speed of the vector at which the position source takes over")
PARAMETER(345, if_time, MS, 0, 0, 100, 10000, 2000, STOPPED,
          "time for the source to agree with the vector before the fault")

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

// Commissioning
PARAMETER(130, sensor_mismatch, PERCENT, 16, 3, -5000, 5000, 0, STOPPED,
          "gain of current sensor a above the mean of both, that of b as much below")
PARAMETER(131, spin_speed, RPM, 8, 0, 30, 20000, 600, STOPPED, "speed of the commissioning's spin")

// Start and supervision
PARAMETER(100, polarity_current, A, 20, 2, 20, 10000, 300, STOPPED, "current of the polarity test")
PARAMETER(101, divergence_limit, DEG, 16, 0, 10, 90, 45, ALWAYS,
          "disagreement of the estimators that counts as divergence")
PARAMETER(102, divergence_time, MS, 0, 0, 1, 1000, 15, ALWAYS, "time above divergence_limit before the fault")
PARAMETER(103, polarity_check, NONE, 0, 0, 0, 1, 1, STOPPED,
          "test the polarity of the magnet at start, and by the back-EMF once the shaft turns")
PARAMETER(522, wiring_check, NONE, 0, 0, 0, 1, 1, STOPPED,
          "look at the wiring of phases and current sensors at the start; needs flying_start")
PARAMETER(160, stop_time, MS, 0, 0, 10, 60000, 1000, ALWAYS,
          "longest time to standstill after a stop has brought the reference to zero")
PARAMETER(521, stall_time, MS, 0, 0, 0, 60000, 2000, ALWAYS,
          "time at the current limit with a shaft that does not follow, before the fault; 0: none")
PARAMETER(161, synchronism_floor, V, 16, 1, 5, 1000, 40, ALWAYS, "EMF error allowed at any speed, see synchronism_time")
PARAMETER(162, synchronism_share, PERCENT, 8, 0, 10, 100, 60, ALWAYS, "share of the EMF added to synchronism_floor")
PARAMETER(163, synchronism_time, MS, 0, 0, 1, 1000, 5, ALWAYS,
          "time of an EMF error at its limit, or of estimators a quarter turn apart, before the fault")
PARAMETER(164, link_regulation, V, 16, 1, 100, 15000, 4050, ALWAYS, "DC-link voltage above which braking is reduced")

// The start
PARAMETER(150, flying_start, NONE, 0, 0, 0, 1, 1, STOPPED, "look for a turning shaft before the start")
PARAMETER(151, start_current, A, 20, 2, 20, 10000, 1000, STOPPED,
          "d-axis current that tells the polarity by saturation")
PARAMETER(152, saturation_d, PERCENT_PER_A, 24, 3, -10000, 10000, 0, STOPPED,
          "change of the incremental Ldd per ampere of i_d")
PARAMETER(153, hold_time, MS, 0, 0, 0, 5000, 0, STOPPED,
          "time after the start that the shaft is held stiffly, for a brake to open; needs the map")
