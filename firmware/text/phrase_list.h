// What the drive says in its own words: sentences and pieces of them, written with put_packed. PHRASE(name, text). Here
// is what several parts say; what one alone says is in a list of the same form in its folder. No include guard: it is
// included with different meanings of PHRASE.

PHRASE(a_fault_is_latched_reset_it_first, "a fault is latched, reset it first: ")
PHRASE(the_drive_is_not_ready_yet, "the drive is not ready yet: ")
PHRASE(the_drive_is_busy_stop_it_first, "the drive is busy, stop it first: ")
PHRASE(no_fault_is_latched, "no fault is latched")
PHRASE(rpm_is_beyond_speed_limit, " rpm is beyond speed_limit, ")
PHRASE(rpm_nothing_changed, " rpm: nothing changed")
PHRASE(is_outside_of, " is outside of ")
PHRASE(nothing_changed, ": nothing changed")
PHRASE(not_taken_while_the_drive_runs, "not taken while the drive runs: ")
PHRASE(set_but_the_drive_does_not_start, "set, but the drive does not start with it: ")
PHRASE(may_not_change_while_the_power_stage, " may not change while the power stage is on: stop the drive first")
PHRASE(not_in_the_loop_parameters_are_the_simulations,
       "not in host-in-the-loop mode: these parameters are the simulation's")
PHRASE(not_while_the_power_stage_is_on, "not while the power stage is on: stop the drive first")
PHRASE(the_store_is_busy, "the store is busy: ")
PHRASE(at, " at ")
PHRASE(a_guarded_start_needs_the_number, "a guarded start needs the client's number: this client is too old")
PHRASE(ms, " ms")
PHRASE(rpm, " rpm")
PHRASE(is_not_a_whole_number_in, " is not a whole number in ")
