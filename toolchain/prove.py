#!/usr/bin/env python3
"""Absence of run-time errors with a 16-bit int, by Frama-C: EVA over the drive's C, WP for the arithmetic's contracts.

Usage: toolchain/prove.py OUT [--defects] [PART ...]     (make prove)

Every part of PARTS has a driver in tests/prove/ that calls the drive's functions with any input that their headers
admit. EVA follows all of that at once, with intervals, and reports an alarm wherever it cannot exclude an undefined
operation: overflow of a signed number, division by zero, a shift, an index or a pointer that is out of range, a value
that was never set. WP proves the contracts of tests/prove/ for functions of PROVED_BY_WP. What neither excludes stands
in tests/prove/alarms.txt, by part, function and kind: more than that is an error. With --defects, the defects of
DEFECTS are planted into a copy of the sources and each has to be found in the function where it is.
"""

import csv
import os
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import planted

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ("hal", "control", "svpwm", "estimators", "firmware", "tests/prove")
PACK, TABLE = "toolchain/pack_text.py", "packed_text_table.c"
KNOWN = "tests/prove/alarms.txt"
SECONDS = 1500
AT_ONCE = 2
RANGES, CONTRACTS = "tests/prove/qmath_ranges.h", "tests/prove/qmath_contracts.h"
LINK_RANGES = "tests/prove/link_ranges.h"
# Read with any argument by itself; what calls it is read with its contract (qmath_ranges.h, link_ranges.h).
WITH_CONTRACT = (
    "q_clz32,q_reciprocal_q31,q_div,q_invert,q_sqrt64,q_sqrt32,q_hypot,q_atan2,q_sincos,q_follow,q_mix,q_limit"
)
OF_LAYOUTS = "svpwm_alternating_fits,svpwm_alternating,svpwm_extended,svpwm_cheapest_pair,svpwm_centred,svpwm_long_zero"
OF_BLOCKS = "crc16,cobs_encode,cobs_decode"
OF_NAMES = "text_begins,text_equals,text_occurs"
OF_WRITING = "put_text,put_unsigned,put_fixed,put_spaces_to,put_words,put_packed"
OF_TYPING = f"{OF_NAMES},text_number,decimal_raw,packed_occurs,suggest_is_near"
OF_LINES = "editor_octet,editor_next,editor_show"
OF_RECORDS = "splitter_octet,splitter_rest,record_to_wire"
OF_FRAMES = "segment_join,segment_split_begin,segment_split_peek,segment_split_advance"
PROVED_BY_WP = (
    *("q_shr", "q_shr64", "q_shr_round", "q_max", "q_min", "q_max16", "q_min16", "q_clamp", "q_in_range", "q_sat64"),
    *("q_add_sat", "q_sub_sat", "q_neg_sat", "q_abs_sat", "q_mul64", "q_mul", "q_mul_sat", "q_mac", "q_mul_add"),
    *("q_product",),
    *("q_mul_sub", "q_mul_floor", "q_mul_add_floor", "q_mul_sub_floor", "q_mul_hi", "q_umul_hi", "q15_sat"),
    *("q15_add_sat", "q15_sub_sat", "q15_mul"),
)
# Read where they are called, and their promise taken: intervals do not see it in the one comparison. WP proves that of
# q_sat64; at the others its prover stops, and tests/qmath tries every edge.
SHOWN_ELSEWHERE = ("q_sat64", "q_limit", "q_sat_bits", "q_follow", "q_mix")
OPEN = ("Unknown", "Invalid", "Inconsistent", "Never tried")

Alarm = tuple[str, str]  # function, kind


@dataclass(frozen=True)
class Part:
    """What is read together."""

    name: str
    sources: tuple[str, ...]  # the driver, patterns of the drive's files
    flags: tuple[str, ...]
    header: str = RANGES
    given: str = ""  # functions of which the contract is taken, not the code


def eva(entry: str, *flags: str) -> tuple[str, ...]:
    """What has EVA read a driver's function."""
    return ("-main", entry, "-eva", "-eva-no-print", *flags)


