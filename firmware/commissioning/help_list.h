// What `help commission` says beyond the command's own line: HELP(command, number, text), see console/help_list.h.

HELP(commission, 1,
     "commission start hold from 'ready'; the shaft must be free to turn. 'stop' ends it; see help start")
HELP(commission, 2, "commission            how far it is")
HELP(commission, 3, "commission results    what was measured, and why it is in use or not")
