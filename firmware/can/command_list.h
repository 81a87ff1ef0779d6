// The command of the CAN node: a row of a table, see console/command_list.h.

PLACE(80)
COMMAND(can, "", "the CAN node: rate, state, errors, who commands")
