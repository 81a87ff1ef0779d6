// What `help look` says beyond the command's own line: HELP(command, number, text), see console/help_list.h.

HELP(look, 1, "From 'ready': short-circuits the motor twice, up to a millisecond each, and measures the current.")
HELP(look, 2, "It brakes a turning shaft a little. The power stage is off again when the answer comes.")
