// What the link says of itself: PHRASE(name, text), see text/phrase_list.h.

PHRASE(a_guarded_start_needs_the_number, "a guarded start needs the client's number: this client is too old")
PHRASE(title_serial, "serial")
PHRASE(disturbances, " disturbances, ")
PHRASE(damaged_records, " damaged records, ")
PHRASE(events_dropped, " events dropped")
