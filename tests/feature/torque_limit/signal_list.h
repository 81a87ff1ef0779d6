// Signals of the torque limit: rows of a table, see firmware/dictionary/signal_list.h.

SIGNAL(torque_share, PERCENT, 10, DRIVE, torque_limit_share() * 25 / 8, "share of current_limit by the speed input")
