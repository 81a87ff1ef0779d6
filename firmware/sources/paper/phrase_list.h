// Why the paper's scheme does not fit the parameters: PHRASE(name, text), see text/phrase_list.h.

PHRASE(position_source_1_needs_id_low_speed, "position_source 1 needs id_low_speed of at least 1 A")
