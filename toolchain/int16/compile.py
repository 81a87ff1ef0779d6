#!/usr/bin/env python3
"""Compiles the drive's C with a 16-bit int and a 16-bit char into objects that run natively.

Usage: toolchain/int16/compile.py OUT [options] SOURCE...    (paths from the root of the tree; OUT/all.o has everything)

clang's front end for the msp430 types and lowers the code: int 16, long 32, long long 64 bits, and every promotion,
shift and overflow that follows from it. Its intermediate code is then made into machine code of this computer.
include/stdint.h gives the types this computer's alignments, so that a copied structure has the same size for both;
pointers become 64 bits wide, and what is copied of a structure with pointers is as long as here, where either side is a
variable of its type. All symbols get the prefix int16_, except the accesses of hal/f2808/target.h and what a compiler
calls by itself; --calls and --gives name more of what it calls natively and what is called natively. With --trap
undefined behaviour ends the program (UBSan's checks, of the code as a 16-bit compiler sees it). For a search, --address
adds AddressSanitizer's checks and --guide counts the branches of the files that a list names (the src: lines of
-fsanitize-coverage-allowlist's). With --tree the sources are those of a copy of the tree, and --rest gives the
objects of all others.
"""

import argparse
import re
import subprocess
import sys
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from fnmatch import fnmatchcase
from functools import partial
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
FRONT = ("--target=msp430", "-std=c99", "-ffreestanding", "-Wall", "-Wextra", "-Werror")
_PADDING = re.compile(
    r"((%\d+) = getelementptr i8, ptr %[\w.]+, i16 \d+.*\n)\s*call void @llvm\.memset.* \2, i8 0, .*\n"
)
_STRUCTURE = re.compile(r"^(%struct\.[\w.]+) = type (.*)$", re.MULTILINE)
_GLOBAL = re.compile(r"^(@[\w.]+) = .*?(?:global|constant) (%struct\.[\w.]+)", re.MULTILINE)
_LOCAL = re.compile(r"(%[\w.]+) = alloca (%struct\.[\w.]+)")
_COPY = re.compile(r"(@llvm\.memcpy\.\S+\(ptr [^,]*?([@%][\w.]+), ptr [^,]*?([@%][\w.]+), i16) \d+")
PREFIX = "int16_"
LAYOUT = "e-m:e-p270:32:32-p271:32:32-p272:64:64-i64:64-i128:128-f80:128-n8:16:32:64-S128"
# Undefined behaviour; not the wrap of unsigned numbers, which is meant, nor null and alignment, which need pointers of
# one size in front and back.
TRAP = (
    "-fsanitize=signed-integer-overflow,shift,integer-divide-by-zero,bounds,unreachable,bool",
    "-fsanitize-trap=all",
)
# sizeof without parentheses, which no macro can halve.
_BARE_SIZE = re.compile(r"\bsizeof\s+(\**\w+(?:(?:->|\.)\w+|\[[^\]]*\])*)")
_LITERAL = re.compile(r'"(?:\\.|[^"\\\n])*"')
# What the drivers call, and what compilers and sanitizers call by themselves.
_NATIVE = r"target_\w+|mem(cpy|set|move|cmp)|__\w*(div|mod|mul|shl|shr|sh)\w*[dt]i\w*|__(asan|sanitizer|start|stop)_\w+"
ADDRESS = ("-Xclang", "-fsanitize=address")
COUNTERS = [f"-sanitizer-coverage-{what}" for what in ("level=3", "inline-8bit-counters", "pc-table")]


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


def widen_line(line: str) -> str:
    """One line of preprocessed code."""
    if line.startswith("#"):
        return line
    return _LITERAL.sub(r"L\g<0>", _BARE_SIZE.sub(r"(sizeof(\1) / 2u)", line))


def widen(text: str) -> str:
    """Preprocessed code with every string literal made of 16-bit characters, and every size in words."""
    return "\n".join(map(widen_line, text.split("\n")))


def with_pointers(code: str) -> set[str]:
    """The structures that have a pointer, or one of them, in them."""
    members = dict(_STRUCTURE.findall(code))
    found = {name for name, of in members.items() if re.search(r"\bptr\b", of)}
    while more := {name for name, of in members.items() if found & set(re.findall(r"%struct\.[\w.]+", of))} - found:
        found |= more
    return found


def copy_whole(code: str) -> str:
    """Copies of structures with pointers have this computer's length."""
    pointed = with_pointers(code)
    everywhere = dict(_GLOBAL.findall(code))
    functions = re.split(r"^(?=define )", code, flags=re.MULTILINE)
    return "".join(_copy_whole(text, everywhere | dict(_LOCAL.findall(text)), pointed) for text in functions)


def _copy_whole(function: str, types: dict[str, str], pointed: set[str]) -> str:
    def size(copy: re.Match[str]) -> str:
        type_ = types.get(copy[2]) or types.get(copy[3])
        if type_ not in pointed:
            return copy[0]
        return f"{copy[1]} ptrtoint (ptr getelementptr ({type_}, ptr null, i32 1) to i16)"

    return _COPY.sub(size, function)


