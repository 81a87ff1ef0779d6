// Signals of the look for a turning shaft: rows of a table, see dictionary/signal_list.h.

PLACE(50)
SIGNAL(wiring, NONE, 0, DRIVE, feature_status.wiring, "wiring mistake found at the start, 0 none")
