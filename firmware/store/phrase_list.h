// What the store says: PHRASE(name, text), see text/phrase_list.h.

PHRASE(outside_of_their_range_now_at_their, " outside of their range, now at their default")
PHRASE(every_parameter_is_at_its_default_save, "every parameter is at its default; 'save' keeps that")
PHRASE(and_more, " ..")
