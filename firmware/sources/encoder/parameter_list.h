// Parameters of the reference encoder: rows of a table, see dictionary/parameter_list.h.

PLACE(70)
PARAMETER(73, encoder_counts, NONE, 0, 0, 16, 65536, 4096, STOPPED, "counts of the reference encoder per turn")

PLACE(200)
// Encoder as reference, hysteresis control
PARAMETER(170, encoder_trim, DEG, 16, 2, -18000, 18000, 0, ALWAYS,
          "added to the electrical angle of the encoder: a deliberate angle error")