QMATH = ("tests/prove/qmath.c", "hal/qmath/*.c")
SLICED = ("arithmetic", "quotients", "roots", "vectors", "angles")
SLICES = (
    *("-eva-precision", "1", "-eva-slevel", "100", "-eva-auto-loop-unroll", "600"),
    *("-eva-split-return-function", "q_clz32:full"),
)
READER = (*("-eva-precision", "0", "-eva-auto-loop-unroll", "12", "-eva-slevel", "20", "-eva-split-return", "auto"),)
RECORD = "firmware/link/record.c"
FRAMES = (
    *("tests/prove/framing.c", "firmware/link/splitter.c", RECORD, "firmware/link/cobs.c"),
    *("firmware/link/crc.c", "firmware/can/segments.c", "hal/qmath/qdiv.c"),
)
TEXTS = (
    *("firmware/text.c", "firmware/words.c", "firmware/packed_text.c", "firmware/parameters.c", "firmware/signals.c"),
    *("firmware/link/octets.c", "hal/qmath/qdiv.c"),
)
TYPED = ("tests/prove/text.c", "firmware/console/suggest.c", *TEXTS)
BESIDE = (
    *("tests/prove/any_drive.c", "firmware/actions.c", "firmware/fault_history.c", "firmware/scope/scope.c"),
    *("firmware/link/guard.c", "firmware/link/stream.c", *TEXTS),
)
TERMINAL = ("firmware/console/console.c", "firmware/console/editor.c", "firmware/console/output.c")
# As many iterations of a loop, each by itself, and as many ways into a function kept apart.
APART = (
    *("-eva-precision", "0", "-eva-auto-loop-unroll", "40", "-eva-slevel", "100"),
    *("-eva-partition-history", "2", "-eva-interprocedural-history"),
)
NUMBERS = (
    *("-eva-precision", "0", "-eva-min-loop-unroll", "130", "-eva-slevel", "12", "-eva-split-return", "auto"),
    *("-eva-slevel-function", "put_digits:60"),
)
NAMES = (
    *("-eva-precision", "0", "-eva-min-loop-unroll", "200", "-eva-slevel", "4", "-eva-split-return", "auto"),
    *("-eva-slevel-function", "is_one_edit_away:60"),
)
ROUNDS = ("-eva-precision", "0", "-eva-auto-loop-unroll", "40", "-eva-slevel", "20", "-eva-split-return", "full")
PARTS = (
    *(Part(name, QMATH, eva(f"prove_{name}", *SLICES)) for name in SLICED),
    Part("lengths", QMATH, eva("prove_lengths", "-eva-precision", "1"), given="q_sqrt64"),
    Part(
        "svpwm",
        ("tests/prove/svpwm.c", "svpwm/*.c", "hal/qmath/*.c"),
        eva("prove_svpwm", *READER),
        "tests/prove/svpwm_ranges.h",
        f"{WITH_CONTRACT},{OF_LAYOUTS}",
    ),
    Part(
        "layouts",
        ("tests/prove/svpwm.c", "svpwm/*.c", "hal/qmath/*.c"),
        eva("prove_layouts", "-eva-precision", "0", "-eva-min-loop-unroll", "7"),
        given=WITH_CONTRACT,
    ),
    Part(
        "edges",
        ("tests/prove/svpwm.c", "svpwm/*.c", "hal/qmath/*.c"),
        eva("prove_edges", "-eva-precision", "0", "-eva-min-loop-unroll", "6", "-eva-slevel", "60"),
        given=WITH_CONTRACT,
    ),
    Part(
        "control",
        ("tests/prove/control.c", "control/*.c", "hal/qmath/*.c"),
        eva("prove_control", *READER, "-eva-subdivide-non-linear", "20"),
        given=WITH_CONTRACT,
    ),
    *(
        Part(
            name,
            (f"tests/prove/{name}.c", "estimators/*.c", "control/*.c", "hal/qmath/*.c"),
            eva(f"prove_{name}", *READER),
            given=WITH_CONTRACT,
        )
        for name in ("estimators", "observer", "flux", "start")
    ),
    Part(
        "commissioning",
        ("tests/prove/start.c", "estimators/*.c", "control/*.c", "hal/qmath/*.c"),
        eva("prove_commissioning", *ROUNDS, "-eva-min-loop-unroll", "70"),
        given=WITH_CONTRACT,
    ),
    Part("packed", TYPED, eva("prove_packed", "-eva-precision", "0", "-eva-min-loop-unroll", "470"), LINK_RANGES),
    Part("numbers", TYPED, eva("prove_numbers", *NUMBERS), LINK_RANGES, f"{WITH_CONTRACT},put_packed"),
    Part("names", TYPED, eva("prove_names", *NAMES), LINK_RANGES, WITH_CONTRACT),
    Part("near", TYPED, eva("prove_near", *NAMES), LINK_RANGES, f"{WITH_CONTRACT},{OF_NAMES}"),
    Part(
        "editor",
        ("tests/prove/editor.c", "firmware/console/editor.c", "firmware/link/octets.c", "hal/qmath/qdiv.c"),
        eva("prove_editor", "-eva-precision", "0", "-eva-slevel", "20", "-eva-auto-loop-unroll", "10"),
        LINK_RANGES,
        "put_text",
    ),
    Part(
        "commands",
        ("tests/prove/commands.c", "firmware/console/commands*.c", "firmware/console/s*.c", *TERMINAL, *BESIDE),
        eva("prove_commands", *READER),
        LINK_RANGES,
        f"{WITH_CONTRACT},{OF_WRITING},{OF_TYPING},{OF_LINES}",
    ),
    Part(
        "requests",
        (
            *("tests/prove/requests.c", "firmware/link/requests*.c", "firmware/link/crc.c", "firmware/hil/*.c"),
            *("firmware/clear.c", "hal/tape.c", *BESIDE),
        ),
        eva("prove_requests", *READER),
        LINK_RANGES,
        f"{WITH_CONTRACT},{OF_WRITING}",
    ),
    Part(
        "console",
        ("tests/prove/console.c", "firmware/link/link.c", "firmware/link/splitter.c", RECORD, *TERMINAL, *BESIDE),
        eva("prove_console", *ROUNDS),
        LINK_RANGES,
        f"{WITH_CONTRACT},{OF_WRITING},{OF_LINES},{OF_RECORDS}",
    ),
    Part(
        "node",
        ("tests/prove/node.c", "firmware/can/*.c", RECORD, *BESIDE),
        eva("prove_node", *ROUNDS),
        LINK_RANGES,
        f"{WITH_CONTRACT},{OF_WRITING},{OF_FRAMES}",
    ),
    Part("blocks", FRAMES, eva("prove_blocks", "-eva-precision", "0", "-eva-auto-loop-unroll", "300"), LINK_RANGES),
    Part("framing", FRAMES, eva("prove_framing", *APART), LINK_RANGES, OF_BLOCKS),
    Part(
        "contracts",
        ("hal/qmath/qdiv.c",),
        ("-wp", "-wp-rte", "-wp-prover", "z3", "-wp-timeout", "10", "-wp-fct", ",".join(PROVED_BY_WP)),
        CONTRACTS,
    ),
)


