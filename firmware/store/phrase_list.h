// What the store says: PHRASE(name, text), see text/phrase_list.h.

PHRASE(title_store, "store")
PHRASE(refused_now_at_their_default, " refused, now at their default")
PHRASE(every_parameter_is_at_its_default_save, "every parameter is at its default; 'save' keeps that")
PHRASE(and_more, " ..")
PHRASE(not_in_the_loop_parameters_are_the_simulations,
       "not in host-in-the-loop mode: these parameters are the simulation's")
PHRASE(not_while_the_power_stage_is_on, "not while the power stage is on: stop the drive first")
PHRASE(the_store_is_busy, "the store is busy: ")
PHRASE(saves_so_far, "; saves so far ")
