"""What the page may ask for, by name. Every action gets a workbench, who asks, and the page's arguments."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

from stillspin import csv_table
from stillspin.drive import commissioning, scope
from stillspin.drive.protocol import Words
from stillspin.errors import InputError
from stillspin.link.errors import DriveError
from stillspin.quantity import ANY, Range
from stillspin.tune import files, plate
from stillspin.tune.messages import Message, for_page, shown_unit
from stillspin.tune.workbench import Workbench

_POLL = 0.05
_LONGEST = 600.0
_WHOLE = Range(0, whole=True)
_CHUNK = 12
"""Records of a capture per question: the plotted signals go on without a gap."""


def _set(bench: Workbench, _: str, given: Message) -> Any:
    name = _text(given, "name")
    change = bench.drive.change(name, _text(given, "value"))
    bench.streamer.learn({name: change.value})
    return asdict(change)


def _values(bench: Workbench, _: str, __: Message) -> Any:
    values = bench.drive.parameters()
    bench.streamer.learn(values)
    return values


def _start(bench: Workbench, who: str, given: Message) -> Any:
    bench.start(who, _typed(given, "speed"))


def _stop(bench: Workbench, _: str, __: Message) -> Any:
    bench.stop()


def _coast(bench: Workbench, _: str, __: Message) -> Any:
    bench.coast()


def _reset(bench: Workbench, _: str, __: Message) -> Any:
    bench.drive.reset()


def _ref(bench: Workbench, _: str, given: Message) -> Any:
    bench.drive.ref(_typed(given, "speed"))


def _save(bench: Workbench, _: str, __: Message) -> Any:
    bench.drive.save()
    return bench.drive.status().store


def _defaults(bench: Workbench, _: str, __: Message) -> Any:
    bench.drive.defaults()
    return _values(bench, "", {})


def _faults(bench: Workbench, _: str, __: Message) -> Any:
    faults = [asdict(fault) for fault in bench.drive.faults()]
    unknown = ("speed", "current_d", "current_q")
    return [fault | {name: for_page(fault[name]) for name in unknown} for fault in faults]


def _plot(bench: Workbench, _: str, given: Message) -> Any:
    names = given.get("signals")
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise InputError("signals: must be a list of names")
    bench.plot(names)


def _load(bench: Workbench, _: str, given: Message) -> Any:
    return files.load(bench, _text(given, "name"), _text(given, "text"))


def _plate(bench: Workbench, _: str, __: Message) -> Any:
    return plate.asked(bench.drive.table, bench.drive.parameters())


def _plate_check(bench: Workbench, _: str, given: Message) -> Any:
    return plate.check(bench, given)


def _plate_use(bench: Workbench, _: str, given: Message) -> Any:
    return plate.use(bench, given)


def _look(bench: Workbench, _: str, __: Message) -> Any:
    return bench.drive.look().text


def _look_again(bench: Workbench, _: str, __: Message) -> Any:
    bench.look_again()


def _commission(bench: Workbench, who: str, _: Message) -> Any:
    bench.commission(who)


def _phase(bench: Workbench, _: str, given: Message) -> Any:
    return bench.drive.words(Words.PHASE, _WHOLE.read_whole(_typed(given, "phase"), "phase"))


def _results(bench: Workbench, _: str, __: Message) -> Any:
    return [asdict(value) for value in commissioning.results(bench.drive)]


def _scope_stop(bench: Workbench, _: str, __: Message) -> Any:
    bench.drive.scope_stop()


def _capture(bench: Workbench, _: str, given: Message) -> Any:
    """Arm, wait until it is done or somebody stops it, read; the next capture ends this one."""
    setup = _setup(given)
    number = bench.begin_capture()
    bench.drive.scope_arm(setup)
    end = time.monotonic() + _LONGEST
    told = -1
    while (state := bench.drive.scope_state().state) not in {scope.DONE, scope.IDLE}:
        if not bench.captures(number):
            raise DriveError("another capture was started and ended this one")
        if time.monotonic() > end:
            bench.drive.scope_stop()
            raise DriveError(f"no trigger within {_LONGEST:g} s; check its signal, level and edge")
        if state != told:
            bench.tell({"t": "scope", "armed": state == scope.ARMED, "text": bench.drive.words(Words.SCOPE, state)})
            told = state
        time.sleep(_POLL)
    if state == scope.IDLE:
        raise DriveError("the capture was stopped before its trigger")
    capture = bench.drive.scope_read(setup, _CHUNK)
    return {
        "time": capture.time.tolist(),
        "signals": {name: [for_page(value) for value in values.tolist()] for name, values in capture.signals.items()},
        "units": {name: shown_unit(unit) for name, unit in capture.units.items()},
        "clipped": list(capture.clipped),
        "interval": capture.interval,
        "at": capture.trigger_time,
        "head": csv_table.head(capture.about),
    }


def _setup(given: Message) -> scope.Setup:
    names = given.get("signals")
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise InputError("signals: must be a list of names")
    trigger = scope.Trigger(_text(given, "trigger"), _typed(given, "level"), _text(given, "edge"))
    channels = [scope.Channel(name) for name in names]
    decimation = scope.DECIMATION.read_whole(_typed(given, "decimation"), "a record every")
    before = scope.BEFORE.read(_typed(given, "before"), "before the trigger")
    return scope.Setup(channels, trigger, decimation, before / 100.0)


def _text(given: Message, key: str) -> str:
    value = given.get(key)
    if not isinstance(value, str):
        raise InputError(f"{key}: must be text")
    return value


def _typed(given: Message, key: str) -> float | str:
    """A number, or the text of one as it was typed into the page."""
    value = given.get(key)
    return value if isinstance(value, str) else ANY.read(value, key)


ACTIONS: dict[str, Callable[[Workbench, str, Message], Any]] = {
    "set": _set,
    "values": _values,
    "start": _start,
    "stop": _stop,
    "coast": _coast,
    "reset": _reset,
    "ref": _ref,
    "save": _save,
    "defaults": _defaults,
    "faults": _faults,
    "plot": _plot,
    "load": _load,
    "plate": _plate,
    "plate_check": _plate_check,
    "plate_use": _plate_use,
    "look": _look,
    "look_again": _look_again,
    "commission": _commission,
    "phase": _phase,
    "results": _results,
    "capture": _capture,
    "scope_stop": _scope_stop,
}

SAFE = frozenset({"stop", "coast"})
"""What must not wait behind anything else."""
