// Signals of the board's sensors: rows of a table, see dictionary/signal_list.h.

PLACE(60)
SIGNAL(temperature, CELSIUS, 8, HEAT_SINK, board.heat_sink_q8, "of the heat sink; unknown where temperature_limit is 0")