def retarget(code: str) -> str:
    """Intermediate code of the msp430 as that of this computer."""
    code = re.sub(r"^target datalayout.*$", f'target datalayout = "{LAYOUT}"', code, flags=re.MULTILINE)
    code = re.sub(r"^target triple.*$", 'target triple = "x86_64-pc-linux-gnu"', code, flags=re.MULTILINE)
    code = code.replace(" dso_local", "")
    # What clears the padding behind a pointer counts the front's bytes, and here they are the pointer's.
    code = copy_whole(_PADDING.sub(r"\1", code))
    # Who calls or is called natively leaves the upper half of a register as it is.
    code = re.sub(r"\b(zero|sign)ext (?=i16\b)", "", code)
    code = re.sub(r"\b(i16 (?:noundef )?)(?:zero|sign)ext\b ?", r"\1", code)
    return re.sub(r'"target-(cpu|features)"="[^"]*"', "", code)


def is_guide(source: Path, guide: Path | None) -> bool:
    """Whether the list names the file."""
    if guide is None:
        return False
    patterns = re.findall(r"^src:(.*)$", guide.read_text(encoding="utf-8"), re.MULTILINE)
    return any(fnmatchcase(f"/{source.as_posix()}", pattern) for pattern in patterns)


def compile_one(source: Path, options: argparse.Namespace) -> Path:
    """One source file to a native object."""
    clang, opt, llc = tools()
    stem = options.out / source.as_posix().replace("/", "_").removesuffix(".c")
    extra = (*(TRAP if options.trap else ()), *(ADDRESS if options.address else ()))
    characters = ("-I", str(HERE / "include"), "-include", str(HERE / "include" / "characters.h"))
    text = widen(
        run(
            clang,
            *FRONT,
            f"-I{options.made}",
            f"-I{options.tree}",
            "-I.",
            *characters,
            "-E",
            str(options.tree / source),
        )
    )
    code = run(
        *(clang, *FRONT, *extra, "-O1", "-g", "-Xclang", "-disable-llvm-passes"),
        *("-x", "cpp-output", "-S", "-emit-llvm", "-o", "-", "-"),
        text=text,
    )
    code_file, optimised, target = (stem.with_suffix(suffix) for suffix in (".ll", ".bc", ".o"))
    code_file.write_text(retarget(code), encoding="utf-8")
    guides = is_guide(source, options.guide)
    passes = ["default<O2>", *(["sancov-module"] if guides else []), *(["asan"] if options.address else [])]
    how = [*(COUNTERS if guides else []), *(["-asan-use-after-return=never"] if options.address else [])]
    run(opt, f"-passes={','.join(passes)}", *how, str(code_file), "-o", str(optimised))
    run(llc, "-O2", "-relocation-model=pic", "-filetype=obj", str(optimised), "-o", str(target))
    return target


def renamed(symbols: Iterable[str], calls: str, gives: str) -> list[str]:
    """Of nm's lines the symbols that are not native."""
    names = {}
    for line in symbols:
        *_, kind, name = line.split()
        names[name] = kind in "Uvw"  # has no definition
    native = {True: re.compile(f"{_NATIVE}|{calls}"), False: re.compile(gives)}
    return [name for name, missing in sorted(names.items()) if not native[missing].fullmatch(name)]


def join(objects: list[Path], options: argparse.Namespace) -> None:
    """All objects as one, with the prefix on every symbol that is not native."""
    joined = options.out / "all.joined"
    run("ld", "-r", "-o", str(joined), *map(str, objects))
    names = renamed(run("nm", str(joined)).splitlines(), options.calls, options.gives)
    (options.out / "names").write_text("".join(f"{name} {PREFIX}{name}\n" for name in names), encoding="utf-8")
    run("objcopy", f"--redefine-syms={options.out / 'names'}", str(joined), str(options.out / "all.o"))


def rest(folder: Path | None, compiled: list[Path]) -> list[Path]:
    """Objects that have been compiled before, but for those that have been compiled now."""
    now = {"all.o", *(path.name for path in compiled)}
    return [] if folder is None else [path for path in sorted(folder.glob("*.o")) if path.name not in now]


def main() -> int:
    """Compiles what the command line names."""
    parser = argparse.ArgumentParser(description="The drive's C with a 16-bit int, for this computer.")
    parser.add_argument("out", type=lambda name: Path(name).resolve())
    parser.add_argument("--trap", action="store_true")
    parser.add_argument("--address", action="store_true")
    parser.add_argument("--guide", type=Path)
    parser.add_argument("--calls", default="")
    parser.add_argument("--gives", default="")
    parser.add_argument("--tree", type=Path, default=ROOT)
    parser.add_argument("--made", type=Path, required=True)
    parser.add_argument("--rest", type=Path)
    parser.add_argument("sources", type=Path, nargs="+")
    options = parser.parse_intermixed_args()
    options.out.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(2) as pool:
        compiled = list(pool.map(partial(compile_one, options=options), options.sources))
    join([*rest(options.rest, compiled), *compiled], options)
    return 0


if __name__ == "__main__":
    sys.exit(main())
