"""What each feature takes of the image that has all of them, and that an edition is this image less what it leaves out.

An object belongs to the feature in whose folder its source is. One of the floors below belongs to the features from
which alone it is reached, by the names that objects ask for; what is reached without them, or from a feature that every
edition has, belongs to what every edition has. Of one that is compiled otherwise without a feature, what it has more is
this feature's. What differs beside that is the edition's own tables and texts.
"""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import compose
from costs import costs

from image.command_file import read_command_file
from image.elf import ObjectFile, read_object
from image.ram_code import SECTION, half_words
from image.sizes import object_words

PLACES = compose.ROOT / "toolchain" / "c28x" / "f2808_flash.cmd"
FIRMWARE = "stillspin_firmware.dir/"
PROGRAM = "stillspin_f2808.dir/"
TABLES = ("made/", "editions/")
FLASH = (".econst", ".cinit", ".pinit", ".switch")


@dataclass(frozen=True)
class Words:
    """Of flash, as expected, and of RAM, the code that runs there included."""

    flash: float = 0.0
    ram: float = 0.0

    def __add__(self, other: "Words") -> "Words":
        return Words(self.flash + other.flash, self.ram + other.ram)

    def __sub__(self, other: "Words") -> "Words":
        return Words(self.flash - other.flash, self.ram - other.ram)


Row = tuple[str, ...]  # the features that share it; none: what every edition has
Linked = Mapping[Path, ObjectFile]


def words_of(objects: Iterable[ObjectFile]) -> Words:
    """What objects come to."""
    per_half_word = costs(compose.ROOT)["words"]["expected"]
    file = read_command_file(PLACES)
    total = Words()
    for obj in objects:
        sections = object_words(obj)
        code = per_half_word * (sections.get(".text", 0) + sections.get(SECTION, 0))
        hot = per_half_word * half_words(obj, file)
        constants = sum(sections.get(name, 0) for name in FLASH)
        total += Words(code + constants, hot + sections.get(".ebss", 0))
    return total


def read(objects: Iterable[Path]) -> Linked:
    """The objects of a link that are compiled."""
    return {
        path: read_object(path) for path in objects if path.suffix == ".obj" and path.read_bytes()[:4] == b"\x7fELF"
    }


def _inside(path: Path) -> str:
    """Where an object lies in its library."""
    return path.as_posix().rpartition(".dir/")[2]


def _library(path: Path) -> str:
    """Of an object of the build."""
    return next((part.removesuffix(".dir") for part in path.parts if part.endswith(".dir")), "")


def tables(linked: Linked) -> Linked:
    """Those of the edition, its packed texts and what it has in the place of a source of another one among them."""
    instead = {library: sources for feature in compose.all_features() for library, sources in feature.instead.items()}
    return {
        path: obj
        for path, obj in linked.items()
        if any(f"/{folder}" in _inside(path) for folder in TABLES)
        or path.stem not in {Path(source).name for source in instead.get(_library(path), (path.stem,))}
    }


def shares(linked: Linked, always: Collection[str]) -> dict[Path, Row]:
    """Of each object but the tables the features that have it. `always`: features that every edition has."""
    left = linked.keys() - tables(linked).keys()
    folder = {path: _feature_of(path) for path in left}
    own = {path: "" if folder[path] in always else folder[path] for path in left}
    homes = {name: path for path in left for name in linked[path].defined}
    asks = {path: {homes[name] for name in linked[path].wanted & homes.keys()} for path in left}
    starts = {path: {own[path]} for path in left if own[path]}
    starts |= {path: {""} for path in left if PROGRAM in path.as_posix() or folder[path] in always}
    found: dict[Path, set[str]] = {path: set() for path in left}
    waiting = list(starts.items())
    while waiting:
        path, users = waiting.pop()
        if users <= found[path]:
            continue
        found[path] |= users
        waiting += [(below, users) for below in asks[path] if not own[below]]
    return {path: () if "" in users else tuple(sorted(users)) for path, users in found.items()}


def without(path: Path) -> tuple[str, Path | None]:
    """The feature without which there is something else in the place of an object, and that where it is its like."""
    for feature in compose.all_features():
        for library, sources in feature.instead.items():
            if any(path.match(f"{Path(source).parent}/CMakeFiles/*/{Path(source).name}.obj") for source in sources):
                other = path.parent.with_name(f"{library}.dir") / path.name
                return feature.name, other if other.exists() else None
    return "", None


def _feature_of(path: Path) -> str:
    """The feature that alone has a use for its source, or in whose folder that is, the innermost: folders may nest."""
    feature, other = without(path)
    if feature and not other:
        return feature
    names = (feature.name for feature in compose.all_features())
    return max((name for name in names if f"{FIRMWARE}{name}/" in path.as_posix()), key=len, default="")


def taken(linked: Linked, always: Collection[str]) -> dict[Row, Words]:
    """What features take of the flash and of the RAM, alone or with others; () is what every edition has."""
    found: dict[Row, Words] = {}
    for path, row in shares(linked, always).items():
        feature, other = without(path)
        words = words_of([linked[path]])
        if other:
            less = words_of([read_object(other)])
            found[(feature,)] = found.get((feature,), Words()) + words - less
            words = less
        found[row] = found.get(row, Words()) + words
    return dict(sorted(found.items()))


def difference(whole: Linked, edition: Linked, left_out: Iterable[str], rows: Mapping[Row, Words]) -> Words:
    """What an edition takes beside the whole image less what it leaves out: nothing, but for a fault of the build."""
    gone = set(left_out)
    less = sum((words for row, words in rows.items() if row and gone.issuperset(row)), Words())
    of_tables = words_of(tables(edition).values()) - words_of(tables(whole).values())
    return words_of(edition.values()) - (words_of(whole.values()) - less + of_tables)
