// What `commission` says: PHRASE(name, text), see text/phrase_list.h.

PHRASE(commissioning, "commissioning: ")
PHRASE(commissioning_the_shaft_will_turn_stop_ends, "commissioning: the shaft will turn; 'stop' ends it")
PHRASE(commission_commission_start_or_commission_re, "commission, commission start or commission results")
PHRASE(percent_of, " %: ")
PHRASE(becomes, " -> ")
PHRASE(results, "results")
