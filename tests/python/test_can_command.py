"""`stillspin can` on a bus in memory, and records over it."""

import threading

import can
import pytest

from stillspin.commands.can_bus import _DBC, Decoder, load
from stillspin.errors import InputError
from stillspin.link.can_bus import REQUEST, RESPONSE, CanTransport
from stillspin.link.errors import LinkError
from stillspin.link.records import Record
from stillspin.link.segments import Joiner, split


@pytest.fixture
def other():
    """The other end of a bus in memory."""
    with can.Bus(interface="virtual", channel="desk") as bus:
        yield bus


def message(identifier, data=b"", **options):
    return can.Message(arbitration_id=identifier, data=data, is_extended_id=False, timestamp=1.5, **options)


def test_every_message_of_the_description_is_decoded_for_every_node():
    database = load(_DBC)
    decoder = Decoder(database)
    for described in database.messages:
        for node in (1, 31):
            line = decoder.line(message((described.frame_id & ~0x7F) + node, bytes(described.length)))
            assert line.startswith(f"1.500  {(described.frame_id & ~0x7F) + node:03X}  node {node}  {described.name}  ")
            assert all(f"{signal.name} " in line for signal in described.signals if not signal.is_multiplexer)


def test_numbers_that_a_node_does_not_know_are_unknown_in_its_telemetry_too():
    """The flag is in STATUS alone; each node has its own, and a node that has said nothing yet knows nothing."""
    decoder = Decoder(load(_DBC))

    def status(node, known):
        return decoder.line(message(0x180 + node, bytes((2 | known << 7, 0, 0, 0, 40, 0, 0, 0))))

    def telemetry(node):
        return decoder.line(message(0x200 + node, bytes((100, 0, 0, 0, 0x10, 0x27, 0, 0))))

    unknown = "CURRENT_D unknown  CURRENT_Q unknown  LINK_VOLTAGE 100 V  LOAD_TORQUE unknown"
    known = "CURRENT_D 0.1 A  CURRENT_Q 0 A  LINK_VOLTAGE 100 V  LOAD_TORQUE 0 Nm"
    assert telemetry(1).endswith(unknown)
    assert status(1, known=True).endswith("SPEED 10 rpm  REFERENCE 0 rpm")
    assert telemetry(1).endswith(known)
    assert telemetry(2).endswith(unknown)
    assert status(2, known=False).endswith("SPEED unknown  REFERENCE 0 rpm")
    assert telemetry(1).endswith(known)
    assert status(1, known=False).endswith("SPEED unknown  REFERENCE 0 rpm")
    assert telemetry(1).endswith(unknown)


def test_currents_of_a_start_are_shown_though_the_rotor_is_not_known():
    """The state is each node's own, too, and with the start's end it is over."""
    decoder = Decoder(load(_DBC))

    def status(node, state):
        return decoder.line(message(0x180 + node, bytes((state, 0, 0, 0, 40, 0, 0, 0))))

    def telemetry(node):
        return decoder.line(message(0x200 + node, bytes((100, 0, 0, 0, 0x10, 0x27, 0, 0))))

    assert status(1, state=3).endswith("SPEED unknown  REFERENCE 0 rpm")
    assert telemetry(1).endswith("CURRENT_D 0.1 A  CURRENT_Q 0 A  LINK_VOLTAGE 100 V  LOAD_TORQUE unknown")
    assert "CURRENT_D unknown  CURRENT_Q unknown" in telemetry(2)
    for state in (2, 4, 6):
        assert status(1, state=3)
        assert status(1, state=state).endswith("SPEED unknown  REFERENCE 0 rpm")
        assert "CURRENT_D unknown  CURRENT_Q unknown" in telemetry(1)


def test_another_description_without_the_flag_is_decoded_as_it_stands(tmp_path):
    lines = _DBC.read_text(encoding="utf-8").splitlines()
    (tmp_path / "other.dbc").write_text("\n".join(line for line in lines if "SPEED_KNOWN" not in line))
    assert "SPEED 10 rpm" in Decoder(load(tmp_path / "other.dbc")).line(
        message(0x181, bytes((0, 0, 0, 0, 40, 0, 0, 0)))
    )


@pytest.mark.parametrize(
    ("frame", "line"),
    [
        (message(0x7FF, b"\x01\x02"), "1.500  7FF  01 02"),
        (message(0x181, b"\x01"), "1.500  181  node 1  STATUS  01 (not as the description says)"),
        (message(0x181, is_error_frame=True), "1.500  181  error frame"),
    ],
)
def test_what_the_description_does_not_know_is_shown_as_it_is(frame, line):
    assert Decoder(load(_DBC)).line(frame) == line


def test_a_description_that_cannot_be_read_is_said(tmp_path):
    (tmp_path / "x.dbc").write_text("nonsense")
    with pytest.raises(InputError, match="cannot be read"):
        load(tmp_path / "x.dbc")


def test_the_command_shows_the_bus(call, other):
    done = threading.Event()

    def talk() -> None:
        while not done.wait(0.05):
            other.send(message(0x182, bytes(8)))

    talker = threading.Thread(target=talk)
    talker.start()
    result = call("can", "can:virtual:desk?node=2", "--duration", "1")
    done.set()
    talker.join()
    assert result.exit_code == 0, result.stderr
    assert "182  node 2  STATUS  " in result.stdout
    assert "must be a CAN bus" in call("can", "/dev/ttyUSB0").stderr


def test_records_go_over_the_bus_in_pieces(other):
    transport = CanTransport("virtual", "desk", node=3)
    record = Record(0x06, 9, bytes(range(60)))
    transport.send(record)
    joiner, got = Joiner(), None
    while got is None:
        frame = other.recv(1)
        assert frame.arbitration_id == REQUEST + 3
        got = joiner.feed(bytes(frame.data))
    assert got == record
    for node in (4, 3):  # the first is somebody else's
        for data in split(Record(0x86, 9, bytes(node))):
            other.send(message(RESPONSE + node, data))
    items = []
    while not items:
        items = transport.receive(1.0)
    assert items == [Record(0x86, 9, bytes(3))]
    with pytest.raises(LinkError, match="console is on the serial port"):
        transport.send_text(b"help\r")
    transport.close()


def test_an_adapter_that_is_not_there_is_said():
    with pytest.raises(LinkError, match="there is no serial port /dev/none"):
        CanTransport("slcan", "/dev/none", 1)
    with pytest.raises(LinkError, match=r"there is no CAN interface can99"):
        CanTransport("socketcan", "can99", 1)
