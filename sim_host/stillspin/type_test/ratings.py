"""What a motor is rated for on its link, and how fast shaft and current are by themselves."""

from __future__ import annotations

import math
from dataclasses import dataclass

from stillspin.cases import open_loop
from stillspin.cases.motor_told import Described
from stillspin.cases.open_loop import rpm, share

_LOADED = 0.8  # of what the drive gives, and of the speed: the rest is for keeping it
_SPARE = 0.9  # of the speed up to which the link's voltage lasts: it sags under load, and valves drop some of it


@dataclass(frozen=True)
class Ratings:
    """In N m, rpm and s, as the nameplate has it.

    Attributes:
        torque: of the magnet at the rated current.
        speed: nine tenths of what the link allows at the rated current without field weakening, up to `speed_limit`.
        fastest: nine tenths of what it allows without load, weakened as far as the drive may, up to `speed_limit`.
        run_up: from rest to `speed` by the rated torque: the mechanical time constant.
        electrical: Lq / R.
        ramp: rpm/s that the drive's own ramp and half of the rated torque allow.
        slowest: below it the drive knows no angle; 0 where the saliency shows it at rest.
        turn: s that a current vector then takes through standstill, at most; else 0.
        cogging: N m, peak.
        saturates: which alone tells the polarity of a shaft that a brake holds.
        slow_torque: of the current up to which the saliency is there; the drive gives no more below `even` rpm, and
            from there to `freed` the limit rises to all (firmware/drive/speed.c).
        most_torque: of all the current that the drive gives.
        even: rpm at which the EMF tells as much as what is left of the saliency.
        freed: rpm, twice of that, or of what balances the saliency at the limit of the current
            (firmware/config/config.c); 0 where all the current is there at rest.
    """

    torque: float
    speed: float
    fastest: float
    run_up: float
    electrical: float
    ramp: float
    slowest: float
    turn: float
    cogging: float
    saturates: bool
    slow_torque: float
    most_torque: float
    even: float
    freed: float

    def load_at(self, speed: float) -> float:
        """The torque that a shaft at a speed (rpm) is loaded with: the rated one, or most of what the drive gives.

        Where the limit rises a load that slows the shaft lowers it: what is given at four fifths of the speed counts.
        """
        kept = _LOADED * abs(speed)
        if kept >= self.freed:
            return self.torque
        told = max(kept - self.even, 0.0) / (self.freed - self.even)
        return min(self.torque, _LOADED * (self.slow_torque + told * (self.most_torque - self.slow_torque)))


def of(motor: Described, *, mapped: bool = False) -> Ratings:
    """The ratings of a motor on its link. mapped: its flux is that of a table."""
    pairs, flux = motor.plant("machine", "pole_pairs"), motor.plant("machine", "magnet_flux")
    current, resistance = motor.plant("machine", "rated_peak_current"), motor.plant("machine", "resistance")
    inductance_q, inertia = motor.plant("machine", "inductance_q"), motor.plant("mechanics", "inertia")
    volts = motor.plant("link", "source_voltage") / math.sqrt(3.0) * motor.told("voltage_use") / 100.0
    torque, limit = 1.5 * pairs * flux * current, motor.told("speed_limit")
    speed = min(limit, _SPARE * rpm(_loaded(volts, flux, resistance * current, inductance_q * current)) / pairs)
    weakened = flux - motor.plant("machine", "inductance_d") * motor.told("weakening_limit")
    turned = motor.told("start_method") == 1.0
    salient, most = motor.told("saliency_current"), motor.told("current_limit")
    even = share(motor.plant("machine", "inductance_d"), inductance_q) / 6.0
    per_share = rpm(motor.plant("link", "source_voltage") / flux / pairs)
    return Ratings(
        torque=torque,
        speed=speed,
        fastest=min(limit, _SPARE * rpm(volts / max(weakened, 0.2 * flux) / pairs)),
        run_up=inertia * speed * math.pi / 30.0 / torque,
        electrical=inductance_q / resistance,
        ramp=min(motor.told("speed_ramp"), rpm(0.5 * torque / inertia)),
        slowest=motor.told("if_speed") if turned else 0.0,
        turn=open_loop.turn_time(motor.told("if_speed"), motor.told("if_acceleration")) if turned else 0.0,
        cogging=motor.plant("mechanics", "cogging_torque"),
        saturates=mapped or bool(motor.plant("machine", "saturation")),
        slow_torque=1.5 * pairs * flux * (salient or most),
        most_torque=1.5 * pairs * flux * most,
        even=even * per_share,
        freed=2.0 * max(even, _balance(motor)) * per_share if 0.0 < salient < most else 0.0,
    )


def _balance(motor: Described) -> float:
    """EMF over the link at which it balances the saliency of the other sign at the limit, by the drive's law.

    1/Lqq rises on with the square of the current.
    """
    d, q = (motor.told(f"inductance_{axis}") * motor.told(f"l{axis}{axis}_4") / 100.0 for axis in "dq")
    reach = motor.told("current_limit") / motor.told("map_current")
    first = 1.0 / motor.told("inductance_q")
    beyond = 1.0 / (first + (1.0 / q - first) * reach**2)
    return 2.0 / 3.0 * math.sqrt((q / d - 1.0) * max(1.0 - beyond / d, 0.0))


def _loaded(volts: float, flux: float, drop: float, flux_q: float) -> float:
    """rad/s electrical at which a current in the q-axis takes all of the voltage: (R I + w flux)^2 + (w Lq I)^2."""
    square = flux**2 + flux_q**2
    beyond = volts**2 - drop**2
    if beyond <= 0.0:
        return 0.0
    return (math.sqrt((drop * flux) ** 2 + square * beyond) - drop * flux) / square
