"""Ctrl-C while workers work: heard at a place where nothing is half done."""

import os
import signal
import subprocess
import sys

import pytest

pytest.importorskip("stillspin._core", reason="the native module is not built")

from stillspin.runs.held_interrupt import HeldInterrupt

IN_THE_MIDDLE = """
import os, signal, time
from collections import deque
from concurrent.futures import _base
from stillspin.runs.workers import Task, Where, workers

taken = _base._AcquireFutures.__enter__

def interrupted(self):
    taken(self)  # the locks of the results that are waited for are held
    if working:
        os.kill(os.getpid(), signal.SIGINT)

_base._AcquireFutures.__enter__ = interrupted
working = []
if __name__ == "__main__":
    try:
        with workers(Where(2)) as crew:
            for done in crew.finished(deque(Task(time.sleep, (0.05,)) for _ in range(200))):
                working.append(done)
    except KeyboardInterrupt:
        print("interrupted after", len(working))
"""


def test_an_interrupt_in_the_middle_of_waiting_ends_the_workers(tmp_path):
    script = tmp_path / "in_the_middle.py"
    script.write_text(IN_THE_MIDDLE)
    started = subprocess.Popen(
        [sys.executable, script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    try:
        said = started.communicate(timeout=120)
    finally:
        if started.poll() is None:
            os.killpg(started.pid, signal.SIGKILL)
    assert started.returncode == 0, said
    assert said[0].startswith("interrupted after "), said


@pytest.fixture(autouse=True)
def _handlers():
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    yield
    for number, handler in before.items():
        assert signal.getsignal(number) == handler


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_it_is_held_back_until_it_is_asked_for(number):
    heard = []
    before = signal.signal(number, lambda *_: heard.append(number))
    try:
        with HeldInterrupt() as interrupt:
            interrupt.hear()
            os.kill(os.getpid(), number)
            assert heard == []
            interrupt.hear()
            interrupt.hear()
        assert heard == [number]
    finally:
        signal.signal(number, before)


def test_the_second_one_is_heard_at_once():
    with pytest.raises(KeyboardInterrupt), HeldInterrupt():
        os.kill(os.getpid(), signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)


def test_what_nobody_asked_for_is_heard_at_the_end():
    done = []
    with pytest.raises(KeyboardInterrupt), HeldInterrupt():
        os.kill(os.getpid(), signal.SIGINT)
        done.append("all of it")
    assert done


def test_an_error_is_not_hidden_by_it():
    with pytest.raises(ValueError, match="first"), HeldInterrupt():
        os.kill(os.getpid(), signal.SIGINT)
        raise ValueError("first")


def test_a_signal_that_is_ignored_stays_so():
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with HeldInterrupt() as interrupt:
            os.kill(os.getpid(), signal.SIGINT)
            interrupt.hear()
    finally:
        signal.signal(signal.SIGINT, before)
