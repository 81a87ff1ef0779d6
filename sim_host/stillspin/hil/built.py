"""Whether a board is built like the virtual drive that it is compared with, said before the first step."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TypeVar

from stillspin import resources
from stillspin.drive import describe
from stillspin.drive.connect import connect
from stillspin.drive.describe import Ask, Identity
from stillspin.drive.own import virtual_ask
from stillspin.drive.requester import Requester
from stillspin.drive.table import Parameter, Signal, Table
from stillspin.hil.kept_board import TIMEOUT
from stillspin.hil.recording import Heading
from stillspin.link.errors import DifferentError

_SHOWN = 8
Row = TypeVar("Row", Parameter, Signal)


def edition_at(where: str) -> str:
    """The edition of the board at an address; empty where it does not say.

    Raises:
        InputError: no address.
        DriveError: nothing can be opened there, or nothing answers.
    """
    requester = Requester(connect(where), TIMEOUT)
    try:
        return describe.identity(lambda kind, body: requester.request(kind, body, repeat=True)).edition
    finally:
        requester.close()


def check_board(ask: Ask) -> Identity:
    """Compare a board's version, board file and table with those of the virtual drive.

    Args:
        ask: of the board.

    Returns:
        What the board says of itself.

    Raises:
        DifferentError: what differs, with both values, and how to go on.
    """
    theirs = describe.identity(ask)
    with virtual_ask() as ask_virtual:
        ours = describe.identity(ask_virtual)
        if theirs.edition not in ("", ours.edition):
            raise DifferentError(
                f"the board has edition {theirs.edition}, and no virtual drive of it is built here: cmake --preset "
                f"release -DSTILLSPIN_EDITION={theirs.edition} && cmake --build --preset release makes one (for a "
                "list of your own its path is the name). No step was done"
            )
        found = list(_of_identity(theirs, ours))
        if theirs.crc != ours.crc:
            found += _of_tables(describe.table(ask, theirs), describe.table(ask_virtual, ours))
    if found:
        more = [f"and {len(found) - _SHOWN} more"] if len(found) > _SHOWN else []
        raise DifferentError(
            f"the board is not built like the virtual drive: {'; '.join([*found[:_SHOWN], *more])}. No step was done. "
            f"Flash an image of these sources for board {ours.board} ({resources.page('flash')}), or use the stillspin "
            "that its image was built with"
        )
    return theirs


def check_recorded(ask: Ask, recording: Heading) -> Identity:
    """Compare a board's version, edition, board file and table with those of the drive in a recording.

    Args:
        ask: of the board.
        recording: of one of its runs.

    Returns:
        What the board says of itself.

    Raises:
        DifferentError: what differs, with both values, and how to go on.
    """
    theirs = describe.identity(ask)
    pairs = {
        "version": (theirs.version, recording.version),
        "edition": (theirs.edition, recording.edition),
        "board file": (theirs.board, recording.board),
        "table": (f"{theirs.crc:08x}", f"{recording.crc:08x}"),
    }
    found = [
        f"{what} {one} on the board, {other} in the recording" for what, (one, other) in pairs.items() if one != other
    ]
    if found:
        raise DifferentError(
            f"the board is not built like the drive in the recording: {'; '.join(found)}. No step was done. Use a "
            "recording that was made with the sources of its image"
        )
    return theirs


def _differs(what: str, board: object, virtual: object) -> str:
    return f"{what} {board} on the board, {virtual} on the virtual drive"


def _of_identity(theirs: Identity, ours: Identity) -> Iterator[str]:
    if theirs.version != ours.version:
        yield _differs("version", theirs.version, ours.version)
    if not theirs.edition:
        yield _differs("edition", "unknown", ours.edition)
    if theirs.board != ours.board:
        yield _differs("board file", theirs.board or "unknown", ours.board)


def _of_tables(theirs: Table, ours: Table) -> list[str]:
    """What differs in the tables; their check sums, when it is the words of states and faults."""
    found = [*_parameters(theirs, ours), *_signals(theirs, ours)]
    return found or [_differs("words for states and faults, table", f"{theirs.crc:08x}", f"{ours.crc:08x}")]


def _named(rows: tuple[Row, ...]) -> dict[str, Row]:
    return {row.name: row for row in rows}


def _one_sided(kind: str, theirs: Mapping[str, object], ours: Mapping[str, object]) -> Iterator[str]:
    for name in [*theirs, *ours]:
        if name not in ours:
            yield f"{kind} {name} on the board alone"
        elif name not in theirs:
            yield f"{kind} {name} on the virtual drive alone"


def _parameters(theirs: Table, ours: Table) -> Iterator[str]:
    board, virtual = _named(theirs.parameters), _named(ours.parameters)
    yield from _one_sided("parameter", board, virtual)
    for name in (name for name in board if name in virtual):
        one, other = board[name], virtual[name]
        if (one.initial, one.unit) != (other.initial, other.unit):
            defaults = (one.text(one.initial_raw), other.text(other.initial_raw))
            yield _differs(f"parameter {name}: default", *defaults)
        elif one.range_text != other.range_text:
            yield _differs(f"parameter {name}: range", one.range_text, other.range_text)
        elif (one.id, one.q, one.index, one.always) != (other.id, other.q, other.index, other.always):
            yield _differs(
                f"parameter {name}: number, place and fraction bits",
                f"{one.id}, {one.index}, {one.q}",
                f"{other.id}, {other.index}, {other.q}",
            )


def _signals(theirs: Table, ours: Table) -> Iterator[str]:
    board, virtual = _named(theirs.signals), _named(ours.signals)
    yield from _one_sided("signal", board, virtual)
    for name in (name for name in board if name in virtual):
        one, other = board[name], virtual[name]
        if (one.index, one.q, one.unit) != (other.index, other.q, other.unit):
            places = (f"{one.index} with {one.q} fraction bits", f"{other.index} with {other.q} fraction bits")
            yield _differs(f"signal {name}: place", *places)
