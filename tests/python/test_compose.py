"""The composition of an edition: what its list takes, what it is refused for, and the tables that come of it."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

import compose  # noqa: E402
from edition_tables import TABLES  # noqa: E402

SPOKEN = {"commands", "status_lines", "text_port", "requests"}
EDITIONS = sorted(path.stem for path in (ROOT / compose.EDITIONS).glob("*.txt"))


def plant(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def rows(text: str) -> list[str]:
    """What stands in a table."""
    found = re.search(r"\{(.*)\}", text, re.DOTALL)
    assert found
    return [row.strip().removeprefix("&") for row in found[1].split(",") if row.strip()]


def test_lab_has_everything() -> None:
    assert {feature.name for feature in compose.read_edition("lab").features} == {
        feature.name for feature in compose.all_features()
    }


def test_an_image_has_something_instead_of_what_only_a_feature_left_out_needs(tmp_path: Path) -> None:
    for edition in EDITIONS:
        compose.write_for_cmake(tmp_path, edition)
        said = re.search(r"set\(composed_instead([^)]*)\)", (tmp_path / compose.CMAKE).read_text(encoding="utf-8"))
        assert said
        has = "hil" in {feature.name for feature in compose.read_edition(edition).features}
        instead = [] if has else ["stillspin_no_replay", "stillspin_unrecorded"]
        assert said[1].split() == instead, edition
    for feature in compose.all_features():
        assert all((ROOT / source).is_file() for source in feature.replaced)


def test_each_edition_is_smaller_than_lab() -> None:
    lab = {feature.name for feature in compose.read_edition("lab").features}
    for name in set(EDITIONS) - {"lab"}:
        assert {feature.name for feature in compose.read_edition(name).features} < lab


def test_hil_is_drive_with_a_host_in_the_place_of_commissioning() -> None:
    drive, hil = ({feature.name for feature in compose.read_edition(name).features} for name in ("drive", "hil"))
    assert drive - hil == {"commissioning"}
    assert hil - drive == {"hil"}


def test_a_table_has_the_rows_of_the_edition_in_their_order(tmp_path: Path) -> None:
    resets = compose.table_text("resets", compose.read_edition("lab"), ROOT)
    assert [row for row in rows(resets) if row.startswith(("scope", "store", "board"))] == [
        "scope_reset",
        "store_reset",
        "board_reset",
    ]
    backwards = plant(tmp_path, "backwards.txt", "scope\nstore\nboard\nconsole\nlink\nsources/observer\ndrive\n")
    assert rows(compose.table_text("resets", compose.read_edition(str(backwards)), ROOT)) == [
        row for row in rows(resets) if row.startswith(("scope", "store", "board", "NULL"))
    ]


QUIET = "drive\nsources/observer\nstart\nstart/flying\nstart/if_start\nboard\nstore\nscope\ncommissioning\n"


def test_what_console_and_link_ask_for_goes_with_them(tmp_path: Path) -> None:
    for said, asked in ((QUIET, set()), (f"{QUIET}link\n", {"requests"}), (f"{QUIET}link\nconsole\n", SPOKEN)):
        edition = compose.read_edition(str(plant(tmp_path, "own.txt", said)))
        assert {name for name in SPOKEN if edition.rows(name)} == asked
        needless = compose.needless_texts(edition, ROOT)
        assert ("TEXT_COMMAND_scope" in needless) == ("TEXT_HELP_start_1" in needless) == (asked != SPOKEN)
        assert edition.rows("resets")


def test_a_command_stands_where_its_list_says_and_only_with_its_feature(tmp_path: Path) -> None:
    own = plant(tmp_path, "mine/feature.toml", 'needs = ["console"]\nheaders = ["mine.h"]\n').parent
    plant(own, "command_list.h", 'PLACE(25)\nCOMMAND(limit, "", "the limit")\n')
    listed = plant(tmp_path, "own.txt", f"{QUIET}link\nconsole\nmine\n")
    edition = compose.read_edition(str(listed))
    names = edition.commands()
    assert names.index("defaults") + 1 == names.index("limit") == names.index("start") - 1
    made = rows(compose.table_text("commands", edition, ROOT))
    assert made == ["NULL" if name == "can" else f"command_{name}" for name in names]
    assert "TEXT_COMMAND_limit" in compose.made(edition)[compose.pack_text.NUMBERS]
    assert "limit" not in compose.read_edition("lab").commands()


def test_without_console_and_link_nothing_of_them_is_linked(tmp_path: Path) -> None:
    """What main() leads to is taken out of the library, as the image takes it; the board's functions stay open."""
    compose.write(tmp_path / "made", str(plant(tmp_path, "quiet.txt", QUIET)))
    files = [path.as_posix() for path in (tmp_path / "made").glob("*.c")]
    subprocess.run(["cc", "-c", f"-I{tmp_path / 'made'}", f"-I{ROOT}", *files], cwd=tmp_path, check=True)
    library = ROOT / "build/release/firmware/libstillspin_firmware.a"
    whole, objects = tmp_path / "whole.o", sorted(map(str, tmp_path.glob("*.o")))
    subprocess.run(["ld", "-r", "-u", "firmware_main", "-o", whole, *objects, library], check=True)
    found = subprocess.run(["nm", whole], capture_output=True, text=True, check=True).stdout
    defined = set(re.findall(r"^\w+ [TtDdBbRr] (\w+)$", found, re.MULTILINE))
    assert {"firmware_main", "store_service", "scope_step", "commissioning_state", "board_service"} <= defined
    spoken = re.compile(r"(command|line|console|editor|request|link|stream|splitter|record)_\w+")
    assert not {name for name in defined if spoken.fullmatch(name)}
    assert not re.findall(r"^ +U (?!hal_)(\w*(?:command|console|edition|request)\w*)$", found, re.MULTILINE)


