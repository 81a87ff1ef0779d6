"""Writes ASAM MDF 4.1 files (.mf4): one channel group with a time master and floating-point channels.

Only what that needs of the standard: no compression, no conversion rules, no attachments. A file is a tree of blocks,
each beginning with a mark, its length, and links (file positions) to other blocks; strings are blocks, too.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import numpy.typing as npt

_HEAD = 24
_ALIGN = 8
_MASTER, _PLAIN = 2, 0
_TIME = 1
_FLOAT = 4


class _Blocks:
    """The file so far; blocks are written before those that link to them, but for the header."""

    def __init__(self) -> None:
        program = b"stillspn"
        self.octets = bytearray(struct.pack("<8s8s8s4xH30xHH", b"MDF     ", b"4.10    ", program, 410, 0, 0))

    def add(self, mark: bytes, links: tuple[int, ...], data: bytes = b"") -> int:
        """Append a block and return its position."""
        self.octets += bytes(-len(self.octets) % _ALIGN)
        at = len(self.octets)
        length = _HEAD + 8 * len(links) + len(data)
        self.octets += struct.pack(f"<4s4xQQ{len(links)}Q", b"##" + mark, length, len(links), *links) + data
        return at

    def text(self, text: str, mark: bytes = b"TX") -> int:
        """Append a string; nothing, position 0, for an empty one."""
        octets = text.encode() + b"\0"
        return self.add(mark, (), octets + bytes(-len(octets) % _ALIGN)) if text else 0

    def reserve(self, mark: bytes, links: int, data: bytes) -> int:
        """Append a block whose links come later."""
        return self.add(mark, (0,) * links, data)

    def link(self, at: int, number: int, target: int) -> None:
        """Set a link of a block."""
        struct.pack_into("<Q", self.octets, at + _HEAD + 8 * number, target)


def write(
    path: Path,
    time: npt.NDArray[np.float64],
    signals: Mapping[str, npt.NDArray[np.float64]],
    units: Mapping[str, str],
    comment: str,
) -> None:
    """Write equally long arrays.

    Args:
        path: the file.
        time: s, the master channel.
        signals: by name.
        units: by name.
        comment: about the whole.
    """
    blocks = _Blocks()
    header = blocks.reserve(b"HD", 6, struct.pack("<Qhh4Bdd", 0, 0, 0, 0, 0, 0, 0, 0.0, 0.0))
    history = "<FHcomment><TX>capture</TX><tool_id>stillspin</tool_id><tool_vendor/><tool_version/></FHcomment>"
    blocks.link(header, 1, blocks.add(b"FH", (0, blocks.text(history, b"MD")), struct.pack("<QhhB3x", 0, 0, 0, 0)))
    blocks.link(header, 5, blocks.text(comment))
    columns = [("time", "s", time), *((name, units.get(name, ""), values) for name, values in signals.items())]
    following = 0
    for number, (name, unit, _) in reversed(list(enumerate(columns))):
        following = _channel(blocks, number, name, unit, following)
    table = np.column_stack([values for _, _, values in columns]).astype("<f8")
    sizes = struct.pack("<QQHH4xII", 0, time.size, 0, 0, 8 * len(columns), 0)
    group = blocks.add(b"CG", (0, following, 0, 0, 0, 0), sizes)
    data = blocks.add(b"DT", (), table.tobytes())
    blocks.link(header, 0, blocks.add(b"DG", (0, group, data, 0), bytes(8)))
    path.write_bytes(bytes(blocks.octets))


def _channel(blocks: _Blocks, number: int, name: str, unit: str, following: int) -> int:
    kind, sync = (_MASTER, _TIME) if number == 0 else (_PLAIN, 0)
    names = (blocks.text(name), 0, 0, 0, blocks.text(unit), 0)
    data = struct.pack("<4BIIIIBBH6d", kind, sync, _FLOAT, 0, 8 * number, 64, 0, 0, 0, 0, 0, *(0.0,) * 6)
    return blocks.add(b"CN", (following, 0, *names), data)
