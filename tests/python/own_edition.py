"""The native module of an edition that the build does not make."""

import shlex
import subprocess
import sys
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


def linked(edition: Path, *sources: Path) -> Path:
    """The module of an edition's list, beside it.

    Linked as the usual one, with the edition's own tables before the libraries, which then give theirs to nobody.

    Args:
        edition: the list.
        sources: of features outside of the tree.
    """
    made, module = edition.with_suffix(""), edition.with_suffix(".so")
    subprocess.run([sys.executable, ROOT / "toolchain/compose.py", edition, made], check=True)
    flags = ["-std=c99", "-O2", "-fPIC", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror"]
    files = [*made.glob("*.c"), *sources]
    subprocess.run(["cc", *flags, f"-I{made}", f"-I{ROOT}", "-c", *files], cwd=made, check=True)
    usual = next((ROOT / "sim_host/stillspin").glob("_core*.so")).as_posix()
    commands = subprocess.run(
        ["ninja", "-C", BUILD, "-t", "commands", usual], capture_output=True, text=True, check=True
    ).stdout
    # The linker, its flags, -o MODULE, objects, libraries; CMake has something before it and something behind it.
    words = shlex.split(next(part for part in commands.splitlines()[-1].split(" && ") if " -o " in part))
    words[words.index("-o") + 1] = str(module)
    at = next(k for k, word in enumerate(words) if word.endswith(".o"))
    words[at:at] = sorted(map(str, made.glob("*.o")))
    subprocess.run(words, cwd=BUILD, check=True)
    return module
