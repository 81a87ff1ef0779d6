// Why parameters do not fit together, but for those of features: PHRASE(name, text), see text/phrase_list.h.

PHRASE(position_source_is_not_in_this_edition, "this position_source is not in this edition of the firmware")
PHRASE(inductance_q_must_be_at_least_inductance, "inductance_q must be at least inductance_d")
PHRASE(blend_high_must_be_above_blend_low, "blend_high must be above blend_low")
PHRASE(window_maximum_must_be_at_least_window, "window_maximum must be at least window_minimum")
PHRASE(link_maximum_must_be_above_link_minimum, "link_maximum must be above link_minimum")
PHRASE(link_regulation_must_be_above_link_minimum,
       "link_regulation must be above link_minimum, and 1 V or more below link_maximum")
PHRASE(turn_off_delay_must_not_exceed_dead, "turn_off_delay must not exceed dead_time + turn_on_delay")
PHRASE(dead_time_turn_on_delay_must_not, "dead_time + turn_on_delay must not exceed 2.4 us")
PHRASE(trip_current_must_be_at_least_current, "trip_current must be at least current_limit")
PHRASE(trip_current_must_be_below_97_of, "trip_current must be below 97 % of current_full_scale")
PHRASE(link_maximum_must_be_below_97_of, "link_maximum must be below 97 % of link_full_scale")
PHRASE(speed_limit_pole_pairs_must_not_exceed, "speed_limit x pole_pairs must not exceed 60000 rpm, 1 kHz")
PHRASE(speed_limit_is_too_high_with_the,
       "speed_limit is too high: with the gates off the EMF would charge the link beyond link_maximum")
PHRASE(weakening_limit_must_not_exceed_current_limi, "weakening_limit must not exceed current_limit")
PHRASE(window_minimum_must_be_settle_time_4, "window_minimum must be settle_time + 4.5 us or more")
PHRASE(0_65_pulse_time_must_be_settle, "0.65 x pulse_time must be settle_time + 4.5 us or more")
PHRASE(avv_needs_two_active_vectors, "AVV needs two active vectors: excitation 1, 2 or 3")
PHRASE(hold_time_needs_excitation_2_3_or, "hold_time needs excitation 2, 3 or 5")
PHRASE(lqq_n_inductance_q_must_be, "lqq_n x inductance_q must be at least ldd_n x inductance_d, n = 1 .. 4")
PHRASE(current_bandwidth_must_not_exceed_2080_rad,
       "current_bandwidth must not exceed 2080 rad/s with current_divider 2")
PHRASE(the_machine_s_parameters_are_too_extreme,
       "the machine's parameters are too extreme together: inertia, flux, resistance, inductances, map, speed_limit")
