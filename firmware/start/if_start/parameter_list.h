// Parameters of the start by a current vector: rows of a table, see dictionary/parameter_list.h.

PLACE(100)
// I-F start: a current vector that turns open-loop until the position source can take over
PARAMETER(340, start_method, NONE, 0, 0, 0, 1, 0, STOPPED,
          "start of a standing shaft: 0 by its saliency, 1 turned by a current vector (I-F)")
PARAMETER(341, if_current, A, 20, 2, 20, 10000, 800, STOPPED, "length of the current vector")
PARAMETER(342, if_align, MS, 0, 0, 10, 5000, 500, STOPPED, "time that the current vector rests before it turns")
PARAMETER(343, if_acceleration, RPM_PER_S, 8, 0, 10, 100000, 500, STOPPED, "acceleration of the current vector")
PARAMETER(344, if_speed, RPM, 8, 0, 10, 6000, 300, STOPPED,
          "speed of the vector at which the position source takes over")
PARAMETER(345, if_time, MS, 0, 0, 100, 10000, 2000, STOPPED,
          "time for the source to agree with the vector before the fault")
