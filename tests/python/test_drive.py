"""The drive as an object, against the small drive of fake_drive.py on a pseudo-terminal."""

import math
import threading
import time

import numpy as np
import pytest
from fake_tables import PARAMETERS

from stillspin.drive import Channel, ConflictWarning, Drive, Outcome, Signal, Table, Trigger, scope
from stillspin.drive.protocol import Request
from stillspin.drive.requester import wait_until
from stillspin.drive.state import RUN, RawStatus
from stillspin.errors import InputError
from stillspin.link.errors import DriveError, LinkError, NoAnswerError, RefusedError


def test_the_table_is_read_once_and_kept_by_its_crc(fake):
    shares = []
    with Drive.open(fake.port, progress=shares.append) as drive:
        first = drive.table
    assert shares[-1] == 1.0
    fake.asked.clear()
    with Drive.open(fake.port) as drive:
        assert drive.table == first
    assert fake.asked == [Request.IDENTITY]
    fake.version = "fake 1.1"
    with Drive.open(fake.port) as drive:
        assert drive.table.version == "fake 1.1"
    assert fake.asked.count(Request.PARAMETER_INFO) == len(PARAMETERS)


@pytest.mark.parametrize(
    "damage", ["", "{}", "[]", '{"format": 1}', '{"format": 1, "parameters": [{}], "signals": []}']
)
def test_a_damaged_table_on_disk_is_read_again(fake, tmp_path, damage):
    with Drive.open(fake.port) as drive:
        first = drive.table
    (file,) = (tmp_path / "home" / "stillspin").iterdir()
    file.write_text(damage)
    with Drive.open(fake.port) as drive:
        assert drive.table == first


def test_values_are_in_the_units_of_the_table(drive):
    assert drive.get("current_limit") == 14.0
    assert drive.set("current_limit", 2.5) == 2.5
    assert drive.set("speed_ramp", "1000 rpm/s") == 1000.0
    assert drive.parameters()["speed_ramp"] == 1000.0
    parameter = drive.table.parameter("current_limit")
    assert (parameter.minimum, parameter.maximum, parameter.initial) == (0.1, 16.0, 14.0)
    assert parameter.text(parameter.initial_raw) == "14.00 A"
    assert set(drive.parameters()) == {entry[1] for entry in PARAMETERS}


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("curent_limit", 1, "no parameter 'curent_limit'; did you mean 'current_limit'"),
        ("current_limit", 17, "current_limit: 17 A is out of range; 0.10 … 16.00 A"),
        ("current_limit", "12 V", "current_limit is in A, not in V"),
        ("motor_poles", "4 A", "motor_poles has no unit, not in A"),
        ("current_limit", "much", "'much' is no number"),
        ("current_limit", float("nan"), "nan A is no number"),
    ],
)
def test_what_is_wrong_with_a_value_is_said_before_it_is_sent(fake, drive, name, value, said):
    fake.asked.clear()
    with pytest.raises(InputError, match=said):
        drive.set(name, value)
    assert fake.asked == []


def test_the_drive_says_why_it_refuses(drive):
    drive.start(100)
    with pytest.raises(RefusedError, match=r"^link_regulation: not taken while the drive runs"):
        drive.set("link_regulation", 20)
    assert drive.get("link_regulation") == 405.0
    with pytest.raises(RefusedError, match="motor_poles: not while the motor is energised"):
        drive.set("motor_poles", 3)
    with pytest.raises(RefusedError, match="not in this state"):
        drive.start()


def test_a_value_that_does_not_go_with_the_others_is_taken_with_a_warning(drive):
    with pytest.warns(
        ConflictWarning, match="the drive does not start with it: link_regulation must be above link_minimum"
    ):
        assert drive.set("link_regulation", 20) == 20.0
    assert drive.get("link_regulation") == 20.0
    assert drive.change("link_regulation", 300).conflict == ""


