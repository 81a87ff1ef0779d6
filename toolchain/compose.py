#!/usr/bin/env python3
"""Makes what an edition of the firmware is composed of: its tables, the packed texts and their numbers.

Usage: toolchain/compose.py EDITION FOLDER     (the build does it)

EDITION is a list in firmware/editions/ or a file of that form elsewhere: one feature a line, a folder of firmware/ with
a feature.toml, or a path from where the list is. What a feature.toml may say:

    needs       features without which this one does not work
    headers     what declares the rows: in its folder, or from the root
    words       kinds of words (text/word_list.h) that are its own
    instead     what an image without it has: libraries, by each the sources outside of the folder whose place it takes
    rows        by table: what stands there, with its place: a number, smaller ones come first. What console and link
                alone ask for is dropped without them, and with it what a feature's commands*.c and requests*.c are for

What else is its own stands in lists of its folder (row_lists.py): parameters, signals, commands, requests, faults,
texts.

What has not changed is not written again. FOLDER belongs into the include path before the tree.
"""

import hashlib
import re
import sys
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import edition_tables
import pack_text
import row_lists
import word_code
from edition_tables import TABLES
from row_lists import ROOT, Lists, rows_of

EDITIONS, FEATURE = "firmware/editions", "feature.toml"
PARAMETERS, SIGNALS, FAULTS, REQUESTS = "parameter_list.h", "signal_list.h", "fault_list.h", "request_list.h"
COMMANDS = "command_list.h"
SOURCES, SOURCE = "position_sources", "position_source"  # a table, and the parameter that it is looked up by
_MAXIMUM = 6  # place of a parameter's in its row
KINDS, KIND = "firmware/text/catalogue.h", re.compile(r"CATALOGUE_([A-Z]+) = (\d+)")
TEXTS, CMAKE = "packed_text_table.c", "composed.cmake"
OF_COMMAND = 0x100  # REQUEST_OF_COMMAND, firmware/link/request_rows.h


@dataclass(frozen=True)
class Feature:
    """A folder with what it says of itself."""

    name: str
    folder: Path
    needs: tuple[str, ...] = ()
    headers: tuple[str, ...] = ()
    words: tuple[str, ...] = ()
    instead: dict[str, list[str]] = field(default_factory=dict)
    rows: dict[str, Any] = field(default_factory=dict)

    @property
    def replaced(self) -> list[str]:
        """The sources that an image without it has others for."""
        return [source for sources in self.instead.values() for source in sources]

    @property
    def parameters(self) -> dict[int, str]:
        """Names of its own parameters by their numbers."""
        return {int(row[0]): row[1] for row in rows_of(self.folder, PARAMETERS)}

    @property
    def signals(self) -> tuple[str, ...]:
        """Names of its own signals."""
        return tuple(row[0] for row in rows_of(self.folder, SIGNALS))

    @property
    def commands(self) -> tuple[str, ...]:
        """Names of its own commands."""
        return tuple(row[0] for row in rows_of(self.folder, COMMANDS))

    @property
    def faults(self) -> tuple[int, ...]:
        """Numbers of the faults that only it brings about."""
        return tuple(int(row[0]) for row in rows_of(self.folder, FAULTS))

    @property
    def requests(self) -> tuple[int, ...]:
        """Numbers of its requests, those of commands as REQUEST_OF_COMMAND has them."""
        rows = rows_of(self.folder, REQUESTS)
        return tuple(int(number, 0) + (OF_COMMAND if kind == "COMMAND" else 0) for kind, _, number in rows)

    def places(self, table: str) -> list[tuple[int, str]]:
        """Its rows in a table with their places."""
        found = []
        for name, places in self.rows.get(table, {}).items():
            found += [(place, name) for place in (places if isinstance(places, list) else [places])]
        return found


