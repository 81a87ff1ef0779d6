"""Image files of every format, and what is refused before a board hears of it."""

from __future__ import annotations

import random
import subprocess
import sys
import zlib
from pathlib import Path

import flash_files as make
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from stillspin import cli
from stillspin.errors import InputError
from stillspin.flash import coff, image_sum
from stillspin.flash.files import drive_image, kernel_program, read_program
from stillspin.flash.layout import SECTORS, UPDATE
from stillspin.flash.program import Block

STAMP = Path(__file__).resolve().parents[2] / "toolchain" / "stamp_image.py"
IMAGE = make.image_blocks(1)
FORMATS = {
    "coff": make.coff(IMAGE),
    "hex": make.intel_hex(IMAGE),
    "ascii": make.boot_ascii(IMAGE, make.ENTRY),
    "binary": make.boot_binary(IMAGE, make.ENTRY),
}


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_gives_the_same_image(file, name):
    image = drive_image(file(FORMATS[name]))
    assert list(image.words) == make.cells(IMAGE)[: len(UPDATE)]
    assert image.resident == make.BOOT
    assert image.identity.text == "0.1.1 (commit c0ffee00, tables 56781234)"
    assert image.size == 4 * 8 + 22


@pytest.mark.parametrize("order", [1, -1])
def test_coff_section_that_runs_from_ram_is_loaded_to_the_flash(order):
    data = make.coff(IMAGE, heads_of=lambda address: (0x8000 + address % 0x4000, address)[::order])
    assert coff.read(data, "image").blocks == coff.read(FORMATS["coff"], "image").blocks


def test_coff_section_that_is_loaded_elsewhere_than_it_runs_has_its_load_address_second():
    blocks = [Block(0x9000, (1, 2, 3))]
    data = make.coff(blocks, heads_of=lambda address: (0x3FA000, address))
    assert [block.address for block in coff.read(data, "image").blocks] == [0x9000]


def test_words_of_hex_are_counted_as_hex2000_counts_them(file):
    # Word addresses, high octet first: 0x3E8002 has 0xDF98.
    program = read_program(file(b":02000004003EBC\n:04800200DF98000003\n:00000001FF\n"))
    assert program.blocks == (Block(0x3E8002, (0xDF98, 0x0000)),)


def test_check_sum_is_that_of_the_drives_link():
    words = (int.from_bytes(b"12345678"[k : k + 2], "little") for k in range(0, 8, 2))
    assert image_sum.crc_of(words) == 0x9AE0DAAF


def test_stamped_image_knows_its_words(file):
    data, end, crc = image_sum.stamp(FORMATS["coff"], "image")
    assert end == 0x3F4004  # the boot code's; boot entry and passwords are not in it
    words = make.cells(IMAGE)[: end - make.START]
    at = make.IDENTITY - make.START
    assert words[at + 12 : at + 14] == [0xFFFF, 0xFFFF]
    words[at + 10 : at + 12] = end & 0xFFFF, end >> 16
    assert crc == zlib.crc32(b"".join(map(make.word, words)))
    assert drive_image(file(data)).summed
    assert not drive_image(file(FORMATS["coff"])).summed
    assert image_sum.stamp(data, "image") == (data, end, crc)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(block=st.integers(0, len(IMAGE) - 2), word=st.integers(0, 200), bit=st.integers(0, 15))
def test_stamped_image_with_another_bit_is_refused(file, block, word, bit):
    program = coff.read(image_sum.stamp(FORMATS["coff"], "image")[0], "image")
    blocks = [Block(b.address, b.words) for b in program.blocks]
    old = blocks[block]
    word %= len(old.words)
    blocks[block] = Block(old.address, (*old.words[:word], old.words[word] ^ 1 << bit, *old.words[word + 1 :]))
    with pytest.raises(InputError):
        drive_image(file(make.intel_hex(blocks)))


def test_build_stamps_the_image(file):
    path = file(FORMATS["coff"])

    def build():
        return subprocess.run([sys.executable, STAMP, path], capture_output=True, text=True, check=False)

    first = build()
    assert first.returncode == 0
    assert first.stdout.startswith("program.out: CRC-32 0x")
    assert drive_image(path).summed
    path.write_bytes(make.coff([b for b in IMAGE if b.address != make.IDENTITY]))
    refused = build()
    assert refused.returncode == 2
    assert "no identity" in refused.stderr
    assert len(refused.stderr.splitlines()) == 1


def test_unsealed_piece_has_no_mark(file):
    image = drive_image(file(FORMATS["coff"]))
    d = SECTORS[0].words
    at = make.IDENTITY - d.start
    assert image.piece(d)[at] == make.MARK
    assert image.piece(d, sealed=False)[at] == make.ERASED
    assert image.piece(SECTORS[1].words, sealed=False) == image.piece(SECTORS[1].words)


