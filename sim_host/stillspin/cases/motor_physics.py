"""What physics says of a motor on this drive: start, ripple, polarity test, top speed, gates off."""

from __future__ import annotations

import math

from stillspin.cases import open_loop
from stillspin.cases.motor_told import PERIOD, Described, Finding

_TURN_LEAST = 12.0  # control interrupts per electrical turn
_MAP_LEVELS, _SALIENT_LEAST = 4, 2  # currents at which the drive measures, and how many must have a saliency
_MAP_LEAST = 0.25  # of current_limit: so far the drive halves them until as many have it


def saliency(motor: Described) -> Finding:
    """Whether the inductances differ enough to tell the position at rest, up to the limit of the current."""
    d, q = motor.plant("machine", "inductance_d"), motor.plant("machine", "inductance_q")
    share = open_loop.share(d, q)
    if motor.told("start_method") == 1.0:
        return _turned(motor, share)
    if share < open_loop.SALIENCY_LEAST:
        words = f"Lq and Ld differ by {share:.1%} of their sum: no start from standstill by saliency"
        return Finding("start at rest", False, f"{words}; start_method = 1 turns the shaft by a current first")
    limit = motor.told("current_limit")
    words = f"(Lq − Ld)/(Lq + Ld) is {share:.1%} without current"
    if not motor.plant("machine", "saturation"):
        return Finding("start at rest", True, words)
    # The plant's Lqq is Lq / (1 + (iq / 2 rated)^2); an eighth of the difference is what the drive needs.
    end = 2.0 * motor.plant("machine", "rated_peak_current") * math.sqrt(q / (d + (q - d) / 8.0) - 1.0)
    words += f", and an eighth of that is there up to {end:.3g} A; current_limit is {limit:.3g} A"
    if end >= limit:
        return Finding("start at rest", True, words)
    mapped = limit
    while _MAP_LEVELS * end < _SALIENT_LEAST * mapped and mapped > _MAP_LEAST * limit:
        mapped /= 2.0
    levels = math.floor(_MAP_LEVELS * end / mapped)
    if levels < _SALIENT_LEAST:
        most = _MAP_LEVELS / _SALIENT_LEAST / _MAP_LEAST * end
        return Finding("start at rest", False, f"{words}: choose current_limit below {0.95 * most:.3g} A")
    salient = min(levels / _MAP_LEVELS, 1.0) * mapped
    words += f": commissioned, the drive gives no more than saliency_current, {salient:.3g} A, while it is slow"
    return Finding("start at rest", True, words)


def _turned(motor: Described, share: float) -> Finding:
    """What a start by a current vector means for whoever uses the drive."""
    current, speed = motor.told("if_current"), motor.told("if_speed")
    carried = 1.5 * motor.plant("machine", "pole_pairs") * motor.plant("machine", "magnet_flux") * current
    words = (
        f"Lq and Ld differ by {abs(share):.1%} of their sum: at rest the angle is not known; below {speed:.0f} rpm, "
        f"where the EMF shows it, a vector of {current:.3g} A turns or holds the shaft, against a slowly changing "
        f"load of up to {carried:.2g} N m"
    )
    linked = motor.plant("machine", "magnet_flux") / motor.plant("machine", "inductance_q")
    if current > linked:
        return Finding(
            "start at rest", False, f"{words}; the vector is hardly damped: lower if_current below {linked:.3g} A"
        )
    return Finding("start at rest", True, words)


def ripple(motor: Described) -> Finding:
    """A pulse of a vector, 2/3 of the link at the motor, over the smaller inductance."""
    volts = 2.0 / 3.0 * motor.plant("link", "source_voltage")
    ripple = volts * motor.told("pulse_time") * 1e-6 / motor.plant("machine", "inductance_d")
    trip, peak = motor.told("trip_current"), motor.told("current_limit") + ripple / 2.0
    pulse = f"a pulse of {motor.told('pulse_time'):g} µs changes the current by {ripple:.3g} A"
    words = f"{pulse}, up to {peak:.3g} A at current_limit; trip_current is {trip:.3g} A"
    if peak > trip:
        return Finding(
            "ripple", False, f"{words}: lower current_limit, shorten pulse_time, or put a choke before the motor"
        )
    return Finding("ripple", True, words)


def polarity(motor: Described) -> Finding:
    """Whether the link drives the test's current through the winding at all, and in what time."""
    if motor.told("start_method") == 1.0:
        return Finding("polarity", True, "the vector that turns the shaft has its polarity: it is not asked for")
    volts = motor.plant("link", "source_voltage") / math.sqrt(3.0)
    resistance, inductance = motor.plant("machine", "resistance"), motor.plant("machine", "inductance_d")
    wanted, possible = min(motor.told("start_current"), motor.told("current_limit")), volts / resistance
    words = f"the polarity test asks for {wanted:.3g} A; the link drives up to {possible:.3g} A"
    if possible < wanted:
        return Finding("polarity", False, f"{words}: lower start_current, or raise the link's voltage")
    rise = -inductance / resistance * math.log1p(-wanted / possible) if wanted < possible else math.inf
    return Finding("polarity", True, f"{words} and is there after {1e3 * rise:.2g} ms")


def speed(motor: Described) -> Finding:
    """The speed that the link and field weakening allow without load."""
    volts = motor.plant("link", "source_voltage") / math.sqrt(3.0) * motor.told("voltage_use") / 100.0
    flux = motor.plant("machine", "magnet_flux")
    weakened = flux - motor.plant("machine", "inductance_d") * motor.told("weakening_limit")
    pairs, limit = motor.plant("machine", "pole_pairs"), motor.told("speed_limit")
    base, fastest = (
        volts / linked / pairs * 30.0 / math.pi if linked > 0.0 else math.inf for linked in (flux, weakened)
    )
    words = f"the EMF takes the link's voltage at {base:.0f} rpm, "
    words += f"with weakening_limit at {fastest:.0f} rpm" if weakened > 0.0 else "weakening_limit leaves nothing of it"
    if fastest < limit:
        ways = f"lower it to {fastest:.0f} rpm, or raise weakening_limit or the link's voltage"
        return Finding("top speed", False, f"{words}; speed_limit is {limit:.0f} rpm: {ways}")
    return Finding("top speed", True, f"{words}; speed_limit is {limit:.0f} rpm")


def emf_of_a_trip(motor: Described) -> Finding:
    """What the diodes charge the link to when the gates go off at the speed limit."""
    limit = motor.told("speed_limit")
    linked = motor.plant("machine", "magnet_flux") * motor.plant("machine", "pole_pairs")
    volts = math.sqrt(3.0) * linked * limit * math.pi / 30.0
    most = motor.told("link_maximum")
    words = (
        f"with the gates off at speed_limit the motor charges the link to {volts:.0f} V; link_maximum is {most:.0f} V"
    )
    if volts > most:
        return Finding("gates off", False, f"{words}: lower speed_limit to {limit * most / volts:.0f} rpm")
    return Finding("gates off", True, words)


def turn(motor: Described) -> Finding:
    """Whether an electrical turn has enough control interrupts."""
    limit, pairs = motor.told("speed_limit"), motor.plant("machine", "pole_pairs")
    steps = 60.0 / (limit * pairs * PERIOD)
    words = f"an electrical turn at speed_limit has {steps:.0f} control interrupts"
    if steps < _TURN_LEAST:
        most = 60.0 / (_TURN_LEAST * pairs * PERIOD)
        return Finding(
            "periods per turn", False, f"{words}; {_TURN_LEAST:.0f} are needed: speed_limit up to {most:.0f} rpm"
        )
    return Finding("periods per turn", True, words)