@dataclass(frozen=True)
class Edition:
    """A list of features."""

    name: str
    file: Path
    features: tuple[Feature, ...]

    def commands(self, root: Path = ROOT) -> list[str]:
        """The names of all commands by their places, of those as well that it has not."""
        return [row[0] for row in self.lists(root).rows(COMMANDS, "COMMAND")]

    def rows(self, table: str, root: Path = ROOT) -> list[tuple[Feature, list[tuple[int, str]]]]:
        """What stands in a table: the features that have rows in it, and these with their places."""
        asked_by = TABLES[table].asked_by
        if asked_by and asked_by not in {feature.name for feature in self.features}:
            return []
        if table == "commands":
            place = self.commands(root).index
            owners = (feature for feature in self.features if feature.commands)
            return [(owner, [(place(name), f"command_{name}") for name in owner.commands]) for owner in owners]
        return [(feature, own) for feature in self.features if (own := feature.places(table))]

    def outside(self, root: Path = ROOT) -> list[Feature]:
        """The features that are not in the tree."""
        inside = (root / "firmware").resolve()
        return [feature for feature in self.features if not feature.folder.resolve().is_relative_to(inside)]

    def lists(self, root: Path = ROOT) -> Lists:
        """The rows of the tree, and of its features outside of it."""
        return Lists(root, tuple(feature.folder for feature in self.outside(root)))


def feature_of(name: str, folder: Path) -> Feature:
    """What the folder says.

    Raises:
        ValueError: it says nothing, or something that is not known.
    """
    file = folder / FEATURE
    if not file.is_file():
        raise ValueError(f"there is no feature {name}: {file} does not exist")
    try:
        said = tomllib.loads(file.read_text(encoding="utf-8"))
        if unknown := said.get("rows", {}).keys() - TABLES.keys():
            raise ValueError(f"no table is called {', '.join(sorted(unknown))}")
        lists = {key: value if isinstance(value, dict) else tuple(value) for key, value in said.items()}
        return Feature(name, folder, **lists)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{file}: {error}") from error


def all_features(root: Path = ROOT) -> list[Feature]:
    """Those of the tree."""
    base = root / "firmware"
    folders = sorted(file.parent for file in base.rglob(FEATURE))
    return [feature_of(folder.relative_to(base).as_posix(), folder) for folder in folders]


def read_edition(name: str, root: Path = ROOT) -> Edition:
    """An edition by its name, or by the path of its list.

    Raises:
        ValueError: there is no such list, a feature that it names does not exist or needs one that it does not name.
    """
    own = name.endswith(".txt")
    file = Path(name) if own else root / EDITIONS / f"{name}.txt"
    if not file.is_file():
        known = ", ".join(path.stem for path in sorted((root / EDITIONS).glob("*.txt")))
        raise ValueError(f"there is no edition {name}: {file} does not exist; there are {known}")
    features = []
    for line in file.read_text(encoding="utf-8").splitlines():
        said = line.partition("#")[0].strip()
        if said:
            inside = root / "firmware" / said
            outside = file.parent / said
            features.append(feature_of(said, outside if not inside.is_dir() and outside.is_dir() else inside))
    here = {feature.name for feature in features}
    for feature in features:
        if missing := [need for need in feature.needs if need not in here]:
            raise ValueError(f"{file}: {feature.name} needs {', '.join(missing)}")
    return Edition(file.stem, file, tuple(features))


def table_text(name: str, edition: Edition, root: Path) -> str:
    """The C file with a table.

    Raises:
        ValueError: two features want the same place.
    """
    table = TABLES[name]
    if name == "commands":
        table = replace(table, least=len(edition.commands(root)))
    if name == SOURCES:
        table = replace(table, least=values_of(SOURCE, edition, root))
    rows: list[tuple[int, str]] = []
    headers = {table.header}
    for feature, own in edition.rows(name, root):
        rows += own
        headers |= {header_of(feature, header, root) for header in feature.headers}
    rows.sort()
    for (place, row), (next_place, next_row) in pairwise(rows):
        if place == next_place or table.form == "one":
            raise ValueError(f"{edition.file}: {row} and {next_row} want the same place in {name}")
    lines = [f"// Made by toolchain/compose.py: {name} of the edition {edition.name}.", "", "#include <stddef.h>", ""]
    lines += [f'#include "{header}"' for header in sorted(headers)]
    return "\n".join([*lines, "", table.text(name, rows)])


