"""The image for the DSP without TI's tools: linker command files, boot code, stand-in link, message without cl2000."""

import json
import os
import re
import shutil
import subprocess
import sys
from fnmatch import fnmatch
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

from checks import command_files  # noqa: E402
from costs import chance_of_words, costs  # noqa: E402
from image import check, classes, features, hooks, link, ram_code, stack  # noqa: E402
from image.boot_code import instruction_words, read_boot_code  # noqa: E402
from image.command_file import read_command_file  # noqa: E402
from image.elf import read_object  # noqa: E402
from image.interrupts import dear_calls  # noqa: E402
from image.link import Pile, place  # noqa: E402
from image.ram_code import left_in_flash, marked  # noqa: E402
from image.resident import changed, kept, unresident  # noqa: E402
from image.sizes import object_words  # noqa: E402
from image.stack import build_graph, stack_depth  # noqa: E402

FLASH = "toolchain/c28x/f2808_flash.cmd"
FOLDERS = {f"libstillspin_{name}.a": name for name in ("control", "estimators", "firmware", "svpwm")} | {
    "libstillspin_hal.a": "hal/f2808",
    "libstillspin_qmath.a": "hal/qmath",
    "libstillspin_replay.a": "hal",
}


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
            "origin = 0x3FB000, length = 0x000FF8",
            "origin = 0x3FA800, length = 0x0017F8",
            "share memory",
        ),
        ("length = 0x000FF8", "length = 0x001000", "last 8 words"),
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


def compiled(tmp_path: Path, code: str) -> Path:
    """An object as the stand-in makes it."""
    source, target = tmp_path / "x.c", tmp_path / "x.obj"
    source.write_text(code, encoding="utf-8")
    cl2000 = ROOT / "toolchain/standin/bin/cl2000"
    run = [
        str(cl2000),
        "--compile_only",
        f"--c_file={source}",
        f"--include_path={ROOT}",
        f"--output_file={target}",
    ]
    subprocess.run(run, check=True)
    return target


def test_words_are_those_of_the_c28x(tmp_path: Path) -> None:
    code = """
#include <stdint.h>
uint16_t words[10];
int32_t longs[10];
bool flags[10];
char* pointers[10];
const char* text(void);
const char* text(void) { return "twelve chars"; }
"""
    words = object_words(read_object(compiled(tmp_path, "#include <stdbool.h>" + code)))
    assert words[".ebss"] == 10 + 20 + 10 + 20
    assert words["strings"] == 13


def test_undefined_symbol_and_overflow_are_seen(tmp_path: Path) -> None:
    code = "int nowhere(void);\nint big[7000];\nint f(void);\nint f(void) { return nowhere() + big[0]; }\n"
    pile = Pile([compiled(tmp_path, code)])
    assert "nowhere" in pile.missing()
    _, complaints = place(pile.words(), read_command_file(ROOT / FLASH))
    assert complaints == ["RAM_DATA takes 14000 words, there are 12288"]


def test_what_does_not_fit_the_sectors_of_an_update_goes_behind_the_resident_part() -> None:
    file = read_command_file(ROOT / FLASH)
    app, room = file.ranges["APP"].length, file.ranges["RESIDENT"].length
    fill, complaints = place({"resident": 100, "ramfuncs": 400, ".text": app - 600, ".econst": 1000}, file)
    assert (fill["APP"], fill["RESIDENT"], complaints) == (app, 900, [])
    _, complaints = place({"resident": 100, ".text": app, ".econst": room}, file)
    assert complaints == [f"RESIDENT takes {room + 100} words, there are {room}"]


@pytest.mark.parametrize(("limit", "complaints"), [(200, []), (199, ["lab, globals in RAM: 200, limit 199"])])
def test_figure_beyond_its_limit_is_caught_and_one_beyond_its_goal_is_short(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, limit: int, complaints: list[str]
) -> None:
    limits = tmp_path / "limits.txt"
    limits.write_text(f"# edition | key | goal | limit\nlab | globals | 100 | {limit}\nlab | stack | 10 | 10\n")
    monkeypatch.setattr(check, "LIMITS", limits)
    figures = {"globals": 200, "stack": 10}
    assert check.judged("lab", figures) == (
        ["lab, globals in RAM: 200, goal 100"],
        complaints,
    )
    assert check.judged("drive", figures) == ([], [])


