"""What was saved survives a change of the edition, in both directions."""

from pathlib import Path

import pytest
from by_edition import IN_FORCE, SAVED, has, store_of, switch_on


@pytest.fixture
def memory(tmp_path: Path) -> Path:
    """The EEPROM that is moved from board to board; lab has saved in it."""
    file = tmp_path / "eeprom"
    lines = ("set flux_low 123", "set can_node 5", "set speed_ramp 500", "save")
    assert switch_on("lab", file, *lines)[-1] == SAVED
    return file


@pytest.mark.parametrize("edition", ["drive", "hil"])
def test_a_save_of_a_smaller_edition_keeps_what_it_has_not(edition: str, memory: Path) -> None:
    assert IN_FORCE in store_of(edition, memory)
    assert has(edition, memory, can_node="5", speed_ramp="500")
    assert switch_on(edition, memory, "set speed_ramp 600", "save")[-1] == SAVED
    assert IN_FORCE in store_of(edition, memory), "and no other firmware's"
    assert switch_on(edition, memory, "set speed_ramp 700", "save")[-1] == SAVED, "into the other slot"
    assert IN_FORCE in store_of("lab", memory)
    assert has("lab", memory, flux_low="123.0", can_node="5", speed_ramp="700")


def test_a_larger_edition_has_defaults_for_what_a_smaller_one_did_not_save(tmp_path: Path) -> None:
    memory = tmp_path / "eeprom"
    assert switch_on("drive", memory, "set speed_ramp 600", "save")[-1] == SAVED
    assert "values saved by another firmware are in force" in store_of("lab", memory)
    assert has("lab", memory, flux_low="350.0", speed_ramp="600")
    assert switch_on("lab", memory, "save")[-1] == SAVED
    assert IN_FORCE in store_of("lab", memory)
    assert IN_FORCE in store_of("drive", memory)


def test_an_edition_without_a_store_does_not_touch_the_memory(memory: Path) -> None:
    kept = memory.read_bytes()
    said = switch_on("minimal", memory, "set speed_ramp 600", "save", "load", "defaults")
    for name in ("save", "load", "defaults"):
        assert f"'{name}' is not in this edition of the firmware, minimal: see 'Editions' in the book" in said
    assert memory.read_bytes() == kept
    assert has("lab", memory, flux_low="123.0", can_node="5", speed_ramp="500")


def test_of_what_was_saved_an_edition_refuses_the_source_that_it_has_not_and_no_more(memory: Path) -> None:
    assert switch_on("lab", memory, "set position_source 8", "save")[-1] == SAVED
    assert "values saved by another firmware are in force" in store_of("drive", memory)
    assert "; 1 refused, now at their default: position_source" in switch_on("drive", memory, "load")[-1]
    assert has("drive", memory, position_source="4", can_node="5", speed_ramp="500")
    assert has("lab", memory, position_source="8", flux_low="123.0", can_node="5", speed_ramp="500")