WITHOUT_IDENTITY = [block for block in IMAGE if block.address != make.IDENTITY]
BAD = {
    "empty": (b"", "is empty; give an .out"),
    "library": (b"!<arch>\n" + bytes(60), "is a library, not a program; give the .out that was linked with it"),
    "s-records": (b"S00600004844521B\n", "has S-records; give Intel hex"),
    "words": (b"hello, this is no image\n" * 9, "has an unknown format"),
    "noise": (bytes(range(7, 256)) * 20, "has an unknown format"),
    "elf": (b"\x7fELF" + bytes(200), "ELF file"),
    "arm coff": (make.coff(IMAGE, target=0x0097), "for an ARM (TMS470) (0x0097), not for the C28x (0x009D): compile"),
    "object": (make.coff(IMAGE, flags=0x1101), "has not been linked"),
    "coff cut": (FORMATS["coff"][:-3], "is cut short"),
    "coff head": (FORMATS["coff"][:30], "is cut short"),
    "hex sum": (FORMATS["hex"].replace(b":10", b":10", 1).replace(b"5AA5", b"5AA4"), "wrong check sum"),
    "hex cut": (FORMATS["hex"][: FORMATS["hex"].index(b"\n", 200) - 4], "no Intel hex record"),
    "hex without end": (FORMATS["hex"][:-12], "is cut short"),
    "hex octets": (b":01800000126D\n", "half a word"),
    "hex segments": (b":020000021200EA\n", "record type 2"),
    "hex behind end": (FORMATS["hex"] + b":00000001FF\n", "after the end record"),
    "ascii cut": (FORMATS["ascii"][:-30], "is cut short"),
    "ascii garbage": (FORMATS["ascii"].replace(b"AA 08", b"AA XX", 1), "not all of it is hexadecimal"),
    "ascii key": (FORMATS["ascii"].replace(b"AA 08", b"AB 08", 1), "does not begin with the key"),
    "binary cut": (FORMATS["binary"][:-7], "is cut short"),
    "binary behind": (FORMATS["binary"] + b"more", "behind the end"),
    "twice": (make.intel_hex([*IMAGE, Block(0x3E8042, (1,))]), "twice; the file is damaged"),
    "nothing": (make.intel_hex([]), "nothing to load"),
    "ram": (make.coff([*IMAGE, Block(0x008000, (1,))]), "is not in the flash"),
    "otp": (make.coff([*IMAGE, Block(0x3D7800, (1,))]), "is not in the flash"),
    "F28335": (make.coff([Block(0x300000, (1,) * 40)]), "is not in the flash"),
    "over the end": (make.coff([*IMAGE, Block(0x3F7FFF, (0xFFFF, 1))]), "is not in the flash"),
    "passwords": (make.coff([*IMAGE, Block(0x3F7FF8, (0,) * 8)]), "passwords"),
    "security": (make.coff([*IMAGE, Block(0x3F7F80, (0,) * 0x76)]), "reserved for code security"),
    "no identity": (make.intel_hex(WITHOUT_IDENTITY), "no image of this drive"),
    "another format": (
        make.intel_hex([*WITHOUT_IDENTITY, Block(make.IDENTITY, (make.MARK, 9, *(0,) * 8))]),
        "no image of this drive",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_what_is_no_image_for_this_board_is_refused_in_one_line(file, name):
    content, blamed = BAD[name]
    path = file(content)
    with pytest.raises(InputError) as caught:
        drive_image(path)
    assert blamed in str(caught.value)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_any_octets_are_an_image_or_refused(file):
    noise = random.Random(3)
    right = drive_image(file(FORMATS["hex"]))
    for name, original in FORMATS.items():
        for _ in range(150):
            content = bytearray(original)
            for _ in range(noise.choice((1, 1, 3, 30))):
                content[noise.randrange(len(content))] = noise.randrange(256)
            try:
                image = drive_image(file(bytes(content)))
            except InputError:
                continue
            assert len(image.words) == len(UPDATE)
            if name == "hex":  # the one format with check sums
                assert image == right


KERNEL = make.kernel_blocks()


@pytest.mark.parametrize(
    ("content", "blamed"),
    [
        (make.boot_binary(IMAGE, make.ENTRY), "is not in the kernel's RAM"),
        (make.boot_binary([*KERNEL, Block(0x0480, (1,))], make.KERNEL_ENTRY), "is not in the kernel's RAM"),
        (make.boot_binary([*KERNEL, Block(0x8000, (1,))], make.KERNEL_ENTRY), "is not in the kernel's RAM"),
        (make.boot_binary([Block(0x3FA000, (1, 2))], 0x3FA000), "is no flash kernel"),
        (make.boot_binary(KERNEL, 0x3FB000), "entry point"),
        (make.intel_hex(KERNEL), "entry point"),
    ],
)
def test_what_is_no_kernel_is_refused(file, content, blamed):
    with pytest.raises(InputError, match=blamed):
        kernel_program(file(content))


def test_dry_run_says_what_would_be_done_and_needs_no_port(tmp_path):
    image, kernel = tmp_path / "image.out", tmp_path / "stillspin_flash_kernel.out"
    image.write_bytes(FORMATS["coff"])
    kernel.write_bytes(make.coff(KERNEL, make.KERNEL_ENTRY))
    done = CliRunner().invoke(cli.app, ["flash", str(image), "--dry-run"])
    assert done.exit_code == 0, done.output
    assert "0.1.1 (commit c0ffee00, tables 56781234), 54 words" in done.output
    assert "sector D: erase, then 72 words" in done.output
    assert "nothing was sent" in done.output


@pytest.mark.parametrize(
    ("arguments", "blamed"),
    [
        (["{image}"], "there is no flash kernel"),
        (["{image}", "--kernel", "{kernel}"], "no port is given"),
        (["{image}", "--kernel", "{kernel}", "--port", "can:slcan:/dev/x"], "must be a serial port"),
        (["{missing}", "--kernel", "{kernel}"], "cannot be read"),
        (["{kernel}", "--kernel", "{kernel}"], "is not in the flash"),
    ],
)
def test_bad_input_is_one_line_and_status_2(tmp_path, capsys, arguments, blamed):
    paths = {name: tmp_path / name for name in ("image", "kernel", "missing")}
    paths["image"].write_bytes(FORMATS["hex"])
    paths["kernel"].write_bytes(make.boot_ascii(KERNEL, make.KERNEL_ENTRY))
    with pytest.raises(SystemExit) as ended:
        cli.app(["flash", *(argument.format(**paths) for argument in arguments)])
    assert ended.value.code == 2
    complaint = capsys.readouterr().err
    assert blamed in complaint
    assert complaint.count("\n") == 1
