// Why the I-F start's parameters do not fit: PHRASE(name, text), see text/phrase_list.h.

PHRASE(start_method_1_needs_a_position_source,
       "start_method 1 needs a position_source other than 0: the encoder has no zero yet")
PHRASE(if_current_must_not_exceed_current_limit, "if_current must not exceed current_limit with start_method 1")
