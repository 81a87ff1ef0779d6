#!/usr/bin/env python3
"""Makes what the build makes of the firmware's lists: the texts, packed, and their numbers.

Usage: toolchain/compose.py FOLDER     (the build does it)

What has not changed is not written again. FOLDER belongs into the include path before the tree.
"""

import sys
from pathlib import Path

import pack_text

TEXTS, CMAKE = "packed_text_table.c", "composed.cmake"


def made(root: Path = pack_text.ROOT) -> dict[str, str]:
    """The files by their names in the folder."""
    texts = pack_text.texts(root)
    return {pack_text.NUMBERS: pack_text.numbers(list(texts)), TEXTS: pack_text.pack(list(texts.values()))}


def write(folder: Path, root: Path = pack_text.ROOT) -> list[Path]:
    """Writes what differs; the C sources among them."""
    files = made(root)
    for name, text in files.items():
        file = folder / name
        if not file.exists() or file.read_text(encoding="utf-8") != text:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
    return [folder / name for name in files if name.endswith(".c")]


def set_list(name: str, paths: list[Path]) -> str:
    """A list for CMake."""
    return "\n  ".join([f"set({name}", *(path.resolve().as_posix() for path in paths)]) + ")\n"


def write_for_cmake(folder: Path) -> None:
    """The same, and what CMake has to know of it: the sources made, and what they are made of."""
    sources = write(folder)
    tools = [Path(__file__), Path(pack_text.__file__)]
    lists = [*tools, *pack_text.files(pack_text.ROOT)]
    text = set_list("composed_sources", sources) + set_list("composed_from", lists)
    (folder / CMAKE).write_text(text, encoding="utf-8")


def main() -> int:
    """See above."""
    if len(sys.argv) != 2:
        print(__doc__.strip())
        return 2
    try:
        write_for_cmake(Path(sys.argv[1]))
    except ValueError as error:
        print(f"compose: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
