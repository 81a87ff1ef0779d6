"""The checks of toolchain/checks catch what they are for: each is given planted violations and clean counterparts."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from planting import plant

MOST_LEFT = 0
ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

import check  # noqa: E402
import pack_text  # noqa: E402
from checks import arrows, conditionals, int16, left, links, packages, registers  # noqa: E402
from checks.preprocessor import without_comments  # noqa: E402


@pytest.fixture
def house(tmp_path: Path) -> Path:
    """A tree with one header in each part of the house."""
    for path in (
        "hal/qmath/qmath.h",
        "hal/hal_pwm.h",
        "hal/f2808/registers.h",
        "hal/f2808/target.h",
        "hal/f2808/pwm_internal.h",
        "control/frame.h",
        "control/pi.h",
        "svpwm/modulator.h",
        "estimators/avv.h",
        "firmware/base/crc.h",
        "firmware/mode/mode.h",
        "firmware/drive/position.h",
        "firmware/start/start.h",
        "firmware/sources/observer/observer.h",
        "firmware/sources/flux/flux.h",
        "firmware/sources/encoder/encoder.h",
        "sim_host/chip/world.hpp",
        "sim_host/plant/plant.hpp",
    ):
        plant(tmp_path, path)
    return tmp_path


@pytest.mark.parametrize(
    ("source", "include"),
    [
        ("hal/qmath/x.c", "control/pi.h"),
        ("hal/hal_x.h", "control/pi.h"),
        ("control/x.c", "svpwm/modulator.h"),
        ("control/x.c", "estimators/avv.h"),
        ("control/x.h", "hal/hal_pwm.h"),
        ("svpwm/x.c", "firmware/mode/mode.h"),
        ("estimators/x.c", "control/pi.h"),
        ("estimators/x.c", "hal/hal_pwm.h"),
        ("firmware/drive/x.c", "hal/f2808/registers.h"),
        ("firmware/x.c", "control/pi.h"),
        ("firmware/mode/x.c", "firmware/drive/position.h"),
        ("firmware/link/x.c", "firmware/start/start.h"),
        ("firmware/sources/observer/x.c", "firmware/sources/flux/flux.h"),
        ("firmware/sources/flux/x.c", "firmware/sources/encoder/encoder.h"),
        ("firmware/sources/paper/x.c", "firmware/sources/flux/flux.h"),
        ("firmware/drive/x.c", "firmware/sources/observer/observer.h"),
        ("firmware/interfaces/x.h", "firmware/base/crc.h"),
        ("firmware/flash_kernel/x.c", "firmware/mode/mode.h"),
        ("hal/f2808/x.c", "firmware/mode/mode.h"),
        ("hal/f2808/x.c", "control/frame.h"),
        ("hal/f2808/x.c", "svpwm/modulator.h"),
        ("hal/f2808/x.c", "estimators/avv.h"),
        ("sim_host/chip/x.cpp", "firmware/mode/mode.h"),
        ("sim_host/chip/x.cpp", "hal/f2808/pwm_internal.h"),
        ("sim_host/plant/x.cpp", "hal/f2808/registers.h"),
        ("control/x.c", "sim_host/chip/world.hpp"),
        ("control/x.c", "../firmware/mode/mode.h"),
        ("control/x.c", "control/../firmware/mode/mode.h"),
        ("control/x.c", "control/no_such_file.h"),
        ("control/x.c", "math.h"),
    ],
)
def test_arrow_that_goes_up_is_caught(house: Path, source: str, include: str) -> None:
    plant(house, source, f'#include <stdint.h>\n#include "{include}"\n')
    findings = arrows.check(house)
    assert [(f.path, f.line) for f in findings] == [(source, 2)]


@pytest.mark.parametrize(
    "line",
    [
        "#include <firmware/mode/mode.h>",
        '  #  include "firmware/mode/mode.h"',
        '#include /* why not */ "firmware/mode/mode.h"',
        '#include \\\n "firmware/mode/mode.h"',
        '#define DRIVE "firmware/mode/mode.h"\n#include DRIVE',
    ],
)
def test_disguised_arrow_is_caught(house: Path, line: str) -> None:
    plant(house, "control/x.c", line + "\n")
    assert len(arrows.check(house)) == 1


@pytest.mark.parametrize(
    ("source", "include"),
    [
        ("control/x.c", '"hal/qmath/qmath.h"'),
        ("control/x.c", '"pi.h"'),
        ("control/x.c", "<stdbool.h>"),
        ("estimators/x.c", '"control/frame.h"'),
        ("firmware/mode/x.c", '"hal/hal_pwm.h"'),
        ("firmware/drive/x.c", '"estimators/avv.h"'),
        ("firmware/drive/x.c", '"firmware/mode/mode.h"'),
        ("firmware/start/x.c", '"firmware/drive/position.h"'),
        ("firmware/sources/encoder/x.c", '"firmware/sources/flux/flux.h"'),
        ("firmware/sources/paper/x.c", '"firmware/sources/observer/observer.h"'),
        ("firmware/flash_kernel/x.c", '"firmware/base/crc.h"'),
        ("hal/f2808/x.c", '"hal/hal_pwm.h"'),
        ("sim_host/chip/x.cpp", '"hal/f2808/target.h"'),
        ("sim_host/plant/x.cpp", "<vector>"),
        ("sim_host/bench/x.cpp", '"firmware/mode/mode.h"'),
    ],
)
def test_arrow_that_goes_down_passes(house: Path, source: str, include: str) -> None:
    plant(house, source, f'#include {include}\n// #include "firmware/mode/mode.h"\n')
    assert arrows.check(house) == []


FIND = "int32_t start_find(const int32_t* place,\n  int32_t (*how)(int32_t)) {\n  return how(*place);\n}\n"


@pytest.mark.parametrize(
    "line",
    [
        "void sequence(void) { start_find(0, 0); }",
        "int32_t start_find(const int32_t* place, int32_t (*how)(int32_t));",
        "static const step_t steps[] = {start_find};",
    ],
)
def test_call_that_goes_up_is_caught(house: Path, line: str) -> None:
    """No include tells of it: the caller may have declared the function itself."""
    plant(house, "firmware/start/start.c", FIND)
    plant(house, "firmware/drive/sequence.c", f"// start_find\n{line}\n")
    assert [(f.path, f.line) for f in arrows.check(house)] == [("firmware/drive/sequence.c", 2)]


@pytest.mark.parametrize(
    ("source", "line"),
    [
        ("firmware/can/node.c", "void node(void) { start_find(0, 0); }"),
        (
            "firmware/drive/sequence.c",
            "static int32_t start_find(void) { return 0; }\nint32_t f(void) { start_find(); }",
        ),
        ("firmware/drive/sequence.c", 'void f(step_t* s) {\n  s->start_find(0);\n  say("start_find");\n}'),
        ("firmware/drive/sequence.c", "int32_t f(void) {\n  const int32_t start_find = 0;\n  return start_find;\n}"),
    ],
)
def test_call_that_does_not_go_up_passes(house: Path, source: str, line: str) -> None:
    plant(house, "firmware/start/start.c", FIND)
    plant(house, source, f"{line}\n")
    assert arrows.check(house) == []


def test_exception_is_borne_and_one_that_nothing_needs_is_caught(house: Path) -> None:
    plant(house, "firmware/start/start.c", FIND)
    source = plant(house, "firmware/drive/sequence.c", "void sequence(void) { start_find(0, 0); }\n")
    plant(house, arrows.LEFT, "# a comment\nfirmware/drive/sequence.c: start_find()\n")
    assert arrows.check(house) == []
    source.write_text("", encoding="utf-8")
    assert [(f.path, f.line) for f in arrows.check(house)] == [(arrows.LEFT, 2)]


def test_exceptions_become_fewer() -> None:
    """This number only ever goes down, to 0."""
    assert len(left(ROOT / arrows.LEFT)) <= MOST_LEFT


def test_comment_stripping_keeps_strings_and_line_numbers() -> None:
    assert without_comments('a "/* no */" /* x\ny */ b // c\nd') == 'a "/* no */"     \n     b     \nd'


@pytest.mark.parametrize(
    "text",
    [
        "#ifdef HOST\nint x;\n#endif\n",
        "#if defined(__TMS320C28XX__)\nint x;\n#endif\n",
        "#ifndef __x86_64__\nint x;\n#endif\n",
        "#if 1\n#error broken\nint x;\n#endif\n",
        "#ifndef A_H\n#define A_H\n#if UINT_MAX > 65535\n#define WIDE 1\n#endif\n#endif\n",
    ],
)
def test_code_that_only_one_build_sees_is_caught(text: str) -> None:
    assert len(conditionals.check_text("firmware/x.c", text)) == 1


def test_guards_and_compile_time_errors_pass() -> None:
    text = """
