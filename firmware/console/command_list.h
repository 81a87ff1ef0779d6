// The console's own commands. COMMAND(name, arguments, help): command_NAME carries it out (commands.h). Those of a
// feature are in a list of its folder; the build joins all rows (all_commands.h): PLACE(number) says where those that
// follow stand in the table, smaller ones first. No include guard: it is included with different meanings of COMMAND.

PLACE(10)
COMMAND(help, "[command]", "the commands, or more of one")
COMMAND(list, "[part]", "parameters whose name or meaning contains the part; * marks changed ones")
COMMAND(get, "name", "a parameter or a signal: value, range, meaning")
COMMAND(set, "name value [unit]", "changes a parameter")

PLACE(30)
COMMAND(start, "hold | free", "switches the power stage on and runs")
COMMAND(stop, "", "brings the shaft to rest, then switches off")
COMMAND(coast, "", "switches off at once: the shaft coasts")
COMMAND(ref, "[speed [rpm]]", "speed reference; before the start or while it runs")
COMMAND(reset, "", "clears a latched fault")
COMMAND(status, "", "state of the drive")

PLACE(50)
COMMAND(watch, "[signal ..]", "a line twice a second until a key is pressed")
COMMAND(faults, "", "the last faults: when, what, and the values then")
COMMAND(signals, "[part]", "signals and their values")

PLACE(90)
COMMAND(version, "", "version of the firmware")
