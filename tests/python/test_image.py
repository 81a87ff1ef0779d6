"""The image for the DSP without TI's tools: linker command files, boot code, resident part, message without cl2000."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from stand_in import FLASH, ROOT, compiled

sys.path.insert(0, str(ROOT / "toolchain"))

from checks import command_files
from image import link
from image.boot_code import instruction_words, read_boot_code
from image.command_file import read_command_file
from image.link import Pile
from image.resident import changed, kept, unresident
from image.sizes import object_words


@pytest.fixture
def house(tmp_path: Path) -> Path:
    """A tree with the linker command files and the table of the chip's memory."""
    for folder in ("toolchain/c28x", "toolchain/f2808"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    return tmp_path


def test_linker_command_files_keep_to_the_chip(house: Path) -> None:
    assert command_files.check(house) == []


@pytest.mark.parametrize(
    ("right", "wrong", "blamed"),
    [
        (
            "> ENTRY,     PAGE = 0",
            "> BOOT,      PAGE = 0",
            "codestart is not at 0x3F7FF6, where it is looked for",
        ),
        ("origin = 0x3F7FF6", "origin = 0x3F7FF8", "passwords"),
        (
            "length = 0x003F58",
            "length = 0x003F68",
            "RESIDENT reaches into the passwords",
        ),
        (
            ".econst   : >> APP | RESIDENT",
            ".econst   : > PASSWORDS",
            ".econst is placed on PASSWORDS",
        ),
        (
            ".econst   : >> APP | RESIDENT",
            ".econst   : >> APP | PASSWORDS",
            ".econst is placed on PASSWORDS",
        ),
        (
            ".text     : >> APP | RESIDENT",
            ".text     : >> APP | NOWHERE",
            "range that does not exist",
        ),
        (
            ".cinit    : > APP,       PAGE = 0",
            ".cinit    : > APP, fill = 0, PAGE = 0",
            "fill",
        ),
        (
            "origin = 0x3FABA8, length = 0x001450",
            "origin = 0x3FA600, length = 0x0019F8",
            "share memory",
        ),
        ("length = 0x001450", "length = 0x001458", "last 8 words"),
        ("length = 0x0003E8", "length = 0x0003F0", "last 8 words"),
        ("length = 0x0003E8", "length = 0x0004E8", "share memory"),
        ("length = 0x00BFB8", "length = 0x00CFB8", "share memory"),
        ("origin = 0x008000", "origin = 0x007000", "outside of memory"),
        ("--stack_size=0x400", "--stack_size=0x500", "stack"),
        ("origin = 0x000400, length = 0x000400", "origin = 0x3FA000, length = 0x000400", "stack"),
        ("RUN_START(_image_globals_start), ", "", "image_globals_start is not made"),
        ("  identity  : > IDENTITY,  PAGE = 0\n", "", "identity has no place"),
        (
            "identity  : > IDENTITY,",
            "identity  : > NOWHERE,",
            "range that does not exist",
        ),
    ],
)
def test_slip_in_a_linker_command_file_is_caught(house: Path, right: str, wrong: str, blamed: str) -> None:
    path = house / FLASH
    text = path.read_text(encoding="utf-8")
    assert right in text
    path.write_text(text.replace(right, wrong), encoding="utf-8")
    assert blamed in "; ".join(finding.message for finding in command_files.check(house))


def test_boot_code_fits_between_entry_and_passwords() -> None:
    code = read_boot_code(ROOT / "hal/f2808/image/boot.asm")
    ranges = read_command_file(ROOT / FLASH).ranges
    assert code.words["codestart"] == ranges["ENTRY"].length == 2
    assert code.words["appentry"] <= ranges["APP_ENTRY"].length
    assert code.wanted == {
        "c_int00",
        "image_identity",
        "image_globals_start",
        "image_globals_size",
    }


def test_boot_code_knows_the_same_mark_and_watchdog_as_the_drive() -> None:
    boot = (ROOT / "hal/f2808/image/boot.asm").read_text(encoding="utf-8")
    header = (ROOT / "hal/hal_image.h").read_text(encoding="utf-8")
    assert "IMAGE_MARK      .set    05AA5h" in boot and "#define HAL_IMAGE_MARK 0x5AA5u" in header
    registers = (ROOT / "hal/f2808/registers.h").read_text(encoding="utf-8")
    assert "#define REG_WDCR 0x7029uL" in registers and "MOV     @7029h, #0068h" in boot
    with pytest.raises(ValueError, match="unknown instruction"):
        instruction_words("RPT #7")


def test_undefined_symbol_and_overflow_are_seen(tmp_path: Path) -> None:
    code = "int nowhere(void);\nint big[7000];\nint f(void);\nint f(void) { return nowhere() + big[0]; }\n"
    pile = Pile([compiled(tmp_path, code)])
    assert "nowhere" in pile.missing()
    _, complaints = link.place(pile.words(), read_command_file(ROOT / FLASH))
    assert complaints == ["RAM_DATA takes 14000 words, there are 9896"]


def test_what_does_not_fit_the_sectors_of_an_update_goes_behind_the_resident_part() -> None:
    file = read_command_file(ROOT / FLASH)
    app, room = file.ranges["APP"].length, file.ranges["RESIDENT"].length
    fill, complaints = link.place({"resident": 100, "ramfuncs": 400, ".text": app - 600, ".econst": 1000}, file)
    assert (fill["APP"], fill["RESIDENT"], complaints) == (app, 900, [])
    _, complaints = link.place({"resident": 100, ".text": app, ".econst": room}, file)
    assert complaints == [f"RESIDENT takes {room + 100} words, there are {room}"]


def resident(folder: Path, archive: str, code: str, name: str = "mtpa") -> tuple[Pile, list[str]]:
    """An archive of one object, and what of its resident part depends on anything else."""
    archived, member = folder / archive, folder / f"{name}.c.obj"
    compiled(folder, code).rename(member)
    archived.write_text(f"{member}\n")
    pile = Pile([archived])
    pile.objects += pile.archived
    return pile, unresident(pile.objects, read_command_file(ROOT / FLASH), link.RESIDENT)


LIBRARY = {"resident": 76 + 41 + 157, "quotients": 317, ".text": 209}  # the C start-up moves with main


def test_resident_part_is_of_the_floors_below_the_drive(tmp_path: Path) -> None:
    code = "int twice(int x);\nint twice(int x) { return 2 * x; }\n"
    file = read_command_file(ROOT / FLASH)
    for archive, name in (("qmath", "qsqrt"), ("svpwm", "on_time"), ("control", "mtpa"), ("estimators", "axis")):
        pile, complaints = resident(tmp_path, f"libstillspin_{archive}.a", code, name)
        assert complaints == []
        own = sum(object_words(pile.objects[0]).values())
        assert pile.words(file) == LIBRARY | {"resident": LIBRARY["resident"] + own}
    for name, section in (("edges", "ramfixed"), ("ripple", "ramfixedh0")):
        pile, complaints = resident(tmp_path, "libstillspin_svpwm.a", code, name)
        assert complaints == []
        assert pile.words(file) == LIBRARY | {section: sum(object_words(pile.objects[0]).values())}
    for archive, name in (("firmware", "mtpa"), ("estimators", "deviation_observer"), ("estimators", "flux_observer")):
        pile, _ = resident(tmp_path, f"libstillspin_{archive}.a", code, name)
        assert pile.words(file)["resident"] == LIBRARY["resident"]
    assert file.section_of("libstillspin_estimators.a", "inverse_inductance.c.obj", ".switch") == "resident"
    assert file.section_of("libstillspin_estimators.a", "inverse_inductance_tensor.c.obj", ".text") == ".text"


def test_resident_part_is_linked_whole_whoever_uses_it() -> None:
    text = "".join(path.read_text(encoding="utf-8") for path in ROOT.glob("*/**/CMakeLists.txt"))
    members = {
        (archive.removeprefix("lib").removesuffix(".a"), member.removesuffix(".*"))
        for placement in read_command_file(ROOT / FLASH).placements
        if placement.section in link.RESIDENT
        for archive, member, _ in placement.inputs
        if not archive.startswith("rts2800")
    }
    assert ("stillspin_firmware", "crc") in members
    for library, name in members:
        alone = re.search(rf"stillspin_resident_sources\([^)]*/{name}\.c\b", text)
        assert alone or f"stillspin_resident({library})" in text, f"{name} of {library}"


def test_resident_part_that_is_not_the_same_in_all_images_is_caught(tmp_path: Path) -> None:
    """By another word, by a file more or less, by another order; and a file that no image has."""
    file = read_command_file(ROOT / FLASH)

    def image(*values: int) -> list[str]:
        objects = []
        for name, value in zip(("mtpa", "frame"), values, strict=False):
            code = f"int {name}(void);\nint {name}(void) {{ return {value}; }}\n"
            objects += resident(tmp_path, "libstillspin_control.a", code, name)[0].objects
        return [line for line in kept(objects, file, ("resident",)) if not line.endswith("is not there")]

    lab = image(1, 2)
    frame = "libstillspin_control.a<frame.c.obj>(.text.frame)"
    assert [line.rpartition(" ")[0] for line in lab] == [frame, frame.replace("frame", "mtpa")]
    assert changed({"lab": lab, "drive": image(1, 2)}) == []
    assert changed({"lab": lab, "drive": image(1)}) == [f"the resident part of drive has not {frame} as in lab"]
    assert changed({"lab": lab, "hil": image(1, 3)}) == [
        f"the resident part of hil has {frame} beside that of lab",
        f"the resident part of hil has not {frame} as in lab",
    ]
    order = ["the resident part of hil has another order than that of lab"]
    assert changed({"lab": lab, "hil": lab[::-1]}) == order
    gone = kept([], file, ("resident",))
    assert changed({"lab": gone})[0] == "libstillspin_qmath.a<qquotient.*>(.text) is not there, and is to be resident"


@pytest.mark.parametrize(
    ("code", "moved"),
    [
        ("int other(void);\nint f(void);\nint f(void) { return other(); }", "other"),
        ("int count;\nint f(void);\nint f(void) { return count++; }", "count"),
        ("static int calls;\nint f(void);\nint f(void) { return calls++; }", "calls"),
        (
            "extern const int table[4];\nint f(int k);\nint f(int k) { return table[k]; }",
            "table",
        ),
        (
            "int g(void);\nextern int (*const list[])(void);\nint (*const list[])(void) = {g};",
            "g",
        ),
    ],
)
def test_resident_part_that_depends_on_what_moves_is_caught(tmp_path: Path, code: str, moved: str) -> None:
    _, complaints = resident(tmp_path, "libstillspin_control.a", code)
    assert len(complaints) == 1
    assert complaints[0].startswith("mtpa.c.obj is resident and refers to ")
    assert moved in complaints[0]
    _, complaints = resident(tmp_path, "libstillspin_firmware.a", code)
    assert complaints == []


def test_resident_part_may_call_itself_read_its_tables_and_divide(
    tmp_path: Path,
) -> None:
    code = """
static const long table[] = {3, 1, 4, 1, 5};
__attribute__((noinline)) static long entry(unsigned k) { return table[k % 5u]; }
long long quotient(long long a, long long b);
long long quotient(long long a, long long b) { return a / b + entry((unsigned)a); }
"""
    _, complaints = resident(tmp_path, "libstillspin_control.a", code)
    assert complaints == []


def test_missing_compiler_is_said_clearly(tmp_path: Path) -> None:
    cmake = shutil.which("cmake")
    assert cmake is not None
    environment = {key: value for key, value in os.environ.items() if key != "C2000_CG_ROOT"}
    command = [cmake, "--preset", "f2808", "-B", str(tmp_path)]
    run = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert run.returncode != 0
    assert "TI's compiler cl2000 is not there" in run.stderr and "C2000_CG_ROOT=" in run.stderr