@dataclass(frozen=True)
class Defect:
    """One change of the sources, and the part and function in which it has to show."""

    part: str
    function: str
    file: str
    right: str
    wrong: str


DEFECTS = (
    Defect("arithmetic", "q15_mul", "hal/qmath/qarith.h", "(int32_t)a * b + 0x4000L", "a * b + 0x4000L"),
    Defect("arithmetic", "q_neg_sat", "hal/qmath/qarith.h", "(x == INT32_MIN) ? INT32_MAX : -x", "-x"),
    Defect("quotients", "q_reciprocal_q31", "hal/qmath/qdiv.c", "[(divisor >> 24) - 128]", "[(divisor >> 24) - 127]"),
    Defect("quotients", "q_invert", "hal/qmath/qdiv.c", "(divisor > 0) ?", "(divisor >= 0) ?"),
    Defect("roots", "inverse_root_q30", "hal/qmath/qsqrt.c", "[(m_q32 >> 25) - 32]", "[(m_q32 >> 25) - 31]"),
    Defect("angles", "sincos_of_quadrant", "hal/qmath/qtrig.c", "sine_q30[node]", "sine_q30[node + 1u]"),
    Defect("svpwm", "alternate", "svpwm/modulator.c", "* FOUR_FIFTHS_Q15", "* 99 * FOUR_FIFTHS_Q15"),
    Defect("layouts", "most_of_both", "svpwm/extended.c", "(room + t1 + t2) / 2", "(room + t1 * t2) / 2"),
    Defect(
        "edges", "svpwm_take_window", "svpwm/windows.c", "window_count < SVPWM_WINDOWS", "window_count <= SVPWM_WINDOWS"
    ),
    Defect(
        "control",
        "command_q16",
        "control/current_controller.c",
        "q_add_sat(controlled_q16, rotational_q16)",
        "controlled_q16 + rotational_q16",
    ),
    Defect(
        "estimators",
        "follow_angle",
        "estimators/tracking_observer.c",
        "q_clamp(before + change, -SPEED_END_BPP, SPEED_END_BPP)",
        "before + change",
    ),
    Defect("estimators", "hurry", "estimators/voltage_match.c", "q_neg_sat(e_q16)", "-e_q16"),
    Defect(
        "observer", "correct", "estimators/deviation_observer.c", "q_limit(s->speed_bpp + ", "q_max(s->speed_bpp + "
    ),
    Defect("observer", "prove_observer", "estimators/deviation_observer.c", "q_limit(ka.s, VARIANCE_MAX)", "ka.s"),
    Defect("flux", "leaked", "estimators/stator_flux.c", "q_add_sat(flux_q16, q_mul", "(flux_q16 + q_mul"),
    Defect(
        "flux",
        "flux_adaptation_change_q24",
        "estimators/flux_adaptation.c",
        "q_sub_sat(length_q24, along_q24)",
        "length_q24 - along_q24",
    ),
    Defect("start", "polarity_step", "estimators/polarity.c", "q_add_sat(s->response_bam, s", "(s->response_bam + s"),
    Defect(
        "start", "saturation_resistance_q24", "estimators/saturation.c", "return q_neg_sat(q_div(", "return -(q_div("
    ),
    Defect("commissioning", "fit_plane", "estimators/fit.c", "rest[FIT_POINTS]", "rest[FIT_POINTS - 1u]"),
    Defect("packed", "packed_next", "firmware/packed_text.c", "[code - FIRST_PAIR]", "[code - FIRST_PAIR + 1u]"),
    Defect("numbers", "put_digits", "firmware/text.c", "reversed[10]", "reversed[9]"),
    Defect("names", "common", "firmware/text.c", "k < count && string[k] != '\\0' &&", "k < count &&"),
    Defect(
        "near", "is_one_edit_away", "firmware/console/suggest.c", "&name[k + 1u], rest, l", "&name[k + 2u], rest, l"
    ),
    Defect("editor", "insert", "firmware/console/editor.c", "l->count >= EDITOR_LINE", "l->count > EDITOR_LINE"),
    Defect("commands", "set_channels", "firmware/console/commands_scope.c", "a->count > 1u +", "a->count > 2u +"),
    Defect("requests", "scope_read", "firmware/link/requests_scope.c", "count > READ_MAX", "count > 2u * READ_MAX"),
    Defect("requests", "delta_take", "firmware/hil/hil.c", "shape[2] > TAPE_INPUTS", "shape[2] > 2u * TAPE_INPUTS"),
    Defect("console", "keep", "firmware/console/console.c", "kept_count) & (KEPT - 1u)", "kept_count) & KEPT"),
    Defect("node", "can_put", "firmware/can/messages.c", "&frame->data[at >> 3]", "&frame->data[at >> 2]"),
    Defect("blocks", "cobs_decode", "firmware/link/cobs.c", "from = 0; from < count", "from = 0; from <= count"),
    Defect(
        "framing", "splitter_octet", "firmware/link/splitter.c", "<= RECORD_ENCODED_MAX)", "<= RECORD_ENCODED_MAX + 1u)"
    ),
    Defect("framing", "take", "firmware/can/segments.c", "j->count >= RECORD_MAX", "j->count > RECORD_MAX"),
    Defect("contracts", "q_clamp", "hal/qmath/qarith.h", "return (x > hi) ? hi : x;", "return (x >= hi) ? lo : x;"),
    Defect("contracts", "q_sat64", "hal/qmath/qarith.h", "(x < 0) ? INT32_MIN : INT32_MAX", "INT32_MAX"),
    Defect("contracts", "q15_sat", "hal/qmath/qarith.h", "q_clamp(x, INT16_MIN, ", "q_clamp(x, -INT16_MAX, "),
    Defect(
        "contracts", "q_mul_hi", "hal/qmath/qarith.h", "q_shr64(q_product(a, b), 32)", "q_shr64((int32_t)a * b, 32)"
    ),
    Defect("contracts", "q_sub_sat", "hal/qmath/qarith.h", "q_sat64((int64_t)a - b)", "a - b"),
)


