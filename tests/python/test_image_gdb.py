"""GDB's remote protocol, spoken by a small client: framing, registers, memory, breakpoints, steps, Ctrl-C."""

import contextlib
import itertools
import re
import socket
import subprocess
import sys
import threading
import xml.etree.ElementTree as ET

import pytest
from c28x_chip import linked_file
from in_process import stillspin

from stillspin.errors import InputError
from stillspin.image import gdb_target, opened
from stillspin.image.gdb import Remote
from stillspin.image.gdb_packets import Line, framed

PATIENCE = 20
CMPA = 0x6809


class Client:
    """Packets with acknowledgements, until it asks to do without."""

    def __init__(self, port):
        self.line = socket.create_connection(("127.0.0.1", port), PATIENCE)
        self.line.settimeout(PATIENCE)
        self.waiting = b""
        self.acknowledged = True

    def _octets(self, count):
        while len(self.waiting) < count:
            more = self.line.recv(4096)
            assert more, "hung up"
            self.waiting += more
        taken, self.waiting = self.waiting[:count], self.waiting[count:]
        return taken

    def send(self, text):
        self.line.sendall(b"$%s#%02x" % (text.encode(), sum(text.encode()) & 0xFF))
        if self.acknowledged:
            assert self._octets(1) == b"+"

    def answer(self):
        assert self._octets(1) == b"$"
        body = b""
        while (octet := self._octets(1)) != b"#":
            body += octet
        assert int(self._octets(2), 16) == sum(body) & 0xFF
        if self.acknowledged:
            self.line.sendall(b"+")
        return re.sub(rb"}(.)", lambda match: bytes((match[1][0] ^ 0x20,)), body, flags=re.DOTALL).decode("latin-1")

    def ask(self, text):
        self.send(text)
        return self.answer()

    def register(self, name):
        return gdb_target.value_of(self.ask(f"p{gdb_target.NAMES.index(name):x}"))

    def word(self, address):
        return gdb_target.value_of(self.ask(f"m{address:x},1"))


class Desk:
    """A board whose time passes where its debugger lets it, in a thread."""

    def __init__(self, file):
        image = opened.read(file)
        self.names = image.names
        self.board = opened.power_on(image, "bench", "A", 1)
        self.remote = Remote(self.board, image.names, 0)
        self.ends = threading.Event()
        self.thread = threading.Thread(target=self.run)
        self.thread.start()

    def run(self):
        while not self.ends.is_set():
            self.remote.poll(0.02)
            if self.remote.runs:
                self.board.advance(100_000)

    def close(self):
        self.ends.set()
        self.thread.join()
        self.remote.close()
        self.board.close()


@pytest.fixture(scope="module")
def desk(tmp_path_factory):
    made = Desk(linked_file(tmp_path_factory.mktemp("gdb"), "control"))
    yield made
    made.close()


@pytest.fixture
def client(desk):
    made = Client(desk.remote.port)
    yield made
    made.line.close()


@pytest.fixture
def at(desk):
    return desk.names.addresses


def test_the_program_waits_for_a_debugger_at_its_first_instruction(client, at):
    assert "qXfer:features:read+" in client.ask("qSupported:multiprocess+;swbreak+")
    assert client.ask("?") == "S05"
    assert client.register("PC") == 0x3F7FF6
    assert client.ask("vMustReplyEmpty") == ""
    assert client.ask(f"Z0,{at['sample']:x},2") == "OK"
    client.send("c")
    assert client.answer() == "S05"
    assert client.register("PC") == at["sample"], "a debugger that comes first finds the program at its beginning"


def test_the_description_has_every_register(client):
    text, offset = "", 0
    while True:
        piece = client.ask(f"qXfer:features:read:target.xml:{offset:x},100")
        text += piece[1:]
        offset += len(piece) - 1
        if piece[0] == "l":
            break
    rows = ET.fromstring(text).findall("feature/reg")
    assert [row.get("name").upper() for row in rows] == list(gdb_target.NAMES)
    assert sum(int(row.get("bitsize")) for row in rows) // 4 == len(client.ask("g"))


def test_a_breakpoint_stops_before_its_instruction_each_time(client, at):
    assert client.ask(f"Z1,{at['sample']:x},2") == "OK"
    counted = []
    for _ in range(3):
        assert client.ask("c") == "S05"
        assert client.register("PC") == at["sample"]
        counted.append(client.word(at["COUNT"]))
    assert counted == [counted[0] + k for k in range(3)], "an interrupt between two stops"
    assert client.ask(f"z1,{at['sample']:x},2") == "OK"


