"""Intel hex as hex2000 --intel --romwidth=16 --memwidth=16 writes it for the C28x.

An address counts words, not octets, and a word comes high octet first: a record of 32 octets is 16 words.
"""

from __future__ import annotations

from stillspin.errors import InputError
from stillspin.flash.program import Block, Program, assemble

_DATA, _END, _SEGMENT, _START_SEGMENT, _LINEAR, _START = range(6)
_SHORTEST = 5


def _record(line: str, number: int, name: str) -> bytes:
    where = f"{name}, line {number}"
    try:
        octets = bytes.fromhex(line[1:])
    except ValueError:
        octets = b""
    if not line.startswith(":") or len(octets) < _SHORTEST or len(octets) != octets[0] + _SHORTEST:
        raise InputError(f"{where}: is no Intel hex record; the file is damaged")
    if sum(octets) & 0xFF:
        raise InputError(f"{where}: wrong check sum; the file is damaged")
    return octets[:-1]


def read(data: bytes, name: str) -> Program:
    """Read a file.

    Raises:
        InputError: it is damaged, breaks off, or does not count in words.
    """
    base, entry, ended = 0, None, False
    blocks = []
    for number, line in enumerate(data.decode("ascii", "replace").split(), 1):
        octets = _record(line, number, name)
        address, kind, body = int.from_bytes(octets[1:3]), octets[3], octets[4:]
        if ended:
            raise InputError(f"{name}, line {number}: comes after the end record; make the file again")
        if kind == _DATA:
            if len(body) % 2:
                raise InputError(
                    f"{name}, line {number}: half a word; make the file with hex2000 --romwidth=16 --memwidth=16"
                )
            words = tuple(int.from_bytes(body[k : k + 2]) for k in range(0, len(body), 2))
            blocks.append(Block(base + address, words))
        elif kind == _LINEAR:
            base = int.from_bytes(body) << 16
        elif kind == _START:
            entry = int.from_bytes(body)
        elif kind == _END:
            ended = True
        else:
            raise InputError(f"{name}, line {number}: hex2000 writes no record type {kind}; make the file with hex2000")
    if not ended:
        raise InputError(f"{name}: is cut short before its last record; copy it again")
    return assemble(blocks, entry, "Intel hex", name)
