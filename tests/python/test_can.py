"""The CAN bus of the virtual drive: DBC against firmware, SLCAN adapter, a real python-can bus."""

from __future__ import annotations

import contextlib
import random
import re
import threading
import time
from pathlib import Path

import can
import pytest

from stillspin import can as drive_can
from stillspin import core
from stillspin.board.can_plug import SlcanPlug
from stillspin.board.desk import SLICE, Desk
from stillspin.board.pseudo_terminal import PseudoTerminal
from stillspin.board.slcan import ERROR, OK, Adapter, Frame
from stillspin.board.socketcan_plug import SocketcanPlug
from stillspin.errors import InputError
from stillspin.link.records import Record
from stillspin.link.segments import Joiner, split

ROOT = Path(__file__).resolve().parents[2]
native = core.load()
TABLE = {message["name"]: message for message in native.can_messages()}
UNKNOWN = "; 0 while SPEED_KNOWN of STATUS is 0"
BESIDE = {
    ("STATUS", "SPEED"): UNKNOWN,
    ("TELEMETRY_1", "LOAD_TORQUE"): UNKNOWN,
    ("TELEMETRY_1", "CURRENT_D"): f"{UNKNOWN}, except in STATE start",
    ("TELEMETRY_1", "CURRENT_Q"): f"{UNKNOWN}, except in STATE start",
}
"""What the DBC says of fields beside their meaning; that the firmware sends them so: test_can_unknown.py."""


@pytest.fixture
def board():
    made = native.VirtualBoard(plant={"solver": {"method": "rk4"}}, parameters={}, seed=1)
    yield made
    made.close()


# ---- DBC and the firmware's table


def test_dbc_has_the_messages_and_fields_of_the_firmware_and_no_others():
    bus = drive_can.database(1)
    assert {m.name for m in bus.messages} == set(TABLE)
    for message in bus.messages:
        ours = TABLE[message.name]
        assert message.frame_id == ours["base"] + 1
        assert not message.is_extended_frame
        assert message.length == ours["octets"]
        assert message.senders == [ours["sender"]]
        fields = {field["name"]: field for field in ours["fields"]}
        assert {signal.name for signal in message.signals} == set(fields)
        for signal in message.signals:
            field = fields[signal.name]
            assert (signal.start, signal.length) == (field["first"], field["bits"])
            assert signal.byte_order == "little_endian"
            assert signal.is_signed == field["signed"]
            assert signal.scale == 1 / field["per_unit"]
            assert (signal.unit or "") == field["unit"]
            assert signal.comment == field["meaning"] + BESIDE.get((message.name, signal.name), "")


def test_every_node_has_its_own_identifiers():
    seen = {}
    for node in drive_can.NODES:
        for message in drive_can.database(node).messages:
            assert seen.setdefault(message.frame_id, (node, message.name)) == (node, message.name)
            assert message.frame_id == TABLE[message.name]["base"] + node
    with pytest.raises(ValueError, match="1 to 31"):
        drive_can.database(32)


def _random_steps(field, source):
    least = -(1 << field["bits"] - 1) if field["signed"] else 0
    most = least + (1 << field["bits"]) - 1
    return source.choice((least, most, 0, source.randint(least, most), source.randint(least, most)))


@pytest.mark.parametrize("name", sorted(TABLE))
def test_both_pack_and_unpack_alike(name):
    source = random.Random(name)
    bus = drive_can.database(7)
    message = bus.get_message_by_name(name)
    fields = {field["name"]: field for field in TABLE[name]["fields"]}
    for _ in range(500):
        steps = {key: _random_steps(field, source) for key, field in fields.items()}
        identifier, packed = native.can_encode(name, 7, steps)
        assert identifier == message.frame_id
        physical = message.decode(packed, decode_choices=False)
        exact = {key: value / fields[key]["per_unit"] for key, value in steps.items()}
        assert physical == pytest.approx(exact, rel=1e-12, abs=0), "times 0.001 and over 1000 differ by a rounding"
        assert message.encode(physical, strict=False) == packed
        assert native.can_decode(name, message.encode(physical, strict=False)) == steps


def test_check_sum_is_the_firmwares():
    source = random.Random(1)
    for _ in range(200):
        data, identifier = source.randbytes(3), source.randrange(0x800)
        assert drive_can.crc8(identifier, data) == native.can_crc8(identifier, data)
    identifier, data = drive_can.command(drive_can.database(3), mode=2, speed=-123.25, alive=17)
    assert identifier == 0x103
    steps = native.can_decode("COMMAND", data)
    assert steps["SPEED"] == -493
    assert steps["ALIVE"] == 1
    assert steps["CRC"] == native.can_crc8(identifier, data[:3])


