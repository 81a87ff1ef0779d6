"""The way to run the firmware with a 16-bit int and char: it must see what a 64-bit computer does not."""

import ctypes
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
COMPILE = ROOT / "toolchain/int16/compile.py"
CLANG = subprocess.run(["bash", "toolchain/find-clang.sh"], cwd=ROOT, capture_output=True, text=True, check=False)
OPT = "opt" + CLANG.stdout.strip().removeprefix("clang")

pytestmark = pytest.mark.skipif(shutil.which(OPT) is None, reason=f"no {OPT}; `make int16` installs it")

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
int32_t product(int16_t a, int16_t b) { return a * b; }
int32_t shifted(uint16_t a) { return (int32_t)(a << 4); }
uint16_t complement(uint16_t a) { return (uint16_t)((uint16_t)~a >> 4); }
bool behind(uint16_t now, uint16_t then) { return now - then > 0x8000u; }
uint16_t character(uint16_t a) { return (uint16_t)(unsigned char)a; }
uint16_t words(void) { return (uint16_t)sizeof(int32_t); }
uint16_t pair_words(void) { return (uint16_t)sizeof(pair_t); }
uint16_t literal(uint16_t k) { return (uint16_t)"ab"[k]; }
int32_t quotient(int32_t a, int32_t b) { return a / b; }
"""


def library(tmp_path: Path, *options: str) -> Path:
    """The planted code, compiled and linked to be loaded."""
    source = tmp_path / "planted.c"
    source.write_text(PLANTED, encoding="utf-8")
    subprocess.run([sys.executable, COMPILE, tmp_path / "out", *options, source], check=True, cwd=ROOT)
    made = tmp_path / "planted.so"
    subprocess.run(["gcc", "-shared", "-o", made, tmp_path / "out/all.o"], check=True)
    return made


@pytest.mark.parametrize(
    ("name", "arguments", "result", "expected"),
    [
        ("product", (ctypes.c_int16(300), ctypes.c_int16(300)), ctypes.c_int32, 90000 - 65536),
        ("shifted", (ctypes.c_uint16(0xFFFF),), ctypes.c_int32, 0xFFF0),
        ("behind", (ctypes.c_uint16(1), ctypes.c_uint16(2)), ctypes.c_bool, True),
        ("character", (ctypes.c_uint16(0x1FF),), ctypes.c_uint16, 0x1FF),
        ("words", (), ctypes.c_uint16, 2),
        ("behind_a_pointer", (ctypes.c_int32(5),), ctypes.c_int32, 14),
        ("pair_words", (), ctypes.c_uint16, 4),
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


@pytest.mark.parametrize("call", ["product(ctypes.c_int16(300), ctypes.c_int16(300))", "quotient(1, 0)"])
def test_what_is_undefined_for_a_sixteen_bit_int_ends_the_program(tmp_path: Path, call: str) -> None:
    made = library(tmp_path, "--trap")
    good = f"import ctypes; l = ctypes.CDLL({str(made)!r}); assert l.int16_quotient(7, 2) == 3"
    assert subprocess.run([sys.executable, "-c", good], check=False).returncode == 0
    assert subprocess.run([sys.executable, "-c", f"{good}; l.int16_{call}"], check=False).returncode < 0