def test_what_a_feature_takes_is_what_no_other_asks_for(tmp_path: Path) -> None:
    """What two features share is neither's; a word that an edition has beside the rest is found."""
    library, program = "stillspin_{}.dir/", "stillspin_f2808.dir/main.c.obj"
    codes = {
        program: "void loop(void);\nint main(void) { loop(); return 0; }",
        "stillspin_firmware.dir/boot/main.c.obj": "int both(void);\nvoid loop(void);\n"
        "void loop(void) { (void)both(); }",
        "stillspin_firmware.dir/hil/hil.c.obj": "int own(void);\nint shared(void);\nint f(void);\nint f(void) "
        "{ return own() + shared(); }",
        "stillspin_firmware.dir/store/store.c.obj": "int shared(void);\nint both(void);\nint g(void);\nint words[9];\n"
        "int g(void) { return both() + shared(); }",
        **{
            f"{library.format('control')}{name}.c.obj": f"int {name}(void);\nint {name}(void) {{ return {len(name)}; }}"
            for name in ("own", "shared", "both")
        },
    }
    linked = {Path("/build", name): read_object(compiled(tmp_path, code + "\n")) for name, code in codes.items()}
    rows = features.taken(linked, ["drive"])
    assert set(rows) == {(), ("hil",), ("store",), ("hil", "store")}
    assert features.shares(linked, ["drive"])[Path("/build/stillspin_control.dir/own.c.obj")] == ("hil",)
    assert features.shares(linked, ["drive"])[Path("/build/stillspin_control.dir/both.c.obj")] == ()
    assert rows[("store",)].ram == 18
    assert sum(words.flash for words in rows.values()) == pytest.approx(features.words_of(linked.values()).flash)
    less = {path: obj for path, obj in linked.items() if path.stem not in ("hil.c", "own.c")}
    assert features.difference(linked, less, ["hil"], rows).flash == pytest.approx(0)
    shared = {path: obj for path, obj in less.items() if path.stem != "shared.c"}
    assert features.difference(linked, shared, ["hil"], rows).flash == pytest.approx(-rows[("hil", "store")].flash)


def test_words_are_those_that_the_chip_is_expected_to_need() -> None:
    """Of the drive's code alone: TI's library and constants are what they are."""
    counted = {"code": 1900, "ram_code": 100, "library": 800, "flash": 3000, "globals": 500, "stack": 50}
    counted |= {"resident": 600, "resident_code": 500}
    figures = check.figures_of(counted | {"flash_room": 65328, "ram_code_room": 4088}, 1300)
    words = costs(ROOT)["words"]
    assert figures["flash_by_class"] == 1800 + 1300
    assert figures["flash_expected"] == round(1800 + words["expected"] * 1200)
    assert figures["flash_p90"] == round(1800 + words["expected"] * words["p90"] * 1200)
    assert figures["resident"] == round(100 + words["expected"] * 500)
    assert figures["resident"] + figures["update"] == pytest.approx(figures["flash_expected"], abs=1)
    assert check.budget(figures)["ram_words"] == 550 + round(words["expected"] * 100)
    assert chance_of_words(words, words["high"]) == pytest.approx(90)


def test_link_leaves_the_figures_that_are_judged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    code = "int image_identity;\nvoid control_isr(void);\nvoid control_isr(void) {}\n"
    code += "void window_isr(void);\nvoid window_isr(void) {}\nint main(void) { return 0; }\n"
    (tmp_path / "calls.txt").write_text("")
    monkeypatch.setattr(stack, "TABLE", tmp_path / "calls.txt")
    given = [compiled(tmp_path, code), ROOT / "hal/f2808/image/boot.asm", ROOT / FLASH]
    assert link.link([*map(str, given), f"--output_file={tmp_path / 'x.out'}"]) == 0
    linked = json.loads((tmp_path / "x.json").read_text(encoding="utf-8"))
    assert linked.pop("objects") == [str(tmp_path / "x.obj")]
    assert "libstillspin_qmath.a<qdiv.*>(.text) is not there" in linked.pop("kept")
    figures = check.figures_of(linked, 0)
    assert check.budget(figures)["flash_words_available"] == 65328
    assert set(check.WHAT) <= set(figures)
    assert figures["thumb"] == figures["code"] - 800 < 20


