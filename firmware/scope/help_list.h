// What `help scope` says beyond the command's own line: HELP(command, number, text), see console/help_list.h.

HELP(scope, 1, "scope channels current_q speed     one to four signals (command signals)")
HELP(scope, 2, "scope trigger speed rising 100     rising, falling, either, above, below; or: scope trigger now")
HELP(scope, 7, "scope hysteresis 5     it has to rise from below 95; by default a quarter of the signal's recent span")
HELP(scope, 3, "scope every 10     one record in every 10 control interrupts of 100 us")
HELP(scope, 4, "scope before 128   128 of the 512 records before the trigger")
HELP(scope, 5, "scope mode auto    or single")
HELP(scope, 6, "scope arm, scope stop, scope, scope print 16     print 16 shows every 16th record")
