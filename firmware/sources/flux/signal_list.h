// Signals of the stator-flux sources: rows of a table, see dictionary/signal_list.h.

PLACE(20)
SIGNAL(load_angle, TURN, 32, ROTOR, flux_observer.load_angle_bam,
       "estimated angle of the stator flux ahead of the rotor")

PLACE(40)
SIGNAL(magnet_flux, MVS, 16, DRIVE, flux_observer.machine.psi_q16 / 10,
       "magnet flux as the stator-flux sources estimate it")
