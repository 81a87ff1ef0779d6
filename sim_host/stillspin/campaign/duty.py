"""What every case of a campaign does: up, load, through zero and back, as fast as its motor can."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from stillspin import core
from stillspin.cases import open_loop
from stillspin.cases.profile import Profile
from stillspin.cases.scenario import Reached, Run
from stillspin.entry import Entry

NOMINAL_LOAD = 0.5  # of the rated torque, where nothing departs
_SPEED = 0.3  # of what link, flux and the drive's limit allow without field weakening
_SEEN = 1.5  # of if_speed, at least, where the EMF alone shows the rotor: room for the load's dip
_BEGIN, _LOADED, _STEP = 0.1, 0.2, 0.005  # s: to the first command; from the speed to the load; its rise
_SETTLE, _HELD = 0.4, 0.2  # s: from a load or a ramp's end until the shaft has to be there, and how long
_MARGIN = 0.01  # s before the next command
_BAND = 0.1  # of the speed
_RECORD = 10  # PWM periods: 1 ms


@dataclass(frozen=True)
class Duty:
    """What is asked of a motor.

    Attributes:
        speed: rpm; torque: rated, N m; ramp: s from rest to the speed.
        turn: s more where a current vector takes the rotor through standstill.
    """

    speed: float
    torque: float
    ramp: float
    turn: float = 0.0

    @property
    def duration(self) -> float:
        """Seconds from the end of the start procedure."""
        return whole_periods(self._back + 2.0 * self.ramp + self.turn + _SETTLE + _HELD)

    @property
    def _load_at(self) -> float:
        return whole_periods(_BEGIN + self.ramp + self.turn + _LOADED)

    @property
    def _back(self) -> float:
        return whole_periods(self._load_at + _SETTLE + _HELD)

    def run(self, name: str, load: float) -> Run:
        """As a run of a scenario. `load`: share of the rated torque, against the first direction."""
        held = whole_periods(self._load_at + _SETTLE), whole_periods(self._back - _MARGIN)
        end = whole_periods(self.duration - _HELD), self.duration
        return Run(
            name=name,
            title="",
            duration=self.duration,
            max_start=3.0,
            commands=((_BEGIN, "speed_ref_rpm", self.speed), (self._back, "speed_ref_rpm", -self.speed)),
            load=((self._load_at, 0.0), (whole_periods(self._load_at + _STEP), round(load * self.torque, 6))),
            parameters={},
            plant={"solver": {"method": "rk4"}},
            reached=(Reached(held, _BAND * self.speed), Reached(end, _BAND * self.speed)),
            record_every=_RECORD,
        )


def whole_periods(seconds: float) -> float:
    """To the control period, 0.1 ms."""
    return round(seconds, 4)


def of(profile: Profile, schema: core.Schema, known: Mapping[str, Entry]) -> Duty:
    """What can be asked of a motor, by its nameplate."""

    def plate(section: str, key: str) -> float:
        return float(profile.plant.get(section, {}).get(key, schema[section][key].default))

    def told(name: str) -> float:
        return float(profile.parameters.get(name, known[name].default))

    pairs, flux = plate("machine", "pole_pairs"), plate("machine", "magnet_flux")
    torque = 1.5 * pairs * flux * plate("machine", "rated_peak_current")
    volts = plate("link", "source_voltage") / math.sqrt(3.0) * told("voltage_use") / 100.0
    base = volts / max(flux, 1e-6) / pairs * 30.0 / math.pi
    turned = told("start_method") == 1.0
    slowest = _SEEN * told("if_speed") if turned else 0.0
    speed = float(f"{max(_SPEED * min(base, told('speed_limit')), slowest):.2g}")
    # What the nominal load leaves of the torque, half of it: a heavier shaft has to follow as well.
    spare = 0.5 * (1.0 - NOMINAL_LOAD) * torque / plate("mechanics", "inertia") * 30.0 / math.pi
    ramp = speed / min(told("speed_ramp"), spare) if spare > 0.0 else speed / told("speed_ramp")
    turn = open_loop.turn_time(told("if_speed"), told("if_acceleration")) if turned else 0.0
    return Duty(speed, torque, round(ramp, 3), round(turn, 3))
