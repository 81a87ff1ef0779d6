"""The wire: COBS, CRC, records among text and noise, pieces on CAN, addresses, what is said when a port fails."""

import errno
import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st
from serial import SerialException

from stillspin.errors import InputError
from stillspin.link import address, cobs
from stillspin.link.errors import LinkError
from stillspin.link.records import MAX_BODY, MAX_ENCODED, Record, RecordError, crc16, from_cobs, pack, to_wire, unpack
from stillspin.link.segments import Joiner, split
from stillspin.link.serial_port import SerialTransport, explain
from stillspin.link.splitter import REST, Damaged, Splitter, Text

octets = st.integers(0, 255)
bodies = st.binary(max_size=MAX_BODY)
records = st.builds(Record, octets, octets, bodies)
# No zero, nothing that ends a line of noise in between: what a console prints.
texts = st.binary(min_size=1, max_size=80).map(lambda data: bytes(0x20 + octet % 0x5F for octet in data))


def test_the_crc_is_the_one_that_the_catalogue_names():
    assert crc16(b"123456789") == 0x29B1


@pytest.mark.parametrize(
    ("data", "encoded"),
    [
        (b"", b"\x01"),
        (b"\0", b"\x01\x01"),
        (b"\x11\x22\0\x33", b"\x03\x11\x22\x02\x33"),
        (bytes(range(1, 255)), b"\xff" + bytes(range(1, 255))),
        (bytes(range(255)), b"\x01\xff" + bytes(range(1, 255))),
        (bytes(range(1, 256)), b"\xff" + bytes(range(1, 255)) + b"\x02\xff"),
    ],
)
def test_cobs_of_the_published_examples(data, encoded):
    assert cobs.encode(data) == encoded
    assert cobs.decode(encoded) == data


@given(st.binary(max_size=1200))
def test_cobs_has_no_zero_and_comes_back(data):
    encoded = cobs.encode(data)
    assert 0 not in encoded
    assert len(encoded) <= len(data) + 1 + len(data) // 254
    assert cobs.decode(encoded) == data


@given(st.binary(max_size=300))
def test_cobs_decodes_or_refuses(data):
    try:
        decoded = cobs.decode(data)
    except cobs.CobsError:
        return
    assert cobs.decode(cobs.encode(decoded)) == decoded


@given(records)
def test_a_record_comes_back_and_fits(record):
    wire = to_wire(record)
    assert wire[0] == wire[-1] == 0
    assert len(wire) - 2 <= MAX_ENCODED
    assert from_cobs(wire[1:-1]) == record


@given(records, st.integers(0, 7), st.data())
def test_one_wrong_bit_is_seen(record, bit, data):
    packed = bytearray(pack(record))
    packed[data.draw(st.integers(0, len(packed) - 1))] ^= 1 << bit
    with pytest.raises(RecordError):
        unpack(bytes(packed))


def test_a_body_that_is_too_long_is_refused():
    with pytest.raises(RecordError, match="241 octets; 240 fit"):
        pack(Record(1, 1, bytes(241)))


def chunks(stream, cuts):
    edges = sorted({0, len(stream), *(cut % (len(stream) + 1) for cut in cuts)})
    return [stream[low:high] for low, high in itertools.pairwise(edges)]


def feed(splitter, parts):
    return [item for part in parts for item in splitter.feed(part, 0.0)]


def text_of(items):
    return b"".join(item.octets for item in items if isinstance(item, Text))


cut_points = st.lists(st.integers(0, 10**6), max_size=12)


@given(st.lists(st.one_of(records, texts), max_size=8), cut_points)
def test_text_and_records_are_told_apart_however_they_are_cut(sent, cuts):
    stream = b"".join(to_wire(item) if isinstance(item, Record) else item for item in sent)
    items = feed(Splitter(), chunks(stream, cuts))
    assert [item for item in items if isinstance(item, Record)] == [item for item in sent if isinstance(item, Record)]
    assert text_of(items) == b"".join(item for item in sent if not isinstance(item, Record))
    assert not [item for item in items if isinstance(item, Damaged)]


@given(st.lists(st.tuples(st.binary(max_size=600), records), min_size=1, max_size=5), cut_points)
def test_every_whole_record_is_found_behind_any_noise(sent, cuts):
    stream = b"".join(noise + to_wire(record) for noise, record in sent)
    found = [item for item in feed(Splitter(), chunks(stream, cuts)) if isinstance(item, Record)]
    assert [item for item in found if item in [record for _, record in sent]] == [record for _, record in sent]


@given(st.binary(max_size=2000), cut_points)
def test_no_octet_is_lost_silently(noise, cuts):
    splitter = Splitter()
    items = feed(splitter, chunks(noise, cuts)) + splitter.feed(b"", 1.0)
    shown = b"".join(item.octets if isinstance(item, Text | Damaged) else to_wire(item)[1:-1] for item in items)
    assert shown == noise.replace(b"\0", b"")