@pytest.mark.parametrize(
    ("mnemonic", "operands", "found"),
    [
        ("adds", "r0, r0, #1", "alu"),
        ("sub.w", "sp, sp, #8", "alu"),
        ("asrs", "r1, r0, #31", "shift"),
        ("movge.w", "r0, #1", "move"),
        ("uxth", "r0, r0", "move"),
        ("cmp.w", "r0, #1000", "compare"),
        ("itete", "ge", "conditional"),
        ("smull", "r0, r1, r2, r3", "long_product"),
        ("smlal", "r0, r1, r2, r3", "other"),
        ("sbcs.w", "r0, r1, r2", "other"),
        ("sdiv", "r0, r1, r2", "other"),
        ("bne.n", "10 <f+0x10>", "branch"),
        ("cbnz", "r0, 10 <f+0x10>", "branch"),
        ("bl", "0 <g>", "call"),
        ("blx", "r3", "call"),
        ("bx", "lr", "return"),
        ("bx", "r3", "branch"),
        ("push", "{r4, lr}", "multiple"),
        ("ldrd", "r0, r1, [sp]", "multiple"),
        ("ldr", "r0, [pc, #40]\t@ (3c <f+0x3c>)", "literal"),
        ("ldrsh.w", "r0, [r1, #14]", "load_near_16"),
        ("ldr", "r0, [r1]", "load_near_32"),
        ("ldr", "r0, [r1, #16]", "load_far_32"),
        ("ldr.w", "r0, [r1, #-4]!", "load_far_32"),
        ("ldrh.w", "r0, [r1, r2, lsl #1]", "load_indexed_16"),
        ("ldr", "r0, [sp, #4]", "load_stack_32"),
        ("strheq", "r0, [r1, #2]", "store_near_16"),
        ("str", "r0, [sp, #4]", "store_stack"),
    ],
)
def test_instructions_have_their_class(mnemonic: str, operands: str, found: str) -> None:
    assert classes.class_of(mnemonic, operands) == found
    assert found in costs(ROOT)["classes"]


def test_words_by_class_are_those_of_a_listing() -> None:
    listing = "\n".join(
        [
            *(
                "a.obj:     file format elf32-littlearm",
                "",
                "Disassembly of section .text.f:",
                "00000000 <f>:",
            ),
            *("   0:\tadds\tr0, #1", "   2:\tbx\tlr", "   4:\t.word\t0x00000000"),
        ]
    )
    counts = classes.counted(listing)
    assert counts == {"a.obj": {"function": 1, "alu": 1, "return": 1}}
    known = costs(ROOT)["classes"]
    assert classes.words(counts["a.obj"], known) == pytest.approx(known["for_size"] * (0.5 + 2.3 + 1.0))


