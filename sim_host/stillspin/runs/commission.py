"""Commissioning: the firmware's own identification of machine and inverter, and the file of what it found."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from stillspin import core, toml_table, whole_file
from stillspin.cases import similarity
from stillspin.cases.profile import Changes, Profile, merged
from stillspin.core import NativeCommissioning, NativeCore
from stillspin.core_loop import NativeStepLoop
from stillspin.entry import Entry
from stillspin.errors import CampaignError, InputError

LIMIT = 180.0
"""Simulated seconds after which a commissioning is given up."""
_STARVED = "too low to find rotor and polarity"
_AMPLE = 4.0  # times the current of the test: that much voltage is not what it lacks


@dataclass(frozen=True)
class Value:
    """One identified firmware parameter, in the unit of the parameter table."""

    name: str
    unit: str
    decimals: int
    before: float
    value: float
    used: bool
    words: str

    @property
    def text(self) -> str:
        """As a parameter file has it."""
        return f"{self.value:.{self.places + 1 if self.places else 0}f}"

    @property
    def places(self) -> int:
        """Decimals to show: one more than those of its unit, none of what is counted."""
        return self.decimals + (self.decimals > 0)


@dataclass(frozen=True)
class Result:
    """What a commissioning found. `duration`: seconds of the drive's time."""

    values: tuple[Value, ...]
    duration: float

    @property
    def refused(self) -> tuple[Value, ...]:
        """Values that the drive did not believe."""
        return tuple(value for value in self.values if not value.used)

    @property
    def told(self) -> dict[str, float]:
        """What the drive is told, with the digits of a parameter file."""
        return {value.name: float(value.text) for value in self.values if value.used}


def run(
    native: NativeCore, profile: Profile, changes: Changes, seed: int, progress: Callable[[float, str], bool] | None
) -> Result:
    """Commission the virtual drive.

    Args:
        native: the native module.
        profile: the plant, and what the drive is told of it beforehand.
        changes: of either.
        seed: of the noise.
        progress: gets the share done (0 … 1) and the phase in words; false breaks off.

    Raises:
        InputError: parameters that do not fit together.
        CampaignError: it broke off, with the reason.
    """
    result = play(native, profile, changes, seed, progress)
    if not result.completed:
        raise CampaignError(f"the commissioning broke off: {result.reason}{_ripple(native, profile, changes, result)}")
    rows = tuple(Value(**{key: row[key] for key in Value.__annotations__}) for row in result.values)
    return Result(rows, float(result.stats["commissioning_seconds"]))


def _ripple(native: NativeCore, profile: Profile, changes: Changes, result: NativeCommissioning) -> str:
    """Where a test of the start has lost its current in the ripple, not for want of voltage, what there is to do."""
    size = similarity.of(merged(profile.plant, changes.plant))
    if size is None or _STARVED not in result.reason:
        return ""
    told = {**profile.parameters, **changes.parameters}
    known = core.at_scale(core.parameters(native), told)
    current, pulse = (float(told.get(name, known[name].default)) for name in ("polarity_current", "pulse_time"))
    possible, ripple = size.current_that_follows(current), 2.0 / 3.0 * size.volts / size.inductance_d * pulse * 1e-6
    if possible < _AMPLE * current or ripple <= current:
        return ""
    link, choke = size.volts * current / ripple, 1e3 * size.inductance_d * (ripple / current - 1.0)
    return (
        f"; its voltage suffices, for {possible:.3g} A in the polarity test's time: the ripple, {ripple:.3g} A in a "
        f"pulse of {pulse:g} us, hides polarity_current, {current:.3g} A; a link of {link:.0f} V, "
        f"or a choke of {choke:.2g} mH in each phase, which costs saliency, makes them equal"
    )


def play(
    native: NativeCore,
    profile: Profile,
    changes: Changes,
    seed: int,
    progress: Callable[[float, str], bool] | None,
    *,
    recording: NativeStepLoop | None = None,
    limit: float = LIMIT,
) -> NativeCommissioning:
    """The commissioning itself, however it ends within `limit` simulated seconds; `recording` gets every period of it.

    Raises:
        InputError: parameters that do not fit together.
    """
    parameters = {**profile.parameters, **changes.parameters}
    try:
        native.check_parameters(parameters)
        return native.commission(
            plant=merged(profile.plant, changes.plant),
            parameters=parameters,
            limit=limit,
            seed=seed,
            progress=progress,
            recording=recording,
        )
    except ValueError as error:
        raise InputError(str(error)) from error


def write(path: Path, result: Result, about: Sequence[str]) -> None:
    """Write the values in use as a parameter file; it appears whole or not at all.

    Args:
        path: the file, replaced when it exists.
        result: what was found.
        about: lines of comment at its head.

    Raises:
        InputError: the file cannot be written.
    """
    lines = [f"# {line}" for line in about]
    lines += ["", "[parameters]"]
    for value in result.values:
        if value.used:
            unit = f"  # {value.unit}" if value.unit else ""
            lines.append(f"{value.name} = {value.text}{unit}")
    whole_file.write(path, "\n".join(lines) + "\n", "--out")


def check_target(path: Path) -> None:
    """Complain about a place that cannot be written before the work is done rather than after it."""
    if path.is_dir():
        raise InputError(f"--out {path}: is a directory, must be a file")
    if not path.absolute().parent.is_dir():
        raise InputError(f"--out {path}: there is no directory {path.parent}")


def load(path: Path, known: Mapping[str, Entry], told: Mapping[str, float] | None = None) -> dict[str, float]:
    """Firmware parameters from a parameter file, for a drive that is told others before.

    Raises:
        InputError: not found, not TOML, an unknown parameter or a value that it does not take.
    """
    table = toml_table.read(path)
    values = table.table("parameters").items()
    table.finish()
    if not values:
        raise InputError(f"{path}: has no [parameters]")
    known = core.at_scale(known, {**(told or {}), **values})
    return {name: core.parameter(known, name, value, f"{path}: {name}") for name, value in values.items()}
