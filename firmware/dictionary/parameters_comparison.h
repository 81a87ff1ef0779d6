// Parameters of what the bench compares: encoder, hysteresis, stator flux: rows of parameter_list.h.

// Encoder as reference, hysteresis control
PARAMETER(170, encoder_trim, DEG, 16, 2, -18000, 18000, 0, ALWAYS,
          "added to the electrical angle of the encoder: a deliberate angle error")
PARAMETER(171, current_law, NONE, 0, 0, 0, 1, 0, STOPPED, "0 PI with space vectors, 1 hysteresis; 1 needs the encoder")
PARAMETER(172, hysteresis_band, A, 20, 3, 20, 5000, 400, ALWAYS,
          "half width of the hysteresis, where the adaptation begins")
PARAMETER(173, hysteresis_frequency, KHZ, 16, 2, 0, 2500, 1000, ALWAYS,
          "mean switching frequency that the hysteresis adapts to; 0 keeps the band")
PARAMETER(174, slice_time, US, 16, 2, 500, 2000, 500, STOPPED,
          "interval of the hysteresis' decisions, a whole part of 100 us")

// The paper's scheme
PARAMETER(311, paper_terms, NONE, 0, 0, 0, 127, 127, STOPPED,
          "terms of the paper's scheme, added up: 1 rotation, 2 integral fed back, 4 drops, 8 load, 16 turns, "
          "32 trajectory, 64 residuals")

// Position by the stator flux
PARAMETER(300, flux_cutoff, RAD_PER_S, 8, 1, 20, 1500, 20, STOPPED,
          "lowest cut-off of the low-pass that integrates the flux")
PARAMETER(301, flux_bandwidth, RAD_PER_S, 8, 0, 10, 600, 100, ALWAYS,
          "bandwidth of the observer behind the stator flux")
PARAMETER(303, flux_low, RPM, 16, 1, 10, 20000, 3500, STOPPED,
          "mechanical speed below which the observer is used, not the stator flux")
PARAMETER(304, flux_high, RPM, 16, 1, 20, 30000, 5000, STOPPED, "mechanical speed above which the stator flux is used")
PARAMETER(302, flux_adapt, NONE, 0, 0, 0, 3, 1, ALWAYS,
          "the stator flux learns: 0 nothing, 1 the q-axis inductance by the torque, 2 the magnet's flux, 3 both")

PARAMETER(305, flux_beside, NONE, 0, 0, 0, 4, 0, STOPPED,
          "a stator-flux method beside position_source 0, looking on: 0 none, 1 CONV, 2 PP-01, 3 PP-02, 4 active")

PARAMETER(306, flux_plain, NONE, 0, 0, 0, 3, 0, STOPPED,
          "to compare, added up: 1 the low-pass at flux_cutoff alone, 2 as printed, PP-02 with (34)")
