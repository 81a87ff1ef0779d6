"""The bring-up guide: its commands exist, and the blocks of stages 1 to 6 run on the boards that they name."""

import re
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from function_desk import RUN, Desk

from stillspin import core, resources
from stillspin.board import power
from stillspin.cases import profile

pytest.importorskip("stillspin._core", reason="the native module is not built")

ROOT = Path(__file__).resolve().parents[2]
GUIDE = (ROOT / "docs" / "bring-up.md").read_text(encoding="utf-8")
STAGES = dict(re.findall(r"^## (Stage [1-9]): [^\n]*\n(.*?)(?=^## |\Z)", GUIDE, re.MULTILINE | re.DOTALL))
LISTS = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "firmware").rglob("command_list.h"))
COMMANDS = set(re.findall(r"^COMMAND\((\w+),", LISTS, re.MULTILINE))
PATIENCE = 700  # ms for the answer to a line


# By how much what was measured may differ from the guide, by its unit; what has none of them is the same.
TOLERANCES = {
    "A": 0.05,  # the noise of the sensors, as stage 2 says
    "V": 0.5,  # one code of the link's converter is 0.1 V, and its noise some of them
    "rpm": 5.0,  # as stage 6 says
    "ohm": 0.004,  # a hundredth, of a commissioning's results
    "mH": 0.08,
    "Vs": 0.0015,
    "kgm2": 0.00005,
    "ms": 10.0,  # a start has whole pairs of periods, and the board's clock no phase with the line
    "%": 1.0,  # of a commissioning: the guide does not say how soon it is asked
}
NUMBER = rf"(-?\d+(?:\.\d+)?)(?: ?({'|'.join(TOLERANCES)})(?!\w))?"
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


class SwitchedOn(Desk):
    """As `stillspin board` switches one on, with what `--set` changes of it."""

    def __init__(self, *changes: str) -> None:
        native = core.load()
        schema, known = core.plant_schema(native), core.parameters(native)
        chosen = profile.load("bench", schema, known, resources.DEFAULT_MOTOR)
        self.board = power.power(native, chosen, profile.changes(list(changes), schema, known), 1)
        self.wait(250)


class Board(SwitchedOn):
    """The board that a stage names."""

    def __init__(self, stage: str, *changes: str) -> None:
        command = re.search(r"^`stillspin board(.*)`$", STAGES[stage], re.MULTILINE)
        assert command
        words = re.findall(r"--set (\S+)", command[1])
        assert command[1] == "".join(f" --set {word}" for word in words), "nothing else is understood here"
        super().__init__(*words, *changes)


def shape(line: str) -> str:
    """A line without its numbers and the width of its columns."""
    return re.sub(r"\s+", " ", re.sub(r"-?\d+(\.\d+)?", "#", line)).strip()


def agrees(command: str, said: str, expected: str) -> bool:
    """The same words, and numbers as near as their units ask."""
    if shape(said) != shape(expected):
        return False
    there, guide = (
        re.findall(r"(-?\d+(?:\.\d+)?)(?: ?(rpm|ms|ohm|mH|Vs|kgm2|A|V|%)(?!\w))?", line) for line in (said, expected)
    )
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


def agree(command: str, said: str, expected: list[str]) -> None:
    """What came back of a line has each of the guide's, among others."""
    lines = said.splitlines()
    for line in expected:
        assert any(agrees(command, one, line) for one in lines), f"{command}: {line!r} is not among {lines}"


def told(stage: str) -> Board:
    """The stage's board with the parameters of the stage set."""
    board = Board(stage)
    for command in commands(stage):
        if command.startswith("set "):
            board.type(command, 150)
    return board


@pytest.mark.parametrize("stage", sorted(set(STAGES) - {"Stage 5"}))
def test_a_stage_does_on_the_virtual_board_what_the_guide_says(stage: str) -> None:
    desk = Board(stage)
    try:
        for command, expected in block(stage):
            agree(command, carry_out(desk, command, PATIENCE), expected)
    finally:
        desk.board.close()


def test_an_emergency_stop_ends_the_pulses_of_stage_3() -> None:
    desk = told("Stage 3")
    try:
        desk.type("set emergency_stop 1", 150)
        desk.type("start free", 800)
        before = desk.board.statistics()["gate_edges"]
        desk.wait(100)
        assert desk.board.statistics()["gate_edges"] != before, "a hash of all edges: the gates are pulsed"
        desk.board.set_input("emergency", 1.0)
        desk.wait(5)
        off = desk.board.statistics()["gate_edges"]
        assert "emergency stop" in desk.type("status", PATIENCE)
        assert desk.board.statistics()["gate_edges"] == off
        desk.type("reset", 100)
        assert "fault       emergency stop" in desk.type("status", PATIENCE), "it is of no use before the release"
        desk.board.set_input("emergency", 0.0)
        desk.type("reset", 100)
        assert "state       ready" in desk.type("status", PATIENCE)
    finally:
        desk.board.close()


TURNED = ("fault.from_power_on=true", "fault.gain_sensor=b", "fault.gain_sensor_factor=-1")


def test_the_wires_are_looked_at_before_the_first_current_of_stage_4() -> None:
    """A sensor that is turned round ends the block before a current stands, in words."""
    desk = Board("Stage 4", *TURNED)
    try:
        for command in commands("Stage 4"):
            desk.type(command, 200)
            assert max(abs(desk.board.truth()[phase]) for phase in ("i_a", "i_b", "i_c")) < 0.5, command
        said = desk.type("status", PATIENCE)
        assert "sensor" in said, said
    finally:
        desk.board.close()