def test_status_signals_and_words(drive):
    status = drive.status()
    assert (status.state, status.fault, status.limits, status.store) == ("ready", "", (), "loaded")
    drive.set("speed_ramp", 100000)
    drive.start(600)
    assert wait_until(lambda: drive.status().speed > 590, 2)
    status = drive.status()
    assert (status.state, status.limits, status.reference) == ("run", ("current",), 600.0)
    assert status.reference_text == "600.0 rpm"
    assert drive.signals("current_q", "angle") == {"current_q": 2.0, "angle": -0.25}
    drive.stop()
    assert wait_until(lambda: not drive.status().energised, 2)


def test_with_the_power_stage_off_nothing_of_the_rotor_is_a_number(fake, drive):
    fake.speed = -25.0  # what an estimator makes of nothing
    status = drive.status()
    assert (status.state, status.speed_known) == ("ready", False)
    assert math.isnan(status.speed)
    assert status.speed_text == "speed unknown: the shaft may be turning"
    assert status.reference_text == "–"
    seen = drive.signals("speed", "angle", "current_q", "link_voltage")
    assert [math.isnan(value) for value in seen.values()] == [True, True, True, False]
    with drive.stream(["speed", "speed_known", "link_voltage"], 0.005) as stream:
        sample = stream.next(2)
        assert math.isnan(sample.values[0])
        assert sample.values[1:] == (0.0, 310.0)
        drive.start(0)
        assert wait_until(lambda: stream.next(2).values[1] == 1.0, 2)
    assert drive.status().speed_known
    fake.raise_fault(1)
    fake.raise_fault(2)
    newest, oldest = drive.faults()
    assert not newest.speed_known
    assert math.isnan(newest.speed)
    assert math.isnan(newest.current_q)
    assert (oldest.speed_known, oldest.current_q) == (True, 3.0)


def test_a_capture_has_no_number_for_what_was_unknown():
    table = Table("", 0, 0, (), (Signal(0, "speed", "rpm", 16, 1, ""), Signal(1, "state", "", 0, 0, "")))
    setup = scope.Setup([Channel("speed", 8192.0), Channel("state")])
    words = [np.array([-32768, -32767, 5, 32766], np.int16), np.array([2, 2, 4, 4], np.int16)]
    found = scope.decode(setup, scope.ScopeState(scope.DONE, 4, 0, 0.0), words, table)
    assert np.isnan(found.signals["speed"]).tolist() == [True, False, False, False]
    assert found.signals["speed"][2] == pytest.approx(5.5 * 0.25)
    assert found.clipped == ("speed",)
    words[0][1] = -32766
    assert scope.decode(setup, scope.ScopeState(scope.DONE, 4, 0, 0.0), words, table).clipped == ()


def test_a_look_tells_how_the_shaft_turns(fake, drive):
    seen = drive.look()
    assert (seen.outcome, seen.speed, seen.text) == (Outcome.TURNS, 1059.0, "the shaft turns at 1059 rpm")
    fake.seen = (3, 45, "it turns at less than 45 rpm")
    seen = drive.look()
    assert (seen.outcome, seen.limit) == (Outcome.STANDS, 45.0)
    assert math.isnan(seen.speed)
    fake.seen = (4, 45, "it turns, the pulses do not agree on how; by its back-EMF at about 45 rpm")
    seen = drive.look()
    assert (seen.outcome, seen.limit) == (Outcome.UNCLEAR, 45.0)
    assert math.isnan(seen.speed)
    fake.seen = (5, 0, "ended by a stop")
    with pytest.raises(DriveError, match="not looked at: ended by a stop"):
        drive.look()
    drive.start(100)
    with pytest.raises(RefusedError):
        drive.look()


def test_what_is_not_saved_is_told(fake, drive):
    assert (drive.status().unsaved, drive.status().unsaved_text) == (0, "")
    drive.set("current_limit", 2.5)
    assert drive.status().unsaved_text == "1 parameter is not saved: 'save' keeps what is in force"
    drive.set("speed_ramp", 1000)
    assert drive.status().unsaved == 2
    drive.set("current_limit", 14.0)
    drive.save()
    assert drive.status().unsaved == 0
    assert RawStatus(*[0] * 13, 255).unsaved_known is None