def test_the_stand_ins_flags_are_those_that_the_costs_were_measured_with() -> None:
    """Words and cycles of the C28x are known for what clang makes with these; other flags would flatter the image."""
    loader = SourceFileLoader("cl2000", str(ROOT / "toolchain/standin/bin/cl2000"))
    spec = spec_from_loader(loader.name, loader)
    assert spec is not None
    module = module_from_spec(spec)
    loader.exec_module(module)
    flags = [flag for flag in module.CLANG if flag not in ("-include", str(module.STANDIN / "include.h"))]
    assert flags == [
        *(
            "--target=thumbv7m-none-eabi",
            "-mcpu=cortex-m3",
            "-std=c99",
            "-ffreestanding",
            "-Os",
            "-mno-movt",
        ),
        *(
            "-ffunction-sections",
            "-fdata-sections",
            "-fno-unwind-tables",
            "-fstack-usage",
        ),
        *(
            "-D__TI_COMPILER_VERSION__=22006000",
            "-D__TMS320C28XX__",
            "-D__TMS320C2000__",
        ),
        *("-Wall", "-Wextra", "-Wshadow", "-Wundef", "-Werror", "-Wno-unused-function"),
    ]
    assert module.SIZE == {
        "--opt_for_speed=0": ("-mllvm", "-inline-threshold=5"),
        "--opt_for_speed=1": (),
    }
    preset = (ROOT / "toolchain/c28x-cl2000.cmake").read_text(encoding="utf-8")
    assert "${C2000_FLAGS} --relaxed_ansi -O2 --opt_for_speed=0 --gen_func_subsections=on" in preset


@pytest.mark.parametrize(
    ("quotient", "complaints"),
    [
        ("int f(int a, int b) { return a / b; }", []),
        (
            "long long f(long long a, long long b) { return a / b; }",
            ["f, which an interrupt may run, calls __aeabi_ldivmod"],
        ),
        (
            "float f(float a, float b) { return a * b; }",
            ["f, which an interrupt may run, calls __aeabi_fmul"],
        ),
    ],
)
def test_a_dear_function_of_the_library_in_an_interrupt_is_caught(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    quotient: str,
    complaints: list[str],
) -> None:
    """Through a pointer that the table of indirect calls knows."""
    code = f"void control_isr(void);\nvoid window_isr(void);\n__attribute__((noinline)) {quotient}\n"
    code += "void (*hook)(void);\nvoid window_isr(void) { hook(); }\nvoid control_isr(void) {}\n"
    (tmp_path / "calls.txt").write_text("window_isr -> f\n")
    monkeypatch.setattr(stack, "TABLE", tmp_path / "calls.txt")
    assert dear_calls([read_object(compiled(tmp_path, code))]) == complaints


def resident(folder: Path, archive: str, code: str, name: str = "mtpa") -> tuple[Pile, list[str]]:
    """An archive of one object, and what of its resident part depends on anything else."""
    archived, member = folder / archive, folder / f"{name}.c.obj"
    compiled(folder, code).rename(member)
    archived.write_text(f"{member}\n")
    pile = Pile([archived])
    pile.objects += pile.archived
    return pile, unresident(pile.objects, read_command_file(ROOT / FLASH), ("resident", "ramfixed"))


LIBRARY = {"resident": 76 + 41 + 157, "quotients": 317, ".text": 209}  # the C start-up moves with main


def test_resident_part_is_of_the_floors_below_the_drive(tmp_path: Path) -> None:
    code = "int twice(int x);\nint twice(int x) { return 2 * x; }\n"
    file = read_command_file(ROOT / FLASH)
    for archive, name in (("qmath", "qdiv"), ("svpwm", "ripple"), ("control", "mtpa"), ("estimators", "axis")):
        pile, complaints = resident(tmp_path, f"libstillspin_{archive}.a", code, name)
        assert complaints == []
        own = sum(object_words(pile.objects[0]).values())
        assert pile.words(file) == LIBRARY | {"resident": LIBRARY["resident"] + own}
    pile, complaints = resident(tmp_path, "libstillspin_svpwm.a", code, "edges")
    assert complaints == []
    assert pile.words(file) == LIBRARY | {"ramfixed": sum(object_words(pile.objects[0]).values())}
    for archive, name in (("firmware", "mtpa"), ("estimators", "deviation_observer"), ("estimators", "flux_observer")):
        pile, _ = resident(tmp_path, f"libstillspin_{archive}.a", code, name)
        assert pile.words(file)["resident"] == LIBRARY["resident"]
    assert file.section_of("libstillspin_estimators.a", "inverse_inductance.c.obj", ".switch") == "resident"
    assert file.section_of("libstillspin_estimators.a", "inverse_inductance_tensor.c.obj", ".text") == ".text"


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
    assert changed({"lab": gone})[0] == "libstillspin_qmath.a<qdiv.*>(.text) is not there, and is to be resident"


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


