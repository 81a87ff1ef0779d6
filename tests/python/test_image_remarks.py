"""What is said of a linked file before it goes anywhere near a chip: passwords, and values that nobody would set."""

import struct

import flash_files
import pytest
from c28x_chip import linked_file
from typer.testing import CliRunner

from stillspin import cli

BEGIN = " .org 0x3F7FF6\n LB start\n .org 0x3F4000\nstart: B start,UNC\n"
FIRST = 22 + 28
SECTION = 48
COPY = 0x10


def shown(file):
    done = CliRunner().invoke(cli.app, ["image", "show", str(file)])
    assert done.exit_code == 0
    return [line for line in done.stdout.splitlines() if line.startswith("warning: ")]


@pytest.fixture
def image(tmp_path):
    def make(words):
        source = tmp_path / "kept.asm"
        source.write_text(f"{BEGIN} .org 0x3F7FF8\n .word {', '.join(words)}\n")
        return linked_file(tmp_path, "kept", [source])

    return make


def test_words_that_lock_no_chip_are_not_spoken_of(image):
    assert shown(image(["0xFFFF"] * 8)) == []


def test_passwords_are_said(image):
    (said,) = shown(image(["0xFFFF"] * 7 + ["0x1234"]))
    assert said.startswith("warning: it has passwords at 0x3F7FF8 to 0x3F7FFF: a chip that gets them is locked ")


def test_what_locks_a_chip_for_ever_is_said(image):
    (said,) = shown(image(["0"] * 8))
    assert said == (
        "warning: the passwords at 0x3F7FF8 to 0x3F7FFF are all 0: in a chip they lock it for ever; leave them 0xFFFF"
    )


def test_a_run_says_it_too(image):
    done = CliRunner().invoke(cli.app, ["image", "time", str(image(["0"] * 8)), "--for", "0.0001"])
    assert "kept.out: the passwords at 0x3F7FF8 to 0x3F7FFF are all 0" in done.stdout


@pytest.mark.parametrize(("kind", "is_said"), [(0x40, False), (COPY | 0x40, True)], ids=["rom_model", "ram_model"])
def test_initial_values_that_a_debugger_would_load_are_said(tmp_path, kind, is_said):
    """cl2000 links them as a section to copy, which no flash gets, unless told --rom_model."""
    data = bytearray(flash_files.coff(flash_files.image_blocks(1)))
    at = FIRST + SECTION * 2
    struct.pack_into("<8s", data, at, b".cinit")
    struct.pack_into("<I", data, at + 40, kind)
    file = tmp_path / "values.out"
    file.write_bytes(data)
    said = [line for line in shown(file) if ".cinit" in line]
    assert len(said) == is_said
    assert all(line.endswith("from the flash they are not set: link with --rom_model") for line in said)


IN_RAM = f"{BEGIN} .org 0x9000\n .word 1, 2, 3\n"


@pytest.mark.parametrize(
    ("text", "is_said"),
    [(IN_RAM, True), (BEGIN, False), (" .org 0x8000\nstart: B start,UNC\n .word 1\n", False)],
    ids=["beside the flash", "flash alone", "RAM alone"],
)
def test_words_in_ram_that_only_a_debugger_loads_are_said(tmp_path, text, is_said):
    """The board has them from the file; a chip that starts from its flash has not."""
    source = tmp_path / "ram.asm"
    source.write_text(text)
    file = tmp_path / "ram.out"
    done = CliRunner().invoke(cli.app, ["image", "assemble", str(source), "--out", str(file)])
    assert done.exit_code == 0, done.output
    said = [line for line in shown(file) if "3 words in RAM that a debugger loads" in line]
    assert len(said) == is_said
    assert len(shown(file)) == is_said
