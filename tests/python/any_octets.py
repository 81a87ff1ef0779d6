"""What must hold whatever octets come: the SLCAN adapter of the virtual board, and the client's readers.

Each function takes any octets and raises an AssertionError when something does not hold. test_any_octets.py tries a few
hundred with Hypothesis, `make fuzz` many (tests/fuzz/client_fuzz.py).
"""

import contextlib

from stillspin.board.slcan import ERROR, Adapter, Frame
from stillspin.drive.describe import unpack as unpack_body
from stillspin.drive.state import RawFault, RawStatus
from stillspin.drive.stream import Stream
from stillspin.link.errors import DriveError
from stillspin.link.records import MAX_BODY, MAX_ENCODED, Record, to_wire
from stillspin.link.segments import Joiner, split
from stillspin.link.splitter import REST, Damaged, Splitter, Text

WHOLE = Record(0x88, 0x5A, bytes(range(40)))


class LegalBus:
    """A CAN controller that takes nothing that a controller cannot."""

    def __init__(self):
        self.rate = 0
        self.listens = False
        self.frames = []

    def can_open(self, rate, listen_only=False):
        assert rate == 0 or 0 < rate <= 1_000_000, rate
        self.rate, self.listens = rate, listen_only

    def can_write(self, frame):
        identifier, extended, remote, length, data = frame
        assert self.rate, "a frame from a closed channel"
        assert not self.listens, "a frame from one that only listens"
        assert 0 <= identifier <= (0x1FFFFFFF if extended else 0x7FF)
        assert 0 <= length <= 8
        assert len(data) == (0 if remote else length)
        self.frames.append(frame)

    def can_counts(self):
        return {"waiting": 0, "transmit_errors": 130, "receive_errors": 3}


def slcan(octets):
    """Every command is answered, however the octets are cut; afterwards the adapter works as ever."""
    at_once, bus = LegalBus(), LegalBus()
    answers = Adapter(at_once).feed(octets)
    adapter = Adapter(bus)
    middle = len(octets) // 2
    assert adapter.feed(octets[:middle]) + adapter.feed(octets[middle:]) == answers
    assert bus.frames == at_once.frames
    assert answers.count(b"\r") + answers.count(ERROR) == octets.count(b"\r")
    assert adapter.refused == answers.count(ERROR)
    heard = adapter.frame(Frame(0, 0x123, False, False, 2, b"\xab\xcd"))
    assert (heard != b"") == adapter.is_open == bool(bus.rate)
    adapter.feed(b"\rC\r")
    bus.frames.clear()
    assert adapter.feed(b"S6\rO\rt1232AABB\r") == b"\r\rz\r"
    assert bus.rate == 500_000
    assert bus.frames == [(0x123, False, False, 2, b"\xaa\xbb")]


def splitter(octets):
    """Nothing is dropped silently, memory stays bounded, and a whole record behind it all is found."""
    reader = Splitter()
    items = reader.feed(octets, 0.0)
    assert len(reader._pending) <= MAX_ENCODED
    items += reader.feed(b"", 2 * REST)
    shown = b"".join(item.octets if isinstance(item, Text | Damaged) else to_wire(item)[1:-1] for item in items)
    assert shown == octets.replace(b"\0", b"")
    assert reader.feed(to_wire(WHOLE), 2 * REST)[-1:] == [WHOLE]


def joiner(octets):
    """Frames of any length and content: memory stays bounded, and a whole record behind them is joined."""
    reader = Joiner()
    at = 0
    while at < len(octets):
        length = octets[at] % 9
        record = reader.feed(octets[at + 1 : at + 1 + length])
        assert record is None or len(record.body) <= MAX_BODY
        at += 1 + length
    for piece in split(WHOLE):
        record = reader.feed(piece)
    assert record == WHOLE


def answers(octets):
    """What a drive answers may be anything: it is read or refused in words."""
    for read in (RawStatus.unpack, RawFault.unpack, lambda body: unpack_body("<BHHI", body)):
        with contextlib.suppress(DriveError):
            read(octets)


def events(octets):
    """An event of any kind and length is taken or left."""
    stream = Stream.__new__(Stream)
    stream.lost = 0
    stream._counter = None
    stream._form = "<I2iB"
    taken = []
    stream._put = lambda at, raw, known: taken.append((at, *raw, known))
    for kind in (0x40, 0x41):
        stream._take(Record(kind, len(octets) % 256, octets))
    assert len(taken) == (len(octets) == 13)


CHECKS = (slcan, splitter, joiner, answers, events)


def some_octets(random):
    """Octets that get further than those of pure chance: words of the protocols, cut, repeated and disturbed."""
    words = (
        *(b"S6\r", b"O\r", b"L\r", b"C\r", b"Z1\r", b"F\r", b"V\r", b"s031C\r", b"t12381122334455667788\r", b"t7FF0\r"),
        *(b"T1FFFFFFF1AA\r", b"r1234\r", b"R000000018\r", b"t1239", b"\r", b"\x07", b"\0", b"\0\0", b"x" * 40),
        *(to_wire(WHOLE), to_wire(Record(0x40, 1, bytes(13))), b"ready\r\n> ", *FRAMES),
    )
    out = bytearray()
    for _ in range(random.randrange(10)):
        kind = random.randrange(4)
        if kind == 0:
            out += random.randbytes(random.randrange(12))
        else:
            word = random.choice(words)
            out += word[: random.randrange(len(word)) + 1] if kind == 1 else word
    for _ in range(random.randrange(3) if out else 0):
        out[random.randrange(len(out))] = random.randrange(256)
    return bytes(out)


FRAMES = tuple(bytes((len(piece),)) + piece for piece in split(WHOLE))
