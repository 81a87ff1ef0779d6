"""What a motor is rated for on its link, and how fast shaft and current are by themselves."""

from __future__ import annotations

import math
from dataclasses import dataclass

from stillspin.cases.motor_told import Described
from stillspin.cases.open_loop import rpm, share

_LOADED = 0.8  # of what the drive gives: the rest is for keeping the speed
_RISEN = 2.5  # times `even`
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
        cogging: N m, peak.
        saturates: which alone tells the polarity of a shaft that a brake holds.
        slow_torque: of the current up to which the saliency is there; the drive gives no more below `even` rpm, and
            from there to twice of it the limit rises to all (firmware/drive/speed.c).
        even: rpm at which the EMF tells as much as what is left of the saliency.
    """

    torque: float
    speed: float
    fastest: float
    run_up: float
    electrical: float
    ramp: float
    slowest: float
    cogging: float
    saturates: bool
    slow_torque: float
    even: float

    def load_at(self, speed: float) -> float:
        """The torque that a shaft at a speed (rpm) is loaded with: the rated one, or most of what the drive gives.

        Where the limit rises a load that slows the shaft lowers it, so that is no speed to be loaded at.
        """
        slow = abs(speed) < _RISEN * self.even
        return min(self.torque, _LOADED * self.slow_torque) if slow else self.torque


def of(motor: Described, *, mapped: bool = False) -> Ratings:
    """The ratings of a motor on its link. mapped: its flux is that of a table."""
    pairs, flux = motor.plant("machine", "pole_pairs"), motor.plant("machine", "magnet_flux")
    current, resistance = motor.plant("machine", "rated_peak_current"), motor.plant("machine", "resistance")
    inductance_q, inertia = motor.plant("machine", "inductance_q"), motor.plant("mechanics", "inertia")
    volts = motor.plant("link", "source_voltage") / math.sqrt(3.0) * motor.told("voltage_use") / 100.0
    torque, limit = 1.5 * pairs * flux * current, motor.told("speed_limit")
    speed = min(limit, _SPARE * rpm(_loaded(volts, flux, resistance * current, inductance_q * current)) / pairs)
    weakened = flux - motor.plant("machine", "inductance_d") * motor.told("weakening_limit")
    open_loop = motor.told("start_method") == 1.0
    salient = motor.told("saliency_current") or math.inf
    per_volt = share(motor.plant("machine", "inductance_d"), inductance_q) / 6.0 / flux / pairs
    return Ratings(
        torque=torque,
        speed=speed,
        fastest=min(limit, _SPARE * rpm(volts / max(weakened, 0.2 * flux) / pairs)),
        run_up=inertia * speed * math.pi / 30.0 / torque,
        electrical=inductance_q / resistance,
        ramp=min(motor.told("speed_ramp"), rpm(0.5 * torque / inertia)),
        slowest=motor.told("if_speed") if open_loop else 0.0,
        cogging=motor.plant("mechanics", "cogging_torque"),
        saturates=mapped or bool(motor.plant("machine", "saturation")),
        slow_torque=1.5 * pairs * flux * salient,
        even=rpm(motor.plant("link", "source_voltage") * per_volt),
    )


def _loaded(volts: float, flux: float, drop: float, flux_q: float) -> float:
    """rad/s electrical at which a current in the q-axis takes all of the voltage: (R I + w flux)^2 + (w Lq I)^2."""
    square = flux**2 + flux_q**2
    beyond = volts**2 - drop**2
    if beyond <= 0.0:
        return 0.0
    return (math.sqrt((drop * flux) ** 2 + square * beyond) - drop * flux) / square
