// The messages on the CAN bus: the one table in C. sim_host/stillspin/can/stillspin.dbc says the same to everybody
// else, and a test compares the two field by field and value by value.
//
// CAN_MESSAGE(message, base, octets, sender, meaning)
//   base    identifier of node 0; node n (1..31, parameter can_node) uses base + n, standard format
//   octets  length; a record's last piece may be shorter
//   sender  HOST or DRIVE
// CAN_FIELD(message, field, first, bits, sign, per_unit, unit, meaning)
//   first     lowest bit: bit b of octet n is 8 n + b, so multi-octet fields are little-endian
//   sign      UNSIGNED or SIGNED, two's complement
//   per_unit  steps that make one unit
// A field stands behind its message. No include guard: it is included with different meanings of the macros.

CAN_MESSAGE(COMMAND, 0x100, 4, HOST, "what the drive shall do; to be repeated within can_timeout")
CAN_FIELD(COMMAND, MODE, 0, 2, UNSIGNED, 1, "", "0 off: gates open, 1 stop: down the ramp, 2 run")
CAN_FIELD(COMMAND, CLEAR_FAULT, 2, 1, UNSIGNED, 1, "", "a rising bit clears a latched fault")
CAN_FIELD(COMMAND, ALIVE, 4, 4, UNSIGNED, 1, "", "one more with every message, after 15 comes 0")
CAN_FIELD(COMMAND, SPEED, 8, 16, SIGNED, 4, "rpm", "speed reference, taken in mode run")
CAN_FIELD(COMMAND, CRC, 24, 8, UNSIGNED, 1, "", "CRC-8 SAE J1850 over identifier (low, high octet) and octets 0 to 2")

CAN_MESSAGE(STATUS, 0x180, 8, DRIVE, "every can_status_period")
CAN_FIELD(STATUS, STATE, 0, 4, UNSIGNED, 1, "", "state of the drive")
CAN_FIELD(STATUS, COMMANDED, 4, 1, UNSIGNED, 1, "", "started by this bus and under its command")
CAN_FIELD(STATUS, TIMED_OUT, 5, 1, UNSIGNED, 1, "", "commands stayed away: can_reaction was carried out")
CAN_FIELD(STATUS, ENERGISED, 6, 1, UNSIGNED, 1, "", "power stage in use")
CAN_FIELD(STATUS, SPEED_KNOWN, 7, 1, UNSIGNED, 1, "", "0: angle and speed are unknown, and the shaft may turn")
CAN_FIELD(STATUS, FAULT, 8, 8, UNSIGNED, 1, "", "latched fault")
CAN_FIELD(STATUS, LIMITS, 16, 8, UNSIGNED, 1, "", "what holds the drive back, one bit each")
CAN_FIELD(STATUS, ALIVE, 24, 4, UNSIGNED, 1, "", "one more with every message")
CAN_FIELD(STATUS, SPEED, 32, 16, SIGNED, 4, "rpm", "speed in use")
CAN_FIELD(STATUS, REFERENCE, 48, 16, SIGNED, 4, "rpm", "speed reference after the ramp")

CAN_MESSAGE(TELEMETRY_1, 0x200, 8, DRIVE, "every can_telemetry_period; values of one control interrupt")
CAN_FIELD(TELEMETRY_1, CURRENT_D, 0, 16, SIGNED, 1000, "A", "d-axis current")
CAN_FIELD(TELEMETRY_1, CURRENT_Q, 16, 16, SIGNED, 1000, "A", "q-axis current")
CAN_FIELD(TELEMETRY_1, LINK_VOLTAGE, 32, 16, UNSIGNED, 100, "V", "DC link")
CAN_FIELD(TELEMETRY_1, LOAD_TORQUE, 48, 16, SIGNED, 500, "Nm", "estimated load torque")

