// Parameters of the look for a turning shaft: rows of a table, see dictionary/parameter_list.h.

PLACE(150)
PARAMETER(522, wiring_check, NONE, 0, 0, 0, 1, 1, STOPPED,
          "look at the wiring of phases and current sensors at the start; needs flying_start")

PLACE(170)
// The start
PARAMETER(150, flying_start, NONE, 0, 0, 0, 1, 1, STOPPED, "look for a turning shaft before the start")
