"""What of the image runs from RAM."""

import re
import sys
from fnmatch import fnmatch
from pathlib import Path

from stand_in import FLASH, ROOT, compiled

sys.path.insert(0, str(ROOT / "toolchain"))

from image import ram_code
from image.command_file import read_command_file
from image.elf import read_object
from image.link import Pile
from image.ram_code import left_in_flash, marked

FOLDERS = {f"libstillspin_{name}.a": name for name in ("control", "estimators", "firmware", "svpwm")} | {
    "libstillspin_hal.a": "hal/f2808",
    "libstillspin_qmath.a": "hal/qmath",
    "libstillspin_replay.a": "hal",
}


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
    assert drivers["clock.c"] == {"set_flash_timing"}
    assert drivers["adc.c"] == {"hal_adc_read_window"}
    assert {"control_isr", "window_isr", "hal_irq_disable"} < drivers["irq.c"]
    assert {"write_registers", "hal_pwm_is_tripped"} < drivers["pwm.c"]
    code = RAM_CODE + "RAM void set_flash_timing(void) {}\nint there(void) { return 1; }\n"
    objects = [read_object(compiled(tmp_path, code))]
    assert left_in_flash(objects, {"x": {"set_flash_timing"}}) == []
    assert left_in_flash(objects, {"x": {"there"}}) == ["there is to run from RAM and is not in ramfuncs"]


def test_what_changes_the_flash_calls_nothing_there(tmp_path: Path) -> None:
    code = RAM_CODE + "RAM void set_flash_timing(void) { (void)there(); }\n"
    objects = [read_object(compiled(tmp_path, code))]
    assert left_in_flash(objects, {}) == ["x.obj changes the flash's timing and refers to there"]
