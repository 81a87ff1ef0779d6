"""The virtual drive: the firmware as it is flashed, on a virtual TMS320F2808, on a switching-level inverter and motor.

The command line is `stillspin` (see `stillspin.cli`); every step of it is a function here that a script can call.
"""

__version__ = "0.1.0"
