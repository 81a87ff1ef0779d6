// What the board's functions say of themselves: PHRASE(name, text), see text/phrase_list.h.

PHRASE(title_board, "board")
PHRASE(title_self_test, "self-test")
PHRASE(celsius, " C; ")
PHRASE(percent, " %")
