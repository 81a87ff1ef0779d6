"""The count of the interrupts' cost fails where a limit is passed, and says what is short of its goal.

The counts are given: neither recorder nor emulator is needed.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

from costs import chance_of_cycles, costs  # noqa: E402
from image import check  # noqa: E402
from image.command_file import CommandFile, Placement  # noqa: E402
from isr import count, counts, program, runs  # noqa: E402
from isr.counts import Cost, Counts  # noqa: E402
from isr.program import Function, Program  # noqa: E402

LOOK = Function("look", "estimators/look.c", 0x100, 40, in_ram=False)
WRITE = Function("write", "hal/write.c", 0x200, 20, in_ram=True)
COPY = Function("memcpy", "", 0x300, 20, in_ram=False)
QUOTIENT = Function("_aeabi_uldivmod", "", 0x400, 20, in_ram=False)


def counted(worst: float, *, library: int = 2) -> Counts:
    """A run of ten periods, in the longest of which 1000 instructions ran in flash and 100 in RAM."""
    costs_of = {("turning", step): Cost(10, 5000, 1100, 10 * worst - 100, worst) for step in (*counts.STEPS, "window")}
    costs_of |= {("turning", "all"): Cost(10, 5000, 1100, 10 * worst - 100, worst)}
    return Counts(costs_of, {"turning": {0: 9000, 1: 900, library: 10}}, {"turning": {0: 1000, 1: 100, library: 1}})


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., int]:
    """The command with a limit of the paper's scheme, the charge of a window, and what the library brings."""
    limits, charges = tmp_path / "limits.txt", tmp_path / "charges.h"
    library = 2

    def replay(_made: Program, trace: Path, _entry: int, what: str) -> Counts:
        trace.touch()
        worst = {"lab, observer, 600": 800.0, "lab, observer, 600, scope": 1600.0, "lab, paper, 80": 900.0}
        return counted(worst.get(what, 700.0), library=library)

    made = Program(tmp_path / "replay.elf", tmp_path / "count.so", [LOOK, WRITE, COPY, QUOTIENT], {})
    monkeypatch.setattr(program, "missing_tools", list)
    monkeypatch.setattr(program, "make", lambda *_: None)
    monkeypatch.setattr(program, "link", lambda *_: made)
    monkeypatch.setattr(check, "configure", lambda *_: None)
    monkeypatch.setattr(check, "build", lambda *_: None)
    monkeypatch.setattr(count, "record", lambda *_: None)
    monkeypatch.setattr(count, "replay", replay)
    monkeypatch.setattr(count, "LIMITS", limits)
    monkeypatch.setattr(count, "CHARGES", charges)
    monkeypatch.setattr(sys, "argv", ["count.py", "recorder", "images", str(tmp_path)])

    def main(limit: int, charge: int = 9000, called: int = 2) -> int:
        nonlocal library
        library = called
        limits.write_text(f"# why\nlab | observer | 1600 | 1600\nlab | paper | 800 | {limit}  # of all its runs\n")
        worth = dict.fromkeys((*count.CHARGED, "CYCLES_SCOPE"), 9000) | {"CYCLES_WINDOW": charge}
        charges.write_text("".join(f"#define {name} {cycles}u\n" for name, cycles in worth.items()))
        return count.main()

    return main


def said(capsys: pytest.CaptureFixture[str]) -> list[str]:
    """What the command has to say beside its tables."""
    return [line for line in capsys.readouterr().out.splitlines() if line.startswith("isr-cost:")]


SHORT = "isr-cost: short: lab, paper: 900 cycles, 9 % of the period, goal 800"


