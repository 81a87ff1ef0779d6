"""Typed view of the native module `stillspin._core`, the one door to the virtual drive.

The lists of plant entries and of firmware parameters come from the native module and are listed nowhere else.
"""

from __future__ import annotations

import importlib
import importlib.util
import json
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Protocol, cast

from stillspin import extras, scales
from stillspin.core_board import NativeBoard
from stillspin.core_loader import NativeLoader
from stillspin.core_loop import NativeStepLoop, NativeStepLoops
from stillspin.entry import Entry, Value
from stillspin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    import numpy.typing as npt

Plant = dict[str, dict[str, Value]]
Blocks = list[tuple[int, list[int]]]
"""Words from an address on."""
Signals = dict[str, "npt.NDArray[Any]"]
Command = tuple[float, str, float]
LoadPoint = tuple[float, float]
GateEdge = tuple[int, int, bool, bool]  # tick, leg, upper, lower
Waveform = dict[str, Signals]
Look = tuple[float, float, int]
"""A stretch of a run to look into: from, to (s), and ticks of 10 ns between two looks at the currents."""
Progress = Callable[[float], bool]


class NativeResult(Protocol):
    """What a run gives back.

    Signals have one element per record, all the same length. The columns of a table of the waveform (`raster`, `edges`,
    `samples`) are equally long.
    """

    signals: Mapping[str, npt.NDArray[Any]]
    waveform: Mapping[str, Mapping[str, npt.NDArray[Any]]]
    completed: bool
    reason: str
    faults: Sequence[tuple[float, str]]
    stats: Mapping[str, float]


class NativeCommissioning(Protocol):
    """What a commissioning gives back: a row per identified parameter (commission.Value has the keys)."""

    values: Sequence[Mapping[str, Any]]
    completed: bool
    reason: str
    stats: Mapping[str, float]


class NativeCore(Protocol):
    """The functions of `stillspin._core`."""

    @property
    def StepLoop(self) -> NativeStepLoops:  # noqa: N802 - a class of the module
        """How a board gets into the loop."""
        ...

    def run(
        self,
        *,
        plant: Plant,
        parameters: dict[str, float],
        commands: list[Command],
        load: list[LoadPoint],
        duration: float,
        max_start: float,
        record_every: int,
        waveform: Look,
        seed: int,
        progress: Progress | None,
        recording: NativeStepLoop | None = None,
    ) -> NativeResult:
        """One run. Times in s from the end of the start procedure; progress gets the share done, false stops."""
        ...

    def commission(
        self,
        *,
        plant: Plant,
        parameters: dict[str, float],
        limit: float,
        seed: int,
        progress: Callable[[float, str], bool] | None,
        recording: NativeStepLoop | None = None,
    ) -> NativeCommissioning:
        """The firmware's commissioning. `limit`: simulated s; progress gets share and phase, false stops."""
        ...

    def VirtualBoard(  # noqa: N802 - a class of the module
        self, *, plant: Plant, parameters: dict[str, float], seed: int, image: Blocks = ...
    ) -> NativeBoard:
        """A board that has just been powered; `parameters` as of a drive that nobody has set up otherwise.

        `image`: machine code that it executes instead of the firmware. ValueError for words that are in no memory.
        """
        ...

    def LoaderBoard(  # noqa: N802 - a class of the module
        self, *, entry: int, blocks: list[tuple[int, list[int]]]
    ) -> NativeLoader:
        """A board in flash boot with an erased flash; the kernel that it knows: entry point, blocks of words."""
        ...

    def parameters(self) -> list[dict[str, Any]]:
        """The firmware's parameter table."""
        ...

    def names(self) -> list[str]:
        """Of all parameters and signals of the firmware, whatever the edition."""
        ...

    def check_parameters(self, parameters: dict[str, float]) -> None:
        """Raises ValueError when firmware parameters do not fit together."""
        ...

    def signals(self) -> list[dict[str, Any]]:
        """Name, unit and meaning of every recorded signal."""
        ...

    def plant_schema(self) -> dict[str, dict[str, dict[str, Any]]]:
        """Section -> key -> unit, minimum, maximum, default, help of the plant."""
        ...

    def flux_map(self, path: str) -> Mapping[str, float]:
        """A table of a machine's flux over its currents.

        At zero current inductance_d, inductance_q (H), magnet_flux, magnet_flux_q (Vs); misfit, the largest difference
        of the table to what the plant interpolates (Vs). ValueError for a table that no machine can have.
        """
        ...

    def replay(
        self,
        *,
        plant: Plant,
        edges: list[GateEdge],
        load: list[tuple[int, float]],
        at: list[int],
    ) -> Mapping[str, npt.NDArray[Any]]:
        """The plant alone, open loop: gate edges and load points in, true values at the ticks `at` out.

        A tick is 10 ns from power-on. Columns: i_a, i_b, i_c, i_d, i_q (A), torque (N m), speed (rad/s mechanical),
        angle (rad mechanical, not wrapped).
        """
        ...