def test_a_record_that_rests_is_given_up_only_when_nothing_is_there():
    wire = to_wire(Record(1, 2, b"abc"))
    splitter = Splitter()
    assert splitter.feed(wire[:4], 0.0) == []
    assert splitter.feed(wire[4:], 10 * REST) == [Record(1, 2, b"abc")]  # the reader was late, the octets were not
    assert splitter.feed(wire[:4], 0.0) == []
    (damaged,) = splitter.feed(b"", 2 * REST)
    assert isinstance(damaged, Damaged)
    assert splitter.feed(b"> ", 3 * REST) == [Text(b"> ")]


def test_text_between_a_damaged_record_and_the_next_is_shown():
    wire = bytearray(to_wire(Record(1, 2, b"abc")))
    wire[3] ^= 0x10
    items = Splitter().feed(bytes(wire) + b"ready\r\n" + to_wire(Record(3, 4)), 0.0)
    assert [type(item) for item in items] == [Damaged, Text, Record]
    assert text_of(items) == b"ready\r\n"


@given(st.lists(records, min_size=1, max_size=4))
def test_records_come_back_from_pieces(sent):
    joiner = Joiner()
    pieces = [piece for record in sent for piece in split(record)]
    assert all(1 <= len(piece) <= 8 for piece in pieces)
    assert [record for piece in pieces if (record := joiner.feed(piece))] == sent
    assert joiner.damaged == 0


def test_a_record_that_never_ends_is_dropped():
    joiner = Joiner()
    first, *_ = split(Record(1, 2, bytes(MAX_BODY)))
    assert joiner.feed(first) is None
    for number in range(1, 200):  # each with the right number, none the last
        assert joiner.feed(bytes((number % 64,)) + bytes(7)) is None
    assert joiner.damaged == 1
    (whole,) = split(Record(3, 4))
    assert joiner.feed(whole) == Record(3, 4)


@given(records, records, st.data())
def test_a_lost_piece_costs_one_record_and_is_counted(first, second, data):
    pieces = list(split(first))
    lost = data.draw(st.integers(0, len(pieces) - 1))
    del pieces[lost]
    joiner = Joiner()
    found = [record for piece in (*pieces, *split(second)) if (record := joiner.feed(piece))]
    assert found == [second]
    assert joiner.damaged == (1 if lost else 0)  # without its first piece a record was never begun


@given(st.lists(st.binary(max_size=8), max_size=40), records)
def test_any_frames_leave_the_joiner_usable(frames, record):
    joiner = Joiner()
    for frame in frames:
        joiner.feed(frame)
    assert [found for piece in split(record) if (found := joiner.feed(piece))] == [record]


@pytest.mark.parametrize(
    ("text", "channel", "options"),
    [
        ("/dev/ttyUSB0", "/dev/ttyUSB0", {"baud": 115200}),
        ("COM3", "COM3", {"baud": 115200}),
        ("serial:///dev/ttyUSB0?baud=57600", "/dev/ttyUSB0", {"baud": 57600}),
        ("serial://COM3", "COM3", {"baud": 115200}),
        ("can:slcan:/dev/ttyACM0?node=3", "/dev/ttyACM0", {"node": 3, "bitrate": 500000}),
        ("virtual:", "bench", {"speed": 1}),
        ("virtual:ideal?speed=0", "ideal", {"speed": 0}),
        ("can:socketcan:can0?bitrate=1000000", "can0", {"node": 1, "bitrate": 1000000}),
    ],
)
def test_addresses(text, channel, options):
    parsed = address.parse(text)
    assert (parsed.channel, parsed.options) == (channel, options)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "must be like serial:///dev/ttyUSB0"),
        ("usb:///dev/ttyUSB0", "must be like serial:///dev/ttyUSB0"),
        ("serial://", "names no port"),
        ("serial:///dev/ttyUSB0?bautd=9600", "no option 'bautd'; did you mean 'baud'"),
        ("serial:///dev/ttyUSB0?baud=fast", "baud: 'fast' is no number; 0 … ∞"),
        ("can:slcan", "must be like"),
        ("can:slcan:/dev/ttyACM0?node=32", "node must be 1 … 31"),
    ],
)
def test_what_is_no_address(text, said):
    with pytest.raises(InputError, match=said):
        address.parse(text)


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (OSError(errno.EBUSY, "busy"), "in use by another program"),
        (OSError(errno.EACCES, "denied"), "group dialout"),
        (OSError(errno.ENOTTY, "not a terminal"), "is no serial port"),
        (
            SerialException(f"could not open port 'COM3': {PermissionError(13, 'Access is denied.')!r}"),
            "in use by another",
        ),
        (
            SerialException(f"could not open port 'COM3': {FileNotFoundError(2, 'No such file')!r}"),
            "there is no serial port",
        ),
        (OSError(errno.EIO, "Input/output error"), "cannot be opened: Input/output error"),
    ],
)
def test_why_a_port_cannot_be_opened(tmp_path, error, said):
    port = tmp_path / "port"
    port.touch()
    assert said in explain(str(port), error)


def test_a_port_that_is_not_there_or_no_port(tmp_path):
    with pytest.raises(LinkError, match=r"there is no serial port /dev/none; there (is|are) "):
        SerialTransport("/dev/none")
    (tmp_path / "file").touch()
    with pytest.raises(LinkError, match="is no serial port"):
        SerialTransport(str(tmp_path / "file"))
