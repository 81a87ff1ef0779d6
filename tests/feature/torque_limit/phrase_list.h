// What the torque limit says of itself: PHRASE(name, text), see firmware/text/phrase_list.h.

PHRASE(torque, "torque")
PHRASE(percent_of_current_limit, " % of current_limit by the voltage at the speed input")