def test_faults_in_words_newest_first(fake, drive):
    drive.start(0)
    fake.raise_fault(1)
    fake.state = 4
    fake.raise_fault(2)
    newest, oldest = drive.faults()
    assert newest.cause == "a phase current beyond trip_current"
    assert oldest.cause.startswith("over-current")
    assert (newest.link_voltage, newest.current_d, newest.current_q) == (310.0, -1.0, 3.0)
    assert drive.status().fault == newest.cause
    drive.reset()
    assert drive.status().fault == ""


def test_a_question_without_an_answer_is_repeated_with_its_tag(fake, drive):
    fake.swallow += [Request.PARAMETER_GET] * 2
    assert drive.get("current_limit") == 14.0
    assert drive.link.counts.repeated == 2
    fake.corrupt += [Request.PARAMETER_GET]
    assert drive.get("current_limit") == 14.0
    assert drive.link.counts.damaged == 1


def test_what_must_not_happen_twice_is_not_repeated(fake, drive):
    fake.swallow += [Request.COMMAND]
    with pytest.raises(NoAnswerError, match="not known"):
        drive.reset()
    assert fake.swallow == []
    drive.stop()
    fake.swallow += [Request.COMMAND]
    drive.stop()  # may be said twice


def test_silence_is_said(fake):
    with Drive.open(fake.port, timeout=0.05) as drive:
        fake.swallow += [Request.STATUS] * 4
        with pytest.raises(NoAnswerError, match=f"no answer from the drive on serial port {fake.port}$"):
            drive.status()


def test_text_among_answers_goes_to_who_listens(fake, drive):
    heard = []
    with drive.link.listening(text=heard.append):
        fake.chatter = b"boot 1.0\r\n"
        drive.get("current_limit")
    assert b"".join(heard) == b"boot 1.0\r\n"


def test_a_port_is_for_one_client(fake, drive):
    with pytest.raises(LinkError, match="in use by another program"):
        Drive.open(fake.port)


def test_an_unplugged_drive_is_said_at_once(fake, drive):
    fake.unplug()
    begin = time.monotonic()
    with pytest.raises(LinkError, match=r"is gone: look whether its cable is in"):
        for _ in range(10):
            drive.status()
    assert time.monotonic() - begin < 2


