// Parameters of the serial port: rows of a table, see dictionary/parameter_list.h.

PLACE(240)
// Serial port
PARAMETER(200, baud_rate, BAUD, 0, 0, 9600, 400000, 115200, STOPPED,
          "bit rate; saved, it applies from the next power-on")
PARAMETER(201, link_timeout, MS, 0, 0, 50, 60000, 1000, ALWAYS,
          "longest silence of the client that guards the motor, then link_reaction")
PARAMETER(202, link_reaction, NONE, 0, 0, 1, 2, 1, ALWAYS, "communication lost: 1 stop, 2 coast")
