"""`run --image`, `reproduce --image`: scenarios on an image, told by its serial port, in a loop with the plant.

Nobody here has an image of the drive. The firmware that is compiled for this computer stands in for one: told and read
through its serial port alone, as an image is, it has to do what the native run does. The image is a control program of
this project's assembler, which does not speak the record protocol.
"""

import json
from dataclasses import replace

import numpy as np
import pytest
from c28x_chip import linked_file
from typer.testing import CliRunner

from stillspin import cli, core
from stillspin.cases import profile, scenario_file
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.hil import built
from stillspin.image import closed_loop, opened, run_record
from stillspin.link.errors import NoAnswerError
from stillspin.measure import figures, pieces
from stillspin.runs import execute, variant
from stillspin.runs.execute import Settings

LENGTH = 0.8


def job(identifier="A10", *, image=None, motor="", **changed):
    native = core.load()
    scenario = scenario_file.load(identifier)
    known = core.parameters(native)
    chosen = profile.load(motor or "bench", core.plant_schema(native), known, motor or scenario.motor)
    made = execute.prepare(scenario, Settings(chosen, profile.Changes(), 1, "", image=image), native)[0]
    return replace(made, run=replace(made.run, **{"duration": LENGTH, "waveform": None, "reached": (), **changed}))


def columns():
    return [str(row["name"]) for row in core.load().signals()]


def firmware(wanted):
    return core.load().VirtualBoard(plant=wanted.plant, parameters={}, seed=wanted.seed)


def through_the_port(wanted, progress=None):
    return closed_loop.play_on(firmware(wanted), wanted, progress, columns())


MEANS = ("true_speed", "est_speed", "i_q_ref")
STEPS = {
    "commands": ((0.0, "speed_ref_rpm", 300.0), (0.4, "set:speed_ramp", 4000.0), (0.45, "speed_ref_rpm", 350.0)),
    "load": ((0.3, 0.0), (0.35, 0.5)),
}


@pytest.fixture(scope="module")
def both():
    wanted = job(**STEPS)
    return through_the_port(wanted), execute.play(core.load(), wanted, None)


def test_steps_given_over_the_port_do_what_the_native_runs_do(both):
    seen, native = both
    assert seen.completed
    assert not seen.notes
    time = seen.signals["time"]
    assert np.allclose(np.diff(time), 0.005)
    assert time[0] < 0.01
    assert time[-1] > LENGTH - 0.01
    late = time > 0.2
    # A step is up to 5 ms late: at 3000 rpm/s that is 15 rpm of the ramp, of the load's slope a tenth of it.
    for name, band in (("true_speed", 15.0), ("est_speed", 15.0), ("speed_ref", 15.0), ("load_torque", 0.05)):
        same = np.interp(time[late], native.signals["time"], native.signals[name])
        assert np.max(np.abs(seen.signals[name][late] - same)) < band, name


def test_a_motor_of_another_size_is_told_and_read_in_its_own_amperes():
    """400 A are beyond the formats until the scales are told, and its table is another one from then on."""
    wanted = job(motor="hsm1_300v", commands=((0.0, "speed_ref_rpm", 300.0),), load=((0.0, 0.0), (0.3, 20.0)))
    seen, native = through_the_port(wanted), execute.play(core.load(), wanted, None)
    assert seen.completed and native.completed, (seen.reason, native.reason)
    means = {name: [np.mean(s[name][s["time"] > 0.5]) for s in (seen.signals, native.signals)] for name in MEANS}
    for name, (port, own) in means.items():
        assert port == pytest.approx(own, rel=0.03), name
    assert means["i_q_ref"][1] > 32.0, "amperes, where the formats have a sixteenth of that"


def test_an_angle_is_held_against_that_of_its_own_period(both):
    """At 300 rpm a period is half a degree: one that is taken for its neighbour is seen."""
    errors = []
    for result in both:
        s = result.signals
        late = s["time"] > 0.2
        errors.append(pieces.wrap_degrees(s["est_angle"][late] - s["true_angle"][late]))
    assert abs(np.mean(errors[0]) - np.mean(errors[1])) < 0.1
    assert np.max(np.abs(errors[0])) < 1.5 * np.max(np.abs(errors[1]))


def test_a_sample_is_of_the_period_that_is_said(monkeypatch):
    """Its signals are those that the firmware's own variables had behind that period's interrupt, bit for bit."""
    known, exact = {}, []
    passed, rows = closed_loop._ClosedLoop._passed, run_record.RunRecord.rows

    def look(self):
        exact.append(self._board.signals()["angle"])
        passed(self)

    def keep(self, origin, end, *, has_drive):
        made = rows(self, origin, end, has_drive=has_drive)
        known["rows"], known["origin"] = made[0], origin
        return made

    monkeypatch.setattr(closed_loop._ClosedLoop, "_passed", look)
    monkeypatch.setattr(run_record.RunRecord, "rows", keep)
    through_the_port(job(duration=0.2))
    at = np.round(known["rows"]["time"] * 1e4).astype(int) + known["origin"]
    there = np.array(exact)[at]  # of the interrupt at the start of period `at`, seen at its end
    assert np.array_equal(known["rows"]["est_angle"], there * 2.0 * np.pi)


def test_what_the_drive_refuses_is_said():
    seen = through_the_port(job(commands=((0.0, "speed_ref_rpm", 30.0), (0.1, "set:encoder_counts", 2048.0))))
    assert any("set:encoder_counts 2048: encoder_counts may not change while" in words for words in seen.notes), (
        seen.notes
    )