def test_a_word_that_is_written_stops_behind_its_instruction(client, at):
    assert client.ask(f"Z2,{at['COUNT']:x},1") == "OK"
    counted = []
    for _ in range(3):
        assert client.ask("c") == f"T05watch:{at['COUNT']:x};"
        counted.append((client.register("PC"), client.word(at["COUNT"])))
    assert client.ask("?") == f"T05watch:{at['COUNT']:x};"
    (place, first), *rest = counted
    assert at["sample"] < place < at["sample"] + 40
    assert rest == [(place, first + 1), (place, first + 2)], "once in each interrupt"
    assert client.ask(f"z2,{at['COUNT']:x},1") == "OK"
    assert client.ask("Z2,c000,1") == "E01", "the chip has no memory there"
    assert client.ask("Z5,8000,1") == "", "there is no such type"
    client.ask(f"Z0,{at['beside']:x},2")
    assert client.ask("c") == "S05"
    client.ask(f"z0,{at['beside']:x},2")


def stops(client, at, points, count):
    """What is told at so many stops: the way, the word's name, and the instruction before, by its offset."""
    names = {at[name]: name for name in ("COUNT", "REF", "LAST")} | {CMPA: "CMPA"}
    for point in points:
        assert client.ask("Z" + point) == "OK"
    told = []
    for _ in range(count):
        way, place = re.fullmatch(r"T05(\w+):([0-9a-f]+);", client.ask("c")).groups()
        told.append((way, names[int(place, 16)], client.register("PC") - at["sample"]))
    for point in points:
        assert client.ask("z" + point) == "OK"
    return told


def test_a_word_that_is_read_stops_behind_its_instruction(client, at):
    (told, *rest) = stops(client, at, [f"3,{at['REF']:x},1"], 3)
    assert told[:2] == ("rwatch", "REF")
    assert rest == [told] * 2, "once in each interrupt; nobody else reads it while no octet comes"


def test_a_word_that_is_read_or_written_stops_at_both(client, at):
    last = f"4,{at['LAST']:x},1"
    first, second, *rest = stops(client, at, [last], 4)
    assert {first[:2], second[:2]} == {("awatch", "LAST")}
    assert first != second, "written by one instruction, read by another"
    assert rest == [first, second]


def test_each_is_told_as_it_was_asked_for(client, at):
    told = stops(client, at, [f"2,{at['LAST']:x},1", f"3,{at['LAST']:x},1"], 2)
    assert {way for way, *_ in told} == {"watch", "rwatch"}


def test_a_write_of_what_is_there_already_is_one_and_a_register_may_be_watched(client, at):
    """The compare value stays 0 as long as the duty is: GDB itself leaves out what changes nothing."""
    told = stops(client, at, [f"2,{CMPA:x},1"], 2)
    assert {row[:2] for row in told} == {("watch", "CMPA")}
    assert told[0] == told[1]


def test_steps_go_through_the_code(client, at):
    client.ask(f"Z0,{at['sample']:x},2")
    client.ask("c")
    client.ask(f"z0,{at['sample']:x},2")
    places = [at["sample"]]
    for _ in range(4):
        assert client.ask("s" if len(places) % 2 else "vCont;s:1") == "S05"
        places.append(client.register("PC"))
    assert [after - before for before, after in itertools.pairwise(places)] == [1, 2, 1, 2]
    assert client.register("DP") == at["REF"] >> 6


def test_registers_and_memory_are_written(client, at):
    client.ask(f"Z0,{at['beside']:x},2")
    client.ask("c")
    before = client.ask("g")
    assert client.ask("P0=78563412") == "OK"
    assert client.register("ACC") == 0x12345678
    assert client.ask("G" + before) == "OK"
    assert client.ask("g") == before
    assert client.ask(f"M{at['REF']:x},2:34127856") == "OK"
    assert client.ask(f"m{at['REF']:x},2") == "34127856"
    assert client.word(at["LAST"]) == 0x5678
    assert client.ask("M6f8a,1:0000") == "E01", "a register is nothing that a probe loads"
    assert client.ask("m400000,1") == "E01"
    assert client.ask("p7f") == "E01"
    assert client.ask("P0=12") == "E01"
    client.ask(f"z0,{at['beside']:x},2")


