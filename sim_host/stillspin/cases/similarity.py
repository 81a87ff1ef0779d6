"""What follows for a machine of another size from its nameplate, where the drive has a default.

Speeds, currents, torques and accelerations among the defaults belong to a machine of a certain size, the reference
below. Another machine gets them times its own size over that of the reference: to the nearest power of two where the
default is a choice that is known no better, exactly where it is a bound. The book has the rules in a table
(docs/motors.md).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

from stillspin import core
from stillspin.cases import open_loop
from stillspin.entry import Entry

PERIOD = 1e-4  # s, of the control interrupt
# The polarity test by motion (estimators/polarity.c): periods of a segment, and the turn in it, electrical.
SEGMENT, SEGMENT_LONGEST = 40, 160
TURN_LEAST, TURN_MOST = math.radians(1.5), math.radians(10.0)
_SPEED_PERIOD = 1e-3  # s
_FOLLOW_MOST = 2.0  # times as much as the reference
_TURN_MOST = 4.0  # the same of AVV's
_SPIN_LEAST = 0.43  # of the speed up to which the pulses alternate
_SWING = 2.1  # the current loop over the frequency at which EMF, inductance and inertia swing
_SWING_TESTED = 2.8  # where a segment of the polarity test is the shortest
_LOOP_END = 10400.0  # rad/s times three half periods and the divider's (firmware/config/rules.c)
_LEVELS_ABOVE = 2.2  # times the ripple, and a tenth to spare
_TRIP_SHARE = 1.5  # of which the ripple has the rest
_LEFT = 1.0 / (1.0 + 0.5**2)  # of Lqq at rated current (sim_host/plant/machine.cpp)
_TURNED = math.tan(2.0 * math.radians(5.0))  # of the axis there
_FRICTION = 1.0 / 32.0  # of the rated torque, at the base speed
_DIGITS = 3  # that count; one more is kept
_NEEDED = {
    "machine": ("pole_pairs", "inductance_d", "inductance_q", "magnet_flux", "rated_peak_current"),
    "mechanics": ("inertia",),
    "link": ("source_voltage",),
}
_RANGE = 20.0  # A, of a board that does not say its sensors'


@dataclass(frozen=True)
class Size:
    """A machine on its board, in SI units."""

    pole_pairs: float
    inductance_d: float
    inductance_q: float
    magnet_flux: float
    current: float
    inertia: float
    volts: float
    current_range: float

    @cached_property
    def torque_per_ampere(self) -> float:
        """N m/A, of the magnet."""
        return 1.5 * self.pole_pairs * self.magnet_flux

    @property
    def torque(self) -> float:
        """N m, of the magnet at rated current."""
        return self.torque_per_ampere * self.current

    @property
    def acceleration(self) -> float:
        """rad/s² at rated current."""
        return self.torque / self.inertia

    @property
    def base_speed(self) -> float:
        """rad/s, where the flux at rated current takes the link's voltage."""
        flux = math.hypot(self.magnet_flux, self.inductance_q * self.current)
        return self.volts / math.sqrt(3.0) / flux / self.pole_pairs

    @property
    def swing(self) -> float:
        """rad/s, of EMF, inductance and inertia on a stiff voltage."""
        return self.pole_pairs * self.magnet_flux * math.sqrt(1.5 / (self.inertia * self.inductance_q))

    @property
    def saliency(self) -> float:
        """1/H by which the slopes of the current differ along the axes; 0 where there is nothing to see."""
        return max(1.0 / self.inductance_d - 1.0 / self.inductance_q, 0.0)

    @property
    def sharpness(self) -> float:
        """What the position changes in a window's current, over the noise of the sensors, which goes by their range."""
        return self.volts * self.saliency / self.current_range

    @property
    def ripple(self) -> float:
        """A/s, the mean of both axes, by the link's voltage."""
        return self.volts * (1.0 / self.inductance_d + 1.0 / self.inductance_q) / 2.0

    @property
    def noise_volts(self) -> float:
        """What the noise of the sensors looks like as an EMF, of 1/s."""
        return self.current_range * self.inductance_q

    def turn(self, current: float, periods: float) -> float:
        """Angle of such a segment of the polarity test, rad electrical."""
        return self.pole_pairs * self.torque_per_ampere * current / self.inertia * (periods * PERIOD) ** 2

    def segment(self, current: float) -> int:
        """Periods that the drive takes for one."""
        if self.turn(current, SEGMENT) > TURN_MOST:
            return SEGMENT // 2
        periods = SEGMENT
        while periods < SEGMENT_LONGEST and self.turn(current, periods) < TURN_LEAST:
            periods *= 2
        return periods

    def clearness(self, current: float) -> float:
        """The turn over its error, which is less the more angles there are, of an arbitrary scale."""
        periods = self.segment(current)
        return self.turn(current, periods) * self.sharpness * math.sqrt(periods)

    def current_that_follows(self, current: float) -> float:
        """A that the link reverses in half a segment of the polarity test with this current."""
        return self.volts / math.sqrt(3.0) * self.segment(current) * PERIOD / 2.0 / (2.0 * self.inductance_q)

    def loop_of_load(self, rate: float) -> float:
        """How fast a load of so many N m in 10 ms is followed, squared, over the acceleration at rated current.

        An observer of third order has a frequency by the cube root of its noises; where the saliency's axis turns with
        the current, the load that is fed forward closes a loop over the angle with this gain.
        """
        followed: float = (rate * self.pole_pairs / self.inertia * self.sharpness) ** (2.0 / 3.0)
        return followed / (self.pole_pairs * self.acceleration)


