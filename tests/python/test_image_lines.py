"""Source lines: what the assembler says of its programs, what line programs of DWARF say, who names lines by them."""

import re
import struct

import pytest
from c28x_chip import PROGRAMS, linked_file, parts_of
from flash_files import coff
from in_process import stillspin
from test_image_time import symbol, with_symbols

from stillspin.c28x import linked, timed
from stillspin.c28x.program import assemble_files
from stillspin.errors import InputError
from stillspin.flash import coff_lines, debug_lines, names
from stillspin.flash.debug_head import Strings
from stillspin.flash.debug_lines import Lines, Row, Source
from stillspin.flash.program import Block


@pytest.fixture(scope="module")
def control():
    return assemble_files([PROGRAMS / "control.asm"])


def test_every_instruction_has_the_line_that_it_was_written_on(control):
    written = {name: (PROGRAMS / name).read_text().splitlines() for name in parts_of("control")}
    assert {line.file for line in control.lines.values()} == set(written)
    for label, address in control.labels.items():
        if address in control.lines:
            line = control.lines[address]
            assert written[line.file][line.number - 1].startswith(f"{label}:")


def test_lines_survive_the_file(control, tmp_path):
    there = names.read(linked_file(tmp_path, "control"))
    assert {address: there.lines.at(address) for address in control.lines} == {
        address: Source(line.file, line.number) for address, line in control.lines.items()
    }
    first = control.symbols["SAMPLE"]
    assert there.lines.at(max(control.words)) == there.lines.at(max(control.lines)), "IRET is the last word"
    assert there.lines.at(max(control.words) + 1) is None, "behind the code there is no line"
    assert there.lines.at(0x8000) is None
    assert there.functions[first] == "sample"
    assert there.addresses["REF"] == 0x8000, "what the program tells others"
    assert "PERIOD" not in there.addresses


def test_places_are_typed_as_names_lines_and_addresses(control, tmp_path):
    there = names.read(linked_file(tmp_path, "control"))
    line = control.lines[control.symbols["SAMPLE"]]
    for typed in ("sample", f"control.asm:{line.number}", hex(control.symbols["SAMPLE"])):
        assert there.address(typed, "--from") == control.symbols["SAMPLE"]
    for typed in ("simple", "control.asm:1", "other.asm:70"):
        with pytest.raises(InputError, match="--from"):
            there.address(typed, "--from")
    assert there.place(control.symbols["SAMPLE"] + 1).endswith(f" sample+1 (control.asm:{line.number + 1})")


# ---- line programs of others, by hand


def unit(opcodes, *, version=3, step=1, base=-5, span=14, count=13, folders=("src",), files=(("main.c", 1),)):
    """A unit of .debug_line; `count` is the first special opcode."""
    lengths = bytes((0, 1, 1, 1, 1, 0, 0, 0, 1, 0, 0, 1))[: count - 1]
    table = b"".join(name.encode() + b"\0" for name in folders) + b"\0"
    table += b"".join(name.encode() + b"\0" + bytes((folder, 0, 0)) for name, folder in files) + b"\0"
    operations = b"\1" if version >= 4 else b""
    head = bytes((step,)) + operations + struct.pack("<BbBB", 1, base, span, count) + lengths + table
    body = struct.pack("<HI", version, len(head)) + head + opcodes
    return struct.pack("<I", len(body)) + body


def at(address):
    return b"\0\5\2" + struct.pack("<I", address)


END = b"\0\1\1"


