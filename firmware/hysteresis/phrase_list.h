// Why hysteresis does not fit the parameters: PHRASE(name, text), see text/phrase_list.h.

PHRASE(current_law_1_needs_position_source_0, "current_law 1 needs position_source 0")
PHRASE(100_us_must_be_a_whole_number, "100 us must be a whole multiple of slice_time")