BOARD = "STILLSPIN_BOARD"
"""Environment variable: the board, a name of hal/boards/; unset or empty is the usual one."""


NOT_INSTALLED = f"this needs the virtual drive, which is missing: {extras.remedy('virtual')}"
PARAMETERS = "parameters.json"
"""The firmware's parameter table in a wheel, which has no native module to ask; toolchain/wheel.py puts it there."""


EDITION = "STILLSPIN_EDITION"
"""Environment variable: the edition, a name of firmware/editions/; unset or empty is the usual one, lab."""
LAB = "lab"
_OTHERS = {BOARD: "boards", EDITION: "editions"}


def _built(kind: str) -> list[str]:
    """Names of the boards or editions that there is a native module of, but for the usual one."""
    return sorted(path.parent.name for path in (Path(__file__).parent / _OTHERS[kind]).glob("*/_core*.so"))


def other_editions() -> list[str]:
    """Those that there is a virtual drive of, beside the one in use."""
    used = os.environ.get(EDITION) or LAB
    return [name for name in (LAB, *_built(EDITION)) if name != used]


def is_there() -> bool:
    """Whether there is a virtual drive at all, without loading one."""
    return any(Path(__file__).parent.glob("_core*.so")) or importlib.util.find_spec("stillspin_virtual") is not None


def require() -> None:
    """Complain at once where there is no virtual drive at all, without loading one.

    Raises:
        InputError: none is built or installed.
    """
    if not is_there():
        raise InputError(NOT_INSTALLED)


def follow_edition(name: str) -> None:
    """Choose an edition for this process, which has no virtual drive yet, and for those that it begins.

    Args:
        name: of the edition; the usual virtual drive stands for one that is not built. Empty changes nothing.
    """
    if name:
        os.environ[EDITION] = name if name in _built(EDITION) else LAB


def _other(kind: str, name: str) -> ModuleType:
    """The native module of another board or edition than the usual one."""
    folder, known = Path(__file__).parent / _OTHERS[kind], _built(kind)
    if name not in known:
        what = _OTHERS[kind].removesuffix("s")
        raise InputError(f"{kind} '{name}': there is no such {what}; known: {', '.join(known) or 'none is built'}")
    spec = importlib.util.spec_from_file_location("stillspin._core", next((folder / name).glob("_core*.so")))
    if spec is None or spec.loader is None:
        raise ImportError(f"the module of {kind} {name} does not load")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    sys.modules["stillspin._core"] = module
    return module


def _built_or_installed() -> ModuleType:
    """The native module: built in the source tree, or of the wheel stillspin-virtual."""
    try:
        return importlib.import_module("stillspin._core")
    except ModuleNotFoundError:
        return importlib.import_module("stillspin_virtual._core")


def load() -> NativeCore:
    """The native module.

    Raises:
        InputError: it is not there, or does not load on this machine.
    """
    wanted = {kind: os.environ.get(kind, "") for kind in _OTHERS}
    if wanted[EDITION] == LAB:
        wanted[EDITION] = ""
    if all(wanted.values()):
        raise InputError(f"{BOARD} and {EDITION}: no virtual drive is built for both at once")
    try:
        for kind, name in wanted.items():
            if name and "stillspin._core" not in sys.modules:
                return cast(NativeCore, _other(kind, name))
        return cast(NativeCore, _built_or_installed())
    except ModuleNotFoundError as error:
        raise InputError(NOT_INSTALLED) from error
    except ImportError as error:
        raise InputError(f"the virtual drive does not load ({error}); it runs where it was built") from error


