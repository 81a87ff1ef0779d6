// What is said of names that were probably meant: PHRASE(name, text), see text/phrase_list.h.

PHRASE(did_you_mean, "': did you mean ")
