"""`stillspin image record` and `replay`: equal inputs make equal outputs, and what does not is found and named."""

import json
from dataclasses import replace

import pytest
from c28x_chip import changed_file, linked_file
from in_process import stillspin

from stillspin import __version__, core
from stillspin.board import power
from stillspin.board.image import blocks_of
from stillspin.cases import profile, scenario_file
from stillspin.drive.own import firmware
from stillspin.errors import InputError
from stillspin.flash import demonstration
from stillspin.image import opened, recording
from stillspin.revision import revision
from stillspin.runs import execute
from stillspin.runs.execute import Settings

FOR = 0.021
OCTET = [(0.017, "f0")]
"""A reference for the control program above what it samples, so that its integrator climbs."""


def played(file, seed, given=None, seconds=FOR):
    """What is recorded of an image, and a comparison with a recording while its board is on."""
    board = opened.power_on(opened.read(file), "bench", "A", seed)
    try:
        made = recording.play(board, seconds, OCTET, given)
        return made, lambda other: recording.compare(other, board), board
    except BaseException:
        board.close()
        raise


def compared(file, seed, recorded):
    _, compare, board = played(file, seed, recorded)
    try:
        return compare(recorded)
    finally:
        board.close()


@pytest.fixture
def control(tmp_path):
    return linked_file(tmp_path, "control")


@pytest.fixture
def recorded(control):
    made, _, board = played(control, 1)
    board.close()
    return made


def test_the_codes_decide(control, recorded):
    assert len(recorded.samples) > 100
    assert compared(control, 1, recorded) is None
    assert compared(control, 2, recorded) is None, "another plant's noise does not come through"
    free, _, board = played(control, 2)
    board.close()
    assert free.samples != recorded.samples


@pytest.mark.parametrize(
    "planted",
    [
        ("control.asm", "SFR     ACC,#8", "SFR     ACC,#7", "MOV     @CMPA,AL"),
        ("sampled.asm", "#0x0900          ; SOCA", "#0x0901          ; SOCA", "ETSEL,#"),
    ],
)
def test_a_planted_error_is_found_where_it_is_written(tmp_path, recorded, planted):
    name, text, other, written = planted
    file = linked_file(tmp_path, "control", [changed_file(tmp_path, "control", name, text, other)])
    difference = compared(file, 1, recorded)
    line = opened.read(file).names.lines.at(difference.program - 1)
    assert line.file == name
    assert written in (tmp_path / name).read_text().splitlines()[line.number - 1]
    assert difference.expected[:2] == difference.found[:2], "the same step and register"


def test_what_is_missing_is_a_difference(control, recorded):
    extra = (recorded.writes[40][0], 0x6809, 1)
    more = replace(recorded, writes=[*recorded.writes[:40], extra, *recorded.writes[40:]])
    difference = compared(control, 1, more)
    assert difference.index == 40
    silent = replace(recorded, writes=[*recorded.writes, (len(recorded.samples) - 1, 0x6809, 1)])
    assert compared(control, 1, silent).found is None


def test_a_program_that_takes_no_sample_differs(tmp_path, recorded):
    difference = compared(linked_file(tmp_path, "echo"), 1, recorded)
    assert (difference.index, difference.expected, difference.found) == (0, recorded.writes[0], None)


def test_the_firmware_is_recorded_as_well():
    native = core.load()
    chosen = profile.load("bench", core.plant_schema(native), core.parameters(native), "A")
    board = power.power(native, chosen, profile.Changes(), 1)
    try:
        made = recording.play(board, 0.15, [(0.1, b"start\r".hex())])
    finally:
        board.close()
    assert len(made.samples) > 100
    assert {recording.register(write[1]) for write in made.writes} >= {"EPwm1.CMPA", "EPwm1.TBPRD", "EPwm2.CMPA"}


RUN_PIN = 25


def watched(file, given=None, pressed=(), over=False):
    """What it does while the run switch is pressed and let go, the shaft turns, and the comparator trips."""
    plant = {"solver": {"method": "rk4"}, "initial": {"speed": 90.0 if given is None else 0.0}}
    board = core.load().VirtualBoard(
        plant=plant, parameters={}, seed=1, image=blocks_of(opened.read(file).program, str(file))
    )
    try:
        board.record(given.samples if given else [], given.inputs if given else [])
        for number in range(150):
            board.set_input("run", float(number in pressed))
            board.set_input("emergency", float(over and number >= 120))
            board.advance(20_000)
        samples, writes, inputs = board.recorded()
        recorded = recording.Recording(0.03, samples, [write[:3] for write in writes], [], "", inputs)
        return recorded, recording.compare(given, board) if given else None
    finally:
        board.close()