def values_of(parameter: str, edition: Edition, root: Path) -> int:
    """How many values a parameter may have that goes from 0 on; 0 where there is none of that name."""
    rows = edition.lists(root).rows(PARAMETERS, "PARAMETER")
    return next((int(row[_MAXIMUM]) + 1 for row in rows if row[1] == parameter), 0)


def variants_text(edition: Edition, root: Path) -> str:
    """The C file with which of its places a position source has there (firmware/interfaces/source.h)."""
    rows = [row for feature, _ in edition.rows(SOURCES, root) for row in feature.rows[SOURCES].items()]
    places = {name: own for name, own in rows if isinstance(own, list) and len(own) > 1}
    head = f"// Made by toolchain/compose.py: the position sources of the edition {edition.name}.\n"
    return head + edition_tables.variants_text(places, values_of(SOURCE, edition, root))


def header_of(feature: Feature, header: str, root: Path) -> str:
    """As it is included: from the root, or by its whole path where the feature is not in the tree."""
    if header.startswith("firmware/"):
        return header
    path = feature.folder / header
    return path.relative_to(root).as_posix() if path.is_relative_to(root) else path.resolve().as_posix()


def runs(rows: Iterable[int]) -> list[tuple[int, int]]:
    """Rows that follow each other, as their first and their number."""
    found: list[tuple[int, int]] = []
    for row in sorted(rows):
        first, count = found[-1] if found else (row, 0)
        found = [*found[:-1], (first, count + 1)] if first + count == row and count else [*found, (row, 1)]
    return found


def looks_text(edition: Edition, root: Path) -> str:
    """The C file with how the signals are looked at (firmware/drive/steps.h)."""
    gone = {name for feature in left_out(edition, root) for name in feature.signals}
    signals = [row[0] for row in edition.lists(root).rows(SIGNALS, "SIGNAL")]
    looks = ["look_at_nothing" if name in gone else f"look_at_{name}" for name in signals]
    return "\n".join(
        [
            f"// Made by toolchain/compose.py: the signals of the edition {edition.name}.",
            "",
            '#include "firmware/drive/steps.h"',
            "",
            *(f"signal_look_t {look};" for look in dict.fromkeys(looks)),
            "signal_look_t* const edition_signal_looks[] = {",
            *(f"    {look}," for look in looks),
            "};",
            "",
        ]
    )


def left_out_text(edition: Edition, root: Path) -> str:
    """The C file with what the edition has not (firmware/base/edition.h).

    Raises:
        ValueError: a feature names a kind of words that does not exist.
    """
    lists = edition.lists(root)
    parameters = [int(row[0]) for row in lists.rows(PARAMETERS, "PARAMETER")]
    signals = [row[0] for row in lists.rows(SIGNALS, "SIGNAL")]
    faults = [int(row[0]) for row in lists.rows(FAULTS, "FAULT")]
    kinds = dict(KIND.findall((root / KINDS).read_text(encoding="utf-8")))
    gone = left_out(edition, root)

    def rows(what: str, numbers: Iterable[int]) -> str:
        found = runs(numbers)
        text = "".join(f"{{{first}, {count}}}, " for first, count in found)
        return f"const rows_t edition_{what}_left_out[] = {{{text}{{0, 0}}}};"

    try:
        mask = sum(1 << int(kinds[word]) for feature in gone for word in feature.words)
    except KeyError as error:
        raise ValueError(f"{FEATURE}: {error}") from error
    tables = [
        rows("parameters", (parameters.index(number) for feature in gone for number in feature.parameters)),
        rows("signals", (signals.index(name) for feature in gone for name in feature.signals)),
        rows("faults", (faults.index(number) for feature in gone for number in feature.faults)),
        rows("requests", (number for feature in gone for number in feature.requests)),
    ]
    return "\n".join(
        [
            f"// Made by toolchain/compose.py: what the edition {edition.name} has not.",
            "",
            '#include "firmware/base/edition.h"',
            "",
            f'const char edition_name[] = "{edition.name}";',
            *tables,
            f"const uint16_t edition_words_left_out = 0x{mask:04x}u;",
            "",
        ]
    )


