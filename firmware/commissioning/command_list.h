// The command of the commissioning: a row of a table, see console/command_list.h.

PLACE(60)
COMMAND(commission, "[start hold | start free | results]", "measures machine and inverter; turns the shaft, 90 s")
