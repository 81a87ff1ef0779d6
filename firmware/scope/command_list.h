// The command of the scope: a row of a table, see console/command_list.h.

PLACE(70)
COMMAND(scope, "[channels | trigger | every | before | mode | arm | stop | print]", "captures signals")
