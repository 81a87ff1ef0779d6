"""What a feature includes, calls and looks up is of features that it needs: an edition that composes has no hole.

The folders that are no feature are in every edition and count as the drive's, which every edition has. What a feature
says to console and link is in files of its own, which nobody else in it uses: where there is no console, they are out.
"""

import re
import shutil
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

import compose  # noqa: E402
from checks.calls import code, foreign_calls  # noqa: E402
from checks.preprocessor import directives  # noqa: E402

DRIVE = "drive"
PROGRAMS = ("firmware/flash_kernel/", "firmware/lamp/")  # of their own
VALUES = "firmware/dictionary/parameters.h"
SPEAKS = {"console": re.compile(r"/(sub_)?commands\w*\.[ch]$"), "link": re.compile(r"/requests\w*\.[ch]$")}
LOOKED_UP = re.compile(r"\bposition_sources\[(POSITION_\w+)\]")


def feature_at(path: str, names: list[str]) -> str | None:
    """The feature that a file of the tree is of."""
    if not path.startswith("firmware/") or path.startswith(PROGRAMS):
        return None
    fitting = (name for name in names if path.startswith(f"firmware/{name}/"))
    return max(fitting, key=len, default=DRIVE)


def sources_by_value(root: Path, features: list[compose.Feature]) -> dict[str, str]:
    """The feature whose row a value of ``position_source`` looks up."""
    by_place = {place: f.name for f in features for place, _ in f.places("position_sources")}
    numbers = re.findall(r"\b(POSITION_\w+) = (\d+)", code(root / VALUES))
    return {name: by_place[int(number)] for name, number in numbers}


def uses(root: Path, features: list[compose.Feature]) -> dict[tuple[str, str], str]:
    """Which feature uses which other one, and where for one."""
    names = [feature.name for feature in features]
    found: dict[tuple[str, str], str] = {}

    def note(source: str, target: str | None, where: str) -> None:
        user = feature_at(source, names)
        if target in SPEAKS and SPEAKS[target].search(source):
            return
        if user and target and user != target:
            found.setdefault((user, target), f"{source}: {where}")

    for call in foreign_calls(root, "firmware"):
        note(call.source, feature_at(call.defined, names), f"{call.name}()")
    values = sources_by_value(root, features)
    for path in sorted((root / "firmware").rglob("*.[ch]")):
        source = path.relative_to(root).as_posix()
        for directive in directives(path.read_text(encoding="utf-8")):
            if directive.name == "include" and directive.rest.startswith('"firmware/'):
                target = directive.rest.split('"')[1]
                note(source, feature_at(target, names), f"#include of {target}")
        for value in LOOKED_UP.findall(code(path)):
            note(source, values[value], f"position_sources[{value}]")
    return found


def closure(name: str, needs: dict[str, tuple[str, ...]]) -> set[str]:
    """What comes with a feature."""
    reached, waiting = {name}, [name]
    while waiting:
        fresh = set(needs[waiting.pop()]) - reached
        reached |= fresh
        waiting += fresh
    return reached


def missing(root: Path) -> dict[tuple[str, str], str]:
    """Uses of a feature that does not come with the user."""
    features = compose.all_features(root)
    needs = {feature.name: feature.needs for feature in features}
    reached = {name: closure(name, needs) for name in needs}
    return {pair: where for pair, where in uses(root, features).items() if pair[1] not in reached[pair[0]]}


@pytest.fixture
def house(tmp_path: Path) -> Path:
    """A copy of the firmware."""
    shutil.copytree(ROOT / "firmware", tmp_path / "firmware")
    return tmp_path


def test_what_a_feature_uses_comes_with_it() -> None:
    assert not missing(ROOT)


def test_the_uses_that_there_are_are_seen() -> None:
    """By call, by include, and by a place of the table."""
    found = uses(ROOT, compose.all_features())
    assert {
        ("can", "link"),
        ("sources/paper", "sources/observer"),
        ("commissioning", "board"),
    } <= found.keys()


@pytest.mark.parametrize("feature", ["can", "sources/paper", "start/flying"])
def test_a_need_that_nobody_states_is_found(house: Path, feature: str) -> None:
    file = house / "firmware" / feature / compose.FEATURE
    file.write_text(
        re.sub(r"(?m)^needs = .*\n", "", file.read_text(encoding="utf-8")),
        encoding="utf-8",
    )
    stated = {f.name: f.needs for f in compose.all_features()}
    assert {used for user, used in missing(house) if user == feature} & set(stated[feature])


@pytest.mark.parametrize(
    ("file", "line", "pair"),
    [
        (
            "firmware/board/planted.c",
            "void planted(void) { scope_step(); }",
            ("board", "scope"),
        ),
        (
            "firmware/scope/planted.c",
            "void planted(void) { line_end(); }",
            ("scope", "console"),
        ),
        (
            "firmware/link/planted.c",
            '#include "firmware/store/store.h"',
            ("link", "store"),
        ),
        (
            "firmware/start/planted.c",
            "const void* planted(void) { return position_sources[POSITION_FLUX_CONV]; }",
            ("start", "sources/flux"),
        ),
        (
            "firmware/mode/planted.c",
            "void planted(void) { hil_reset(); }",
            (DRIVE, "hil"),
        ),
    ],
)
def test_a_planted_use_is_found(house: Path, file: str, line: str, pair: tuple[str, str]) -> None:
    (house / file).write_text(line + "\n", encoding="utf-8")
    assert missing(house).keys() == {pair}