def test_many_threads_get_their_own_answers(drive):
    wrong = []

    def ask(name, value):
        wrong.extend(name for _ in range(40) if drive.get(name) != value)

    threads = [threading.Thread(target=ask, args=pair) for pair in (("current_limit", 14.0), ("speed_limit", 3300.0))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []


def test_a_guarded_motor_stops_when_the_client_is_silent(fake, drive):
    drive.set("link_timeout", 100)
    drive.start(300, guarded=True)
    assert fake.state == 4
    assert wait_until(lambda: fake.state != 4, 2)


def test_what_another_client_asks_keeps_no_motor_running(fake, drive):
    drive.set("link_timeout", 100)
    drive.start(300, guarded=True)
    drive.holder = 0
    drive.hold()  # from here on it is somebody else
    with drive.kept_alive(0.02):
        assert wait_until(lambda: fake.state != RUN, 2)


def test_a_client_that_goes_leaves_the_motor_of_another_alone(fake, drive):
    with drive.running(300):
        assert drive.raw_status().held
        fake.start(4711)  # meanwhile it has stopped, and another client has started it
        assert not drive.raw_status().held
    assert fake.state == RUN
    assert not drive.let_go()
    assert fake.state == RUN
    drive.stop()
    assert fake.state != RUN  # stop is for everybody


def test_questions_are_asked_in_the_order_of_their_coming(drive):
    order = []
    for number in range(20):

        def ask(number=number):
            with drive.link._turns.turn(urgent=False):
                order.append(number)

        with drive.link._turns.turn(urgent=False):
            threads = []
            for _ in range(3):
                threads.append(threading.Thread(target=ask))
                threads[-1].start()
                waiting = len(threads)
                assert wait_until(lambda waiting=waiting: len(drive.link._turns._waiting) == waiting, 5, 0.0)
        ask()  # who has just had his turn does not go first again
        for thread in threads:
            thread.join()
    assert order == sorted(order)


def test_running_is_guarded_and_ends_with_the_context(fake, drive):
    drive.set("link_timeout", 200)
    drive.set("speed_ramp", 20000)
    with drive.running(300):
        time.sleep(0.5)
        assert fake.state == 4
        assert fake.guarded
    assert fake.state == 2


def test_running_says_which_fault_ended_it(fake, drive):
    fake.start_fault = 1
    with pytest.raises(DriveError, match="the motor does not run: over-current"), drive.running(300):
        pytest.fail("it did not start")


def test_a_stream_counts_what_is_lost(fake, drive):
    with drive.stream(["speed", "link_voltage"], period=0.005) as stream:
        first = stream.next(2)
        assert first.values[1] == 310.0
        fake._counter = (fake._counter + 3) % 256
        times = [next(iter(stream)).time for _ in range(20)]
    assert stream.lost == 3
    assert times == sorted(times)
    assert wait_until(lambda: fake.stream is None, 1)


def test_a_stream_of_too_much_is_refused(drive):
    with pytest.raises(InputError, match="9 signals; 1 … 8"):
        drive.stream(["speed"] * 9)
    with pytest.raises(InputError, match=r"0.001 … 65.535 s"):
        drive.stream(["speed"], 100)


def test_a_capture_has_units_and_time_from_the_trigger(drive):
    drive.start(0)
    capture = drive.capture("speed", Channel("current_d", 4.0), trigger=Trigger("speed", 10, "rising"), decimation=2)
    assert capture.time.size == scope.DEPTH
    assert capture.time[128] == 0.0
    assert capture.interval == pytest.approx(2e-4)
    # The fake counts records; its value at the trigger is the signal's, less than a step of 4 A / 2^15 away.
    assert capture.signals["current_d"][128] == pytest.approx(-1.5, abs=4 / 2**15)
    step = np.diff(capture.signals["current_d"])
    assert np.allclose(step, 4 / 2**15)
    assert capture.units == {"speed": "rpm", "current_d": "A"}
    assert capture.clipped == ()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"trigger": Trigger("speed", 0, "up")}, "no trigger edge 'up'; known: above, below, either"),
        (
            {"trigger": Trigger("speed", 40000)},
            r"speed: 40000 rpm is out of range; -32768 … 32768 rpm \(all",
        ),
        ({"decimation": 0}, "decimation: 0 is out of range; 1 … 65535"),
        ({"trigger": Trigger("state", 2.5)}, "state: 2.5 is not a whole number"),
        ({"pretrigger": 1.0}, "pretrigger: 100 % is out of range; 0 … 99.9 %"),
    ],
)
def test_what_is_wrong_with_a_capture_is_said(drive, options, said):
    with pytest.raises(InputError, match=said):
        drive.capture("speed", **options)


def test_a_commissioning_is_followed_to_its_results(drive):
    phases = []
    report = drive.commission(lambda share, phase: phases.append((share, phase)) or True)
    assert not report.complete
    assert phases[0][1] == "staircase"
    assert report.unsaved == ""
    assert phases[-1] == (1.0, "done")
    assert [(value.name, value.value, value.used) for value in report.values] == [
        ("current_limit", 13.5, True),
        ("speed_limit", 5000.0, False),
    ]
    assert report.values[1].words == "too few samples"


def test_a_commissioning_says_that_its_results_are_not_saved(fake, drive):
    fake.values[6] -= 1
    heard = []
    report = drive.commission(lambda share, phase: heard.append(phase))
    assert report.unsaved == "1 parameter is not saved: 'save' keeps what is in force"
    assert heard[-1] == f"done: {report.unsaved}"


def test_a_commissioning_can_be_stopped(drive):
    with pytest.raises(DriveError, match="was stopped"):
        drive.commission(lambda share, phase: False)


def test_save_waits_for_the_store(fake, drive):
    drive.save()
    assert drive.status().store == "saved"
