// Parameters of commissioning: rows of a table, see dictionary/parameter_list.h.

PLACE(130)
PARAMETER(131, spin_speed, RPM, 8, 0, 30, 20000, 600, STOPPED, "speed of the commissioning's spin")
