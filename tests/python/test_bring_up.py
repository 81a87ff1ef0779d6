"""The bring-up guide: its commands exist, and the blocks of stages 1 to 6 run on the boards that they name."""

import re
from pathlib import Path

import pytest
from test_board_functions import Desk

from stillspin import core

pytest.importorskip("stillspin._core", reason="the native module is not built")

ROOT = Path(__file__).resolve().parents[2]
GUIDE = (ROOT / "docs" / "bring-up.md").read_text(encoding="utf-8")
STAGES = dict(re.findall(r"^## (Stage [1-9]): [^\n]*\n(.*?)(?=^## |\Z)", GUIDE, re.MULTILINE | re.DOTALL))
LIST = (ROOT / "firmware/console/command_list.h").read_text(encoding="utf-8")
COMMANDS = set(re.findall(r"^COMMAND\((\w+),", LIST, re.MULTILINE))
PATIENCE = 700  # ms for the answer to a line


def block(stage: str) -> list[tuple[str, list[str]]]:
    """Commands of a stage and what the guide says comes back."""
    found: list[tuple[str, list[str]]] = []
    for text in re.findall(r"^```\n(.*?)^```$", STAGES[stage], re.MULTILINE | re.DOTALL):
        for line in text.splitlines():
            if line.startswith("> "):
                found.append((line[2:], []))
            else:
                found[-1][1].append(line)
    return found


def plant(stage: str) -> dict[str, dict[str, float | bool]]:
    """What the stage's `stillspin board` line changes of it."""
    command = re.search(r"^`stillspin board(.*)`$", STAGES[stage], re.MULTILINE)
    assert command
    changed: dict[str, dict[str, float | bool]] = {}
    for section, key, value in re.findall(r"--set (\w+)\.(\w+)=(\S+)", command[1]):
        changed.setdefault(section, {})[key] = value == "true" if value in ("true", "false") else float(value)
    return changed


def shape(line: str) -> str:
    """A line without its numbers and the width of its columns."""
    return re.sub(r"\s+", " ", re.sub(r"-?\d+(\.\d+)?", "#", line)).strip()


def test_there_are_six_stages_with_a_block_each() -> None:
    assert sorted(STAGES) == [f"Stage {n}" for n in range(1, 7)]
    assert all(len(block(stage)) >= 2 for stage in STAGES)


def test_every_command_and_parameter_of_the_guide_exists() -> None:
    known = core.parameters(core.load())
    lines = [command for stage in STAGES for command, _ in block(stage)]
    inline = re.findall(r"`([a-z]+(?: [^`]+)?)`", GUIDE)
    lines += [words for words in inline if words.split()[0] in COMMANDS]
    assert len(lines) > 40
    for line in lines:
        word, *rest = line.split()
        assert word in COMMANDS, line
        if word in ("set", "get"):
            assert rest[0] in known, line
    named = set(re.findall(r"`([a-z]+_[a-z_]+)`", GUIDE))
    signals = {row["name"] for row in core.load().signals()}
    fields = {"current_d", "current_q", "current_a", "current_b"}
    assert named - set(known) - signals - fields == set()


@pytest.mark.parametrize("stage", sorted(STAGES))
def test_a_stage_does_on_the_virtual_board_what_the_guide_says(stage: str) -> None:
    desk = Desk({}, plant(stage), wait=250)
    try:
        for command, expected in block(stage):
            said = {shape(line) for line in desk.type(command, PATIENCE).splitlines()}
            for line in expected:
                assert shape(line) in said, f"{command}: {line!r} is not among {sorted(said)}"
    finally:
        desk.board.close()


def test_the_currents_of_stage_4_are_those_of_the_guide() -> None:
    desk = Desk({}, plant("Stage 4"))
    try:
        for command, _ in block("Stage 4"):
            if command.startswith(("signals", "coast")):
                break
            desk.type(command, 200)
        desk.wait(3500)
        means = dict.fromkeys(("i_a", "i_b", "i_c", "current_d"), 0.0)
        for _ in range(200):
            desk.wait(0.137)
            now = {**desk.board.truth(), **desk.board.signals()}
            means = {name: mean + now[name] / 200 for name, mean in means.items()}
        assert means["i_a"] == pytest.approx(2.0, rel=0.1)
        assert means["current_d"] == pytest.approx(means["i_a"], abs=0.15)
        assert [means["i_b"], means["i_c"]] == pytest.approx([-means["i_a"] / 2] * 2, abs=0.1)
    finally:
        desk.board.close()