@dataclass(frozen=True)
class Read:
    """What a part's reading leaves open, and how much of the code it has been through or proved."""

    alarms: Counter[Alarm]
    words: str


def sources_of(part: Part, tree: Path, table: Path) -> list[str]:
    """Its files, and with the texts the table that the build makes of them."""
    found = [path.relative_to(tree).as_posix() for pattern in part.sources for path in sorted(tree.glob(pattern))]
    return [*found, str(table)] if "firmware/packed_text.c" in found else found


def summary(part: Part, rows: list[dict[str, str]], said: str) -> str:
    """How much was read or proved."""
    reached = re.search(r"(\d+) functions analyzed.*?(\d+) statements reached \(out of (\d+)\)", said, re.DOTALL)
    if reached:
        return f"{reached[1]} functions, {reached[2]} of {reached[3]} statements reached"
    proved = sum(row["status"].startswith("Valid") for row in rows)
    return f"{len(PROVED_BY_WP)} functions, {proved} properties proved"


def plain(function: str) -> str:
    """The copies of an inline function, one for each file, are one function."""
    return re.sub(r"_\d+$", "", function)


def is_open(part: Part, row: dict[str, str]) -> bool:
    """Whether that is left open.

    What a function needs is shown where it is called, what it promises where it is read by itself; EVA does not try
    what it does not reach.
    """
    status, kind = row["status"], row["property kind"]
    promised = (*part.given.split(","), *SHOWN_ELSEWHERE)
    given = kind == "postcondition" and bool(part.given) and plain(row["function"]) in promised
    if given or kind == "precondition" or not status.startswith(OPEN) or status.endswith("dead"):
        return False
    return status != "Never tried" or (part.header == CONTRACTS and plain(row["function"]) in PROVED_BY_WP)


