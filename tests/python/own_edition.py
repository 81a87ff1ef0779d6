"""The native module of an edition that the build does not make."""

import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build/release"

LOADED = """
import importlib.util, sys
spec = importlib.util.spec_from_file_location("stillspin._core", sys.argv[1])
sys.modules["stillspin._core"] = native = importlib.util.module_from_spec(spec)
spec.loader.exec_module(native)
"""
"""For a process of its own, which gets the module's path: the firmware has static state."""


def ninja(tool: str, *arguments: str) -> str:
    """What ninja knows of the build."""
    command = ["ninja", "-C", BUILD, "-t", tool, *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def recompiled(made: Path, commands: str) -> dict[str, Path]:
    """By their names in the build: the objects of sources that include what is made of the lists, with another one."""
    usual = f"{BUILD}/made"
    blocks = ninja("deps").split("\n\n")
    seen = {
        block.split(":", 1)[0].strip()
        for block in blocks
        if f" {usual}/firmware/" in block or " made/firmware/" in block
    }
    found, jobs = {}, []
    for words in map(shlex.split, commands.splitlines()):
        name = words[words.index("-o") + 1] if "-o" in words else ""
        if name not in seen or "-c" not in words or "/made/" in words[-1]:
            continue
        found[name] = made / "anew" / name.replace("/", "_")
        cut = words.index("-MD")
        jobs.append(
            [*(f"-I{made}" if word == f"-I{usual}" else word for word in words[:cut]), "-o", found[name], *words[-2:]]
        )
    (made / "anew").mkdir(exist_ok=True)
    with ThreadPoolExecutor() as pool:
        list(pool.map(lambda job: subprocess.run(job, cwd=BUILD, check=True), jobs))
    return found


def linked(edition: Path, *sources: Path) -> Path:
    """The module of an edition's list, beside it.

    Linked as the usual one, with the edition's own tables before the libraries, which then give theirs to nobody. Where
    features outside of the tree have rows of parameters or signals, everything that has seen a list is compiled anew.

    Args:
        edition: the list.
        sources: of features outside of the tree.
    """
    made, module = BUILD / "own" / edition.stem, edition.with_suffix(".so")  # a path that stays, for compilers' caches
    subprocess.run([sys.executable, ROOT / "toolchain/compose.py", edition, made], check=True)
    flags = ["-std=c99", "-O2", "-fPIC", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror"]
    files = [*made.glob("*.c"), *sources]
    subprocess.run(["cc", *flags, f"-I{made}", f"-I{ROOT}", "-c", *files], cwd=made, check=True)
    usual = next((ROOT / "sim_host/stillspin").glob("_core*.so")).as_posix()
    commands = ninja("commands", usual)
    # The linker, its flags, -o MODULE, objects, libraries; CMake has something before it and something behind it.
    words = shlex.split(next(part for part in commands.splitlines()[-1].split(" && ") if " -o " in part))
    words[words.index("-o") + 1] = str(module)
    anew = (
        recompiled(made, commands) if any(source.with_name("parameter_list.h").exists() for source in sources) else {}
    )
    words = [str(anew.pop(word, word)) for word in words]
    at = next(k for k, word in enumerate(words) if word.endswith(".o"))
    words[at:at] = [*sorted(map(str, made.glob("*.o"))), *map(str, anew.values())]
    subprocess.run(words, cwd=BUILD, check=True)
    return module