def test_what_is_left_out_leaves_its_place_empty() -> None:
    sources = compose.table_text("position_sources", compose.read_edition("minimal"), ROOT)
    assert rows(sources) == ["NULL", "NULL", "observer_avv_source", "avv_source", "observer_source", *["NULL"] * 4]
    states = compose.table_text("drive_states", compose.read_edition("minimal"), ROOT)
    assert rows(states) == [*["NULL"] * 3, "start_state", *["NULL"] * 4]
    assert "edition_phase_control = NULL;" in compose.table_text("phase_control", compose.read_edition("minimal"), ROOT)


def test_every_value_of_position_source_has_its_place_in_every_edition() -> None:
    for name in ("lab", "minimal"):
        edition = compose.read_edition(name)
        places = rows(compose.table_text("position_sources", edition, ROOT))
        assert len(places) == compose.values_of("position_source", edition, ROOT) == 9
    assert compose.values_of("no_parameter", edition, ROOT) == 0


def test_a_source_with_several_values_knows_which_of_them_it_has() -> None:
    lab, minimal = (compose.read_edition(name) for name in ("lab", "minimal"))
    assert "position_source_variants[] = {0, 0, 0, 0, 0, 1, 2, 3, 4};" in compose.variants_text(lab, ROOT)
    assert "position_source_variants[] = {0};" in compose.variants_text(minimal, ROOT)
    one = compose.Feature("one", ROOT, rows={"position_sources": {"one_source": [9]}})
    more = compose.Feature("more", ROOT, rows={"position_sources": {"more_source": [10, 11]}})
    with_one = compose.Edition("own", ROOT, (*lab.features, one))
    assert "{0, 0, 0, 0, 0, 1, 2, 3, 4};" in compose.variants_text(with_one, ROOT)
    with pytest.raises(ValueError, match="flux_source and more_source have several places"):
        compose.variants_text(compose.Edition("own", ROOT, (*lab.features, more)), ROOT)


def test_texts_of_what_is_left_out_are_not_packed_but_for_names() -> None:
    needless = compose.needless_texts(compose.read_edition("minimal"), ROOT)
    gone = {
        "TEXT_COMMAND_scope",
        "TEXT_COMMAND_ARGUMENTS_scope",
        "TEXT_HELP_scope_1",
        "TEXT_FAULT_28",
        "TEXT_REMEDY_28",
    }
    assert gone <= needless
    kept = {"TEXT_COMMAND_NAME_scope", "TEXT_COMMAND_start", "TEXT_HELP_start_1", "TEXT_FAULT_2", "TEXT_STATUS_8"}
    assert not kept & needless
    assert needless <= compose.pack_text.texts().keys(), "every one of them is a text"
    assert not compose.needless_texts(compose.read_edition("lab"), ROOT)


