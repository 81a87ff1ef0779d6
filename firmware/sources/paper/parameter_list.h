// Parameters of the paper's scheme: rows of a table, see dictionary/parameter_list.h.

PLACE(50)
PARAMETER(69, zvv_proportional, RAD_PER_S, 8, 1, 1, 2000, 110, ALWAYS, "Kp of the paper's ZVV observer")
PARAMETER(70, zvv_integral, RAD_PER_S2, 8, 1, 0, 20000, 11000, ALWAYS, "Ki of the paper's ZVV observer")
PARAMETER(71, id_low_speed, A, 20, 2, -1000, 1000, 0, ALWAYS,
          "d-axis current below the blend, makes the ZVV deviation observable")

PLACE(220)
// The paper's scheme
PARAMETER(311, paper_terms, NONE, 0, 0, 0, 127, 127, STOPPED,
          "terms of the paper's scheme, added up: 1 rotation, 2 integral fed back, 4 drops, 8 load, 16 turns, "
          "32 trajectory, 64 residuals")
