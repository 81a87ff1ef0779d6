"""The ten questions of a nameplate, and the motor that follows from the answers: for the command line and the page.

The only place that knows how what a nameplate says becomes what a machine is.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from stillspin import core
from stillspin.quantity import Range

Answers = Mapping[str, float]
_SPEED = 1000.0 * math.pi / 30.0
"""rad/s at 1000 rpm."""
_MARGIN, _OF_SENSORS = 1.3, 0.7
"""Largest current: of the rated one, and of what the sensors can see."""


@dataclass(frozen=True)
class Question:
    """What is asked, and how the parameters of a drive that knows the motor answer it."""

    key: str
    name: str
    """For complaints."""
    text: str
    unit: str
    needs: tuple[str, ...]
    """Parameters that `known` reads."""
    known: Callable[[Mapping[str, float]], float]
    range: Range


def _ask(key: str, name: str, text: str, parameter: str, range_: Range, factor: float = 1.0) -> Question:  # noqa: PLR0917
    return Question(key, name, text, range_.unit, (parameter,), lambda values: values[parameter] * factor, range_)


def _positive(unit: str) -> Range:
    return Range(1e-9, unit=unit)


QUESTIONS = (
    _ask("pole_pairs", "pole pairs", "Pole pairs (half the number of poles)", "pole_pairs", Range(1, 30, whole=True)),
    _ask(
        "resistance",
        "resistance",
        "Resistance of a phase (half of that between wires)",
        "stator_resistance",
        _positive("ohm"),
    ),
    _ask(
        "inductance_d",
        "d-axis inductance",
        "d-axis inductance of a phase (the smaller one)",
        "inductance_d",
        _positive("mH"),
    ),
    _ask("inductance_q", "q-axis inductance", "q-axis inductance of a phase", "inductance_q", _positive("mH")),
    Question(
        "emf",
        "voltage constant",
        "Voltage constant, rms between two wires at 1000 rpm",
        "V",
        ("magnet_flux", "pole_pairs"),
        lambda values: values["magnet_flux"] * values["pole_pairs"] * _SPEED * math.sqrt(1.5),
        _positive("V"),
    ),
    _ask("rated_current", "rated current", "Rated current, rms", "rated_current", _positive("A"), math.sqrt(0.5)),
    _ask("inertia", "inertia", "Inertia of rotor and load", "inertia", _positive("kgm2")),
    _ask("voltage", "DC-link voltage", "DC-link voltage", "link_minimum", _positive("V"), 2.0),
    _ask(
        "current_range",
        "current range",
        "Range of the board's current sensors",
        "current_full_scale",
        _positive("A"),
    ),
    _ask("speed", "largest speed", "Largest speed", "speed_limit", _positive("rpm")),
)


def read(typed: Mapping[str, object]) -> dict[str, float]:
    """The answers as somebody typed them.

    Raises:
        InputError: no number, out of range, or a fraction of a pole pair; names the question.
    """
    return {each.key: each.range.read(typed.get(each.key, ""), each.name) for each in QUESTIONS}


def magnet_flux(emf: float, pole_pairs: float) -> float:
    """Vs, peak of a phase, of V rms between two wires at 1000 rpm."""
    return emf / math.sqrt(1.5) / (pole_pairs * _SPEED)


def plant(answers: Answers, voltage_range: float | None = None) -> core.Plant:
    """What the answers say of the machine and its board, in SI units.

    Args:
        answers: of all questions.
        voltage_range: of the link's divider, V; one and a half times the link's voltage when the board does not say.
    """
    link = answers["voltage"]
    return {
        "machine": {
            "pole_pairs": int(answers["pole_pairs"]),
            "resistance": answers["resistance"],
            "inductance_d": answers["inductance_d"] / 1e3,
            "inductance_q": answers["inductance_q"] / 1e3,
            "magnet_flux": float(f"{magnet_flux(answers['emf'], answers['pole_pairs']):.6g}"),
            "rated_peak_current": float(f"{answers['rated_current'] * math.sqrt(2.0):.6g}"),
        },
        "mechanics": {"inertia": answers["inertia"]},
        "link": {
            "source_voltage": link,
            "brake_on_voltage": round(1.33 * link, 9),
            "brake_off_voltage": round(1.3 * link, 9),
        },
        "adc": {
            "current_range": answers["current_range"],
            "voltage_range": round(1.5 * link, 9) if voltage_range is None else voltage_range,
        },
    }


def stated(answers: Answers) -> dict[str, float]:
    """The drive's parameters that follow from no machine: what may flow, and how fast it may turn."""
    peak = answers["rated_current"] * math.sqrt(2.0)
    limit = min(_MARGIN * peak, _OF_SENSORS * answers["current_range"])
    return {"current_limit": float(f"{limit:.4g}"), "speed_limit": answers["speed"]}


def file_text(name: str, answers: Answers) -> str:
    """A motor's file."""
    found, limits = plant(answers), stated(answers)
    machine, link, adc = found["machine"], found["link"], found["adc"]
    return f"""description = "{name}"

[machine]
pole_pairs = {machine["pole_pairs"]}
resistance = {machine["resistance"]:g}  # ohm, of a phase
inductance_d = {machine["inductance_d"]:g}  # H
inductance_q = {machine["inductance_q"]:g}  # H
magnet_flux = {machine["magnet_flux"]:.6g}  # Vs, peak
rated_peak_current = {machine["rated_peak_current"]:.6g}  # A

[mechanics]
inertia = {found["mechanics"]["inertia"]:g}  # kg m2, rotor and load

[link]
source_voltage = {link["source_voltage"]:g}  # V
brake_on_voltage = {link["brake_on_voltage"]:.6g}
brake_off_voltage = {link["brake_off_voltage"]:.6g}

[adc]
current_range = {adc["current_range"]:g}  # A, of the sensors
voltage_range = {adc["voltage_range"]:.6g}  # V, of the link's divider

[parameters]
current_limit = {limits["current_limit"]:g}  # A, peak
speed_limit = {limits["speed_limit"]:g}  # rpm
"""
