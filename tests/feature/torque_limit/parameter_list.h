// Parameters of the torque limit: rows of a table, see firmware/dictionary/parameter_list.h.

// Torque limit
PARAMETER(900, torque_limit_least, PERCENT, 16, 0, 1, 100, 5, ALWAYS, "share of current_limit that is left at 0 V")