def read(part: Part, tree: Path, out: Path) -> Read:
    """Lets Frama-C read a part."""
    table, log = out / f"{part.name}.csv", out / f"{part.name}.log"
    machine = ("-machdep", "gcc_x86_16", f"-cpp-extra-args=-I. -std=c99 -include {part.header}")
    sources = sources_of(part, tree, out / TABLE)
    given = ("-eva-use-spec", part.given) if part.given else ()
    command = ["frama-c", *machine, *sources, *part.flags, *given, "-then", "-report-csv", str(table)]
    # Frama-C believes PWD more than where it is.
    home = {**os.environ, "PWD": str(tree), "WHY3CONFIG": str(out / "why3.conf")}
    done = subprocess.run(command, cwd=tree, env=home, capture_output=True, text=True, check=False, timeout=SECONDS)
    log.write_text(done.stdout + done.stderr, encoding="utf-8")
    if done.returncode != 0:
        raise RuntimeError(f"frama-c fails, see {log}: {(done.stdout + done.stderr)[-1500:]}")
    with table.open(encoding="utf-8", newline="") as lines:
        rows = list(csv.DictReader(lines, delimiter="\t", quoting=csv.QUOTE_NONE))
    alarms = Counter((plain(row["function"]), row["property kind"]) for row in rows if is_open(part, row))
    return Read(alarms, summary(part, rows, done.stdout))