def test_every_row_is_declared_by_a_header_that_its_feature_names() -> None:
    """Otherwise only the compiler of an edition that has it would notice."""
    for feature in compose.all_features():
        headers = [ROOT / compose.header_of(feature, header, ROOT) for header in feature.headers]
        declared = "".join(header.read_text(encoding="utf-8") for header in headers)
        rows_of_it = [name for table in feature.rows.values() for name in table]
        for name in (*rows_of_it, *(f"command_{command}" for command in feature.commands)):
            assert re.search(rf"\b{name}\b", declared), f"{feature.name}: {name}"


@pytest.mark.parametrize(
    ("lines", "wrong"),
    [
        ("drive\nscoop\n", "there is no feature scoop"),
        ("drive\nbase\n", "there is no feature base"),
        ("console\n", "console needs link"),
        ("hysteresis\nsources/encoder\nsources/flux\n", "sources/encoder needs sources/observer"),
    ],
)
def test_a_list_that_cannot_be_built_is_refused_by_name(tmp_path: Path, lines: str, wrong: str) -> None:
    own = plant(tmp_path, "own.txt", lines)
    with pytest.raises(ValueError, match=wrong):
        compose.read_edition(str(own))


def test_an_edition_that_there_is_not_is_refused_with_those_that_there_are() -> None:
    with pytest.raises(ValueError, match=f"no edition labs: .*there are {', '.join(EDITIONS)}"):
        compose.read_edition("labs")


@pytest.mark.parametrize(
    ("said", "wrong"),
    [
        ("[rows]\nrests = { a = 1 }\n", "no table is called rests"),
        ('need = ["link"]\n', "need"),
        ("needs = [\n", "feature.toml"),
    ],
)
def test_a_feature_that_says_what_nobody_knows_is_refused(tmp_path: Path, said: str, wrong: str) -> None:
    plant(tmp_path, "own/feature.toml", said)
    own = plant(tmp_path, "own.txt", "own\n")
    with pytest.raises(ValueError, match=wrong):
        compose.read_edition(str(own))


def test_two_rows_of_one_place_are_refused(tmp_path: Path) -> None:
    plant(tmp_path, "own/feature.toml", "[rows]\nphase_control = { own_control = 1 }\n")
    own = plant(tmp_path, "own.txt", "drive\nsources/observer\nsources/flux\nsources/encoder\nhysteresis\nown\n")
    with pytest.raises(ValueError, match="hysteresis_control and own_control want the same place in phase_control"):
        compose.table_text("phase_control", compose.read_edition(str(own)), ROOT)


def test_an_edition_needs_what_a_start_looks_with(tmp_path: Path) -> None:
    own = plant(tmp_path, "own.txt", "drive\n")
    with pytest.raises(ValueError, match="no feature is there for start_source, and no edition works without it"):
        compose.table_text("start_source", compose.read_edition(str(own)), ROOT)


def test_a_list_is_joined_of_every_folders_part(tmp_path: Path) -> None:
    joined = compose.made(compose.read_edition("minimal"), ROOT)["firmware/interfaces/all_config_values.h"]
    assert '#include "firmware/drive/config_list.h"' in joined
    assert '#include "firmware/commissioning/config_list.h"' in joined


def test_the_configuration_stops_where_the_edition_cannot_be_built(tmp_path: Path) -> None:
    plant(tmp_path, "own.txt", "console\n")
    command = ["cmake", "-S", str(ROOT), "-B", str(tmp_path / "build"), f"-DSTILLSPIN_EDITION={tmp_path / 'own.txt'}"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert "console needs link" in done.stderr


def test_a_feature_that_is_reached_over_the_tree_is_outside_of_it(tmp_path: Path) -> None:
    tree = tmp_path / "tree"
    plant(tmp_path, "tree/firmware/editions/own.txt", "../../../mine\n")
    plant(tmp_path, "mine/feature.toml", "")
    edition = compose.read_edition(str(tree / "firmware/editions/own.txt"), tree)
    assert [feature.name for feature in edition.outside(tree)] == ["../../../mine"]


def test_what_has_not_changed_is_not_written_again(tmp_path: Path) -> None:
    sources = compose.write(tmp_path)
    before = {path: path.stat().st_mtime_ns for path in sources}
    assert len(before) > len(TABLES)
    compose.write(tmp_path)
    assert {path: path.stat().st_mtime_ns for path in sources} == before
    compose.write(tmp_path, "minimal")
    assert {path.name for path in sources if path.stat().st_mtime_ns != before[path]} >= {"position_sources.c"}
