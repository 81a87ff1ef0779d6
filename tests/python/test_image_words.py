"""Words of the image: what the stand-in counts, by class, what the chip is expected to need of them, limits."""

import json
import sys
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

import pytest
from stand_in import FLASH, ROOT, compiled

sys.path.insert(0, str(ROOT / "toolchain"))

from costs import chance_of_words, costs
from image import check, classes, features, link, stack
from image.elf import read_object
from image.sizes import object_words


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


def test_what_a_driver_has_more_for_a_feature_is_that_features(tmp_path: Path) -> None:
    """It is compiled otherwise without it."""
    program = "int f(int);\nint main(void);\nint main(void) { return f(1); }\n"
    long, short = (f"int f(int);\nint f(int x) {{ return {value}; }}\n" for value in ("x * x / 7 + x", "x"))
    places = {name: tmp_path / f"hal/f2808/CMakeFiles/stillspin_{name}.dir/pwm.c.obj" for name in ("hal", "unrecorded")}
    for path, code in zip(places.values(), (long, short), strict=True):
        path.parent.mkdir(parents=True)
        path.write_bytes(compiled(tmp_path, code).read_bytes())
    main = {Path("/build/stillspin_f2808.dir/main.c.obj"): read_object(compiled(tmp_path, program))}
    whole, edition = ({**main, path: read_object(path)} for path in places.values())
    rows = features.taken(whole, ["drive"])
    assert rows[("hil",)].flash > 0
    assert rows[()].flash == pytest.approx(features.words_of(edition.values()).flash)
    assert features.difference(whole, edition, ["hil"], rows).flash == pytest.approx(0)
    assert features.difference(whole, whole, ["commissioning"], rows).flash == pytest.approx(0)


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
