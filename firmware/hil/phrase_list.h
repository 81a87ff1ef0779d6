// What the host in the loop says: PHRASE(name, text), see text/phrase_list.h.

PHRASE(the_power_stage_is_on_stop_first, "the power stage is on: stop first")
PHRASE(parameters_are_being_saved_or_read_try, "parameters are being saved or read: try again")
PHRASE(not_in_host_in_the_loop_mode, "not in host-in-the-loop mode: enter it first")
