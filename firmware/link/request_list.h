// The requests that every drive with a link answers: REQUEST(kind, name, number). Kind REQUEST is one of its own,
// COMMAND a code of the request COMMAND with an argument. A number is never given to anything else. Those of a feature
// are in a list of its folder; the build joins all of them (all_requests.h). No include guard: it is included with
// different meanings of REQUEST.

REQUEST(REQUEST, IDENTITY, 0x01)
REQUEST(REQUEST, PARAMETER_INFO, 0x02)
REQUEST(REQUEST, SIGNAL_INFO, 0x03)
REQUEST(REQUEST, PARAMETER_READ, 0x04)
REQUEST(REQUEST, PARAMETER_GET, 0x05)
REQUEST(REQUEST, PARAMETER_SET, 0x06)
REQUEST(REQUEST, COMMAND, 0x07)
REQUEST(REQUEST, STATUS, 0x08)
REQUEST(REQUEST, SIGNALS, 0x09)
REQUEST(REQUEST, FAULT, 0x0A)
REQUEST(REQUEST, WORDS, 0x0B)
REQUEST(REQUEST, LINK, 0x0C)
REQUEST(REQUEST, STREAM, 0x15)

REQUEST(COMMAND, START, 1)  // argument bit 0: watched over by the link, the whole is then the client's number
REQUEST(COMMAND, STOP, 2)
REQUEST(COMMAND, COAST, 3)
REQUEST(COMMAND, RESET, 4)
REQUEST(COMMAND, SPEED, 5)  // argument: rpm, Q16