def known() -> dict[str, Counter[Alarm]]:
    """The alarms that are known, by part."""
    found: dict[str, Counter[Alarm]] = {part.name: Counter() for part in PARTS}
    for line in (ROOT / KNOWN).read_text(encoding="utf-8").splitlines():
        words = line.split("#")[0].split()
        if words:
            found[words[0]][words[1], " ".join(words[2:-1])] = int(words[-1])
    return found


def more_than(alarms: Counter[Alarm], bound: Counter[Alarm]) -> dict[Alarm, int]:
    """What there is more of than is known."""
    return {alarm: count for alarm, count in sorted(alarms.items()) if count > bound[alarm]}


def at_once(work: Callable[[Part], Read], parts: list[Part]) -> Iterator[tuple[Part, Read]]:
    """The parts' readings in their order, two at a time."""
    with ThreadPoolExecutor(AT_ONCE) as pool:
        yield from zip(parts, pool.map(work, parts), strict=True)


def check(out: Path, wanted: list[str]) -> int:
    """Reads the parts; prints a line for each, and what is new."""
    status, bounds = 0, known()
    parts = [part for part in PARTS if not wanted or part.name in wanted]
    for part, done in at_once(lambda part: read(part, ROOT, out), parts):
        bound = bounds[part.name]
        left = f"{done.alarms.total()} left open ({bound.total()} known)"
        print(f"prove: {part.name}: {done.words}, {left}", flush=True)
        for (function, kind), count in more_than(done.alarms, bound).items():
            status = 1
            print(f"{part.name} {function} {kind} {count}  # known are {bound[function, kind]}")
    return status


def plant(out: Path, wanted: list[str]) -> int:
    """Plants the defects, those of a part together, and looks where they show."""
    complaints, bounds = [], known()
    defects = {part.name: [d for d in DEFECTS if d.part == part.name] for part in PARTS}
    parts = [part for part in PARTS if defects[part.name] and (not wanted or part.name in wanted)]
    for part in parts:
        changes = [(d.file, d.right, d.wrong) for d in defects[part.name]]
        complaints += planted.plant(out / "trees" / part.name, FOLDERS, changes)
    for part, done in at_once(lambda part: read(part, out / "trees" / part.name, out), parts):
        seen = {function for function, _ in more_than(done.alarms, bounds[part.name])}
        complaints += [f"{d.function}: {d.wrong!r} is not found" for d in defects[part.name] if d.function not in seen]
    planned = sum(len(defects[part.name]) for part in parts)
    print(f"prove: {planned} defects planted, {len(complaints)} not found where they are")
    for complaint in complaints:
        print(f"prove: {complaint}")
    return 1 if complaints else 0


def main() -> int:
    """The drive, or the defects."""
    out = Path(sys.argv[1]).resolve()
    out.mkdir(parents=True, exist_ok=True)
    subprocess.run(["why3", "-C", str(out / "why3.conf"), "config", "detect"], capture_output=True, check=True)
    subprocess.run([sys.executable, PACK, str(out / TABLE)], cwd=ROOT, check=True)
    names = [word for word in sys.argv[2:] if not word.startswith("-")]
    return plant(out, names) if "--defects" in sys.argv else check(out, names)


if __name__ == "__main__":
    sys.exit(main())
