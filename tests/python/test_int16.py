"""The way to run the firmware with a 16-bit int and char: it must see what a 64-bit computer does not, and say so."""

import ctypes
import json
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain/int16"))

import compare_runs  # noqa: E402

COMPILE = ROOT / "toolchain/int16/compile.py"
CLANG = subprocess.run(["bash", "toolchain/find-clang.sh"], cwd=ROOT, capture_output=True, text=True, check=False)
OPT = "opt" + CLANG.stdout.strip().removeprefix("clang")


@pytest.fixture
def compiles() -> None:
    """What makes code that runs here is there."""
    if shutil.which(OPT) is None:
        pytest.fail(f"no {OPT}; `bash toolchain/setup.sh build llvm`, as `make test` does, installs it", pytrace=False)


PLANTED = """
typedef struct {
  char letter;
  int32_t number;
} pair_t;
typedef struct {
  const int32_t* at;
  int32_t count;
} walk_t;
static const int32_t numbers[2] = {7, 9};
walk_t walk(int32_t count) { const walk_t w = {numbers, count}; return w; }
int32_t behind_a_pointer(int32_t count) { const walk_t w = walk(count); return w.at[1] + w.count; }
static walk_t kept;
int32_t copied(int32_t count) {
  walk_t here;
  here = walk(count);
  kept = here;
  return kept.at[1] + kept.count;
}
int32_t product(int16_t a, int16_t b) { return a * b; }
int32_t shifted(uint16_t a) { return (int32_t)(a << 4); }
uint16_t complement(uint16_t a) { return (uint16_t)((uint16_t)~a >> 4); }
bool behind(uint16_t now, uint16_t then) { return now - then > 0x8000u; }
uint16_t character(uint16_t a) { return (uint16_t)(unsigned char)a; }
uint16_t words(void) { return (uint16_t)sizeof(int32_t); }
uint16_t bare_words(const pair_t* at) { return (uint16_t)(sizeof *at + sizeof numbers + sizeof at->number); }
uint16_t place(void) { return (uint16_t)offsetof(pair_t, number); }
uint16_t entries(void) { return (uint16_t)(sizeof numbers / sizeof numbers[0]); }
uint16_t pair_words(void) { return (uint16_t)sizeof(pair_t); }
uint16_t literal(uint16_t k) { return (uint16_t)"ab"[k]; }
int32_t quotient(int32_t a, int32_t b) { return a / b; }
int16_t moved(int16_t a, int16_t by) { return (int16_t)(a << by); }
int32_t number(uint16_t k) { return numbers[k]; }
typedef union {
  uint16_t word;
  bool flag;
} word_t;
uint16_t flag(uint16_t word) { const word_t w = {word}; return w.flag ? 1u : 0u; }
"""


def library(tmp_path: Path, *options: str) -> Path:
    """The planted code, compiled and linked to be loaded."""
    source = tmp_path / "planted.c"
    source.write_text(PLANTED, encoding="utf-8")
    subprocess.run(
        [sys.executable, COMPILE, tmp_path / "out", "--made", tmp_path, *options, source], check=True, cwd=ROOT
    )
    made = tmp_path / "planted.so"
    subprocess.run(["gcc", "-shared", "-o", made, tmp_path / "out/all.o"], check=True)
    return made


