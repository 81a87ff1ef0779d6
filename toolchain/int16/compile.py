#!/usr/bin/env python3
"""Compiles the drive's C with a 16-bit int and a 16-bit char into objects that run natively.

Usage: toolchain/int16/compile.py OUT [--trap] SOURCE...    (from the root of the tree; OUT/all.o has everything)

clang's front end for the msp430 types and lowers the code: int 16, long 32, long long 64 bits, and every promotion,
shift and overflow that follows from it. Its intermediate code is then made into machine code of this computer.
include/stdint.h gives the types this computer's alignments, so that a copied structure has the same size for both;
pointers become 64 bits wide, so no structure with a pointer in it may be copied or initialised whole. All symbols get
the prefix int16_, except the accesses of hal/f2808/target.h and what a compiler calls by itself. With --trap undefined
behaviour ends the program (UBSan's checks, of the code as a 16-bit compiler sees it).
"""

import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
FRONT = ("--target=msp430", "-std=c99", "-ffreestanding", "-Wall", "-Wextra", "-Werror")
_PADDING = re.compile(r"((%\d+) = getelementptr i8, ptr %\d+, i16 \d+.*\n)\s*call void @llvm\.memset.* \2, i8 0, .*\n")
PREFIX = "int16_"
LAYOUT = "e-m:e-p270:32:32-p271:32:32-p272:64:64-i64:64-i128:128-f80:128-n8:16:32:64-S128"
# Undefined behaviour; not the wrap of unsigned numbers, which is meant, nor null and alignment, which need pointers of
# one size in front and back.
TRAP = (
    "-fsanitize=signed-integer-overflow,shift,integer-divide-by-zero,bounds,unreachable,bool",
    "-fsanitize-trap=all",
)
_LITERAL = re.compile(r'"(?:\\.|[^"\\\n])*"')
_NATIVE = re.compile(r"target_\w+|mem(cpy|set|move|cmp)|__\w*(div|mod|mul|shl|shr|sh)\w*[dt]i\w*")


def run(*command: str, text: str | None = None) -> str:
    """Output of a program; its complaints and the end of this one when it fails."""
    done = subprocess.run(command, cwd=ROOT, input=text, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"int16: {' '.join(command)}\n{done.stderr}")
    return done.stdout


def tools() -> tuple[str, str, str]:
    """clang, opt and llc of one version."""
    clang = run("bash", "toolchain/find-clang.sh").strip()
    suffix = clang.removeprefix("clang")
    return clang, f"opt{suffix}", f"llc{suffix}"


def widen(text: str) -> str:
    """Preprocessed code with every string literal made of 16-bit characters."""
    lines = (line if line.startswith("#") else _LITERAL.sub(r"L\g<0>", line) for line in text.split("\n"))
    return "\n".join(lines)


def retarget(code: str) -> str:
    """Intermediate code of the msp430 as that of this computer."""
    code = re.sub(r"^target datalayout.*$", f'target datalayout = "{LAYOUT}"', code, flags=re.MULTILINE)
    code = re.sub(r"^target triple.*$", 'target triple = "x86_64-pc-linux-gnu"', code, flags=re.MULTILINE)
    code = code.replace(" dso_local", "")
    # What clears the padding behind a pointer counts the front's bytes, and here they are the pointer's.
    code = _PADDING.sub(r"\1", code)
    # Who calls or is called natively leaves the upper half of a register as it is.
    code = re.sub(r"\b(zero|sign)ext (?=i16\b)", "", code)
    code = re.sub(r"\b(i16 (?:noundef )?)(?:zero|sign)ext\b ?", r"\1", code)
    return re.sub(r'"target-(cpu|features)"="[^"]*"', "", code)


def compile_one(source: Path, out: Path, extra: tuple[str, ...]) -> Path:
    """One source file to a native object."""
    clang, opt, llc = tools()
    stem = out / source.as_posix().replace("/", "_").removesuffix(".c")
    characters = ("-I", str(HERE / "include"), "-include", str(HERE / "include" / "characters.h"))
    text = widen(run(clang, *FRONT, "-I.", *characters, "-E", source.as_posix()))
    code = run(
        *(clang, *FRONT, *extra, "-O1", "-g", "-Xclang", "-disable-llvm-passes"),
        *("-x", "cpp-output", "-S", "-emit-llvm", "-o", "-", "-"),
        text=text,
    )
    code_file, optimised, target = (stem.with_suffix(suffix) for suffix in (".ll", ".bc", ".o"))
    code_file.write_text(retarget(code), encoding="utf-8")
    run(opt, "-passes=default<O2>", str(code_file), "-o", str(optimised))
    run(llc, "-O2", "-relocation-model=pic", "-filetype=obj", str(optimised), "-o", str(target))
    return target


def join(objects: list[Path], out: Path) -> None:
    """All objects as one, with the prefix on every symbol that is not native."""
    joined = out / "joined.o"
    run("ld", "-r", "-o", str(joined), *map(str, objects))
    symbols = {line.split()[-1] for line in run("nm", str(joined)).splitlines()}
    renames = [f"{name} {PREFIX}{name}\n" for name in sorted(symbols) if not _NATIVE.fullmatch(name)]
    (out / "names").write_text("".join(renames), encoding="utf-8")
    run("objcopy", f"--redefine-syms={out / 'names'}", str(joined), str(out / "all.o"))


def main() -> int:
    """Compiles what the command line names."""
    out, *rest = sys.argv[1:]
    folder = Path(out).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    extra = TRAP if "--trap" in rest else ()
    sources = [Path(name) for name in rest if name != "--trap"]
    with ThreadPoolExecutor(2) as pool:
        join(list(pool.map(lambda source: compile_one(source, folder, extra), sources)), folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