def needless_texts(edition: Edition, root: Path) -> set[str]:
    """What the edition never says: of the features that it has not all but the names, which it refuses."""
    gone = left_out(edition, root)
    found = {f"TEXT_PARAMETER_{name}" for feature in gone for name in feature.parameters.values()}
    found |= {f"TEXT_SIGNAL_{name}" for feature in gone for name in feature.signals}
    found |= {f"TEXT_{what}_{number}" for feature in gone for number in feature.faults for what in ("FAULT", "REMEDY")}
    answered = {name for _, own in edition.rows("commands", root) for _, name in own}
    commands = [name for name in edition.commands(root) if f"command_{name}" not in answered]
    found |= {f"TEXT_COMMAND_{what}{name}" for name in commands for what in ("", "ARGUMENTS_")}
    kinds = tuple(f"TEXT_{word}_" for feature in gone for word in feature.words)
    kinds += tuple(f"TEXT_HELP_{name}_" for name in commands)
    for feature in gone:
        list_of_phrases = feature.folder / "phrase_list.h"
        if list_of_phrases.exists():
            said = row_lists.rows(list_of_phrases.read_text(encoding="utf-8"), "PHRASE")
            found |= {f"SAY_{row[0]}" for row in said}
    return found | {name for name in pack_text.texts(edition.lists(root)) if name.startswith(kinds)}


def left_out(edition: Edition, root: Path = ROOT) -> list[Feature]:
    """The tree's features that it has not."""
    here = {feature.name for feature in edition.features}
    return [feature for feature in all_features(root) if feature.name not in here]


def made(edition: Edition, root: Path = ROOT) -> dict[str, str]:
    """The files by their names in the folder."""
    lists = edition.lists(root)
    texts = pack_text.texts(lists)
    needless = needless_texts(edition, root)
    kept = ["" if name in needless else text for name, text in texts.items()]
    return {
        pack_text.NUMBERS: pack_text.numbers(list(texts)),
        **lists.joined(),
        TEXTS: pack_text.pack(kept, sum(1 for name in texts if pack_text.NAME.match(name))),
        "left_out.c": left_out_text(edition, root),
        "signal_looks.c": looks_text(edition, root),
        "source_variants.c": variants_text(edition, root),
        **{f"{name}.c": table_text(name, edition, root) for name in TABLES},
    }


def write(folder: Path, edition: str = "lab", root: Path = ROOT) -> list[Path]:
    """Writes what differs; the C sources among them."""
    files = made(read_edition(edition, root), root)
    for name, text in files.items():
        write_one(folder / name, text)
    return [folder / name for name in files if name.endswith(".c")]


def write_one(file: Path, text: str) -> None:
    """Writes a file that says something else, or is not there."""
    if not file.exists() or file.read_text(encoding="utf-8") != text:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")


def set_list(name: str, values: Iterable[str]) -> str:
    """A list for CMake."""
    return "\n  ".join([f"set({name}", *values]) + ")\n"


def write_for_cmake(folder: Path, name: str) -> None:
    """The same, and what CMake has to know of it."""
    edition, features = read_edition(name), all_features()
    sources = write(folder, name)
    outside, lists = edition.outside(), edition.lists()
    files = [
        *(Path(module.__file__) for module in (edition_tables, pack_text, row_lists, word_code)),
        Path(__file__),
        edition.file,
    ]
    files += lists.files()
    files += [feature.folder / FEATURE for feature in (*features, *outside)]
    text = set_list("composed_sources", (path.resolve().as_posix() for path in sources))
    text += set_list("composed_from", (path.resolve().as_posix() for path in files))
    text += set_list("composed_left_out", (feature.name for feature in left_out(edition)))
    text += set_list("composed_instead", (library for feature in left_out(edition) for library in feature.instead))
    text += set_list("composed_outside", (feature.folder.resolve().as_posix() for feature in outside))
    dictionary = "".join(lists.text(name) for name in (PARAMETERS, SIGNALS, FAULTS))
    text += set_list("composed_tables", [hashlib.sha256(dictionary.encode()).hexdigest()[:8]])
    write_one(folder / CMAKE, text)


def main() -> int:
    """See above."""
    if len(sys.argv) != 3:
        print(__doc__.strip())
        return 2
    try:
        write_for_cmake(Path(sys.argv[2]), sys.argv[1])
    except ValueError as error:
        print(f"compose: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
