// The command that looks for a turning shaft: a row of a table, see console/command_list.h.

PLACE(40)
COMMAND(look, "", "whether and how the shaft turns, by two short pulses")
