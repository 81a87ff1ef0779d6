"""The lists of the firmware: macro calls, a row each, which C includes with different meanings of the macro.

A list has parts: files of one name in the folders of firmware/, and in those of an edition's features outside of the
tree. The build joins them to one header, a row of which means the same in every edition of the tree.
"""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TOKEN = re.compile(r'//[^\n]*|"(?:[^"\\]|\\.)*"|[(),]|[^"(),/]+|/')
PLACE = re.compile(r"^PLACE\((\d+)\)\n", re.MULTILINE)


@dataclass(frozen=True)
class Joined:
    """A list with parts."""

    header: str  # made of them
    macro: str
    keys: tuple[int, ...]  # the arguments of which no two rows have the same
    places: bool = False  # its order is that of the places in its parts; otherwise the first part, then by their paths


# By the parts' name.
JOINED = {
    "parameter_list.h": Joined("firmware/dictionary/all_parameters.h", "PARAMETER", (0,), places=True),
    "signal_list.h": Joined("firmware/dictionary/all_signals.h", "SIGNAL", (0,), places=True),
    "fault_list.h": Joined("firmware/dictionary/all_faults.h", "FAULT", (0,)),
    "request_list.h": Joined("firmware/link/all_requests.h", "REQUEST", (0, 2)),
    "command_list.h": Joined("firmware/console/all_commands.h", "COMMAND", (0,), places=True),
    "config_list.h": Joined("firmware/interfaces/all_config_values.h", "CONFIG_VALUE", (0,)),
    "help_list.h": Joined("firmware/console/all_help.h", "HELP", (0, 1)),
}


def rows(text: str, macro: str) -> list[list[str]]:
    """The arguments of each call of the macro; strings that stand side by side are one, without their quotes."""
    found: list[list[str]] = []
    depth, open_call, last = 0, False, ""
    for token in TOKEN.findall(text):
        if token.startswith("//"):
            continue
        if token == "(" and depth == 0:
            open_call = last.split()[-1:] == [macro]
            if open_call:
                found.append([""])
        elif token == ")" and depth == 1:
            open_call = False
        elif token == "," and depth == 1 and open_call:
            found[-1].append("")
        elif open_call:
            found[-1][-1] += token[1:-1].replace('\\"', '"') if token.startswith('"') else token.strip()
        depth += (token == "(") - (token == ")")
        last = token
    return found


@dataclass(frozen=True)
class Lists:
    """Those of a tree, and of folders outside of it."""

    root: Path = ROOT
    outside: tuple[Path, ...] = ()

    def parts(self, name: str) -> list[Path]:
        """The files of a list: the one beside the header that is made of them first, then by their paths."""
        first = self.root / Path(JOINED[name].header).with_name(name) if name in JOINED else None
        found = sorted((self.root / "firmware").rglob(name), key=lambda path: (path != first, path))
        return [*found, *(path for folder in self.outside if (path := folder / name).is_file())]

    def files(self) -> list[Path]:
        """All files named as a list."""
        places = ((self.root / "firmware").rglob, *(folder.glob for folder in self.outside))
        return sorted(path for found in places for path in found("*_list.h"))

    def text(self, name: str) -> str:
        """A list as one."""
        texts = [path.read_text(encoding="utf-8") for path in self.parts(name)]
        if name not in JOINED or not JOINED[name].places:
            return "\n".join(texts)
        return "\n".join(text.strip("\n") + "\n" for _, text in sorted(self._blocks(name, texts)))

    def _blocks(self, name: str, texts: Iterable[str]) -> Iterator[tuple[float, str]]:
        """What stands at a place, and behind all that have one what has none.

        Raises:
            ValueError: two stand at the same place, or rows before the first place of their file.
        """
        taken: set[str] = set()
        for text in texts:
            head, *placed = PLACE.split(text)
            if placed and (lost := rows(head, JOINED[name].macro)):
                raise ValueError(
                    f"{name}: {' '.join(lost[0][:2])} stands before the first PLACE of its file; give it one"
                )
            for place, block in zip(placed[::2], placed[1::2], strict=True):
                if place in taken:
                    raise ValueError(f"{name}: place {place} is taken")
                taken.add(place)
                yield float(place), block
            if not placed:
                yield float("inf"), head

    def rows(self, name: str, macro: str) -> list[list[str]]:
        """The rows of all parts; faults by their numbers, which their texts are found by.

        Raises:
            ValueError: two rows have the same number, or name.
        """
        found = rows(self.text(name), macro)
        keys = JOINED[name].keys if name in JOINED else ()
        seen: set[tuple[str, ...]] = set()
        for key in (tuple(row[k] for k in keys) for row in found if keys):
            if key in seen:
                raise ValueError(f"{name}: {' '.join(key)} is there twice")
            seen.add(key)
        return sorted(found, key=lambda row: int(row[0])) if macro == "FAULT" else found

    def joined(self) -> dict[str, str]:
        """The headers that have all parts of a list, by their names.

        Raises:
            ValueError: as ``rows``.
        """
        found = {}
        for name, of in JOINED.items():
            self.rows(name, of.macro)
            lines = ["// Made by toolchain/compose.py: the rows of every folder.", ""]
            if of.places:
                lines += [self.text(name)]
            else:
                paths = (
                    path.relative_to(self.root) if path.is_relative_to(self.root) else path.resolve()
                    for path in self.parts(name)
                )
                lines += [*(f'#include "{path.as_posix()}"' for path in paths), ""]
            found[of.header] = "\n".join(lines)
        return found


TREE = Lists()


def rows_of(folder: Path, name: str) -> list[list[str]]:
    """Those of one folder."""
    file = folder / name
    return rows(file.read_text(encoding="utf-8"), JOINED[name].macro) if file.is_file() else []