REFERENCE = Size(4, 4.9e-3, 7.8e-3, 0.16, 10.8894, 0.00455, 300.0, 20.0)
"""The machine and board for which the drive's defaults are."""


def of(plant: core.Plant) -> Size | None:
    """The size that a motor's file states; none where an entry is missing."""
    if any(key not in plant.get(section, {}) for section, keys in _NEEDED.items() for key in keys):
        return None
    stated = [float(plant[section][key]) for section, keys in _NEEDED.items() for key in keys]
    values = [*stated, float(plant.get("adc", {}).get("current_range", _RANGE))]
    return Size(*values) if min(values) > 0.0 else None


def missing(plant: core.Plant) -> list[str]:
    """What a motor's file must say as well for its size to be known; empty where it is."""
    asked = [(section, key) for section, keys in _NEEDED.items() for key in keys]
    return [f"{section}.{key}" for section, key in asked if not float(plant.get(section, {}).get(key, 0.0)) > 0.0]


def assumed(plant: core.Plant) -> core.Plant:
    """What no nameplate says, where a motor's file does not either: by rules, as for the motors of the catalogue.

    The saliency's axis turns by 5 degrees at rated current where the plant's saturation leaves saliency there: Lqq is
    four fifths of Lq then. A machine whose table of fluxes is read has its own. At the base speed the friction takes
    a share of the rated torque.
    """
    size, found = of(plant), core.Plant()
    machine = plant.get("machine", {})
    if size and "flux_map" not in machine and "cross_inductance" not in machine:
        left = max(_LEFT * size.inductance_q - size.inductance_d, 0.0)
        found["machine"] = {"cross_inductance": float(f"{left * _TURNED / 2.0:.{_DIGITS}g}")}
    if size and "viscous_friction" not in plant.get("mechanics", {}):
        share = _FRICTION * size.torque / size.base_speed
        found["mechanics"] = {"viscous_friction": float(f"{share:.{_DIGITS}g}")}
    return found


def power_of_two(ratio: float) -> float:
    """The nearest one."""
    return 2.0 ** round(math.log2(ratio))


def _halved(value: float, fits: Callable[[float], bool]) -> float:
    while not fits(value):
        value /= 2.0
    return value


@dataclass(frozen=True)
class _Asked:
    """A machine, what its drive is told already, and the drive's parameters at its scales."""

    size: Size
    told: Mapping[str, float]
    known: Mapping[str, Entry]

    def default(self, name: str) -> float:
        """For the reference, whose scales are 0."""
        return float(self.known[name].default) / 2.0 ** self.known[name].exponent

    def limited(self, current: float) -> float:
        return min(current, self.told.get("current_limit", current))


def _by_current(asked: _Asked, name: str) -> float:
    return asked.limited(asked.default(name) * power_of_two(asked.size.current / REFERENCE.current))


