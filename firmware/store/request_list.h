// Requests of the store: REQUEST(kind, name, number), see link/request_list.h.

REQUEST(COMMAND, SAVE, 7)
REQUEST(COMMAND, DEFAULTS, 8)
REQUEST(COMMAND, LOAD, 9)
