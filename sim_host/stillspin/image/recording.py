"""What one run was told from outside given to another, and what both write to the ePWM compared, bit for bit.

The run that is recorded is that of an image or of the firmware that is compiled for this computer. A recording has the
codes in the order of the converter's samples; the levels of pins that the program read, the trip inputs and the
encoder's edges by step; the octets that came at the serial port with their times; and every write to a register of the
ePWM in order. What the program makes of equal inputs has to be equal: the first write that is not is named by its step,
its register and the line of the image that made it. A step is a sample of the converter.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path

from stillspin.board.desk import TICKS_PER_SECOND
from stillspin.core import NativeCore, Progress
from stillspin.core_board import NativeBoard
from stillspin.core_code import Change
from stillspin.errors import InputError
from stillspin.image import closed_loop, opened
from stillspin.image.closed_loop import Wanted
from stillspin.image.opened import Image
from stillspin.image.run_record import Played

_FORMAT = 2
_MODULES = range(0x6800, 0x6980)
_MODULE = 0x40
_REGISTERS = {
    **{0x00: "TBCTL", 0x01: "TBSTS", 0x02: "TBPHSHR", 0x03: "TBPHS", 0x04: "TBCTR", 0x05: "TBPRD", 0x07: "CMPCTL"},
    **{0x08: "CMPAHR", 0x09: "CMPA", 0x0A: "CMPB", 0x0B: "AQCTLA", 0x0C: "AQCTLB", 0x0D: "AQSFRC", 0x0E: "AQCSFRC"},
    **{0x0F: "DBCTL", 0x10: "DBRED", 0x11: "DBFED", 0x12: "TZSEL", 0x14: "TZCTL", 0x15: "TZEINT", 0x16: "TZFLG"},
    **{0x17: "TZCLR", 0x18: "TZFRC", 0x19: "ETSEL", 0x1A: "ETPS", 0x1B: "ETFLG", 0x1C: "ETCLR", 0x1D: "ETFRC"},
    **{0x1E: "PCCTL", 0x20: "HRCNFG"},
}

Octets = tuple[float, str]
"""When, in seconds after power-on, and in hexadecimal digits what."""


@dataclass(frozen=True)
class Recording:
    """Of a run from power-on."""

    seconds: float
    samples: list[int]
    writes: list[tuple[int, int, int]]
    """Samples before it, address, value."""
    octets: list[Octets]
    made_by: str
    inputs: list[list[Change]]
    """Changes of pins 0 to 15, 16 to 31 and 32 to 34, of the active trip inputs, and of the encoder's edges."""
    firmware: str = ""
    """What made it says of itself: version, edition, commit and tables."""
    revision: str = ""
    """Of the sources of this program."""


@dataclass(frozen=True)
class Difference:
    """The first write that is not the same; None where one side has no more."""

    index: int
    expected: tuple[int, int, int] | None
    found: tuple[int, int, int] | None
    program: int
    """The address behind the instruction that wrote; 0 where there is none."""


def register(address: int) -> str:
    """As TI names it: EPwm1.CMPA."""
    if address not in _MODULES:
        return f"0x{address:04X}"
    module, offset = divmod(address - _MODULES.start, _MODULE)
    return f"EPwm{module + 1}.{_REGISTERS.get(offset, f'0x{offset:02X}')}"


def play(board: NativeBoard, seconds: float, octets: Sequence[Octets], given: Recording | None = None) -> Recording:
    """Let a board that has just been switched on run, and record it.

    Args:
        board: of an image or the firmware.
        seconds: how long.
        octets: for its serial port.
        given: what it is told in the place of what is there; its codes as long as there are some. A board that has
            not come to the last of them has as long again, since its start may take longer than the recorded one.

    Raises:
        CampaignError: the chip cannot go on.
    """
    board.record(given.samples if given else [], given.inputs if given else [])
    at = 0.0
    for when, text in sorted(octets):
        if when > seconds:
            break
        opened.advance(board, when - at)
        at = when
        board.serial_write(bytes.fromhex(text))
    opened.advance(board, seconds - at)
    if given and len(board.recorded()[0]) < len(given.samples):
        opened.advance(board, seconds)
    samples, writes, inputs = board.recorded()
    return Recording(seconds, samples, [write[:3] for write in writes], list(octets), "", inputs)


def of_run(
    native: NativeCore, job: Wanted, image: Image | None, progress: Progress | None
) -> tuple[Recording | None, Played]:
    """Let a board run a scenario, told over its serial port, and record it from power-on; nothing where it never began.

    Args:
        native: the native module.
        job: what is run.
        image: what drives the plant; the firmware where there is none.
        progress: gets the share done (0 … 1); false breaks the run off.
    """
    made: list[tuple[float, list[int], list[tuple[int, int, int, int]], list[list[Change]]]] = []
    if image:
        board = opened.power_plant(native, image, job.plant, job.seed)
    else:
        board = native.VirtualBoard(plant=job.plant, parameters={}, seed=job.seed)
    board.record([])
    looks = (lambda _: None, lambda b: made.append((b.now / TICKS_PER_SECOND, *b.recorded())))
    played = closed_loop.play_on(
        board, job, progress, [str(row["name"]) for row in native.signals()], looks, image=image
    )
    if not made:
        return None, played
    seconds, samples, writes, inputs = made[0]
    return Recording(seconds, samples, [write[:3] for write in writes], played.sent, "", inputs), played


def compare(recording: Recording, board: NativeBoard) -> Difference | None:
    """Hold what a board has written, which was given the recording, against the recording.

    What came behind the recording's last sample is not compared. Where the board has taken fewer, the writes of the
    others are missing.
    """
    end = len(recording.samples)
    expected = [write for write in recording.writes if write[0] < end]
    found = [write for write in board.recorded()[1] if write[0] < end]
    for index, (one, other) in enumerate(zip_longest(expected, found)):
        if other is None or one != other[:3]:
            return Difference(index, one, other[:3] if other else None, other[3] if other else 0)
    return None


def save(recording: Recording, file: Path) -> None:
    """As JSON.

    Raises:
        InputError: it cannot be written.
    """
    content = {
        "recording": _FORMAT,
        "made_by": recording.made_by,
        "firmware": recording.firmware,
        "revision": recording.revision,
        "seconds": recording.seconds,
        "octets": recording.octets,
        "samples": recording.samples,
        "writes": recording.writes,
        "inputs": recording.inputs,
    }
    try:
        file.write_text(json.dumps(content, separators=(",", ":")) + "\n", encoding="utf-8")
    except OSError as error:
        raise InputError(f"{file}: cannot be written ({error.strerror})") from error


def load(file: Path) -> Recording:
    """The same back.

    Raises:
        InputError: it cannot be read, or is no recording.
    """
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
        if content["recording"] != _FORMAT:
            raise InputError(f"{file}: is a recording of format {content['recording']}, not {_FORMAT}; record it again")
        return Recording(
            float(content["seconds"]),
            [int(code) for code in content["samples"]],
            [(int(step), int(address), int(value)) for step, address, value in content["writes"]],
            [(float(when), str(text)) for when, text in content["octets"]],
            str(content["made_by"]),
            [[(int(step), int(looks), int(value)) for step, looks, value in rows] for rows in content["inputs"]],
            str(content.get("firmware", "")),
            str(content.get("revision", "")),
        )
    except OSError as error:
        raise InputError(f"{file}: cannot be read ({error.strerror})") from error
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise InputError(f"{file}: is no recording of `image record` ({error})") from error