def test_the_currents_of_stage_4_are_those_of_the_guide() -> None:
    desk = told("Stage 4")
    try:
        desk.type("start free", 500)
        highest = 0.0
        for _ in range(200):
            desk.wait(17.137)
            seen = desk.board.signals()
            highest = max(highest, seen["current_d"] - seen["current_d_reference"])
        assert highest < 0.2, "a tenth"
        means = dict.fromkeys(("i_a", "i_b", "i_c", "current_d", "voltage_alpha"), 0.0)
        for _ in range(200):
            desk.wait(0.137)
            now = {**desk.board.truth(), **desk.board.signals()}
            means = {name: mean + now[name] / 200 for name, mean in means.items()}
        assert means["i_a"] == pytest.approx(2.0, abs=0.05)
        assert means["current_d"] == pytest.approx(means["i_a"], abs=0.03)
        assert [means["i_b"], means["i_c"]] == pytest.approx([-means["i_a"] / 2] * 2, abs=0.05)
        assert means["voltage_alpha"] == pytest.approx(2.0, abs=0.2)
    finally:
        desk.board.close()


def test_too_low_a_link_in_stage_4_is_said() -> None:
    desk = Board("Stage 4", "link.source_voltage=26")
    try:
        for command in commands("Stage 4")[:5]:
            desk.type(command, 150)
        desk.wait(500)
        assert "the DC link is too low to find rotor and polarity at the start" in desk.type("status", PATIENCE)
    finally:
        desk.board.close()


@dataclass
class Commissioned:
    """Stage 5 as it was carried out: what came back of each line, and how long each phase lasted, s."""

    answers: list[tuple[str, list[str], str]] = field(default_factory=list)
    phases: dict[str, float] = field(default_factory=dict)


@pytest.fixture(scope="module")
def commissioned() -> Commissioned:
    done = Commissioned()
    desk = Board("Stage 5")
    try:
        for command, expected in block("Stage 5"):
            later = re.fullmatch(r"\((\d+) s later\)", command)
            for _ in range(4 * int(later[1]) if later else 0):
                desk.wait(190)
                phase = re.search(r"under way, \d+ %: (\w+)", desk.type("commission", 60))
                if phase:
                    done.phases[phase[1]] = done.phases.get(phase[1], 0.0) + 0.25
            done.answers.append((command, expected, "" if later else desk.type(command, PATIENCE)))
        return done
    finally:
        desk.board.close()


def test_the_commissioning_goes_as_the_guide_says(commissioned: Commissioned) -> None:
    for command, expected, said in commissioned.answers:
        agree(command, said, expected)


@pytest.mark.parametrize(("title", "phase"), [("staircase", "DC"), ("spin", "spin"), ("map", "inductances")])
def test_a_phase_of_the_commissioning_takes_as_long_as_the_guide_says(
    commissioned: Commissioned, title: str, phase: str
) -> None:
    seconds = re.search(rf"^\| {title}, (\d+) s \|", STAGES["Stage 5"], re.MULTILINE)
    assert seconds
    assert commissioned.phases[phase] == pytest.approx(float(seconds[1]), abs=1.0)


def test_the_commissioning_is_as_near_to_the_truth_as_the_guide_says(commissioned: Commissioned) -> None:
    native = core.load()
    plant = profile.load("bench", core.plant_schema(native), core.parameters(native), resources.DEFAULT_MOTOR).plant
    found = re.findall(r"^(\w+) +\S+ -> (\S+)", commissioned.answers[-2][2], re.MULTILINE)
    values = {name: float(value) for name, value in found}
    of = {**plant["machine"], **plant["mechanics"]}
    volts = float(plant["adc"]["voltage_gain"])  # the drive's to the true ones: nothing in the drive can tell
    for name, key, unit, share in (
        ("stator_resistance", "resistance", 1.0, 0.02),
        ("inductance_d", "inductance_d", 1e3, 0.02),
        ("inductance_q", "inductance_q", 1e3, 0.02),
        ("magnet_flux", "magnet_flux", 1.0, 0.01),
        ("inertia", "inertia", 1.0, 0.05),
    ):
        true = float(of[key]) * (1.0 + float(plant["parameter_error"][key])) * volts * unit
        assert values[name] == pytest.approx(true, rel=share), name


def test_the_shaft_of_stage_6_runs_as_the_guide_says() -> None:
    desk = Board("Stage 6")
    try:
        desk.type("ref 300 rpm", 100)
        desk.type("start free", 1500)
        seen = []
        for _ in range(300):
            desk.wait(3.37)
            seen.append((desk.board.signals()["speed"], desk.board.signals()["current_q"]))
        speeds, currents = zip(*seen, strict=True)
        assert max(abs(speed - 300.0) for speed in speeds) < 6.0
        assert sum(currents) / len(currents) == pytest.approx(0.1, abs=0.05)
        desk.type("ref 0 rpm", 1000)
        desk.board.set_load(2.0)
        desk.wait(1000)
        assert abs(desk.truth("speed")) < 5.0, "it resists"
        assert desk.state == RUN
    finally:
        desk.board.close()