def test_pins_and_encoder_come_from_the_recording(tmp_path):
    file = linked_file(tmp_path, "watching")
    recorded, _ = watched(file, pressed=range(60, 90), over=True)
    pins = recorded.inputs[RUN_PIN // 16]
    assert {value >> RUN_PIN % 16 & 1 for _, _, value in pins} == {0, 1}
    assert len(recorded.inputs[4]) > 50, "the shaft turns"
    assert {value for _, _, value in recorded.inputs[3]} > {0}, "a trip"
    again, difference = watched(file, recorded)
    assert difference is None, "on a board whose shaft stands and whose inputs nobody touches"
    assert again.inputs == recorded.inputs
    without = replace(recorded, inputs=[[], [], [], [], []])
    assert watched(file, without)[1] is not None, "the converter's codes alone do not decide"


def of_scenario(identifier, seconds):
    native = core.load()
    scenario = scenario_file.load(identifier)
    chosen = profile.load("bench", core.plant_schema(native), core.parameters(native), scenario.motor)
    job = execute.prepare(scenario, Settings(chosen, profile.Changes(), 1, ""), native)[0]
    return replace(job, run=replace(job.run, duration=seconds))


@pytest.mark.parametrize("identifier", ["A10", "A12"])
def test_a_scenario_is_played_back_bit_for_bit(identifier):
    """The firmware on another plant with other noise, whose shaft nobody loads: A12 has its angle from the encoder."""
    native = core.load()
    job = of_scenario(identifier, 0.1)
    recorded, played = recording.of_run(native, job, job.image, None)
    assert played.completed
    assert len(recorded.writes) > 10_000
    for given, same in ((recorded, True), (replace(recorded, inputs=[[], [], [], [], []]), identifier == "A10")):
        other = {"solver": {"method": "rk4"}, "initial": {"angle": 1.0}}
        board = native.VirtualBoard(plant=other, parameters={}, seed=9)
        try:
            recording.play(board, recorded.seconds, recorded.octets, given)
            assert (recording.compare(recorded, board) is None) is same
        finally:
            board.close()


def test_a_run_of_a_scenario_is_chosen(tmp_path):
    file = tmp_path / "control.rec"
    image = linked_file(tmp_path, "control")
    done = run_command("record", file, "--image", image, "--scenario", "A10", "--run", "creep", "--for", "0.05")
    assert done.exit_code == 0, done.stderr
    assert "answers no request" in done.stdout
    assert run_command("replay", image, file, "--seed", "5").exit_code == 0
    for words, says in (
        (("--scenario", "A10", "--run", "none"), "it has creep"),
        (("--run", "creep"), "--scenario"),
        (("--scenario", "A10", "--send", "0.1:x"), "leave it out"),
    ):
        done = run_command("record", file, *words)
        assert done.exit_code == 2
        assert says in done.stderr


def run_command(*words):
    return stillspin("image", *words)


def test_the_commands(tmp_path, control):
    file = tmp_path / "control.rec"
    done = run_command("record", file, "--image", control, "--for", "0.02", "--send", "0.018:@")
    assert done.exit_code == 0, done.stderr
    done = run_command("replay", control, file, "--seed", "3")
    assert done.exit_code == 0, done.stdout
    assert "the same" in done.stdout
    content = json.loads(file.read_text())
    content["writes"][-4][2] ^= 1
    file.write_text(json.dumps(content))
    done = run_command("replay", control, file)
    assert done.exit_code == 4
    assert "differs: recorded step" in done.stdout
    assert "EPwm1.CMPA" in done.stdout
    assert "(control.asm:" in done.stdout


def test_a_recording_says_which_firmware_and_which_sources_made_it(tmp_path):
    file = tmp_path / "own.rec"
    done = run_command("record", file, "--for", "0.001")
    assert done.exit_code == 0, done.stderr
    content = json.loads(file.read_text())
    assert (content["made_by"], content["firmware"], content["revision"]) == ("firmware", firmware(), revision())
    assert recording.load(file).firmware == firmware()
    assert recording.load(file).revision == revision()


def test_a_recording_of_an_image_says_what_the_image_says_of_itself(tmp_path):
    marked = opened.look(demonstration.write(tmp_path)[0])
    assert opened.identity(marked) == f"{__version__} (a demonstration, for a virtual board alone)"
    said = []
    for amount in ("8", "7"):
        folder = tmp_path / amount
        folder.mkdir()
        source = changed_file(folder, "control", "control.asm", "SFR     ACC,#8", f"SFR     ACC,#{amount}")
        image, file = linked_file(folder, "control", [source]), folder / "control.rec"
        assert run_command("record", file, "--image", image, "--for", "0.001").exit_code == 0
        said.append(json.loads(file.read_text())["firmware"])
        assert said[-1] == opened.identity(opened.read(image))
    assert said[0].startswith("no identity, SHA-256 of its words ")
    assert said[0] != said[1], "one instruction is another"


def test_what_is_no_recording_is_said(tmp_path):
    file = tmp_path / "x"
    for content in ("", "[]", "{}", '{"recording": 1}', '{"recording": 7}'):
        file.write_text(content)
        with pytest.raises(InputError, match="recording"):
            recording.load(file)
    with pytest.raises(InputError, match="cannot be read"):
        recording.load(tmp_path / "none")


def test_times_of_lines_are_checked(tmp_path):
    done = run_command("record", tmp_path / "x", "--send", "now:start")
    assert done.exit_code == 2
    assert "--send" in done.stderr


def test_registers_have_ti_s_names():
    assert [recording.register(address) for address in (0x6809, 0x684A, 0x6940, 0x7101)] == [
        "EPwm1.CMPA",
        "EPwm2.CMPB",
        "EPwm6.TBCTL",
        "0x7101",
    ]


def test_a_recording_without_a_sample_compares_nothing_and_says_so(tmp_path):
    source = tmp_path / "silent.asm"
    source.write_text(" .org 0x3F7FF6\n LB start\n .org 0x3F4000\nstart: B start,UNC\n")
    file, recording = str(linked_file(tmp_path, "silent", [source])), str(tmp_path / "silent.rec")
    assert stillspin("image", "record", recording, "--image", file, "--for", "0.001").exit_code == 0
    done = stillspin("image", "replay", file, recording)
    assert done.exit_code == 1
    assert "nothing was compared: silent.out took 0 samples" in done.stdout