def _polarity_current(asked: _Asked, name: str) -> float:
    """Enough that the turn of a light shaft shows, as little as a heavy one bears; and the link has to reverse it."""
    size, current = asked.size, _by_current(asked, name)
    if size.saliency == 0.0:
        return current
    enough = REFERENCE.clearness(asked.default(name)) / math.sqrt(2.0)
    tried = [current]
    while size.clearness(tried[-1]) < enough and tried[-1] < size.current:
        tried.append(min(2.0 * tried[-1], size.current))
    followed = [current for current in tried if current <= size.current_that_follows(current)]
    best = max(followed or tried[:1], key=size.clearness)
    return _halved(best, lambda current: size.turn(current, SEGMENT / 2) <= TURN_MOST)


def _load(asked: _Asked, name: str) -> float:
    """All three torques of the observer alike; where the EMF alone shows the angle, no more than the default."""
    size, rate = asked.size, asked.default("observer_load_rate")
    factor = power_of_two(size.torque / REFERENCE.torque)
    if open_loop.share(size.inductance_d, size.inductance_q) < open_loop.SALIENCY_LEAST:
        return min(asked.default(name) * factor, float(asked.known[name].default))
    most = _FOLLOW_MOST * REFERENCE.loop_of_load(rate)
    return asked.default(name) * _halved(factor, lambda factor: size.loop_of_load(rate * factor) <= most)


def _by_base_speed(asked: _Asked, name: str) -> float:
    return asked.default(name) * power_of_two(asked.size.base_speed / REFERENCE.base_speed)


def _up_to_top_speed(asked: _Asked, name: str) -> float:
    found = _by_base_speed(asked, name)
    return min(found, asked.told.get("speed_limit", found))


def _spin(asked: _Asked, name: str) -> float:
    """Where the EMF is a sixteenth of the link's voltage at least, and no faster than the pulses alternate.

    Less is little beside what the devices leave of their dead time while no current flows; beyond, the mean of the
    currents is off by a share of the ripple.
    """
    size, found = asked.size, _up_to_top_speed(asked, name)
    pulses = asked.told.get("pulse_time", _pulse_time(asked, "pulse_time")) / asked.default("pulse_time")
    most = pulses * open_loop.spin_most(size.volts, size.magnet_flux, size.pole_pairs)
    while found < most * _SPIN_LEAST:
        found *= 2.0
    return min(found, most, asked.told.get("speed_limit", found))


def _ramp(asked: _Asked, name: str) -> float:
    """A share of what the rated current accelerates with, and no faster to the base speed than the reference."""
    size = asked.size
    ratio = min(size.acceleration / REFERENCE.acceleration, size.base_speed / REFERENCE.base_speed)
    return asked.default(name) * power_of_two(ratio)


def _if_ramp(asked: _Asked, name: str) -> float:
    """The same share of what the turning current accelerates with."""
    current = asked.told.get("if_current", _by_current(asked, "if_current"))
    usual = REFERENCE.torque_per_ampere * asked.default("if_current") / REFERENCE.inertia
    return asked.default(name) * power_of_two(asked.size.torque_per_ampere * current / asked.size.inertia / usual)


def _speed_alpha(asked: _Asked, name: str) -> float:
    """Of a speed error the same share is closed, but no more rated current asked for by the speed's noise."""

    def step(size: Size) -> float:
        return size.torque_per_ampere * _SPEED_PERIOD / size.inertia

    def electrical(size: Size) -> float:
        return size.pole_pairs * size.acceleration

    usual = asked.default(name) * step(REFERENCE) ** 2
    share = usual / (1.0 + usual) * min(1.0, electrical(asked.size) / electrical(REFERENCE))
    return share / (1.0 - share) / step(asked.size) ** 2


def _by_agility(asked: _Asked, name: str) -> float:
    """As much faster as a current off the q-axis moves the shaft sooner; the default where there is no saliency.

    The axis turns with the current before commissioning has measured it: the slower a current moves the shaft, the more
    current answers to such a turn.
    """
    size, default = asked.size, asked.default(name)
    if open_loop.share(size.inductance_d, size.inductance_q) < open_loop.SALIENCY_LEAST:
        return default
    ratio = size.pole_pairs * size.acceleration / (REFERENCE.pole_pairs * REFERENCE.acceleration)
    faster = max(power_of_two(math.sqrt(ratio)), 1.0)
    return default * _halved(faster, lambda faster: faster * faster <= _TURN_MOST * ratio)