def test_words_of_states_and_faults_are_those_of_the_firmware():
    status = drive_can.database().get_message_by_name("STATUS")
    lists = "".join(path.read_text() for path in (ROOT / "firmware").rglob("fault_list.h"))
    faults = re.findall(r"^FAULT\((\d+), (\w+)", lists, re.MULTILINE)
    assert faults
    ours = {int(number): name.lower() for number, name in faults}
    assert {k: str(v) for k, v in status.get_signal_by_name("FAULT").choices.items()} == ours
    states = re.findall(r"DRIVE_(\w+) = (\d+)", (ROOT / "firmware/interfaces/state.h").read_text())
    ours = {int(number): name.lower() for name, number in states}
    assert {k: str(v) for k, v in status.get_signal_by_name("STATE").choices.items()} == ours


# ---- the adapter alone


class FakeBus:
    def __init__(self):
        self.rate, self.listens, self.sent = 0, False, []
        self.counts = {"waiting": 0, "transmit_errors": 0, "receive_errors": 0}

    def can_open(self, rate, listen_only=False):
        self.rate, self.listens = rate, listen_only

    def can_write(self, frame):
        self.sent.append(frame)

    def can_counts(self):
        return self.counts


@pytest.fixture
def adapter():
    return Adapter(FakeBus())


def _open(adapter):
    assert adapter.feed(b"S6\rO\r") == OK + OK
    return adapter._bus


def test_rates_and_opening(adapter):
    assert adapter.feed(b"O\r") == ERROR, "no rate yet"
    rates = [10, 20, 50, 100, 125, 250, 500, 750, 1000]
    for number, rate in enumerate(rates):
        assert adapter.feed(f"S{number}\rO\r".encode()) == OK + OK
        assert adapter._bus.rate == 1000 * rate
        assert adapter.feed(b"S6\rO\rC\r") == ERROR + ERROR + OK, "not while it is open"
        assert adapter._bus.rate == 0
    assert adapter.feed(b"C\r") == ERROR
    assert adapter.feed(b"s0014\rO\rC\r") == OK * 3, "BTR of 1 Mbit/s at 16 MHz"
    assert adapter.feed(b"s031C\rL\r") == OK * 2
    assert (adapter._bus.rate, adapter._bus.listens) == (125_000, True)
    assert adapter.feed(b"t1230\r") == ERROR, "it only listens"


def test_frames_out(adapter):
    bus = _open(adapter)
    assert adapter.feed(b"t1232AbcD\rT1FFFFFFF0\rr7FF4\rR000000018\r") == b"z\rZ\rz\rZ\r"
    assert bus.sent == [
        (0x123, False, False, 2, b"\xab\xcd"),
        (0x1FFFFFFF, True, False, 0, b""),
        (0x7FF, False, True, 4, b""),
        (0x1, True, True, 8, b""),
    ]


@pytest.mark.parametrize(
    "line",
    ["t", "t12", "t123", "t1239", "t1231", "t12314", "t1231456", "t8000", "T200000000", "t1z30", "t123 0", "x", "P",
     "W0", "M00000000", "U1", "Q1", "S9x", "s00", "O1", "V1", "tĀ"],
)  # fmt: skip
def test_what_is_wrong_is_answered_with_bel(adapter, line):
    bus = _open(adapter)
    assert adapter.feed(line.encode("utf-8") + b"\r") == ERROR
    assert bus.sent == []


def test_frames_in_with_and_without_a_stamp(adapter):
    frame = Frame(123_400_000_000, 0x12, False, False, 2, b"\x0a\xff")
    assert adapter.frame(frame) == b"", "closed"
    _open(adapter)
    assert adapter.frame(frame) == b"t01220AFF\r"
    assert adapter.frame(Frame(0, 0x1ABCDEF0, True, False, 0, b"")) == b"T1ABCDEF00\r"
    assert adapter.frame(Frame(0, 0x7FF, False, True, 5, b"")) == b"r7FF5\r"
    assert adapter.feed(b"Z1\r") == ERROR
    assert adapter.feed(b"C\rZ1\rO\r") == OK * 3
    assert adapter.frame(frame) == b"t01220AFF%04X\r" % (1_234_000 % 60_000)


def test_state_version_and_empty_lines(adapter):
    assert adapter.feed(b"F\r") == ERROR
    bus = _open(adapter)
    assert adapter.feed(b"\r\nV\rN\rF\r") == OK + b"V1013\rNSTSP\rF00\r"
    bus.counts["transmit_errors"] = 128
    assert adapter.feed(b"F\r") == b"FA4\r"


def test_any_octets_leave_the_adapter_usable():
    source = random.Random(5)
    lines = [b"S6", b"O", b"C", b"L", b"t1230", b"T00000001", b"F", b"V", b"Z1", b"t1238001122", b"s0014"]
    adapter = Adapter(FakeBus())
    for _ in range(20_000):
        octets = source.choice((source.randbytes(source.randrange(40)), source.choice(lines) + b"\r"))
        adapter.feed(octets)
    adapter.feed(b"\rC\r")
    assert adapter.feed(b"S6\rO\rt12311F\r") == OK + OK + b"z\r"
    assert adapter._bus.sent[-1] == (0x123, False, False, 1, b"\x1f")