def test_ctrl_c_stops_a_program_that_runs(client, at):
    client.send("c")
    client.line.sendall(b"\x03")
    assert client.answer() == "S02"
    first = client.word(at["COUNT"])
    assert at["main"] <= client.register("PC") <= at["sample"] + 39
    assert client.word(at["COUNT"]) == first, "its time stands"


def test_monitor_says_where_and_what_was_executed(client, at):
    def monitor(text):
        return bytes.fromhex(client.ask("qRcmd," + text.encode().hex())).decode()

    client.ask(f"Z0,{at['sample']:x},2")
    client.ask("c")
    monitor("trace 3")
    client.ask("s")
    client.ask("s")
    client.ask(f"z0,{at['sample']:x},2")
    assert re.search(r"sample\+3 \(control.asm:\d+\)", monitor("where"))
    assert "cycles" in monitor("cycles")
    traced = monitor("trace 0")
    assert traced.index("SETC SXM") < traced.index("MOVW DP,#0x2c")
    assert "where" in monitor("dance")


def test_without_acknowledgements(client):
    assert client.ask("QStartNoAckMode") == "OK"
    client.line.sendall(b"+")
    client.acknowledged = False
    assert client.ask("?") == "S05"
    assert client.ask("D") == "OK"


def test_a_port_in_use_is_said(desk):
    with pytest.raises(InputError, match="--gdb"):
        Remote(desk.board, desk.names, desk.remote.port)


def test_packets_come_in_pieces_and_broken():
    line = Line()
    whole = framed("m0,1") + b"\x03" + framed("X}#$*")
    packets = []
    for octet in whole:
        got, _ = line.take(bytes((octet,)))
        packets += got
    assert packets == ["m0,1", "\x03", "X}#$*"]
    assert Line().take(b"$g#00") == ([], b"-")
    assert Line().take(b"+$g#67") == (["g"], b"+")


def assembled(tmp_path, text):
    source = tmp_path / "trap.asm"
    source.write_text(text)
    return linked_file(tmp_path, "trap", [source])


@contextlib.contextmanager
def served(image):
    """A client of a program's board, in a process of its own."""
    command = [sys.executable, "-m", "stillspin", "board", "--image", image, "--gdb", "0", "--speed", "0", "--for", "1"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as process:
        try:
            client = Client(int(re.search(r"localhost:(\d+)", process.stdout.readline())[1]))
            yield client
            client.line.close()
        finally:
            process.terminate()
            process.wait(timeout=20)


def test_the_command_serves_the_control_program(tmp_path):
    image = linked_file(tmp_path, "control")
    at = opened.read(image).names.addresses
    with served(image) as client:
        client.ask(f"Z0,{at['sample']:x},2")
        for count in range(3):
            assert client.ask("c") == "S05"
            assert (client.register("PC"), client.word(at["COUNT"])) == (at["sample"], count)


def test_a_trap_instruction_stops_and_goes_on(tmp_path):
    text = " .org 0x3F7FF6\n LB start\n .org 0x3F4000\nstart: NOP\nhere: ESTOP0\n NOP\nstay: B stay,UNC\n"
    with served(assembled(tmp_path, text)) as client:
        assert client.ask("c") == "S05"
        assert client.register("PC") == 0x3F4001
        assert client.ask("s") == "S05"
        assert client.register("PC") == 0x3F4003, "behind it, and one instruction on"


ILLEGAL = """
        .org 0x3F7FF6
        LB start
        .org 0x3F4000
start:  NOP
lost:   .word 0x0000
stay:   B stay,UNC
        .org 0x66
        NOP
again:  B again,UNC
"""


@pytest.mark.parametrize(("go_on", "behind"), [("s", 0x66), ("c", 0x67)])
def test_what_is_no_instruction_stops_before_it_traps(tmp_path, go_on, behind):
    with served(assembled(tmp_path, ILLEGAL)) as client:
        assert client.ask("c") == "S04"
        assert client.register("PC") == 0x3F4001
        assert client.ask("?") == "S04"
        client.ask("Z0,67,1")
        assert client.ask(go_on) == "S05"
        assert client.register("PC") == behind, "the routine of vector 19, which the boot ROM sends there"


def test_gdb_goes_with_an_image_alone():
    done = stillspin("board", "--gdb", "0")
    assert done.exit_code == 2
    assert "--gdb" in done.stderr
