"""A session of the console begins clean, keeps the watchdog alive and leaves no motor running behind it."""

import os
import pty
import signal
import subprocess
import sys
import time

import pytest

from stillspin import resources
from stillspin.drive.requester import wait_until
from stillspin.exit_codes import ExitCode

PATIENCE = 15.0
QUIET = 0.3
DRAWS = "\x1b[?2004h"
"""The line editor begins a line, so keys are its own; until then the terminal takes a Ctrl-D for itself."""
READY, RUN, STOP = 2, 4, 5


@pytest.fixture
def ask(call, fake):
    """Calls the command line for the small drive."""
    return lambda *arguments: call(*arguments, "--drive", fake.port)


class Person:
    """At a terminal on which `stillspin console` runs."""

    def __init__(self, port, *options):
        self._master, slave = pty.openpty()
        command = [sys.executable, "-m", "stillspin", "console", "--drive", port, *options]
        self.process = subprocess.Popen(
            command,
            stdin=slave,
            stdout=slave,
            stderr=slave,
            start_new_session=True,
            env={**os.environ, "TERM": "xterm"},
        )
        os.close(slave)
        os.set_blocking(self._master, False)
        self.seen = ""
        assert self.sees("Ctrl-D leaves"), self.seen
        assert self.sees(f"what you see: {resources.page('tuning')};"), self.seen
        assert self.sees(DRAWS), self.seen

    def _look(self):
        try:
            octets = os.read(self._master, 65536)
        except (BlockingIOError, OSError):
            return
        self.seen += octets.decode(errors="replace")
        if "\x1b[6n" in octets.decode(errors="replace"):  # where is the cursor
            os.write(self._master, b"\x1b[1;1R")

    def sees(self, words, patience=PATIENCE):
        def shown():
            self._look()
            return words in self.seen

        return wait_until(shown, patience)

    def type(self, keys):
        self._wait_for_quiet()
        os.write(self._master, keys.encode())

    def _wait_for_quiet(self):
        """While text is shown above the line the terminal takes keys for itself."""
        end = time.monotonic() + PATIENCE
        seen, since = self.seen, time.monotonic()
        while time.monotonic() < min(since + QUIET, end):
            self._look()
            if self.seen != seen:
                seen, since = self.seen, time.monotonic()
            time.sleep(0.02)

    def enters(self, line):
        """Types a line and waits until the editor begins the next one."""
        before = self.seen.count(DRAWS)
        self.type(line + "\r")

        def begins():
            self._look()
            return self.seen.count(DRAWS) > before

        assert wait_until(begins, PATIENCE), self.seen

    def goes(self):
        def gone():
            self._look()
            return self.process.poll() is not None

        return wait_until(gone, PATIENCE)

    def hang_up(self):
        os.close(self._master)
        self._master = -1

    def close(self):
        self.process.kill()
        self.process.wait()
        if self._master >= 0:
            os.close(self._master)


@pytest.fixture
def sit_down(fake):
    people = []
    fake.values[200] = 5000  # link_timeout; machines stall

    def begin(*options):
        people.append(Person(fake.port, *options))
        return people[-1]

    yield begin
    for person in people:
        person.close()


def runs(fake):
    return wait_until(lambda: fake.state == RUN, PATIENCE)


def stops(fake):
    return wait_until(lambda: fake.state in {STOP, READY}, PATIENCE)


def test_a_line_that_was_left_is_emptied_and_an_abandoned_watch_is_not_shown(ask, fake):
    fake.typed, fake.watched = b"start", True
    result = ask("console", "-c", "version")
    assert fake.lines == ["version"]
    assert "heard version" in result.stdout
    assert "rpm" not in result.stdout


def test_what_the_drive_tells_unasked_while_a_session_begins_is_no_lost_connection(ask, fake):
    fake.tells = b"\r\n! nothing was heard for link_timeout: the motor stops\r\n\r> \x1b[K"
    result = ask("console", "-c", "version")
    assert (result.exit_code, fake.lines) == (ExitCode.DONE, ["version"]), result.stderr


def test_a_watch_does_not_outlive_its_session(ask, fake):
    ask("console", "-c", "watch")
    assert fake.lines == ["watch"]
    assert not fake.watched


def test_commands_that_have_started_the_motor_stop_it_at_their_end(ask, fake):
    result = ask("console", "-c", "start")
    assert "the motor stops, because the session that started it ends" in result.stdout
    assert stops(fake)


def test_free_and_keep_running_leave_it_running(ask, fake):
    assert "the motor stops" not in ask("console", "-c", "start free").stdout
    assert fake.state == RUN
    fake.state = READY
    fake.lines.clear()
    assert "the motor runs on; nobody watches it" in ask("console", "-c", "start", "--keep-running").stdout
    assert fake.lines == ["start", "start free"]
    assert fake.state == RUN
    assert not fake.guarded