@pytest.mark.usefixtures("compiles")
@pytest.mark.parametrize(
    ("name", "arguments", "result", "expected"),
    [
        ("product", (ctypes.c_int16(300), ctypes.c_int16(300)), ctypes.c_int32, 90000 - 65536),
        ("shifted", (ctypes.c_uint16(0xFFFF),), ctypes.c_int32, 0xFFF0),
        ("behind", (ctypes.c_uint16(1), ctypes.c_uint16(2)), ctypes.c_bool, True),
        ("character", (ctypes.c_uint16(0x1FF),), ctypes.c_uint16, 0x1FF),
        ("words", (), ctypes.c_uint16, 2),
        ("behind_a_pointer", (ctypes.c_int32(5),), ctypes.c_int32, 14),
        ("copied", (ctypes.c_int32(5),), ctypes.c_int32, 14),
        ("pair_words", (), ctypes.c_uint16, 4),
        ("bare_words", (ctypes.c_void_p(),), ctypes.c_uint16, 4 + 4 + 2),
        ("place", (), ctypes.c_uint16, 2),
        ("entries", (), ctypes.c_uint16, 2),
        ("literal", (ctypes.c_uint16(1),), ctypes.c_uint16, ord("b")),
        ("complement", (ctypes.c_uint16(0xFFF0),), ctypes.c_uint16, 0),
        ("quotient", (ctypes.c_int32(-7), ctypes.c_int32(2)), ctypes.c_int32, -3),
    ],
)
def test_words_have_sixteen_bits(
    planted: ctypes.CDLL, name: str, arguments: tuple[object, ...], result: type, expected: int
) -> None:
    function = getattr(planted, f"int16_{name}")
    function.restype = result
    assert function(*arguments) == expected


@pytest.fixture(scope="module")
def planted(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    """The planted code, loaded."""
    return ctypes.CDLL(str(library(tmp_path_factory.mktemp("int16"))))


@pytest.fixture(scope="module")
def trapping(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The planted code that ends where something is undefined."""
    return library(tmp_path_factory.mktemp("int16_trap"), "--trap")


@pytest.mark.usefixtures("compiles")
@pytest.mark.parametrize(
    ("good", "bad"),
    [
        ("product(181, 181)", "product(300, 300)"),
        ("quotient(7, 2)", "quotient(1, 0)"),
        ("moved(1, 14)", "moved(1, 16)"),
        ("number(1)", "number(2)"),
        ("flag(1)", "flag(2)"),
    ],
)
def test_what_is_undefined_for_a_sixteen_bit_int_ends_the_program(trapping: Path, good: str, bad: str) -> None:
    def status(call: str) -> int:
        code = f"import ctypes; ctypes.CDLL({str(trapping)!r}).int16_{call}"
        return subprocess.run([sys.executable, "-c", code], check=False).returncode

    assert status(good) == 0
    assert status(bad) == -signal.SIGILL


def left(**changed: Any) -> dict[str, Any]:
    """What a run leaves, as its process says it."""
    run = {
        "signals": {"time": np.arange(3.0), "speed": np.zeros(3, np.float32)},
        "faults": [(0.5, "overcurrent")],
        "reason": "",
        "stats": {"register_accesses": 9.0, "wall_seconds": 1.0},
    }
    said: dict[str, Any] = json.loads(json.dumps(compare_runs.left_by(SimpleNamespace(**(run | changed)))))
    return said


@pytest.mark.parametrize(
    ("native", "other", "said"),
    [
        (left(), left(stats={"register_accesses": 9.0, "wall_seconds": 2.0}), "same"),
        ({"broken": "lost"}, {"broken": "lost"}, "same"),
        (left(), left(signals={"time": np.arange(3.0), "speed": np.array([0, 0, 1e-45], np.float32)}), "speed"),
        (left(), left(signals={"time": np.arange(3.0)}), "speed"),
        (left(), left(faults=[(0.5, "overvoltage")]), "faults"),
        (left(), left(reason="stalled"), "reason"),
        (left(), left(stats={"register_accesses": 10.0}), "stats"),
        (left(), {"crashed": -4}, "crashed"),
        ({"crashed": -4}, {"crashed": -4}, "DIFFERS"),
        ({"broken": "lost"}, {"broken": "stuck"}, "broken"),
    ],
)
def test_runs_that_differ_in_anything_are_told(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    native: dict[str, Any],
    other: dict[str, Any],
    said: str,
) -> None:
    monkeypatch.setattr(compare_runs, "jobs_of", lambda _: [SimpleNamespace(run=SimpleNamespace(name="start"))])
    monkeypatch.setattr(compare_runs, "played", lambda module, *_: native if module == "native" else other)
    monkeypatch.setattr(sys, "argv", ["compare_runs.py", "int16", "A10"])
    assert compare_runs.main() == (0 if said == "same" else 1)
    told = capsys.readouterr().out
    assert told.startswith("same" if said == "same" else "DIFFERS A10 start:") and said in told
