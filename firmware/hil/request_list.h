// Requests of the host in the loop: REQUEST(kind, name, number), see link/request_list.h.

REQUEST(REQUEST, HIL_ENTER, 0x20)
REQUEST(REQUEST, HIL_STEP, 0x21)
REQUEST(REQUEST, HIL_LEAVE, 0x22)
