"""How noisy the drive is told that the current is: its sensors' noise, more where the model is less sure.

The book has the rule with the others (docs/motors.md).
"""

from __future__ import annotations

import math

from stillspin import core
from stillspin.cases import open_loop
from stillspin.cases.similarity import REFERENCE, Size, of

PER_AMPERE = 5e-3
"""A rms of a current difference, of the sensors' range: quantisation and noise of 12 bits."""
_LEAST, _MOST = 1.0, 4.0
_LEAST_BLIND = 0.5
"""Without saliency: where the ripple is small, the EMF changes the current little, and is followed late with more."""
_OFF = 0.05  # of an inductance, before it is learnt
_PULSE = 42e-6  # s, the drive's default


def times(plant: core.Plant) -> float:
    """How many times the sensors' noise the drive is told, a power of two; 1 where an entry is missing.

    The saliency's axis turns with the current, and until commissioning has measured that an observer takes the turn for
    one of the shaft. The faster it believes an angle that is seen sharply, and the less the current that answers
    accelerates the shaft, the more of a turn follows from a turn. Where the EMF alone shows the shaft, it goes by what
    an inductance that is off by a twentieth makes of a pulse.
    """
    size = of(plant)
    if size is None:
        return 1.0
    if open_loop.share(size.inductance_d, size.inductance_q) < open_loop.SALIENCY_LEAST:
        least, ratio = _LEAST_BLIND, _OFF * 2.0 / 3.0 * size.ripple * _PULSE / (PER_AMPERE * size.current_range)
    else:
        least, ratio = _LEAST, _believed(size) / _believed(REFERENCE)
    return float(2.0 ** math.floor(math.log2(min(max(ratio, least), _MOST))))


def _believed(size: Size) -> float:
    return size.sharpness / (size.pole_pairs * size.acceleration)
