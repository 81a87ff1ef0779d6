"""A small drive on a pseudo-terminal: the record protocol and a line of console, without firmware or motor.

It is for what a client must get right whatever is at the other end: time-outs, repetition, damage, refusals. What the
real firmware does is tested against the virtual board.
"""

import struct
import threading
import time
import zlib

from fake_line import Line
from fake_tables import (
    BUSY,
    COMMISSION,
    CONFLICT,
    CONFLICT_WORDS,
    FAULT,
    LENGTH,
    OK,
    PARAMETERS,
    RANGE,
    READY,
    ROTOR,
    RUN,
    RUNNING,
    SIGNALS,
    STATE,
    STOP,
    UNKNOWN,
    WORDS,
    RefusalError,
    raw,
)

from stillspin.drive.scope import DEPTH
from stillspin.link.records import Record, to_wire
from stillspin.link.splitter import Splitter, Text


class FakeDrive:
    """`port` is the pseudo-terminal to open."""

    def __init__(self, version="fake 1.0"):
        self.version = version
        self.values = {number: raw(initial, q) for number, _, _, q, _, _, _, initial, _, _ in PARAMETERS}
        self.kept = dict(self.values)
        self.state, self.fault, self.store = READY, 0, 1
        self.speed = self.reference = self.set_point = 0.0
        self.guarded = False
        self.holder = self.beside_text = 0  # numbers of who holds the motor, and of who has spoken last
        self.faults = []
        self.asked = []  # types of the requests answered, in order
        self.swallow = []  # types of requests of which the next one gets no answer
        self.corrupt = []  # types of requests of which the next answer arrives damaged
        self.stubborn = 0  # number of the parameter that cannot be set
        self.start_fault = 0  # what the next start ends in
        self.begins = RUN  # its state behind a start
        self.chatter = b""  # said before the next answer
        self.typed = b""
        self.lines = []  # of the console
        self.interrupts = 0
        self.dies = False  # with the next line of the console
        self.tells = b""  # unasked, behind the prompt of Ctrl-C
        self.watched = False  # a line of `watch` again and again
        self.refusals = 0  # lines of console that were not carried out
        self.setup = None
        self.scope = 4  # its state: done
        self.stream = None
        self.unsent = 0  # samples of the stream that it counts as such
        self.missing = 0  # samples that its numbers leave out behind the first of a stream
        self.streamed = False
        self.outcome, self.progress = 0, 0.0
        self.pace = 4000  # of a commissioning, per mille per second
        self.looked = (0, 0, "no look since power-on")
        self.seen = (2, 1059, "the shaft turns at 1059 rpm")  # by the next look
        self._counter = 0
        self._begin = self._last = self._heard = self._sent = self._watched = time.monotonic()
        self._line = Line()
        self.port = self._line.name
        self._splitter = Splitter()
        self._lock = threading.Lock()
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self.unplug()

    def unplug(self):
        self._end.set()
        self._thread.join()
        self._line.hang_up()

    def switch_on_again(self):
        """As after a power cut: the parameters are the defaults, the time begins anew, nothing is streamed."""
        with self._lock:
            self.values = {number: raw(initial, q) for number, _, _, q, _, _, _, initial, _, _ in PARAMETERS}
            self.state, self.fault, self.guarded, self.stream = READY, 0, False, None
            self._begin = time.monotonic()

    @property
    def unsaved(self):
        return sum(value != self.kept[number] for number, value in self.values.items())

    @property
    def known(self):
        return 3 if self.state in (RUN, STOP, COMMISSION) else 0

    def raise_fault(self, code):
        with self._lock:
            self._fail(code)

    def _fail(self, code):
        self.faults.insert(0, (self._now_ms(), code, self.state, self.speed))
        self.state, self.fault, self.guarded = FAULT, code, False

    def say(self, octets):
        self._line.write(octets)

    def _now_ms(self):
        return int((time.monotonic() - self._begin) * 1000)

    def _run(self):
        while not self._end.is_set():
            for item in self._splitter.feed(self._line.read(), time.monotonic()):
                if isinstance(item, Text):
                    self._console(item.octets)
                elif isinstance(item, Record):
                    self._answer(item)
            with self._lock:
                self._move()
        if self.dies:
            self._line.hang_up()

    def _console(self, octets):
        for octet in octets:
            self.watched = False
            if octet == 3:
                self.typed, self.interrupts = b"", self.interrupts + 1
                self._line.write(b"^C\r\n> " + self.tells)
            elif octet == 13:
                line, self.typed = self.typed, b""
                self._obey(line)
            else:
                self.typed += bytes((octet,))

    def _obey(self, line):
        if self.dies:
            self._end.set()  # and with it the port
            return
        self.lines.append(line.decode())
        self.refusals += line.startswith(b"refuse")
        self._line.write(line + b"\r\n" + b"heard " + line + b"\r\n> ")
        if line.startswith(b"start"):
            self.start(self.beside_text if line == b"start" else 0)
        self.watched = line == b"watch"

    def _start_if_ready(self, argument):
        if self.state != READY:
            raise RefusalError(STATE)
        if argument == 1:
            raise RefusalError(RANGE, "a guarded start needs the client's number")
        self.start(argument)

    def start(self, holder):
        self.state, self.guarded, self.holder, self._heard = self.begins, bool(holder & 1), holder, time.monotonic()

    def _move(self):
        now = time.monotonic()
        step, self._last = now - self._last, now
        ramp = self.values[86] / 2**8 * step
        target = self.set_point if self.state == RUN else 0.0
        self.reference += max(-ramp, min(ramp, target - self.reference))
        self.speed += (self.reference - self.speed) * min(1.0, step * 50)
        if self.state == 5 and abs(self.speed) < 2:
            self.state = READY
        if self.state == COMMISSION:
            self.progress = min(1000.0, self.progress + step * self.pace)
            if self.progress == 1000:
                self.state, self.outcome = READY, 3
        if self.guarded and self.state == RUN and now - self._heard > self.values[200] / 1000:
            self.state = 5
        self._tell()

    def _tell(self):
        now = time.monotonic()
        if self.watched and now - self._watched >= 0.02:
            self._watched = now
            self._line.write(b"speed 12.3 rpm\r\n")
        if self.stream and now - self._sent >= self.stream[0]:
            self._sent = now
            numbers = self._signals(self.stream[1])
            body = struct.pack(f"<I{len(numbers)}i", self._now_ms(), *numbers)
            left_out, self.missing = (self.missing, 0) if self.streamed else (0, self.missing)
            self.streamed = True
            self._counter = (self._counter + 1 + left_out) % 256
            self._line.write(to_wire(Record(0x40, self._counter, body + bytes((self.known,)))))

    def _signals(self, indices):
        values = {"state": self.state, "speed": self.speed, "speed_reference": self.reference, "link_voltage": 310.0}
        values |= {"angle": -0.25, "current_d": -1.5, "current_q": 2.0 if self.state == RUN else 0.0}
        values = {name: value if self.known or name not in ROTOR else 0.0 for name, value in values.items()}
        values["speed_known"] = self.known & 1
        if any(index >= len(SIGNALS) for index in indices):
            raise RefusalError(UNKNOWN)
        return [raw(values[SIGNALS[index][0]], SIGNALS[index][2]) for index in indices]

    def _answer(self, record):
        if record.kind in self.swallow:
            self.swallow.remove(record.kind)
            return
        with self._lock:
            try:
                body = bytes((OK,)) + self._request(record.kind, record.body)
            except RefusalError as error:
                body = bytes((error.status,)) + error.text.encode()
            except struct.error:
                body = bytes((LENGTH,))
        self.asked.append(record.kind)
        wire = to_wire(Record(record.kind | 0x80, record.tag, body))
        if record.kind in self.corrupt:
            self.corrupt.remove(record.kind)
            wire = wire[:2] + bytes((wire[2] ^ 1 or 2,)) + wire[3:]
        chatter, self.chatter = self.chatter, b""
        self._line.write(chatter + wire)

    def _request(self, kind, body):
        handler = getattr(self, f"_on_{kind:02x}", None)
        if handler is None:
            raise RefusalError(UNKNOWN)
        return handler(body)

    def _on_01(self, _):
        crc = zlib.crc32(repr((PARAMETERS, SIGNALS, self.version)).encode())
        head = struct.pack("<HHHHI", 1, len(PARAMETERS), len(SIGNALS), 16, crc)
        return head + self.version.encode() + b"\0ipm\0" + struct.pack("<IH", 0x1234ABCD, 1)

    def _on_02(self, body):
        (index,) = struct.unpack("<H", body)
        number, name, unit, q, decimals, low, high, initial, always, meaning = PARAMETERS[index]
        numbers = (raw(low, q), raw(high, q), raw(initial, q))
        return struct.pack("<HBBBBiii", number, q, decimals, always, 0, *numbers) + b"\0".join(
            word.encode() for word in (name, unit, meaning)
        )

    def _on_03(self, body):
        name, unit, q, meaning = SIGNALS[struct.unpack("<H", body)[0]]
        needs = 0x40 if name in ROTOR else 0
        return struct.pack("<B", q | needs) + b"\0".join(word.encode() for word in (name, unit, meaning))

    def _on_04(self, body):
        first, count = struct.unpack("<HB", body)
        numbers = [entry[0] for entry in PARAMETERS[first : first + count]]
        return b"".join(struct.pack("<Hi", number, self.values[number]) for number in numbers)

    def _on_05(self, body):
        (number,) = struct.unpack("<H", body)
        if number not in self.values:
            raise RefusalError(UNKNOWN)
        return struct.pack("<i", self.values[number])

    def _on_06(self, body):
        number, value = struct.unpack("<Hi", body)
        entry = next((entry for entry in PARAMETERS if entry[0] == number), None)
        if entry is None:
            raise RefusalError(UNKNOWN)
        if not raw(entry[5], entry[3]) <= value <= raw(entry[6], entry[3]):
            raise RefusalError(RANGE, f"{entry[1]} is out of range")
        if self.state == RUN and not entry[8]:
            raise RefusalError(RUNNING)
        if number == 164 and value < raw(50, 16) and self.state == RUN:
            raise RefusalError(CONFLICT, f"not taken while the drive runs: {CONFLICT_WORDS}")
        self.values[number] = value
        if self.values[164] < raw(50, 16):
            raise RefusalError(
                CONFLICT, "set, but the drive does not start with it: link_regulation must be above link_minimum"
            )
        if self.stubborn == number:
            raise RefusalError(BUSY)
        return struct.pack("<i", value)

    def _on_07(self, body):
        code, argument = struct.unpack("<Bi", body)
        if code == 1:
            self._start_if_ready(argument)
            if self.start_fault:
                self._fail(self.start_fault)
        elif code == 2 and self.state in (RUN, COMMISSION):
            self.outcome = 4 if self.state == COMMISSION else self.outcome
            self.state = 5
        elif code == 3 and self.state != FAULT:
            self.state, self.reference = READY, 0.0
        elif code == 4:
            self.state, self.fault = READY, 0
        elif code == 5:
            self.set_point = argument / 2**16
        elif code == 6:
            self._start_if_ready(argument)
            self.state, self.outcome, self.progress = COMMISSION, 1, 0
        elif code == 10:
            if self.state != READY:
                raise RefusalError(STATE)
            self.looked = self.seen
        elif code == 7:
            self.store = 5
            self.kept = dict(self.values)
        elif code == 8:
            self.values = {number: raw(initial, q) for number, _, _, q, _, _, _, initial, _, _ in PARAMETERS}
        return b""

    def _on_08(self, body):
        asker = int.from_bytes(body, "little")
        if asker:
            self.beside_text = asker
        if asker and asker == self.holder:
            self._heard = time.monotonic()
        speeds = (raw(self.speed, 16), raw(self.reference, 16))
        phase = 2 if self.state == COMMISSION else 0
        last = (self.outcome, phase, int(self.progress), self._link_flags(asker), self.known, self.unsaved)
        limits = 1 if self.state == RUN else 0
        return struct.pack(
            "<IBBHiiBBBBHBBB", self._now_ms(), self.state, self.fault, limits, *speeds, self.store, 0, *last
        )

    def _link_flags(self, asker):
        on = self.guarded and self.state in (RUN, COMMISSION)
        return on + 4 * (on and asker == self.holder)

    def _on_09(self, body):
        indices = struct.unpack(f"<{len(body) // 2}H", body)
        return struct.pack(f"<{len(indices)}iB", *self._signals(indices), self.known)

    def _on_0a(self, body):
        (age,) = struct.unpack("<B", body)
        if age >= len(self.faults):
            raise RefusalError(RANGE)
        at, code, state, speed = self.faults[age]
        numbers = (raw(speed, 16), raw(310, 16), raw(-1, 20), raw(3, 20))
        return struct.pack("<HIBBiiiiB", len(self.faults), at, code, state, *numbers, 3 if state in (RUN, STOP) else 0)

    def _on_0b(self, body):
        kind, code = struct.unpack("<BB", body)
        if kind not in WORDS or code >= len(WORDS[kind]):
            raise RefusalError(UNKNOWN)
        return WORDS[kind][code].encode()

    def _on_0c(self, _):
        return struct.pack("<9H", *([0] * 7), self.unsent, self.refusals)

    def _on_10(self, body):
        head = struct.unpack_from("<HHBBHiB", body)
        channels = [struct.unpack_from("<HB", body, 13 + 3 * at) for at in range(head[6])]
        self.setup = (*head, channels)
        return b""

    def _on_11(self, _):
        if not self.setup:
            raise RefusalError(STATE)
        return b""

    def _on_12(self, _):
        return struct.pack("<BHHI", self.scope, DEPTH, self.setup[1], self._now_ms())

    def _on_13(self, body):
        channel, offset, count = struct.unpack("<BHB", body)
        signal, shift = self.setup[7][channel]
        (value,) = self._signals([signal])
        words = [max(-32768, min(32767, (value >> shift) + at - self.setup[1])) for at in range(offset, offset + count)]
        return struct.pack(f"<{count}h", *words)

    def _on_14(self, _):
        return b""

    def _on_15(self, body):
        period, *indices = struct.unpack(f"<{len(body) // 2}H", body)
        self._signals(indices)
        self.stream = (period / 1000, indices) if period else None
        self.streamed = False
        return b""

    def _on_17(self, _):
        outcome, speed, words = self.looked
        return struct.pack("<Bi", outcome, raw(speed, 16)) + words.encode()

    def _on_16(self, body):
        (index,) = struct.unpack("<H", body)
        rows = [(6, raw(14, 20), raw(13.5, 20), 0), (8, raw(3300, 8), raw(5000, 8), 1)]
        return struct.pack("<HHiiB", len(rows), *rows[index])
