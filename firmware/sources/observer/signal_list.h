// Signals of what position sources have in common: rows of a table, see dictionary/signal_list.h.

PLACE(15)
SIGNAL(deviation_q, A_PER_S, 8, ROTOR, q_mul_sat(source_deviation_q20, 10000L, 12),
       "q-axis current deviation under zero vectors; position_source 0 and 1 only")
