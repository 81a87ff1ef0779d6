#!/usr/bin/env python3
"""Runs scenarios twice, with the native drive and with the one of a 16-bit int, and compares every recorded bit.

Usage: toolchain/int16/compare_runs.py MODULE [--seconds S] [--every N] [--jobs J] [SCENARIO]...

MODULE is the folder of the second native module (build/.../tests/int16/stillspin_int16). All scenarios but those on
demand unless some are named; of each run the first S seconds behind the start (default: all), every Nth run only. All
columns, faults, the reason and the counts of accesses and interrupts must be the same. Exit status 1 when one differs.
"""

import argparse
import hashlib
import importlib.util
import json
import os
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

from stillspin import core, resources
from stillspin.cases import profile, scenario_file
from stillspin.cases.profile import Changes
from stillspin.core import NativeResult
from stillspin.runs import execute

NOT_COMPARED = ("wall_seconds", "plant_share")
_SERVERS = threading.local()


def take_module(folder: str) -> None:
    """Puts a native module in the place of the package's own."""
    if folder == "native":
        return
    path = next(Path(folder).glob("_core*.so"))
    spec = importlib.util.spec_from_file_location("stillspin._core", path)
    if spec is None or spec.loader is None:
        raise SystemExit(f"{path} does not load")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    sys.modules["stillspin._core"] = module


def jobs_of(identifier: str) -> list[execute.Job]:
    """The runs of a scenario on its motor, profile bench, seed 1."""
    native = core.load()
    chosen = scenario_file.load(identifier)
    schema, known = core.plant_schema(native), core.parameters(native)
    settings = execute.Settings(
        profile.load("bench", schema, known, chosen.motor), Changes({}, {}, ()), 1, "", "the nameplate"
    )
    return execute.prepare(chosen, settings, native)


def digest(identifier: str, index: int, seconds: float) -> dict[str, Any]:
    """What a run leaves, in short."""
    job = jobs_of(identifier)[index]
    job = replace(job, run=replace(job.run, duration=min(job.run.duration, seconds)))
    try:
        result = execute.play(core.load(), job, None)
    except (RuntimeError, ValueError, ArithmeticError) as error:
        return {"broken": str(error)}
    return left_by(result)


def left_by(result: NativeResult) -> dict[str, Any]:
    """The same of a run that did not break."""
    left: dict[str, Any] = {
        name: hashlib.sha256(values.tobytes()).hexdigest() for name, values in sorted(result.signals.items())
    }
    left["records"] = len(result.signals["time"])
    left["faults"] = [list(fault) for fault in result.faults]
    left["reason"] = result.reason
    left["stats"] = {name: value for name, value in sorted(result.stats.items()) if name not in NOT_COMPARED}
    return left


def serve(module: str) -> None:
    """Plays the runs that standard input names, each in a process of its own: the firmware has static variables."""
    take_module(module)
    core.load()
    for line in sys.stdin:
        child = os.fork()
        if child == 0:
            print(json.dumps(digest(*json.loads(line))), flush=True)
            os._exit(0)
        if code := os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]):
            print(json.dumps({"crashed": code}), flush=True)


def server(module: str) -> subprocess.Popen[str]:
    """This thread's process with a native module, which has all at hand that a run needs."""
    kept: dict[str, subprocess.Popen[str]] = _SERVERS.__dict__
    if module not in kept:
        command = [sys.executable, __file__, "--serve", module]
        kept[module] = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    return kept[module]


def played(module: str, identifier: str, index: int, seconds: float) -> dict[str, Any]:
    """What a run leaves, from the module's server. RuntimeError where that has ended."""
    by = server(module)
    if by.stdin is None or by.stdout is None:
        raise RuntimeError("a server without pipes")
    print(json.dumps((identifier, index, seconds)), file=by.stdin, flush=True)
    if not (said := by.stdout.readline()):
        raise RuntimeError(f"what plays the runs of {module} has ended: {by.wait()}")
    left: dict[str, Any] = json.loads(said)
    return left


def compare(module: str, identifier: str, index: int, name: str, seconds: float) -> tuple[bool, str]:
    """One run by both drives."""
    mine, other = (played(which, identifier, index, seconds) for which in ("native", module))
    different = sorted(key for key in {*mine, *other} if mine.get(key) != other.get(key))
    if different or "crashed" in mine:
        told = {key: (mine.get(key), other.get(key)) for key in different if key in ("crashed", "reason")}
        return False, f"DIFFERS {identifier} {name}: {', '.join(different)} {told or ''}"
    stats = mine.get("stats", {})
    how = mine.get("broken") or mine["reason"] or "completed"
    accesses = stats.get("register_accesses", 0)
    return True, f"same    {identifier} {name}: {mine.get('records', 0)} records, {accesses:.0f} accesses, {how}"


def main() -> int:
    """Compares what the command line names."""
    if sys.argv[1:2] == ["--serve"]:
        serve(sys.argv[2])
        return 0
    parser = argparse.ArgumentParser(description="The native drive against that of a 16-bit int.")
    parser.add_argument("module")
    parser.add_argument("--seconds", type=float, default=1e9)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("scenarios", nargs="*")
    options = parser.parse_intermixed_args()
    ids = options.scenarios or scenario_file.campaign_ids(resources.names("motors"))
    todo = [(i, k, job.run.name) for i in ids for k, job in enumerate(jobs_of(i))][:: options.every]
    with ThreadPoolExecutor(options.jobs) as pool:
        results = []
        for result in pool.map(lambda t: compare(options.module, *t, options.seconds), todo):
            print(result[1], flush=True)
            results.append(result[0])
    print(f"{sum(results)} of {len(results)} runs the same, bit for bit")
    return 0 if results and all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
