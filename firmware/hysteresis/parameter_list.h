// Parameters of hysteresis control: rows of a table, see dictionary/parameter_list.h.

PLACE(210)
PARAMETER(171, current_law, NONE, 0, 0, 0, 1, 0, STOPPED, "0 PI with space vectors, 1 hysteresis; 1 needs the encoder")
PARAMETER(172, hysteresis_band, A, 20, 3, 20, 5000, 400, ALWAYS,
          "half width of the hysteresis, where the adaptation begins")
PARAMETER(173, hysteresis_frequency, KHZ, 16, 2, 0, 2500, 1000, ALWAYS,
          "mean switching frequency that the hysteresis adapts to; 0 keeps the band")
PARAMETER(174, slice_time, US, 16, 2, 500, 2000, 500, STOPPED,
          "interval of the hysteresis' decisions, a whole part of 100 us")