def _current_bandwidth(asked: _Asked, name: str) -> float:
    """Faster than what swings by itself; more so where the EMF of the polarity test has to be met in half a segment."""
    size, most = asked.size, _LOOP_END / (3.0 + asked.told.get("current_divider", 1.0))
    tested = asked.told.get("polarity_current", _polarity_current(asked, "polarity_current"))
    times = _SWING_TESTED if size.saliency > 0.0 and size.segment(tested) < SEGMENT else _SWING
    return max(asked.default(name), min(math.ceil(times * size.swing), most))


def _drop_band(asked: _Asked, name: str) -> float:
    """A smaller share of the board's range where the ripple is: within the band no dead time is told from a current."""
    default = float(asked.known[name].default)
    ratio = asked.default(name) * asked.size.ripple / REFERENCE.ripple / default
    return default * min(power_of_two(ratio), 1.0)


def _pulse_time(asked: _Asked, name: str) -> float:
    """Shorter where the ripple leaves commissioning no levels of i_d (firmware/commissioning/staircase.c).

    Twice the ripple is the least of them. The most is where the magnet still holds the rotor, or the limit of the field
    weakening, and what the ripple leaves to the trip.
    """
    size, default = asked.size, asked.default(name)
    limit, trip, weakening = (
        asked.told.get(each, math.inf) for each in ("current_limit", "trip_current", "weakening_limit")
    )
    if open_loop.share(size.inductance_d, size.inductance_q) < open_loop.SALIENCY_LEAST:
        return default
    held = size.magnet_flux / (2.0 * (size.inductance_q - size.inductance_d))
    most = min(max(min(limit, held), weakening), trip / _TRIP_SHARE)
    ripple = 2.0 / 3.0 * size.volts / size.inductance_d * 1e-6  # A, of a pulse of 1 µs
    enough = most / (_LEVELS_ABOVE * ripple)
    return min(max(enough, open_loop.PULSE_LEAST), default)


def _synchronism_floor(asked: _Asked, name: str) -> float:
    """What the sensors' noise looks like; no less than the default in volts of the board's size, for the devices."""
    noise = asked.default(name) * power_of_two(asked.size.noise_volts / REFERENCE.noise_volts)
    return max(noise, float(asked.known[name].default))


_Law = Callable[[_Asked, str], float]
RULES: dict[str, _Law] = {
    **dict.fromkeys(("blend_low", "blend_high", "flux_low", "flux_high"), _by_base_speed),
    **dict.fromkeys(("if_speed", "speed_input_full"), _up_to_top_speed),
    "spin_speed": _spin,
    **dict.fromkeys(("start_current", "if_current"), _by_current),
    "polarity_current": _polarity_current,
    **dict.fromkeys(("observer_load_rate", "observer_load_quiet", "observer_load_step"), _load),
    **dict.fromkeys(("avv_bandwidth_long", "avv_bandwidth_short"), _by_agility),
    "drop_band": _drop_band,
    "speed_ramp": _ramp,
    "if_acceleration": _if_ramp,
    "speed_alpha": _speed_alpha,
    "current_bandwidth": _current_bandwidth,
    "synchronism_floor": _synchronism_floor,
    "pulse_time": _pulse_time,
}
"""By parameter; what a motor's file states of one goes before."""


def values(plant: core.Plant, told: Mapping[str, float], known: Mapping[str, Entry]) -> dict[str, float]:
    """What the rules say, within the ranges of the drive's parameters; nothing where the nameplate is not complete.

    Args:
        plant: what a motor's file states of machine and board.
        told: what it states of the drive's parameters, and what follows from it; no rule says anything of these.
        known: the drive's parameters at its scales.
    """
    size = of(plant)
    if size is None:
        return {}
    asked = _Asked(size, told, known)
    return {name: _within(known[name], law(asked, name)) for name, law in RULES.items() if name in known.keys() - told}


def follow(plant: core.Plant, told: Mapping[str, float], known: Mapping[str, Entry]) -> dict[str, float]:
    """Of these the ones that are not the drive's defaults; see `values`."""
    found = values(plant, told, known)
    return {
        name: value
        for name, value in found.items()
        if not math.isclose(value, float(known[name].default), rel_tol=10.0**-_DIGITS)
    }


def _within(entry: Entry, value: float) -> float:
    rounded = float(f"{value:.{_DIGITS + 1}g}")
    return min(max(rounded, entry.minimum or rounded), entry.maximum or rounded)
