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


# By how much what was measured may differ from the guide, by its unit; what has none of them is the same.
TOLERANCES = {
    "A": 0.05,  # the noise of the sensors, as stage 2 says
    "V": 0.5,  # one code of the link's converter is 0.1 V, and its noise some of them
    "rpm": 1.0,  # as stage 6 says
    "ms": 10.0,  # a start has whole pairs of periods, and the board's clock no phase with the line
    "%": 1.0,  # of a commissioning: the guide does not say how soon it is asked
}
SAID = ("set", "get", "ref", "version")  # they say what is set, and nothing that was measured


def block(stage: str) -> list[tuple[str, list[str]]]:
    """Commands of a stage and what the guide says comes back; `(3 s later)` is a command to the clock."""
    found: list[tuple[str, list[str]]] = []
    for text in re.findall(r"^```\n(.*?)^```$", STAGES[stage], re.MULTILINE | re.DOTALL):
        for line in text.splitlines():
            if line.startswith(("> ", "(")):
                found.append((line.removeprefix("> "), []))
            else:
                found[-1][1].append(line)
    return found


def commands(stage: str) -> list[str]:
    """What is typed in a stage."""
    return [command for command, _ in block(stage) if not command.startswith("(")]


def carry_out(desk: Desk, command: str, patience: int) -> str:
    """A line of a block: what comes back, nothing while time goes by."""
    if later := re.fullmatch(r"\((\d+) s later\)", command):
        desk.wait(1000 * int(later[1]))
        return ""
    return str(desk.type(command, patience))


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


def agrees(command: str, said: str, expected: str) -> bool:
    """The same words, and numbers as near as their units ask."""
    if shape(said) != shape(expected):
        return False
    there, guide = (re.findall(r"(-?\d+(?:\.\d+)?)(?: ?(rpm|ms|A|V|%)(?!\w))?", line) for line in (said, expected))
    exact = command.split(maxsplit=1)[0] in SAID
    return all(
        abs(float(one) - float(other)) <= (0 if exact else TOLERANCES.get(unit, 0)) + 1e-9
        for (one, unit), (other, _) in zip(there, guide, strict=True)
    )


@pytest.mark.parametrize(
    ("command", "said", "is_so"),
    [
        ("signals current_d", "current_d  2.06 A  measured d-axis current", True),
        ("signals current_d", "current_d  2.15 A  measured d-axis current", False),
        ("signals current_d", "current_d  2.09 V  measured d-axis current", False),
        ("signals current_d", "current_d  2.09 A  measured q-axis current", False),
        ("get current_d", "current_d  2.06 A  measured d-axis current", False),
    ],
)
def test_a_number_of_the_guide_may_differ_by_what_was_measured(command: str, said: str, is_so: bool) -> None:
    assert agrees(command, said, "current_d             2.09 A           measured d-axis current") is is_so


def test_what_has_no_unit_is_the_same() -> None:
    assert not agrees("status", "saves so far 1", "saves so far 0")
    assert not agrees("version", "stillspin 0.1.1, protocol 1", "stillspin 0.1.0, protocol 1")


def test_there_are_six_stages_with_a_block_each() -> None:
    assert sorted(STAGES) == [f"Stage {n}" for n in range(1, 7)]
    assert all(len(block(stage)) >= 2 for stage in STAGES)


def test_every_command_and_parameter_of_the_guide_exists() -> None:
    known = core.parameters(core.load())
    lines = [command for stage in STAGES for command in commands(stage)]
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
    fields = {"current_d", "current_q", "current_a", "current_b", "voltage_alpha"}
    assert named - set(known) - signals - fields == set()


@pytest.mark.parametrize("stage", sorted(STAGES))
def test_a_stage_does_on_the_virtual_board_what_the_guide_says(stage: str) -> None:
    desk = Desk({}, plant(stage), wait=250)
    try:
        for command, expected in block(stage):
            said = carry_out(desk, command, PATIENCE).splitlines()
            for line in expected:
                assert any(agrees(command, one, line) for one in said), f"{command}: {line!r} is not among {said}"
    finally:
        desk.board.close()


def test_the_wires_are_looked_at_before_the_first_current_of_stage_4() -> None:
    """A sensor that is turned round ends the block before a current stands, in words."""
    turned = {"from_power_on": 1.0, "gain_sensor": 2.0, "gain_sensor_factor": -1.0}
    desk = Desk({}, plant("Stage 4") | {"fault": turned})
    try:
        for command in commands("Stage 4"):
            desk.type(command, 200)
            assert max(abs(desk.board.truth()[phase]) for phase in ("i_a", "i_b", "i_c")) < 0.5, command
        said = desk.type("status", PATIENCE)
        assert "sensor" in said, said
    finally:
        desk.board.close()


def test_the_currents_of_stage_4_are_those_of_the_guide() -> None:
    desk = Desk({}, plant("Stage 4"))
    try:
        for command, _ in block("Stage 4"):
            if command.startswith(("signals", "coast")):
                break
            carry_out(desk, command, 200)
        means = dict.fromkeys(("i_a", "i_b", "i_c", "current_d"), 0.0)
        for _ in range(200):
            desk.wait(0.137)
            now = {**desk.board.truth(), **desk.board.signals()}
            means = {name: mean + now[name] / 200 for name, mean in means.items()}
        assert means["i_a"] == pytest.approx(2.0, abs=0.05)
        assert means["current_d"] == pytest.approx(means["i_a"], abs=0.05)
        assert [means["i_b"], means["i_c"]] == pytest.approx([-means["i_a"] / 2] * 2, abs=0.05)
    finally:
        desk.board.close()
