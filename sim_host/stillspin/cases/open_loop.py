"""A machine whose inductances hardly differ: nothing shows its angle at rest, so a current vector turns it first.

What the vector must be follows from the nameplate: long enough for the load, short enough for its damping, and up to a
speed at which the back-EMF stands out of the link's noise.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

SALIENCY_LEAST = 1.0 / 15.0
"""(Lq - Ld)/(Lq + Ld) below which nothing shows the axis at rest, as commissioning has it: Lq an eighth above Ld."""
_EMF_SHARE = 0.10  # of the link's voltage, at the vector's last speed
_SPIN_SHARE = 0.145  # the same in the spin, at most: the pulses alternate up to some 0.17
_SPIN_EMF = 0.93  # of that: the ramp's current drops some over a winding whose L/R is short
_SPIN_MOST = 0.6  # of speed_limit
_FLUX_SHARE = 0.5  # L I of the vector, of the magnet's flux: beyond that it is damped less (control/if_start.h)
_TORQUE_SHARE = 0.1  # of the vector's torque, for its own acceleration and that behind it
_RISE_TIME = 0.6  # s, to the last speed
_LAG = 0.4  # rad that the damping turns the vector back while it gains speed, of the 45 degrees that it may
_MEAN_TIME = 0.1  # s, of the mean that it takes off (control/if_start.h)
_AGREES = 0.3  # s that the position source has to agree with the vector before it takes over
_PULSE = 42.0  # us, the drive's default
PULSE_LEAST = 24.0
"""µs: the shortest pulses that windows fit into with the usual settle time."""
_SPEEDS = (10.0, 6000.0)  # rpm, that the parameter takes
_SPIN = (30.0, 20000.0)
_RAMP_MOST = 3000.0  # rpm/s, the drive's default
_ADAPT_TIME = 50.0  # ms: a load saturates the iron as fast as it falls on the shaft, and no map says by how much


def share(inductance_d: float, inductance_q: float) -> float:
    """What tells the axis of a shaft at rest."""
    return (inductance_q - inductance_d) / (inductance_q + inductance_d)


def one_inductance(told: Mapping[str, float]) -> dict[str, float]:
    """The mean for both axes of a machine whose Ld is hardly above its Lq: the drive takes no Ld above Lq.

    Args:
        told: what follows from the machine.

    Returns:
        Nothing where Lq is the larger one, or so much smaller that the difference counts.
    """
    d, q = (told.get(name, 0.0) for name in ("inductance_d", "inductance_q"))
    if not 0.0 < q < d or share(q, d) > SALIENCY_LEAST:
        return {}
    return dict.fromkeys(("inductance_d", "inductance_q"), round((d + q) / 2.0, 9))


def spin_most(volts: float, flux: float, pairs: float) -> float:
    """The speed of the commissioning's spin, rpm, up to which its pulses alternate, with or without saliency."""
    return rpm(_SPIN_SHARE * volts / flux / pairs)


def _pulse_time(told: Mapping[str, float], volts: float) -> float:
    """The pulses, µs, whose ripple on top of the longest vector stays below the trip; the default where they do.

    The whole ripple counts, not the half of it to either side of the mean: saturation raises it near the limit.
    """
    ripple = 2.0 / 3.0 * volts / told["inductance_d"] * 1e-3  # A, of a pulse of 1 µs
    room = told.get("trip_current", math.inf) - told["current_limit"]
    if room >= _PULSE * ripple:
        return _PULSE
    return max(math.floor(10.0 * room / ripple) / 10.0, PULSE_LEAST)


def following(told: Mapping[str, float], volts: float) -> dict[str, float]:
    """The parameters of a start by a current vector, and of the spin behind it.

    Args:
        told: what the drive is told of machine and limits, in its own units.
        volts: of the link.

    Returns:
        Nothing for a machine with saliency, or one that is told incompletely.
    """
    needed = ("inductance_d", "inductance_q", "magnet_flux", "pole_pairs", "current_limit", "speed_limit")
    if any(not told.get(name) for name in needed) or share(told["inductance_d"], told["inductance_q"]) > SALIENCY_LEAST:
        return {}
    flux, pairs, limit = told["magnet_flux"], told["pole_pairs"], told["current_limit"]
    rated = told.get("rated_current") or limit / 2.0
    current = min(rated, limit, _FLUX_SHARE * flux / (told["inductance_q"] * 1e-3))
    fastest = min(_SPEEDS[1], told["speed_limit"] / 3.0)
    speed = min(max(rpm(_EMF_SHARE * volts / flux / pairs), _SPEEDS[0]), fastest)
    torque = 1.5 * pairs * flux * current
    ramp = _RAMP_MOST
    if told.get("inertia"):
        ramp = min(ramp, _TORQUE_SHARE * rpm(torque / told["inertia"]))
    slope = min(speed / _RISE_TIME, ramp)
    if told.get("inertia"):
        swing = math.sqrt(pairs * torque / told["inertia"])
        slope = min(slope, rpm(_LAG * swing / _MEAN_TIME / pairs))
    pulse = told["pulse_time"] if "pulse_time" in told else _pulse_time(told, volts)
    spin = min(
        max(pulse / _PULSE * _SPIN_EMF * spin_most(volts, flux, pairs), _SPIN[0]),
        _SPIN_MOST * told["speed_limit"],
        _SPIN[1],
    )
    return {
        "start_method": 1.0,
        "if_current": round(current, 2),
        "if_speed": float(round(speed)),
        "if_acceleration": float(max(round(slope), 10)),
        "spin_speed": float(round(spin)),
        "speed_ramp": float(max(round(ramp), 10)),
        "adapt_time": _ADAPT_TIME,
        **({"pulse_time": pulse} if pulse < _PULSE else {}),
    }


def turn_time(speed: float, slope: float) -> float:
    """Seconds at most that the vector needs from one direction of `if_speed` to the other, both in rpm (and per s)."""
    return 2.0 * speed / slope + _AGREES


def rpm(speed: float) -> float:
    """Of rad/s."""
    return speed * 30.0 / math.pi
