// Requests of commissioning: REQUEST(kind, name, number), see link/request_list.h.

REQUEST(REQUEST, COMMISSION_RESULT, 0x16)
REQUEST(COMMAND, COMMISSION, 6)  // argument as that of START
