// Parameters of the stator-flux sources: rows of a table, see dictionary/parameter_list.h.

PLACE(230)
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