@pytest.mark.parametrize("version", [2, 3, 4])
def test_opcodes_do_what_the_standard_says(version):
    special = 13 + (2 - -5) + 14 * 3  # line + 2, address + 3
    opcodes = (
        at(0x3F4000) + b"\3\x09\1" + bytes((special,)) + b"\x08" + b"\3\x7f\1" + b"\x09\x10\x00\1" + b"\2\x04" + END
    )
    lines = debug_lines.read(unit(opcodes, version=version))
    expected = {0x3F4000: 10, 0x3F4003: 12, 0x3F4003 + (255 - 13) // 14: 11, 0x3F4003 + 17 + 16: 11}
    assert {address: lines.at(address).number for address in expected} == expected
    assert lines.at(0x3F4002).number == 10
    assert str(lines.at(0x3F4000)) == "src/main.c:10"
    assert lines.at(0x3F4003 + 17 + 16 + 4) is None
    assert lines.places("main.c", 12) == [0x3F4003]
    assert lines.places("ain.c", 12) == []


def test_paths_of_windows_are_written_and_found_with_slashes():
    """Most who have TI's compiler have it there."""
    lines = debug_lines.read(unit(at(0x100) + b"\1" + END, folders=("C:\\drive\\src",), files=(("..\\main.c", 1),)))
    assert str(lines.at(0x100)) == "C:/drive/src/../main.c:1"
    assert lines.places("main.c", 1) == lines.places("..\\main.c", 1) == [0x100]
    absolute = debug_lines.read(unit(at(0x100) + b"\1" + END, files=(("C:\\main.c", 1),)))
    assert str(absolute.at(0x100)) == "C:/main.c:1"


def test_steps_of_instructions_files_and_unknown_opcodes():
    opcodes = at(0x100) + b"\5\x07\x06\x04\2\1" + b"\2\3\4\1\x03\1\1" + b"\0\3\x80\1\1" + END
    lines = debug_lines.read(unit(opcodes, step=2, files=(("a.c", 0), ("b.c", 1))))
    assert str(lines.at(0x100)) == "src/b.c:1"
    assert str(lines.at(0x106)) == "a.c:2"


def described(opcodes, forms=(0x1F, 0x0B), *, files=((0, "main.c"), (1, "part.c")), extra=b"", strings=None):
    """A unit of DWARF 5 and its .debug_line_str, which has the paths where their form says so."""
    kept = bytearray(strings or b"")

    def path(text):
        if forms[0] == 0x08:
            return text.encode() + b"\0"
        kept.extend(text.encode() + b"\0")
        return struct.pack("<I", len(kept) - len(text) - 1)

    folders = b"\1\1" + bytes((forms[0],)) + b"\2" + path("/home/build") + path("src")
    table = b"\3\1" + bytes((forms[0],)) + b"\2" + bytes((forms[1],)) + b"\5\x1e" + bytes((len(files),))
    for folder, name in files:
        table += path(name) + folder.to_bytes({0x0B: 1, 0x05: 2, 0x0F: 1}[forms[1]], "little") + bytes(range(16))
    lengths = bytes((0, 1, 1, 1, 1, 0, 0, 0, 1, 0, 0, 1))
    head = struct.pack("<BBBbBB", 1, 1, 1, -5, 14, 13) + lengths + folders + table
    body = struct.pack("<HBBI", 5, 4, 0, len(head)) + head + extra + opcodes
    return struct.pack("<I", len(body)) + body, bytes(kept)


@pytest.mark.parametrize("forms", [(0x1F, 0x0B), (0x1F, 0x05), (0x0E, 0x0F), (0x08, 0x0F)])
def test_dwarf_5_describes_its_lists_and_counts_files_from_0(forms):
    section, strings = described(at(0x3F4000) + b"\3\x09\1" + b"\4\0\2\2\1" + END, forms)
    kept = Strings(of_all=strings) if forms[0] == 0x0E else Strings(of_lines=strings)
    lines = debug_lines.read(section, kept)
    assert str(lines.at(0x3F4000)) == "src/part.c:10", "the second, as in every version the first one is number 1"
    assert str(lines.at(0x3F4002)) == "main.c:10", "in the compilation's own folder"


def test_dwarf_5_that_is_damaged_is_left_out():
    good = unit(at(0x10) + b"\1\2\4" + END)
    section, strings = described(at(0x20) + b"\1\2\4" + END)
    for bad in (section[:12] + b"\xff" + section[13:], described(at(0x20) + b"\1" + END, (0x55, 0x0B))[0]):
        assert debug_lines.read(bad + good, Strings(strings)).at(0x10) is not None
    assert debug_lines.read(section + good, Strings()).at(0x20) is None, "its strings are missing"
    assert debug_lines.read(section + good, Strings(strings)).at(0x10) is not None


def test_damaged_and_unknown_units_are_left_out():
    good = unit(at(0x10) + b"\1\2\4" + END)
    for bad in (unit(at(0x20) + b"\1" + END, version=6), unit(b"\0\x05\2\0"), struct.pack("<I", 3) + b"\3\0\1"):
        assert debug_lines.read(bad + good).at(0x10) is not None
        assert debug_lines.read(good + bad).at(0x20) is None
    assert not debug_lines.read(struct.pack("<I", 0xFFFFFFFF) + bytes(40))
    assert not debug_lines.read(good[:-8])


def test_a_range_of_no_lines_is_damage():
    assert not debug_lines.read(unit(at(0x100) + b"\x20" + END, span=0))


def test_an_end_gives_way_to_a_beginning():
    one, two = Source("a.c", 1), Source("b.c", 2)
    lines = Lines([Row(0x10, one), Row(0x20, None), Row(0x20, two), Row(0x30, None)])
    assert [lines.at(address) for address in (0x0F, 0x10, 0x20, 0x30)] == [None, one, two, None]


def test_lines_add_up():
    lines = Lines([Row(0x10, Source("a.c", 1)), Row(0x12, Source("a.c", 2)), Row(0x14, None)])
    spent = {0x10: (1, 0, 0, 0), 0x11: (4, 1, 1, 1), 0x12: (9, 0, 0, 8), 0x14: (100, 0, 0, 0)}
    assert timed.by_line(lines, spent) == [(Source("a.c", 2), (9, 0, 0, 8)), (Source("a.c", 1), (5, 1, 1, 1))]


# ---- in COFF


@pytest.mark.parametrize("wide", [False, True])
def test_coff_has_them_packed_or_an_octet_to_a_word(tmp_path, control, wide):
    """Sizes in words are read as well."""
    section = linked.debug_lines(control)
    section += bytes(len(section) % 2)
    octets = b"".join(bytes((octet, 0)) for octet in section) if wide else section
    blocks = [Block(first, tuple(words)) for first, words in linked.runs(control.words)]
    strings = bytearray()
    data = with_symbols(coff(blocks), [symbol("sample", control.symbols["SAMPLE"], strings=strings)], strings)
    file = tmp_path / "control.out"
    file.write_bytes(with_section(data, ".debug_line", octets))
    there = names.read(file)
    line = control.lines[control.symbols["SAMPLE"]]
    assert there.lines.at(control.symbols["SAMPLE"]) == Source(line.file, line.number)
    assert "sample" in there.functions.values()


def test_a_section_of_coff_that_counts_octets_has_nothing_of_what_is_behind_it(tmp_path, control):
    """So do those that cl2000 links, one right behind the other."""
    section = linked.debug_lines(control)
    behind = unit(at(0x3F4002) + b"\3\x09\1\2\x04" + END)  # as another section's octets might be read
    data = coff([Block(first, tuple(words)) for first, words in linked.runs(control.words)])
    file = tmp_path / "control.out"
    file.write_bytes(with_section(data, ".debug_line", section + behind + b"\xff" * len(section), size=len(section)))
    lines = names.read(file).lines
    assert all(lines.at(address) == Source(*line) for address, line in control.lines.items())


def with_section(data, name, octets, size=None):
    """The COFF file with one section more, whose content and name are behind all, and its head behind the others."""
    _, count, _, table, symbols, optional, _, _ = struct.unpack_from("<HHIIIHHH", data)
    heads = 22 + optional + 48 * count
    moved = 48
    raw = len(data) + moved
    size = size or len(octets) // 2
    head = struct.pack("<8sIIIIIIIIIHH", struct.pack("<II", 0, 0), 0, 0, size, raw, 0, 0, 0, 0, 0x10, 0, 0)
    out = bytearray(data[:heads] + head + data[heads:])
    struct.pack_into("<H", out, 2, count + 1)
    struct.pack_into("<I", out, 8, table + moved)
    for index in range(count):
        at_ = 22 + optional + 48 * index + 20
        (where,) = struct.unpack_from("<I", out, at_)
        struct.pack_into("<I", out, at_, where + moved if where else 0)
    strings = table + moved + 18 * symbols
    out += octets
    place = len(out) - strings
    out += name.encode() + b"\0"
    struct.pack_into("<II", out, heads, 0, place)
    return bytes(out)


def more(octets):
    return octets + bytes(18 - len(octets))


def with_line_numbers(data, section, entries):
    """The COFF file with a table of line numbers of a section, by its place, behind all."""
    out = bytearray(data)
    (optional,) = struct.unpack_from("<H", data, 16)
    at_ = 22 + optional + 48 * section
    struct.pack_into("<I", out, at_ + 28, len(data))
    struct.pack_into("<I", out, at_ + 36, len(entries))
    return bytes(out) + b"".join(struct.pack("<IH", *entry) for entry in entries)


def function(name, address, line, strings):
    return symbol(name, address, more=1, strings=strings) + (
        symbol(".bf", address, kind=101, more=0)[:17] + b"\1" + more(struct.pack("<IH", 0, line))
    )


def test_coff_s_own_line_numbers(tmp_path):
    """Blocks of a function each, whose numbers count from the line of its .bf; two files."""
    strings = bytearray()
    entries = [
        symbol(".file", 0, kind=103, more=0)[:17] + b"\1" + more(b"first.c"),
        function("_one", 0x3F4000, 10, strings),
        function("_two", 0x3F4010, 30, strings),
        symbol(".file", 0, kind=103, more=0)[:17] + b"\1" + more(b"second.c"),
        function("_three", 0x3F4020, 5, strings),
    ]
    data = with_symbols(coff([Block(0x3F4000, (0x7700,) * 64)]), entries, strings)
    numbers = [(2, 0), (0x3F4002, 2), (0x3F4006, 7), (6, 0), (0x3F4018, 3), (12, 0), (0x3F4024, 2)]
    file = tmp_path / "own.out"
    file.write_bytes(with_line_numbers(data, 2, numbers))
    lines = names.read(file).lines
    expected = {
        **{0x3F4000: "first.c:10", 0x3F4001: "first.c:10", 0x3F4002: "first.c:11", 0x3F4006: "first.c:16"},
        **{0x3F4010: "first.c:30", 0x3F4018: "first.c:32", 0x3F4020: "second.c:5", 0x3F4025: "second.c:6"},
    }
    assert {address: str(lines.at(address)) for address in expected} == expected
    assert lines.at(0x3F4040) is None
    assert lines.places("second.c", 6) == [0x3F4024]


def test_line_numbers_without_their_function_are_left_out():
    strings = bytearray()
    data = with_symbols(coff([Block(0x3F4000, (0x7700,) * 64)]), [symbol("_main", 0x3F4000)], strings)
    assert not coff_lines.read(data)
    lines = coff_lines.read(with_line_numbers(data, 2, [(0x3F4002, 2), (99, 0), (0x3F4004, 1)]))
    assert lines.at(0x3F4002) is None
    with pytest.raises(struct.error):
        coff_lines.read(with_line_numbers(data, 2, [(0, 0)])[:30])


# ---- the commands


def run_command(*words):
    return stillspin("image", *words)


def test_image_time_says_what_lines_took(tmp_path):
    image = tmp_path / "control.out"
    made = run_command("assemble", PROGRAMS / "control.asm", "--out", image)
    assert made.exit_code == 0, made.stderr
    done = run_command("time", image, "--after", "0.02", "--for", "0.002", "--lines", "3")
    assert done.exit_code == 0, done.stderr
    rows = [line for line in done.stdout.splitlines() if line.startswith("control.asm:")]
    assert len(rows) == 3
    assert "more (--lines)" in done.stdout
    texts = (PROGRAMS / "control.asm").read_text().splitlines()
    waiting = {int(row.split()[0].split(":")[1]) for row in rows}
    assert all("SCIRXST" in texts[number - 1] or "beside,NTC" in texts[number - 1] for number in waiting)


def test_image_time_says_what_lines_took_of_an_interrupt(tmp_path):
    image = linked_file(tmp_path, "control")
    done = run_command("time", image, "--after", "0.02", "--for", "0.002", "--lines", "100")
    each = re.findall(r"(?m)^    (\S+) +([\d.]+)   of each in the mean$", done.stdout)
    functions, lines = ({name: float(took) for name, took in part} for part in (each[:2], each[2:]))
    # Of the table: a cycle each, but LCR's 4 and IRET's 8; LRETR's 4.
    own = {"sample": 20 + 4 + 8, "law": 5 + 4}
    # LAST is read two instructions behind its write, ADCTRL2 two behind that of CMPA.
    data = {"sample": 2 + 2, "law": 0}
    # Where the flash is entered its line of four words comes after 3 waits, the next ones 4 cycles after each other:
    # they are late by what the words before took less.
    fetches = {"sample": (3 + 3 + 1) + (3 + 1 + 2 + 2), "law": 3 + 3 + 1}
    assert functions == {name: own[name] + data[name] + fetches[name] for name in own}
    assert sum(lines.values()) == sum(functions.values())
    returns = (PROGRAMS / "sampled.asm").read_text().splitlines().index("        IRET") + 1
    assert max(lines, key=lines.get) == f"sampled.asm:{returns}"


def test_assembling_says_what_is_wrong_and_where(tmp_path):
    source = tmp_path / "wrong.asm"
    source.write_text(" .org 0x3F4000\nstart: NOP\n FROB AL\n")
    done = run_command("assemble", source, "--out", tmp_path / "x.out")
    assert done.exit_code == 2
    assert "wrong.asm, line 3" in done.stderr
    source.write_text(' .copy "wrong.asm"\n')
    assert "copies itself" in run_command("assemble", source, "--out", tmp_path / "x.out").stderr
    source.write_text(" .org 0x3F4000\n NOP\n")
    none = run_command("assemble", tmp_path / "none.asm", "--out", tmp_path / "x.out")
    assert none.stderr == f"stillspin: {tmp_path / 'none.asm'}: cannot be read (No such file or directory)\n"
    assert "no label 'start'" in run_command("assemble", source, "--out", tmp_path / "x.out").stderr
