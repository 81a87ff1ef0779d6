// What `help <command>` says beyond the command's own line. HELP(command, number, text): one line. What a feature's
// command says is in a list of the same form in its folder, and the build makes console/all_help.h of them all, which
// is included with different meanings of HELP.

HELP(list, 1, "list            all parameters")
HELP(list, 2, "list current    those with 'current' in name or meaning")
HELP(set, 1, "set speed_ramp 300 rpm/s")
HELP(set, 2, "The unit may be left out; a wrong one is refused. A value applies at once, and is lost at power-off")
HELP(set, 3, "unless saved. Some may not change while the power stage is on.")
HELP(start, 1, "The drive finds angle and polarity by itself, then runs at the speed of 'ref'.")
HELP(start, 2, "start hold      while a key is held (the space bar); stops when none has come for link_timeout")
HELP(start, 3, "start free      until 'stop', even without this terminal; also ends the watch over a running motor")
HELP(start, 4, "start           watched by the program at the other end, which keeps it alive (stillspin console)")
HELP(ref, 1, "ref 600 rpm     ref -50")
HELP(watch, 1, "watch           state, speed, current, DC link")
HELP(watch, 2, "watch load_torque current_q")