#ifndef A_H
#define A_H
#ifdef __cplusplus
extern "C" {
#endif
#if PERIOD > 9999
#error the period does not fit the counter
#endif
#endif
"""
    assert conditionals.check_text("firmware/a.h", text) == []


def test_sixteen_bit_fault_is_caught_that_the_host_compiler_accepts(tmp_path: Path) -> None:
    clang = int16.find_clang()
    assert clang is not None, "make setup installs a clang with the msp430 target"
    fault = plant(
        tmp_path,
        "control/x.c",
        "#include <stdint.h>\nint32_t f(void);\nint32_t f(void) {\n  return 1 << 20;\n}\n",
    )
    host = shutil.which("gcc")
    assert host is not None
    flags = [flag for flag in int16.FLAGS if flag.startswith(("-W", "-std", "-fsyntax"))]
    assert subprocess.run([host, *flags, str(fault)], check=False).returncode == 0
    assert [(f.path, f.line) for f in int16.check_sources(tmp_path)] == [("control/x.c", 4)]


@pytest.mark.parametrize(
    "body",
    [
        "int16_t f(int32_t x) { return x; }",  # narrowing
        "uint16_t f(void) { return 70000; }",  # a constant that needs more than 16 bits
        "int32_t f(int16_t a, int16_t b) { int16_t a1 = a; { int16_t a1 = b; return a1; } }",  # shadowing
        "int32_t f(void) { return FEATURE_X; }",  # not declared
    ],
)
def test_other_faults_are_caught_with_the_drives_flags(tmp_path: Path, body: str) -> None:
    plant(tmp_path, "firmware/x.c", f"#include <stdint.h>\n{body}\n")
    assert int16.check_sources(tmp_path)


def test_widened_arithmetic_passes(tmp_path: Path) -> None:
    body = "int32_t f(int16_t a, int16_t b);\nint32_t f(int16_t a, int16_t b) { return (int32_t)a * b; }\n"
    plant(tmp_path, "firmware/x.c", f"#include <stdint.h>\n{body}")
    assert int16.check_sources(tmp_path) == []


def test_fault_in_the_dsps_branch_is_caught(tmp_path: Path) -> None:
    text = (ROOT / "hal/f2808/target.h").read_text(encoding="utf-8")
    right, wrong = "return *(volatile uint16_t*)address", "return *(volatile uint32_t*)address"
    assert right in text
    plant(tmp_path, "hal/f2808/x.c", '#include "hal/f2808/target.h"\n')
    plant(tmp_path, "hal/f2808/target.h", text)
    assert int16.check_sources(tmp_path) == []
    plant(tmp_path, "hal/f2808/target.h", text.replace(right, wrong))
    assert [f.path for f in int16.check_sources(tmp_path)] == ["hal/f2808/target.h"]


def test_fault_in_what_the_build_makes_is_caught(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for folder in ("hal", "control", "estimators", "svpwm", "firmware"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    assert int16.check_generated(tmp_path) == []
    text = (tmp_path / int16.IDENTITY).read_text(encoding="utf-8")
    plant(tmp_path, int16.IDENTITY, text.replace("@revision@uL", "@revision@u"))
    assert {f.path for f in int16.check_generated(tmp_path)} == {int16.IDENTITY}
    plant(tmp_path, int16.IDENTITY, text)
    monkeypatch.setattr(pack_text, "blocks", lambda _, start: ([start | 0x10000], []))
    assert {f.path for f in int16.check_generated(tmp_path)} == {"firmware/packed_text_table.c"}


def test_dead_link_and_dead_path_are_caught(tmp_path: Path) -> None:
    plant(tmp_path, "docs/index.md", "[there](there.md) and `control/pi.h`\n")
    plant(tmp_path, "docs/there.md", "```\n[not](a-link.md)\n```\n")
    plant(tmp_path, "control/pi.h")
    plant(tmp_path, "README.md", "[a](docs/index.md)\n![b](docs/images/none.png)\nsee `control/none.c`\n")
    plant(tmp_path, "CONTRIBUTING.md", "[a](docs/none.md)\n")
    findings = links.check(tmp_path)
    assert [(f.path, f.line) for f in findings] == [("README.md", 2), ("README.md", 3), ("CONTRIBUTING.md", 1)]


def test_function_that_is_not_where_its_link_leads_is_caught(tmp_path: Path) -> None:
    plant(tmp_path, "README.md", "[`pi_step`](control/pi.h) and [`pi_stop`](control/pi.h)\n")
    plant(tmp_path, "control/pi.h", "int32_t pi_step(pi_t* s);\nint32_t pi_stop_all(void);\n")
    assert [f.message for f in links.check(tmp_path)] == ["pi_stop is not in pi.h"]


def test_package_that_is_not_installed_is_caught(tmp_path: Path) -> None:
    plant(
        tmp_path,
        "sim_host/pyproject.toml",
        '[tool.setuptools]\npackages = ["stillspin", "stillspin.gone", "stillspin.motors"]\n'
        '[tool.setuptools.package-dir]\nstillspin = "stillspin"\n"stillspin.motors" = "motors"\n',
    )
    plant(tmp_path, "sim_host/stillspin/__init__.py")
    plant(tmp_path, "sim_host/stillspin/flash/__init__.py")
    assert [f.message.split()[0:2] for f in packages.check(tmp_path)] == [
        ["stillspin.flash", "is"],
        ["package", "stillspin.gone"],
    ]


def test_lock_file_names_no_address() -> None:
    """Where packages come from is the machine's business: the lock says what, not whence."""
    lock = (ROOT / "toolchain/requirements.lock").read_text(encoding="utf-8")
    assert "://" not in lock
    assert "--index" not in lock and "--find-links" not in lock
    pinned = [line for line in lock.splitlines() if line and not line.startswith((" ", "#"))]
    assert pinned and all("==" in line for line in pinned)


def test_every_dependency_is_explained() -> None:
    """Each direct dependency has its reason in the book."""
    book = (ROOT / "docs/dependencies.md").read_text(encoding="utf-8")
    rows = (ROOT / "toolchain/debian-packages.txt").read_text(encoding="utf-8").splitlines()
    debian = [row.split("|")[1].strip() for row in rows if not row.startswith("#")]
    requirements = (ROOT / "toolchain/requirements.in").read_text(encoding="utf-8").splitlines()
    python = [re.split(r"[^\w-]", line)[0] for line in requirements if not line.startswith("#")]
    assert debian and python
    assert [name for name in debian + python if f"`{name}`" not in book] == []


def register_house(tmp_path: Path) -> Path:
    """A tree with the register map and the tables that it is held against."""
    maps = [f"hal/f2808/{name}" for name in ("registers.h", "registers_can.h", "f2808_values.h")]
    for path in [*maps, "hal/boards/bench.h", "hal/boards/ipm.h"]:
        plant(tmp_path, path, (ROOT / path).read_text(encoding="utf-8"))
    shutil.copytree(ROOT / "toolchain/f2808", tmp_path / "toolchain/f2808")
    return tmp_path


@pytest.mark.parametrize(
    ("file", "right", "wrong", "blamed"),
    [
        ("registers.h", "REG_PLLCR 0x7021uL", "REG_PLLCR 0x7022uL", "REG_PLLCR"),
        ("registers.h", "REG_PLLCR 0x7021uL  // PLL multiplier (EALLOW)", "REG_PLLCR 0x7021uL  //", "REG_PLLCR"),
        ("registers.h", "0x6800uL + 0x40uL", "0x6800uL + 0x80uL", "EPWM_TBCTL"),
        ("registers.h", "0x0CE3uL + 2uL", "0x0CE3uL + 1uL", "REG_PIEIFR"),
        ("registers.h", "EPWM_CMPB 0x0Au", "EPWM_CMPB 0x0Cu", "EPWM_CMPB"),
        ("registers.h", "ADCTRL2_SOC_SEQ1_LSB 13", "ADCTRL2_SOC_SEQ1_LSB 12", "ADCTRL2_SOC_SEQ1_LSB"),
        ("registers.h", "EPWM_TZSEL_OSHT1_MASK 0x0100u", "EPWM_TZSEL_OSHT1_MASK 0x0001u", "EPWM_TZSEL_OSHT1_MASK"),
        ("registers.h", "// port A direction, 1 output (EALLOW, 32)", "// port A direction (EALLOW)", "REG_GPADIR"),
        ("registers.h", "VECTOR_SEQ2INT 33u", "VECTOR_SEQ2INT 34u", "VECTOR_SEQ2INT"),
        ("registers.h", "#define VECTOR_TINT2 14u", "#define VECTOR_TIMER2 14u", "VECTOR_TIMER2"),
        ("registers_can.h", "CANMC_CCR_MASK 0x00001000uL", "CANMC_CCR_MASK 0x00002000uL", "CANMC_CCR_MASK"),
        ("registers_can.h", "CANGIF_BOIF_MASK 0x00000400uL", "CANGIF_BOIF_MASK 0x00000800uL", "CANGIF_BOIF_MASK"),
        ("registers_can.h", "0x6104uL + 8uL", "0x6104uL + 4uL", "REG_CANMDL"),
        ("f2808_values.h", "WDCR_WDCHK_KEY 5u", "WDCR_WDCHK_KEY 6u", "WDCR_WDCHK_KEY"),
        ("f2808_values.h", "TZCTL_FORCE_LOW 2u", "TZCTL_FORCE_LOW 1u", "TZCTL_FORCE_LOW"),
        ("f2808_values.h", "0x00FF0000uL", "0x0000FF00uL", "GPACTRL_QUALPRD2_MASK"),
        ("../boards/bench.h", "BOARD_PIN_OVER_CURRENT 12u", "BOARD_PIN_OVER_CURRENT 14u", "BOARD_PIN_OVER_CURRENT"),
        ("../boards/bench.h", "BOARD_TRIP_INPUT 1u", "BOARD_TRIP_INPUT 2u", "BOARD_PIN_OVER_CURRENT"),
        ("../boards/ipm.h", "BOARD_FIRST_LEG_MODULE 4u", "BOARD_FIRST_LEG_MODULE 1u", "BOARD_PIN_FIRST_GATE"),
        ("../boards/ipm.h", "BOARD_PIN_RELAY 0u", "BOARD_PIN_RELAY 8u", "BOARD_PIN_RELAY"),
    ],
)
def test_slip_in_the_register_map_is_caught(tmp_path: Path, file: str, right: str, wrong: str, blamed: str) -> None:
    house = register_house(tmp_path)
    text = (house / "hal/f2808" / file).read_text(encoding="utf-8")
    assert right in text
    plant(house, f"hal/f2808/{file}", text.replace(right, wrong))
    findings = registers.check(house)
    assert findings and any(finding.message.startswith(blamed) for finding in findings)


def test_register_map_agrees_with_the_tables(tmp_path: Path) -> None:
    assert registers.check(register_house(tmp_path)) == []


def test_each_check_has_a_row_in_the_book_that_says_what_it_is_for() -> None:
    page = (ROOT / "docs/architecture.md").read_text(encoding="utf-8").partition("\n## Checks\n")[2]
    rows = re.findall(r"^\| (\w+) \| .+ \| .+ \|$", page, re.MULTILINE)
    assert rows == ["check", *check.DESCRIPTIONS]
