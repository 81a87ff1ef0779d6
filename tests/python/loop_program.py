"""The control program of tests/c28x/programs as a board in the loop: built, modelled, and stepped through a run.

Its model here is of its own: Python's integers, and the answers as firmware/hil/hil.h has them.
"""

import os
import select
import struct
import zlib
from types import SimpleNamespace

from c28x_chip import changed_file

from stillspin.c28x import linked
from stillspin.c28x.program import assemble_files
from stillspin.drive.protocol import Request
from stillspin.link.records import Record, to_wire
from stillspin.link.splitter import Splitter

PLACES = "state", "windows", "link_voltage", "current_a", "current_b", "current_q_reference"
"""The signals that it has, in the order of its settings; all others of the table stay zero."""
_FAST = 31
"""Divider of the serial port: 390625 bit/s."""
_NAME = 20
_SIGN = 1 << 31


def built(folder, identity, names, change=("", "")):
    """The program as a file, with what a drive calls itself, its signals' names, and a piece of its text changed.

    All that is the drive's stands in the settings: without a change the code is that of `program("control")`.
    """
    made = assemble_files([changed_file(folder, "control", "loop.asm", *change)])
    at, words = made.symbols, made.words
    words[at["RATE"]] = _FAST
    words[at["KNOWN"]] = 2 * len(names) - 1
    settings = {
        "PLACES": [2 * names.index(name) for name in PLACES],
        "IDENTITY": [len(identity), *identity],
        "NAMES": [octet for name in names for octet in name.encode().ljust(_NAME, b"\0")],
    }
    for name, values in settings.items():
        words.update(enumerate(values, at[name]))
    file = folder / "control.out"
    file.write_bytes(linked.to_elf(made, 0x3F7FF6))
    return file


class _Reader:
    def __init__(self, octets):
        self._left = iter(octets)

    def differences(self, words, count):
        """Renew the first words of a list."""
        for at in range(count):
            if at % 8 == 0:
                mask = next(self._left)
            if mask >> at % 8 & 1:
                words[at] = words[at] + self._difference() & 0xFFFF

    def _difference(self):
        folded, shift, octet = 0, 0, 0x80
        while octet & 0x80:
            octet = next(self._left)
            folded |= (octet & 0x7F) << shift
            shift += 7
        return folded >> 1 ^ -(folded & 1)


def _folded(word, before):
    difference = (word - before + 0x8000 & 0xFFFF) - 0x8000
    rest = difference << 1 if difference >= 0 else ~(difference << 1)
    made = []
    while rest > 0x7F:
        made.append(rest & 0x7F | 0x80)
        rest >>= 7
    return [*made, rest]


def _differences(words, before):
    made = []
    for first in range(0, len(words), 8):
        pairs = list(zip(words[first : first + 8], before[first : first + 8], strict=True))
        made.append(sum(1 << bit for bit, (word, was) in enumerate(pairs) if word != was))
        made += [octet for word, was in pairs if word != was for octet in _folded(word, was)]
    return bytes(made)


class Model:
    """What the program computes of a run's steps."""

    def __init__(self, names):
        self._names = names
        self._shape = [0] * 4
        self._lists = [0] * 24, [0] * 4, [[0] * 7 for _ in range(20)]
        self._told, self._before = [[0, 0], [0] * 14], [[0, 0], [0] * 14]
        self.values = dict.fromkeys(names, 0)

    @property
    def outputs(self):
        """Words that it tells its hardware."""
        return self._told[1]

    @property
    def signals(self):
        """Raw values in their order."""
        return [self.values[name] for name in self._names]

    def answer(self, step):
        """To the next step."""
        reader = _Reader(step[2:])
        inputs, works, windows = self._lists
        reader.differences(self._shape, 4)
        reader.differences(works, self._shape[3])
        reader.differences(inputs, self._shape[2])
        for window in windows[: self._shape[0]]:
            reader.differences(window, 1 + self._shape[1])
        self._control(windows[: self._shape[0]])
        crc = zlib.crc32(struct.pack(f"<{len(self._names)}i", *self.signals))
        told, before = self._told, self._before
        made = step[:2] + _differences(told[0], before[0]) + _differences(told[1], before[1]) + struct.pack("<I", crc)
        self._before = [list(words) for words in told]
        return made

    def _control(self, windows):
        values = self.values
        a, b = (sum(window[result] for window in windows) for result in (1, 2))
        integral = (values["current_q_reference"] + a - b + _SIGN) % (2 * _SIGN) - _SIGN
        values |= {"state": 1, "windows": len(windows), "current_a": a, "current_b": b, "current_q_reference": integral}
        if windows:
            values["link_voltage"] = windows[-1][3]
        duty = max(min(integral >> 8, 2400), -2400)
        legs = [2500 - duty, 7500 + duty, 2500 + duty, 7500 - duty, 2500, 7500]
        self._told = [[0, 14], [1, *legs, *[0xFFFF] * 6, 9999]]


class StandIn:
    """In the place of the native drive's loop: sends a run's requests and holds the answers against the model's."""

    def __init__(self, ask, names):
        self._ask, self._model = ask, Model(names)
        self._board = [0, 0], [0] * 14
        self.steps, self.mismatch, self.refusal, self.lost = 0, None, None, ""
        self._logs = b"", b""

    def send(self, request):
        """One of them; false behind the first difference, or what is refused."""
        answer = self._ask(request)
        if answer[0]:
            self.refusal = answer[0], answer[1:]
        elif request[0] == Request.HIL_STEP:
            self._compare(answer[1:], self._model.answer(request[1:]))
        return self.refusal is None and self.mismatch is None

    def _compare(self, answer, expected):
        self._logs = self._logs[0] + answer, self._logs[1] + expected
        reader, (shape, outputs) = _Reader(answer[2:]), self._board
        reader.differences(shape, 2)
        reader.differences(outputs, shape[1])
        if answer != expected:
            self.mismatch = self.steps, shape[0] != 0, outputs, self._model.outputs, self._model.signals
        self.steps += 1

    def finish(self):
        """Nothing is left: each answer was looked at."""

    def take_logs(self):
        """What both have said since the last call."""
        logs, self._logs = self._logs, (b"", b"")
        return logs


def through(descriptor, names):
    """A stand-in whose board is at an open serial port."""
    splitter, tags = Splitter(), iter(range(1 << 30))

    def ask(request):
        tag = next(tags) % 256
        os.write(descriptor, to_wire(Record(request[0], tag, request[1:])))
        while True:
            select.select([descriptor], [], [])
            for item in splitter.feed(os.read(descriptor, 4096), 0.0):
                if isinstance(item, Record) and item.tag == tag and item.is_answer:
                    return item.body

    return StandIn(ask, names)


def native(names):
    """What `hil` takes for the native module."""
    return SimpleNamespace(StepLoop=SimpleNamespace(through=lambda descriptor, _: through(descriptor, names)))