CAN_MESSAGE(TELEMETRY_2, 0x280, 8, DRIVE, "with TELEMETRY_1, of the same control interrupt")
CAN_FIELD(TELEMETRY_2, CURRENT_D_REFERENCE, 0, 16, SIGNED, 1000, "A", "d-axis current reference")
CAN_FIELD(TELEMETRY_2, CURRENT_Q_REFERENCE, 16, 16, SIGNED, 1000, "A", "q-axis current reference")
CAN_FIELD(TELEMETRY_2, VOLTAGE_D, 32, 16, SIGNED, 64, "V", "d-axis voltage command")
CAN_FIELD(TELEMETRY_2, VOLTAGE_Q, 48, 16, SIGNED, 64, "V", "q-axis voltage command")

CAN_MESSAGE(PARAMETER_REQUEST, 0x300, 7, HOST, "reads or writes a parameter")
CAN_FIELD(PARAMETER_REQUEST, OPERATION, 0, 8, UNSIGNED, 1, "", "0 get, 1 set")
CAN_FIELD(PARAMETER_REQUEST, ID, 8, 16, UNSIGNED, 1, "", "number of the parameter, stillspin params")
CAN_FIELD(PARAMETER_REQUEST, RAW, 24, 32, SIGNED, 1, "", "value with the parameter's fractional bits")

CAN_MESSAGE(PARAMETER_RESPONSE, 0x380, 8, DRIVE, "answer to PARAMETER_REQUEST")
CAN_FIELD(PARAMETER_RESPONSE, OPERATION, 0, 8, UNSIGNED, 1, "", "as asked")
CAN_FIELD(PARAMETER_RESPONSE, ID, 8, 16, UNSIGNED, 1, "", "as asked")
CAN_FIELD(PARAMETER_RESPONSE, RAW, 24, 32, SIGNED, 1, "", "value in effect")
CAN_FIELD(PARAMETER_RESPONSE, STATUS, 56, 8, UNSIGNED, 1, "", "0 done, otherwise why not")

CAN_MESSAGE(RECORD_REQUEST, 0x400, 8, HOST, "a piece of a record of the serial protocol")
CAN_FIELD(RECORD_REQUEST, NUMBER, 0, 6, UNSIGNED, 1, "", "of the piece, from 0 in the first")
CAN_FIELD(RECORD_REQUEST, LAST, 6, 1, UNSIGNED, 1, "", "the record ends with this piece")
CAN_FIELD(RECORD_REQUEST, FIRST, 7, 1, UNSIGNED, 1, "", "the record begins with this piece")

CAN_MESSAGE(RECORD_RESPONSE, 0x480, 8, DRIVE, "a piece of the answer's record")
CAN_FIELD(RECORD_RESPONSE, NUMBER, 0, 6, UNSIGNED, 1, "", "of the piece, from 0 in the first")
CAN_FIELD(RECORD_RESPONSE, LAST, 6, 1, UNSIGNED, 1, "", "the record ends with this piece")
CAN_FIELD(RECORD_RESPONSE, FIRST, 7, 1, UNSIGNED, 1, "", "the record begins with this piece")

CAN_MESSAGE(DIAGNOSTIC, 0x500, 8, DRIVE, "once a second: what went wrong on the bus since power-on")
CAN_FIELD(DIAGNOSTIC, BAD_COMMANDS, 0, 16, UNSIGNED, 1, "", "wrong length or CRC, or the alive counter stood still")
CAN_FIELD(DIAGNOSTIC, LOST_FRAMES, 16, 16, UNSIGNED, 1, "",
          "received and overwritten, gaps of the alive counter, pieces missing")
CAN_FIELD(DIAGNOSTIC, BUS_OFFS, 32, 8, UNSIGNED, 1, "", "times bus-off, stays at 255")
CAN_FIELD(DIAGNOSTIC, RESTARTS, 40, 8, UNSIGNED, 1, "", "transmissions that had to be restarted, stays at 255")
CAN_FIELD(DIAGNOSTIC, TRANSMIT_ERRORS, 48, 8, UNSIGNED, 1, "", "the controller's error counter now")
CAN_FIELD(DIAGNOSTIC, RECEIVE_ERRORS, 56, 8, UNSIGNED, 1, "", "the controller's error counter now")
