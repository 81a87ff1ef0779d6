// Parameters of the CAN bus: rows of a table, see dictionary/parameter_list.h.

PLACE(250)
// CAN bus
PARAMETER(220, can_node, NONE, 0, 0, 1, 31, 1, STOPPED, "number on the CAN bus")
PARAMETER(221, can_rate, KBIT_PER_S, 0, 0, 0, 1000, 500, STOPPED,
          "one that is usual, 10 to 1000; with any other value the bus is off")
PARAMETER(222, can_timeout, MS, 0, 0, 10, 10000, 200, ALWAYS,
          "longest silence of the bus that started the drive, then can_reaction")
PARAMETER(223, can_reaction, NONE, 0, 0, 0, 2, 1, ALWAYS, "when commands are missing: 0 nothing, 1 stop, 2 coast")
PARAMETER(224, can_status_period, MS, 0, 0, 0, 10000, 10, ALWAYS, "period of the STATUS message; 0 sends none")
PARAMETER(225, can_telemetry_period, MS, 0, 0, 0, 10000, 20, ALWAYS,
          "period of TELEMETRY_1 and TELEMETRY_2; 0 sends none")
PARAMETER(226, can_recovery, MS, 0, 0, 1, 10000, 100, ALWAYS, "time from bus-off to the next attempt")