def test_a_fault_ends_the_run_with_its_words():
    wanted = job()
    plant = {**wanted.plant, "fault": {"open_phase": "a", "open_phase_at": 0.2}}
    seen = through_the_port(replace(wanted, plant=plant))
    assert not seen.completed
    assert seen.reason.startswith("fault: ")
    assert seen.faults[0][0] == pytest.approx(0.2, abs=0.1)


def test_a_run_can_be_stopped():
    seen = through_the_port(job(), lambda _: False)
    assert seen.reason == "stopped by the user"


@pytest.fixture
def control(tmp_path):
    return linked_file(tmp_path, "control")


def test_a_program_without_the_protocol_runs_under_the_load(control):
    wanted = job(image=opened.read(control), duration=0.3, load=((0.1, 0.0), (0.2, 0.5)))
    seen = closed_loop.play(core.load(), wanted, wanted.image, None)
    assert seen.completed
    assert "answers no request of the record protocol" in seen.notes[0]
    assert "18 parameters, the start, 1 step (references, commands)" in seen.notes[0]
    assert seen.signals["load_torque"][-1] == pytest.approx(0.5)
    assert np.isnan(seen.signals["est_angle"]).all()
    assert seen.signals["true_speed"][-1] < -100, "nothing holds the shaft against the load"


def test_the_native_run_beside_is_recorded_as_rarely():
    scenario = variant.native().scenario(scenario_file.load("A10"))
    assert {run.record_every for run in scenario.runs} == {run_record.RASTER}
    assert variant.native().settings(Settings(None, None, 1, "", image=object())).image is None


def test_a_figure_without_its_signals_has_no_value(control):
    wanted = job(image=opened.read(control), duration=0.3)
    seen = closed_loop.play(core.load(), wanted, wanted.image, None)
    scenario = scenario_file.load("A10")
    scenario = replace(scenario, figures=tuple(replace(figure, windows=((0.0, 0.3),)) for figure in scenario.figures))
    made = {each.name: each for each in figures.evaluate(scenario, {"creep": dict(seen.signals)}, "bench")}
    assert made["position_error_peak"].value is None
    assert made["speed_ripple"].value is not None


@pytest.fixture
def cli_runs():
    return lambda *arguments: CliRunner().invoke(cli.app, list(arguments))


@pytest.mark.parametrize("command", [("run",), ("reproduce", "--no-commission")])
def test_the_commands(cli_runs, tmp_path, control, monkeypatch, command):
    short = scenario_file.load("A10")
    run = replace(short.runs[0], duration=0.3, reached=(), commands=())
    monkeypatch.setattr(scenario_file, "load", lambda _: replace(short, runs=(run,), plots=()))
    done = cli_runs(*command, "A10", "--image", str(control), "--out", str(tmp_path / "r"))
    assert done.exit_code == ExitCode.SHORT
    assert "image" in done.stdout
    assert "native" in done.stdout
    assert "answers no request" in done.stdout
    native = json.loads((tmp_path / "r" / "native.json").read_text())
    assert native
    assert (tmp_path / "r" / "runs" / "A10-creep.parquet").exists()


def test_what_cannot_be_executed_is_said_first(cli_runs, tmp_path):
    for command in ("run", "reproduce"):
        done = cli_runs(command, "A10", "--image", str(tmp_path / "none.out"))
        assert done.exit_code == ExitCode.BAD_INPUT
        assert "none.out" in done.stderr


def test_an_image_that_begins_nowhere_is_refused(tmp_path):
    file = tmp_path / "x.out"
    file.write_bytes(b"")
    with pytest.raises(InputError):
        opened.read(file)


def test_time_in_a_scenario(cli_runs, control, monkeypatch):
    """Of the stretch behind the start procedure: each interrupt of the control program, at its rate."""
    short = scenario_file.load("A10")
    run = replace(short.runs[0], duration=0.1)
    monkeypatch.setattr(scenario_file, "load", lambda _: replace(short, runs=(run,)))
    done = cli_runs("image", "time", str(control), "A10", "--functions", "3")
    assert done.exit_code == ExitCode.DONE
    assert "A10, run creep:" in done.stdout
    (row,) = [line.split() for line in done.stdout.splitlines() if line.startswith("INT1.1 sample")]
    assert int(row[2]) == 2000
    done = cli_runs("image", "time", str(control), "A10", "--for", "1")
    assert done.exit_code == ExitCode.BAD_INPUT
    assert "--for, --after" in done.stderr


def test_a_whole_drive_s_interrupts_are_timed_from_its_start_on(monkeypatch):
    """The looks come in their order, once each, and the first at the end of the start procedure."""
    seen = []
    wanted = job(duration=0.1)
    board = firmware(wanted)
    looks = (lambda b: seen.append(("begins", b.now)), lambda b: seen.append(("ends", b.now)))
    closed_loop.play_on(board, wanted, None, columns(), looks)
    assert [word for word, _ in seen] == ["begins", "ends"]
    assert (seen[1][1] - seen[0][1]) / 1e8 == pytest.approx(0.106, abs=0.001)


def test_hil_says_that_it_takes_an_image_of_the_drive(cli_runs, tmp_path, monkeypatch):
    def silent(_):
        raise NoAnswerError("no answer")

    monkeypatch.setattr(built, "edition_at", silent)
    done = cli_runs("hil", "A10", "--image", str(linked_file(tmp_path, "echo")))
    assert done.exit_code == ExitCode.NO_CONNECTION
    assert "no image of the drive" in done.stderr
    assert "stillspin run --image" in done.stderr
