// Parameters of functions of the board: rows of a table, see dictionary/parameter_list.h.

PLACE(260)
// Functions of the board (board/functions.h)
PARAMETER(400, bootstrap_time, MS, 16, 1, 0, 200, BOARD_BOOTSTRAP_TIME, STOPPED,
          "lower devices on before the first pulse; 0: no bootstrap capacitors")
PARAMETER(401, precharge_voltage, V, 16, 1, 0, 15000, 0, STOPPED,
          "DC-link voltage at which the precharge relay closes; 0: none")
PARAMETER(402, precharge_time, MS, 0, 0, 10, 60000, 2000, ALWAYS, "time for the DC link to reach precharge_voltage")
PARAMETER(403, brake_voltage, V, 16, 1, 0, 15000, 0, STOPPED,
          "DC-link voltage that switches the brake resistor on; 0: none")
PARAMETER(404, brake_hysteresis, V, 16, 1, 10, 1000, 100, ALWAYS,
          "the brake resistor is switched off so far below brake_voltage")
PARAMETER(405, brake_share, PERCENT, 16, 0, 1, 100, 20, ALWAYS,
          "share of the time that the brake resistor may be on, over 8 s")
PARAMETER(410, temperature_limit, CELSIUS, 8, 0, 0, 130, 0, ALWAYS, "heat-sink temperature of the fault; 0: no sensor")
PARAMETER(411, temperature_derating, CELSIUS, 8, 0, 0, 130, 70, ALWAYS,
          "heat-sink temperature from which the current limit falls, to half at temperature_limit")
PARAMETER(412, overload_current, A, 20, 2, -100, 10000, -100, ALWAYS,
          "continuous phase current, peak; below 0: rated_current, 0: no check")
PARAMETER(413, overload_time, MS, 0, 0, 100, 600000, 60000, ALWAYS,
          "time constant of the winding, or of the inverter where that is shorter")
PARAMETER(420, emergency_stop, NONE, 0, 0, 0, 1, 0, STOPPED,
          "1: an emergency-stop contact is wired and switches the gates off")
PARAMETER(421, gate_feedback, NONE, 0, 0, 0, 1, 0, STOPPED, "1: the gate enable's output is wired back and watched")
PARAMETER(430, speed_input, NONE, 0, 0, 0, 2, 0, STOPPED,
          "speed and run switch at the board: 0 not used, 1 from 0 V, 2 live zero at 10 %")
PARAMETER(431, speed_input_dead, PERCENT, 16, 1, 0, 500, 20, ALWAYS,
          "share of the speed input's lower end that means standstill")
PARAMETER(432, speed_input_loss, NONE, 0, 0, 1, 2, 1, ALWAYS,
          "when the speed input's live zero is lost: 1 stop, 2 coast")
PARAMETER(433, speed_input_full, RPM, 8, 0, 10, 6000, 2000, ALWAYS, "speed at the upper end of the speed input")
PARAMETER(440, reference_input, NONE, 0, 0, 0, 1, 0, STOPPED,
          "1: ground and reference are wired to the ADC, for the self-test")
