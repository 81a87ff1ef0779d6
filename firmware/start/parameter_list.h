// Parameters of the start of a standing shaft: rows of a table, see dictionary/parameter_list.h.

PLACE(140)
// Start and supervision
PARAMETER(100, polarity_current, A, 20, 2, 20, 10000, 300, STOPPED, "current of the polarity test")

PLACE(175)
PARAMETER(151, start_current, A, 20, 2, 20, 10000, 1000, STOPPED,
          "d-axis current that tells the polarity by saturation")