def test_what_is_beyond_its_goal_is_short_and_what_is_beyond_its_limit_fails(
    run: Callable[..., int], capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(900) == 0
    assert said(capsys) == [SHORT]
    assert run(899) == 1
    assert said(capsys) == [SHORT, "isr-cost: lab, paper: 900 cycles, 9 % of the period, limit 899"]


def test_a_charge_that_is_less_than_expected_is_short(
    run: Callable[..., int], capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(900, charge=1599) == 0
    assert said(capsys)[0] == "isr-cost: short: charges.h: CYCLES_WINDOW lets 1599 cycles pass, 1600 are expected"


def test_a_division_of_the_library_in_an_interrupt_fails(
    run: Callable[..., int], capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(900, called=3) == 1
    assert said(capsys)[-1] == "isr-cost: an interrupt calls _aeabi_uldivmod"


def test_the_budget_is_that_of_the_longest_period(run: Callable[..., int], tmp_path: Path) -> None:
    run(900)
    left = json.loads((tmp_path / "budget.json").read_text(encoding="utf-8"))
    cycles = costs(ROOT)["cycles"]
    lab = left["editions"]["lab"]
    assert left["period_cycles"] == cycles["period"]
    assert (lab["worst_cycles_expected"], lab["worst_cycles_p90"]) == (1600, round(1600 * cycles["p90"]))
    assert lab["by_source"]["paper"]["worst_cycles_expected"] == 900
    assert lab["by_scenario"]["paper, 80"]["worst"] == 900
    assert set(lab["by_source"]) == set(runs.SOURCES)
    functions = json.loads((tmp_path / "figures.json").read_text(encoding="utf-8"))["details"]["lab"]["functions"]
    look, write = ({row["function"]: row for row in functions}[name] for name in ("look", "write"))
    assert (look["in"], look["longest"]) == ("flash", round(1000 * cycles["flash"]))
    assert (write["in"], write["longest"]) == ("RAM", round(100 * cycles["ram"]))


def test_each_edition_is_counted_in_what_it_can(run: Callable[..., int], tmp_path: Path) -> None:
    run(900)
    editions = json.loads((tmp_path / "budget.json").read_text(encoding="utf-8"))["editions"]
    assert set(editions) == {"lab", "drive", "hil", "minimal"}
    asked = {edition: set(own["by_scenario"]) for edition, own in editions.items()}
    assert "paper, 80" in asked["lab"] - asked["drive"]
    assert asked["lab"] > asked["drive"] > asked["hil"]
    assert "observer, 0, commissioning" in asked["drive"]
    assert asked["hil"] - asked["minimal"] == {"observer, 600, scope"}


def test_a_program_is_linked_with_the_tables_of_its_edition(tmp_path: Path) -> None:
    sources = [Path("/tree/control/pi.c"), tmp_path / "made/watch.c", tmp_path / "editions/drive/watch.c"]
    objects = program.Objects(tmp_path, {Path(f"{k}.obj"): source for k, source in enumerate(sources)}, [])
    assert list(objects.of("lab").values()) == [sources[0], sources[1]]
    assert list(objects.of("drive").values()) == [sources[0], sources[2]]
    assert list(objects.of("hil").values()) == [sources[0]]


def test_a_program_has_the_drivers_of_its_edition(tmp_path: Path) -> None:
    """Without the host in the loop those that are compiled without record and replay, in the place of the others."""
    source = program.ROOT / "hal/f2808/pwm.c"
    targets = [Path(f"hal/f2808/CMakeFiles/stillspin_{name}.dir/pwm.c.obj") for name in ("hal", "unrecorded")]
    objects = program.Objects(tmp_path, dict.fromkeys(targets, source), [])
    assert list(objects.of("hil")) == list(objects.of("lab")) == targets[:1]
    assert list(objects.of("drive")) == list(objects.of("minimal")) == targets[1:]


def test_the_chance_of_the_time_agrees_with_its_quantile() -> None:
    cycles = costs(ROOT)["cycles"]
    assert chance_of_cycles(cycles, cycles["p90"]) == pytest.approx(90, abs=0.5)
    assert chance_of_cycles(cycles, 1.0) == pytest.approx(50)


def compiled(code: str, target: Path) -> Path:
    """An object by the stand-in; its source."""
    source = target.with_suffix(".c")
    source.write_text(code, encoding="utf-8")
    cl2000 = ROOT / "toolchain/standin/bin/cl2000"
    subprocess.run([cl2000, f"--c_file={source}", f"--output_file={target}"], check=True)
    return source


def test_functions_are_found_where_the_linker_put_them(tmp_path: Path) -> None:
    """Of the drive by their objects' symbols, of the library by its members, of the replay none."""
    library = tmp_path / "CMakeFiles/stillspin_a.dir"
    library.mkdir(parents=True)
    target, aside = library / "x.obj", tmp_path / "replay.o"
    code = "int f(int), h(int);\nint f(int x) { return x + 1; }\nint h(int x) { return x + 3; }\n"
    code += '__attribute__((section("ramfuncs"))) int g(int);\nint g(int x) { return x + 2; }\n'
    source = compiled(code, target)
    linked = f"""Discarded input sections
 .text.gone     0x00000000        0x8 {target}
Linker script and memory map
 .text.f        0x00001000        0x4 {target}
 .text.h        0x00001800        0x4 {target}
 ramfuncs       0x00002000        0x4 {target}
 .text.a_name_too_long
                0x00003000       0x20 {aside}
 .text          0x00004000       0x20 /usr/lib/libc_nano.a(lib_a-memcpy.o)
"""
    listed = Placement("ramfuncs", "APP", "RAM_CODE", inputs=(("libstillspin_a.a", "x*", ".text:_h"),))
    file = CommandFile({}, [listed], 0, set(), "")
    found = program.functions_of(linked, {target: source}, [aside], file)
    assert [(each.name, each.start, each.in_ram) for each in found] == [
        ("f", 0x1000, False),
        ("h", 0x1800, True),
        ("g", 0x2000, True),
        ("memcpy", 0x4000, False),
    ]


def test_every_object_of_the_drive_is_compiled_as_the_image_compiles_it(tmp_path: Path) -> None:
    base = "/t/cl2000 --compile_only --c_file=/s/{0} -v28 --opt_for_speed=1 --output_file={1}.dir/{0}.obj"
    libraries = {
        "a.c": "control/CMakeFiles/stillspin_control",
        "main.c": "hal/CMakeFiles/stillspin_f2808",
        "lamp.c": "firmware/lamp/CMakeFiles/stillspin_lamp",
    }
    entries = [{"command": base.format(name, library), "file": name} for name, library in libraries.items()]
    (tmp_path / "compile_commands.json").write_text(json.dumps(entries), encoding="utf-8")
    assert program.commands(tmp_path) == {
        "control/CMakeFiles/stillspin_control.dir/a.c.obj": [
            *("/t/cl2000", "--compile_only", "--c_file=/s/a.c", "-v28", "--opt_for_speed=1")
        ]
    }
