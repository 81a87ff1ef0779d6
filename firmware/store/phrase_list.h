// What the store says: PHRASE(name, text), see text/phrase_list.h.

PHRASE(refused_now_at_their_default, " refused, now at their default")
PHRASE(every_parameter_is_at_its_default_save, "every parameter is at its default; 'save' keeps that")
PHRASE(and_more, " ..")
