// Signals of the start: rows of a table, see dictionary/signal_list.h.

PLACE(18)
SIGNAL(start_phase, NONE, 0, DRIVE, starting.phase, "phase of the start")
SIGNAL(polarity_sigma, NONE, 8, DRIVE, starting.sigma_q8,
       "confidence in the polarity found at the start, standard errors")