def test_a_motor_of_somebody_else_is_left_alone(ask, fake):
    fake.values[200] = 5000  # link_timeout: machines stall
    fake.start(4711)
    ask("console", "-c", "status")
    assert fake.state == RUN


def test_a_session_that_ends_leaves_a_motor_alone_that_another_has_started_since(sit_down, fake):
    person = sit_down()
    person.enters("start")
    assert runs(fake)
    assert person.sees("heard start"), person.seen
    fake.start(4711)
    person.type("\x04")
    assert person.goes()
    assert fake.state == RUN


def test_a_session_keeps_the_guard_alive(sit_down, fake):
    person = sit_down()
    person.enters("start")
    assert runs(fake)
    time.sleep(6.0)
    assert fake.state == RUN
    os.killpg(person.process.pid, signal.SIGSTOP)  # it hangs: nothing comes any more
    assert stops(fake)
    os.killpg(person.process.pid, signal.SIGCONT)


def test_ctrl_c_goes_to_the_drive_and_a_second_one_asks(sit_down, fake):
    person = sit_down()
    person.enters("start")
    assert runs(fake)
    before = fake.interrupts
    person.type("\x03")
    assert wait_until(lambda: fake.interrupts > before, PATIENCE)
    assert fake.state == RUN
    assert person.process.poll() is None
    for _ in range(3):  # a computer that stalls between two takes the second for a first
        person.type("\x03")
        if person.sees("leave and stop the motor?", 1.6):
            break
    assert "leave and stop the motor?" in person.seen, person.seen
    person.type("n\r")
    time.sleep(0.5)
    assert (person.process.poll(), fake.state) == (None, RUN)
    time.sleep(2.0)
    person.type("\x03\x03")
    assert wait_until(lambda: person.sees("leave and stop") and person.seen.count("leave and stop") > 1, PATIENCE)
    person.type("y\r")
    assert person.goes()
    assert stops(fake)


def test_the_answer_may_be_to_keep_it_running(sit_down, fake):
    person = sit_down()
    person.enters("start")
    assert runs(fake)
    person.type("\x03\x03")
    assert person.sees("leave and stop the motor?"), person.seen
    person.type("k\r")
    assert person.goes()
    assert fake.lines[-1] == "start free"
    assert fake.state == RUN


def test_who_leaves_a_motor_that_runs_free_is_told(sit_down, fake):
    person = sit_down()
    person.enters("start free")
    assert runs(fake)
    person.type("\x04")
    assert person.goes()
    assert "the motor runs on" in person.seen
    assert fake.state == RUN


def test_who_leaves_is_told_what_is_not_saved(sit_down, fake):
    person = sit_down()  # which has changed link_timeout
    person.type("\x04")
    assert person.sees("1 parameter is not saved: 'save' keeps what is in force"), person.seen
    assert person.goes()
    other = sit_down()
    fake.kept = dict(fake.values)
    other.type("exit\r")
    assert other.goes()
    assert "not saved" not in other.seen


def test_the_line_at_the_bottom_has_no_number_for_what_nothing_asks_for(sit_down, fake):
    fake.reference = 1200.0  # what a coast has left
    person = sit_down()
    assert person.sees("unknown: the shaft may be turning, reference –"), person.seen
    assert "reference 1200" not in person.seen


@pytest.mark.parametrize("way", ["\x04", "exit\r", signal.SIGTERM, signal.SIGHUP, None])
def test_every_way_out_stops_the_motor(sit_down, fake, way):
    person = sit_down()
    person.enters("start")
    assert runs(fake)
    if way is None:
        person.hang_up()
    elif isinstance(way, str):
        person.type(way)
    else:
        os.kill(person.process.pid, way)
    assert stops(fake)
    assert wait_until(lambda: person.process.poll() is not None, PATIENCE)
    if isinstance(way, signal.Signals):
        assert person.process.returncode == ExitCode.INTERRUPTED


def test_a_port_that_is_gone_is_said_without_a_key(sit_down, fake):
    person = sit_down()
    fake.unplug()
    assert person.goes(), person.seen
    assert person.process.returncode == ExitCode.NO_CONNECTION
    assert f"serial port {fake.port} is gone: look whether its cable is in" in person.seen
    assert "Errno" not in person.seen


def test_a_port_that_is_gone_before_the_answer_is_said(ask, fake):
    fake.dies = True
    result = ask("console", "-c", "version")
    assert result.exit_code == ExitCode.NO_CONNECTION
    assert "is gone: look whether its cable is in" in result.stderr
    assert "no answer" not in result.stderr