def test_stack_of_modes_that_exclude_each_other(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    code = """
#define KEEP __attribute__((noinline))
void use(volatile int* p);
KEEP void use(volatile int* p) { p[0]++; }
KEEP static void large(void) { volatile int room[50]; use(room); }
KEEP static void small(void) { volatile int room[5]; use(room); }
int (*choice)(void);
void control_isr(void);
void window_isr(void);
void control_isr(void) { large(); }
void window_isr(void) { small(); }
int main(void) { small(); large(); return 0; }
"""
    objects = [read_object(compiled(tmp_path, code))]
    table = tmp_path / "calls.txt"
    monkeypatch.setattr(stack, "TABLE", table)

    def total(lines: str) -> int:
        table.write_text(lines)
        return stack_depth(objects).total

    one, other = "[one]\nlarge is not called\n", "[other]\nsmall is not called\n"
    assert total(one) + 90 <= total(other) < total("")
    assert total(one + other) == total(other)
    table.write_text("[one]\nnobody is not called\n")
    assert "calls.txt: nobody is no function" in stack_depth(objects).complaints
    table.write_text("large is sometimes called\n")
    assert "not understood: large is sometimes called" in "; ".join(stack_depth(objects).complaints)


STATES = """
#include <stddef.h>
#include "firmware/interfaces/state.h"
void by_step(struct drive* d);
void by_begin(struct drive* d, drive_state_t s);
extern const state_t start_state;
"""
LOOP = "int main(void) { drive_states[0]->step(NULL); return 0; }\nvoid control_isr(void);\nvoid window_isr(void);\n"
LOOP += "void control_isr(void) {}\nvoid window_isr(void) {}\n"
OWN = "void by_step(struct drive* d) { (void)d; }\n"
OWN += "void by_begin(struct drive* d, drive_state_t s) { (void)d, (void)s; }\n"


@pytest.mark.parametrize(
    ("calls", "complaints"),
    [
        ("main -> @drive_states.step", []),
        ("main -> @drive_states.stop", ["calls.txt: @drive_states.stop is no table"]),
        ("main -> @drive_status.step", ["calls.txt: @drive_status.step is no table"]),
        # What belongs to a feature that is not linked goes for nothing, what no feature has does not.
        ("main -> @drive_states.step\nhysteresis_step -> hal_tick", []),
        ("main -> @drive_states.step hysteresis_samples", []),
        (
            "main -> @drive_states.step hysteresis_sample",
            ["calls.txt: hysteresis_sample is no function"],
        ),
        ("main -> @drive_states.step\nhil_step is not called", []),
        (
            "main -> @drive_states.step\nhysteresis_stop -> hal_tick",
            ["calls.txt: hysteresis_stop is no function"],
        ),
        # A function of the tree that every edition has is missed.
        (
            "main -> @drive_states.step interlock_refusal",
            ["calls.txt: interlock_refusal is no function"],
        ),
    ],
)
def test_calls_through_a_pointer_follow_the_edition(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, calls: str, complaints: list[str]
) -> None:
    rows = "const state_t start_state = {by_begin, by_step, NULL, NULL};\n"
    tables = "const state_t* const drive_states[] = {&start_state, NULL};\n"
    objects = [read_object(compiled(tmp_path, STATES + own)) for own in (LOOP + OWN, rows, tables)]
    (tmp_path / "calls.txt").write_text(calls + "\n")
    monkeypatch.setattr(stack, "TABLE", tmp_path / "calls.txt")
    assert stack_depth(objects).complaints == complaints
    assert hooks.reached(objects, "drive_states.step") == {"by_step"}
    assert hooks.reached(objects, "drive_states.begin") == {"by_begin"}
    assert hooks.reached(objects, "drive_states.abandon") == set()


def test_stack_sees_frames_recursion_and_pointers(tmp_path: Path) -> None:
    code = """
#define KEEP __attribute__((noinline))
void use(volatile int* p);
void (*hook)(void);
KEEP void use(volatile int* p) { p[0]++; }
KEEP static void deep(void) { volatile int room[50]; use(room); }
KEEP void main_loop(int n);
KEEP void main_loop(int n) { deep(); if (n > 0) main_loop(n - 1); use(&n); }
KEEP static void by_pointer(void) { hook(); volatile int x; use(&x); }
int main(void) { main_loop(3); by_pointer(); return 0; }
"""
    objects = [read_object(compiled(tmp_path, code))]
    graph = build_graph(objects)
    assert graph.frames["deep"] >= 100 and graph.by_pointer == {"by_pointer"}
    complaints = "; ".join(stack_depth(objects).complaints)
    assert "recursion: main_loop > main_loop" in complaints
    assert "by_pointer calls through a pointer" in complaints


def test_missing_compiler_is_said_clearly(tmp_path: Path) -> None:
    cmake = shutil.which("cmake")
    assert cmake is not None
    environment = {key: value for key, value in os.environ.items() if key != "C2000_CG_ROOT"}
    command = [cmake, "--preset", "f2808", "-B", str(tmp_path)]
    run = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert run.returncode != 0
    assert "TI's compiler cl2000 is not there" in run.stderr and "C2000_CG_ROOT=" in run.stderr


RAM_CODE = """
#define RAM __attribute__((section("ramfuncs"), noinline))
void set_flash_timing(void);
int there(void);
"""


def test_what_is_listed_runs_from_ram(tmp_path: Path) -> None:
    text = (ROOT / FLASH).read_text(encoding="utf-8")
    listed = "ramfuncs  : { *(ramfuncs) liba.a<x.*>(.text:_f, .text:_gone) liba.a<absent.*>(.text:_f)"
    (tmp_path / "x.cmd").write_text(text.replace("ramfuncs  : { *(ramfuncs)", listed), encoding="utf-8")
    file = read_command_file(tmp_path / "x.cmd")
    code = "int f(int);\nint f(int x) { return x + 1; }\nint g(int);\nint g(int x) { return x + 2; }\n"
    obj = read_object(compiled(tmp_path, code), "liba.a")
    assert [ram_code.runs_from_ram(file, "liba.a", "x.obj", f".text.{name}") for name in "fg"] == [True, False]
    pile = Pile([])
    pile.objects = [obj]
    assert pile.words(file)["ramfuncs"] == pile.words(file)[".text"] - 209 == (pile.words()[".text"] - 800) // 2


def test_what_the_drives_list_names_exists() -> None:
    file = read_command_file(ROOT / FLASH)
    for archive, member, section in (
        each for p in file.placements if p.section in ram_code.SECTIONS for each in p.inputs
    ):
        folder = ROOT / FOLDERS[archive]
        sources = [path for path in folder.rglob("*.c") if fnmatch(path.name + ".obj", member)]
        name = section.removeprefix(".text").removeprefix(":_")
        texts = [path.read_text(encoding="utf-8") for path in sources]
        assert any(re.search(rf"^[a-z][^;{{]*\b{name}\([^;]*\{{", text, re.MULTILINE) for text in texts), (member, name)


def test_what_is_marked_to_run_from_ram_is_there(tmp_path: Path) -> None:
    drivers = marked(ROOT / "hal/f2808")
    assert {name for names in drivers.values() for name in names} == {"set_flash_timing"}
    code = RAM_CODE + "RAM void set_flash_timing(void) {}\nint there(void) { return 1; }\n"
    objects = [read_object(compiled(tmp_path, code))]
    assert left_in_flash(objects, {"x": {"set_flash_timing"}}) == []
    assert left_in_flash(objects, {"x": {"there"}}) == ["there is to run from RAM and is not in ramfuncs"]


def test_what_changes_the_flash_calls_nothing_there(tmp_path: Path) -> None:
    code = RAM_CODE + "RAM void set_flash_timing(void) { (void)there(); }\n"
    objects = [read_object(compiled(tmp_path, code))]
    assert left_in_flash(objects, {}) == ["x.obj changes the flash's timing and refers to there"]