def _choices(row: Mapping[str, Any]) -> tuple[str, ...]:
    return tuple(str(choice) for choice in row.get("choices", ()))


Schema = dict[str, dict[str, Entry]]


def plant_schema(core: NativeCore) -> Schema:
    """Section -> key -> entry of everything that can be set on the plant."""
    return {
        section: {
            key: Entry(
                name=f"{section}.{key}",
                unit=row.get("unit", ""),
                minimum=row.get("minimum"),
                maximum=row.get("maximum"),
                default=row["default"],
                help=row.get("help", ""),
                choices=_choices(row),
                whole=isinstance(row["default"], int) and not isinstance(row["default"], bool),
            )
            for key, row in keys.items()
        }
        for section, keys in core.plant_schema().items()
    }


def parameters(core: NativeCore) -> dict[str, Entry]:
    """Name -> firmware parameter, in the order of the firmware's table."""
    return {row["name"]: _parameter_entry(row) for row in core.parameters()}


def known_parameters() -> dict[str, Entry]:
    """The parameters of the firmware that this package belongs to, also where there is no virtual drive to ask.

    Raises:
        InputError: there is neither a virtual drive nor a table.
    """
    file = Path(__file__).with_name(PARAMETERS)
    if not file.exists():
        return parameters(load())
    return {row["name"]: _parameter_entry(row) for row in json.loads(file.read_text(encoding="utf-8"))}


def known_names() -> frozenset[str]:
    """Names of parameters and signals of the firmware that this package belongs to, whatever the edition.

    Without a virtual drive to ask those of the parameters alone, without a table none.
    """
    try:
        return frozenset(load().names())
    except InputError:
        return frozenset(known_parameters()) if Path(__file__).with_name(PARAMETERS).exists() else frozenset()


def _parameter_entry(row: Mapping[str, Any]) -> Entry:
    decimals = int(row["decimals"])
    # The firmware keeps its table in binary fractions; people think in the decimals of the table.
    minimum, maximum, default = (round(float(row[key]), decimals) for key in ("minimum", "maximum", "default"))
    return Entry(
        name=row["name"],
        unit=row["unit"],
        minimum=minimum,
        maximum=maximum,
        default=default,
        help=row["help"],
        choices=_choices(row),
        access=str(row["access"]),
        number=int(row["id"]),
        decimals=decimals,
        whole=bool(row["whole"]),
    )


def at_scale(known: Mapping[str, Entry], told: Mapping[str, Any]) -> dict[str, Entry]:
    """The parameters of a drive that is told these values.

    Its `current_scale` and `voltage_scale` move range and default of all that has amperes or volts in it.
    """
    return {name: entry.at_scale(scales.of(told)) for name, entry in known.items()}


def at_some_scale(known: Mapping[str, Entry]) -> dict[str, Entry]:
    """The parameters with all that they may be in some drive: for files that do not say in which."""
    most = max((round(known[name].maximum or 0.0) for name in scales.SCALES if name in known), default=0)
    return {name: entry.at_some_scale(most) for name, entry in known.items()}


def parameter(known: Mapping[str, Entry], name: str, value: object, where: str) -> float:
    """The value of firmware parameter `name` as the firmware takes it: a number, a choice by its index.

    Raises:
        InputError: no such parameter, or a value that it does not take.
    """
    if name not in known:
        raise InputError(f"{where}: there is no firmware parameter '{name}'{did_you_mean(name, known)}")
    return float(known[name].check(value, where))


def plant_entry(schema: Schema, section: str, key: str, value: object, where: str) -> Value:
    """The checked value of plant entry `section.key`.

    Raises:
        InputError: no such section or key, or a value that it does not take.
    """
    return entry_known(schema, section, key, where).check(value, where)


def entry_known(schema: Schema, section: str, key: str, where: str) -> Entry:
    """The plant entry `section.key`; complains when there is none."""
    section_known(schema, section, where)
    if key not in schema[section]:
        raise InputError(f"{where}: section '{section}' has no entry '{key}'{did_you_mean(key, schema[section])}")
    return schema[section][key]


def section_known(schema: Schema, section: str, where: str) -> None:
    """Complain when the plant has no such section."""
    if section not in schema:
        raise InputError(f"{where}: there is no plant section '{section}'{did_you_mean(section, schema)}")
