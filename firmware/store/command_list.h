// Commands of the store: rows of a table, see console/command_list.h.

PLACE(20)
COMMAND(save, "", "saves the parameters for the next power-on")
COMMAND(load, "", "goes back to the saved parameters")
COMMAND(defaults, "", "sets every parameter to its default; not kept until saved")
