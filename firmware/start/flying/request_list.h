// Requests of the look for a turning shaft: REQUEST(kind, name, number), see link/request_list.h.

REQUEST(REQUEST, LOOK, 0x17)
REQUEST(COMMAND, LOOK, 10)