# ---- the board and python-can


@contextlib.contextmanager
def _running(board):
    """The desk in a thread of its own, as fast as it goes but not faster than programs read."""
    desk = Desk(board, PseudoTerminal(), SlcanPlug(board, PseudoTerminal()))
    stop = threading.Event()

    def loop():
        while not stop.is_set():
            desk.step(SLICE)
            time.sleep(0.0005)

    thread = threading.Thread(target=loop)
    thread.start()
    try:
        yield desk
    finally:
        stop.set()
        thread.join()
        desk.can.close()
        desk.port.close()


def _bus(desk, **options):
    return can.Bus(interface="slcan", channel=desk.can.name, bitrate=500_000, sleep_after_open=0.1, **options)


def _wait_for(bus, identifier, seconds=20.0):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        message = bus.recv(0.5)
        if message is not None and message.arbitration_id == identifier:
            return message
    raise AssertionError(f"no frame {identifier:#x}")


def test_python_can_reads_status_that_cantools_decodes(board):
    messages = drive_can.database()
    with _running(board) as desk, _bus(desk) as bus:
        seen = {}
        for _ in range(400):
            message = bus.recv(2.0)
            assert message is not None
            seen[messages.get_message_by_frame_id(message.arbitration_id).name] = messages.decode_message(
                message.arbitration_id, message.data
            )
            if {"STATUS", "TELEMETRY_1", "TELEMETRY_2", "DIAGNOSTIC"} <= set(seen):
                break
        assert str(seen["STATUS"]["STATE"]) in {"ready", "calibrate"}
        assert seen["TELEMETRY_1"]["LINK_VOLTAGE"] == pytest.approx(300.0, abs=15.0)
        assert seen["DIAGNOSTIC"]["BUS_OFFS"] == 0
        assert bus.get_version(5.0) == (10, 13)


def test_python_can_reads_and_writes_a_parameter(board):
    messages = drive_can.database()
    request = messages.get_message_by_name("PARAMETER_REQUEST")
    with _running(board) as desk, _bus(desk) as bus:
        for operation, raw, expected in ((0, 0, 200), (1, 321, 321)):
            data = request.encode({"OPERATION": operation, "ID": 222, "RAW": raw})
            bus.send(can.Message(arbitration_id=request.frame_id, data=data, is_extended_id=False))
            answer = messages.decode_message(0x381, _wait_for(bus, 0x381).data)
            assert (answer["ID"], answer["RAW"], str(answer["STATUS"])) == (222, expected, "ok")


def test_python_can_carries_records(board):
    with _running(board) as desk, _bus(desk) as bus:
        for data in split(Record(0x01, 0x55, b"")):
            bus.send(can.Message(arbitration_id=0x401, data=data, is_extended_id=False))
        joiner = Joiner()
        record = None
        while record is None:
            record = joiner.feed(bytes(_wait_for(bus, 0x481).data))
        assert joiner.damaged == 0
        assert (record.kind, record.tag) == (0x81, 0x55)


def test_python_can_starts_and_stops_the_motor(board):
    messages = drive_can.database()
    alive = 0

    def say(bus, mode, speed, until):
        nonlocal alive
        end = time.monotonic() + 60
        while time.monotonic() < end:
            alive += 1
            identifier, data = drive_can.command(messages, mode=mode, speed=speed, alive=alive)
            bus.send(can.Message(arbitration_id=identifier, data=data, is_extended_id=False))
            while (message := bus.recv(0.002)) is not None:
                if message.arbitration_id == 0x181:
                    status = messages.decode_message(0x181, message.data)
                    if until(status):
                        return status
        raise AssertionError(f"never in mode {mode}: {status}")

    board.close()  # another, that waits longer: commands come in wall-clock time
    board = native.VirtualBoard(plant={"solver": {"method": "rk4"}}, parameters={"can_timeout": 5000.0}, seed=1)
    try:
        with _running(board) as desk, _bus(desk) as bus:
            say(bus, 0, 0, lambda s: str(s["STATE"]) == "ready")
            status = say(bus, 2, 300.0, lambda s: abs(s["SPEED"] - 300.0) < 15.0)
            assert str(status["STATE"]) == "run"
            assert status["COMMANDED"] == 1
            say(bus, 1, 0, lambda s: str(s["STATE"]) == "ready")
    finally:
        board.close()


def test_socketcan_where_the_kernel_has_it(board):
    if not Path("/sys/class/net/vcan0").exists():
        with pytest.raises(InputError, match="--socketcan vcan0"):
            SocketcanPlug(board, "vcan0")
        pytest.skip("this kernel has no interface vcan0: ip link add vcan0 type vcan")
    plug = SocketcanPlug(board, "vcan0")
    with can.Bus(interface="socketcan", channel="vcan0") as bus:
        for _ in range(100):
            board.advance(200_000)
            plug.hand_back()
        assert _wait_for(bus, 0x181, 2.0)
    plug.close()
