"""The checks of the inside of firmware/: small headers, no question for the source, no parameter in an interrupt, one
writer for what a period has."""

import sys
from pathlib import Path

import pytest

from planting import plant

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

from checks import comparisons, faces, inside, interrupt, left, writers  # noqa: E402


def including(count: int) -> str:
    return "#include <stdint.h>\n" + "".join(f'#include "firmware/base/h{k}.h"\n' for k in range(count))


@pytest.mark.parametrize(
    ("text", "what"),
    [
        (including(7), "includes"),
        (including(6) + '#  include   "firmware/mode/x.h"\n', "includes"),
        ("\n" * 151, "lines"),
    ],
)
def test_header_that_is_too_large_is_caught(tmp_path: Path, text: str, what: str) -> None:
    header = plant(tmp_path, "firmware/mode/mode.h", text)
    assert [f.path for f in faces.check(tmp_path)] == ["firmware/mode/mode.h"]
    plant(tmp_path, faces.LEFT, f"# a comment\nfirmware/mode/mode.h: {what}\n")
    assert faces.check(tmp_path) == []
    header.write_text("", encoding="utf-8")
    assert [(f.path, f.line) for f in faces.check(tmp_path)] == [(faces.LEFT, 2)]


def test_header_that_is_just_small_enough_passes(tmp_path: Path) -> None:
    plant(tmp_path, "firmware/mode/mode.h", including(6) + '// #include "firmware/mode/x.h"\n' + "\n" * 142)
    plant(tmp_path, "firmware/mode/mode.c", including(9))
    plant(tmp_path, "hal/wide.h", including(9))
    assert faces.check(tmp_path) == []


VALUES = "enum {\n  POSITION_ENCODER = 0,  // measured\n  POSITION_AVV = 3\n};\n"


@pytest.mark.parametrize(
    "line",
    [
        "bool f(void) { return parameters.position_source == 3; }",
        "bool f(const parameters_t* p) { return p->position_source > 4; }",
        "void f(void) { switch (parameters . position_source) { default: break; } }",
        "int32_t f(void) { const int32_t source = parameters.position_source; return source; }",
        "bool f(int32_t source) { return source != POSITION_AVV; }",
        "bool f(const parameters_t* p) { return kinds[p->position_source] == 2; }",
        "bool f(const parameters_t* p) { return position_source_variants[p->position_source] == 2; }",
        "bool f(void) { return parameter_get(ID_position_source) != 0; }",
        "bool f(const drive_t* d) { return d->source == &avv_source; }",
        "bool f(const drive_t* d) { return d->source != position_sources[POSITION_AVV]; }",
        "bool f(const drive_t* d) { return position_sources[parameters.position_source] != d->source; }",
        "bool f(drive_t* d) { const position_source_t* s = position_sources[POSITION_AVV]; return d->source != s; }",
        "bool f(drive_t* d) { const position_source_t *s = &avv_source, *t = s; return t == d->source; }",
        "bool f(drive_t* d) { d->wanted = position_sources[POSITION_AVV]; return d->source == d->wanted; }",
        "bool f(const drive_t* d) { return d->source == edition_default_source; }",
        "bool f(drive_t* d) { const position_source_t* s = edition_start_source; return d->source == s; }",
    ],
)
def test_question_which_source_is_chosen_is_caught(tmp_path: Path, line: str) -> None:
    plant(tmp_path, "firmware/dictionary/parameters.h", VALUES)
    plant(tmp_path, "firmware/drive/speed.c", f'#include "firmware/mode/mode.h"\n{line}\n')
    assert [(f.path, f.line) for f in comparisons.check(tmp_path)] == [("firmware/drive/speed.c", 2)]


@pytest.mark.parametrize(
    "line",
    [
        "uint16_t f(void) { return position_sources[parameters.position_source]->traits; }",
        "int16_t f(void) { return position_source_variants[parameters.position_source]; }",
        "estimator_output_t f(drive_t* d) { return position_sources[POSITION_AVV]->step(d, NULL); }",
        "bool f(const drive_t* d) { return (d->source->traits & SOURCE_MEASURES) != 0u; }",
        "bool f(drive_t* d) { return edition_start_source->traits == 0u; }",
        "bool f(void) {\n  const void* s = position_sources[POSITION_AVV];\n  return NULL != s && s != NULL;\n}",
        "bool f(const state_t* s) {\n  const position_source_t* o = position_sources[POSITION_AVV];\n"
        "  return s->kind == o->traits;\n}\nbool g(const int* o, const int* p) {\n  return p == o;\n}",
        "// parameters.position_source == POSITION_AVV",
        'const char* f(void) { return "POSITION_AVV"; }',
    ],
)
def test_source_that_is_looked_up_passes(tmp_path: Path, line: str) -> None:
    plant(tmp_path, "firmware/dictionary/parameters.h", VALUES)
    plant(tmp_path, "firmware/drive/speed.c", line + "\n")
    assert comparisons.check(tmp_path) == []


def test_nobody_in_the_drive_asks_which_source_is_chosen() -> None:
    assert comparisons.check(ROOT) == []


INTERRUPT = """
static void step(drive_t* d) { d->look(&steps_of_drive); }
void drive_control_interrupt(void) { step(&drive); }
"""


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("firmware/drive/control_interrupt.c", INTERRUPT.replace("step(&", "if (parameters.mtpa == 0) step(&")),
        ("firmware/drive/control_interrupt.c", INTERRUPT.replace("d->look(", "read(d, parameters.mtpa, ")),
        (
            "firmware/drive/control_interrupt.c",
            "static bool first(drive_t* d) { return parameters.mtpa != 0; }\n"
            "static bool (*const phases[])(drive_t* d) = {first};\n"
            "void drive_control_interrupt(void) {\n  phases[0](&drive);\n}\n",
        ),
        ("firmware/drive/sampling.c", "void drive_window_interrupt(void) {\n  take(parameters.mtpa);\n}\n"),
        ("firmware/drive/speed.c", "void speed_step(drive_t* d,\n  int32_t x) {\n  d->x = x + parameters.mtpa;\n}\n"),
        ("firmware/drive/steps.h", "#define speed_step(d) ((d)->x + parameters.mtpa)\n"),
        (
            "firmware/drive/speed.c",
            "const steps_t steps_of_drive = {.first = f};\nint f(void) { return parameters.mtpa; }\n",
        ),
        ("firmware/start/hook.c", "static int32_t hook(drive_t* d) { return d->x / parameters.mtpa; }\n"),
        (
            "firmware/start/hook.c",
            "int32_t in_table(void) { return parameters.mtpa; }\nrows_t* const rows[] = {in_table};\n",
        ),
    ],
)
def test_parameter_that_an_interrupt_reads_is_caught(tmp_path: Path, path: str, text: str) -> None:
    plant(tmp_path, interrupt.POINTERS, "step -> hook 3 x hook @rows\n[host in the loop]\nstep -> elsewhere\n")
    called = INTERRUPT.replace("d->look", "speed_step(d, 0), d->look")
    plant(tmp_path, "firmware/drive/control_interrupt.c", called)
    plant(tmp_path, "firmware/drive/other.c", "void elsewhere(void) { use(parameters.mtpa); }\n")
    plant(tmp_path, "firmware/drive/own.c", "static int step(int x) { return x + parameters.mtpa; }\n")
    assert interrupt.check(tmp_path) == []
    plant(tmp_path, path, text)
    assert [f.path for f in interrupt.check(tmp_path)] == [path]


@pytest.mark.parametrize(("table", "name"), [("interlocks", "edition_interlocks"), ("position_sources",) * 2])
def test_parameter_read_in_a_row_of_a_feature_is_caught(tmp_path: Path, table: str, name: str) -> None:
    text = f"void drive_control_interrupt(void) {{ walk({name}); }}\n"
    plant(tmp_path, "firmware/drive/control_interrupt.c", text)
    plant(tmp_path, "firmware/board/feature.toml", f"[rows]\n{table} = {{ board_row = 20 }}\n")
    plant(tmp_path, "firmware/board/board.c", "int board_row(void) {\n  return parameters.precharge_voltage;\n}\n")
    assert [(f.path, f.line) for f in interrupt.check(tmp_path)] == [("firmware/board/board.c", 2)]


def test_all_parameters_at_once_are_caught(tmp_path: Path) -> None:
    text = "void drive_control_interrupt(void) {\n  const parameters_t* const p = &parameters;\n  use(p->mtpa);\n}\n"
    plant(tmp_path, "firmware/drive/control_interrupt.c", text)
    assert [(f.path, f.line) for f in interrupt.check(tmp_path)] == [("firmware/drive/control_interrupt.c", 2)]


@pytest.mark.parametrize("inside", [False, True])
@pytest.mark.parametrize(
    "made", ["static const parameters_t* const seen = &parameters;", "parameters_t* seen = (void*)&parameters;"]
)
def test_a_pointer_to_all_parameters_that_stays_is_caught(tmp_path: Path, made: str, inside: bool) -> None:
    begin = "void drive_control_interrupt(void) {\n"
    text = f"{begin}  {made}\n" if inside else f"{made}\n{begin}"
    plant(tmp_path, "firmware/drive/control_interrupt.c", f"{text}  use(seen->mtpa);\n}}\n")
    assert {f.path for f in interrupt.check(tmp_path)} == {"firmware/drive/control_interrupt.c"}


def test_what_the_interrupts_run_is_found_in_the_drive_itself() -> None:
    """Through calls, the table of phases, that of sources and their hooks, and down from each of both interrupts."""
    reached = set(interrupt.Program(ROOT).reached(interrupt.INTERRUPTS).values())
    steps = {"drive_protect", "step_if_ramp", "source_paper", "flux_excitation", "hysteresis_slice", "scope_step"}
    assert {*steps, "board_refusal", "selftest_refusal"} <= reached
    assert not {"parameter_set", "drive_config_make", "background_step", "console_service"} & reached


def test_headers_have_no_exceptions() -> None:
    """Nor will they have any."""
    assert not left(ROOT / faces.LEFT)


def test_test_that_reaches_into_the_drive_is_caught(tmp_path: Path) -> None:
    plant(tmp_path, inside.FACE, "inline auto& state() { return drive.state; }\n")
    plant(tmp_path, "tests/firmware/x.cpp", "// The drive. So it is.\nint f() { return inside::state(); }\n")
    assert inside.check(tmp_path) == []
    plant(tmp_path, "tests/firmware/y.cpp", "int f() { return x; }\nint g() { return drive.state + board.drive.x; }\n")
    assert [(f.path, f.line) for f in inside.check(tmp_path)] == [("tests/firmware/y.cpp", 2)]


PERIOD = {
    "control/frame.h": "typedef struct { int32_t d, q; } dq_t;\nvoid frame_turn(dq_t* out, const dq_t* in);\n",
    "firmware/drive/schedule.c": "void schedule_next(const drive_t* d, schedule_t* s) { s->slot = d->slot; }\n",
    "firmware/interfaces/source.h": "typedef struct {\n  void (*follow)(drive_t* d, const dq_t* now);\n} source_t;\n",
    "firmware/base/clear.h": "void clear(void* begin, uint16_t words);\n",
    "firmware/drive/map.c": "static void follow(dq_t* at) { at->d = 0; }\n",
}


@pytest.mark.parametrize(
    "line",
    [
        "  d->control.references.current_q20.q = 0;",
        "  drive_control_t* const c = &d->control; c->references.closed = true;",
        "  dq_t* const r = &d->control.references.current_q20;",
        "  drive.estimate.selected.angle_bam += half;",
        "  d->samples.windows[0].span_ticks = 1;",
        "  d->schedule.slot++;",
        "  d->flags.spins = true;",
        "  d->estimate.model = d->config.nameplate;",
        "  frame_turn(&d->estimate.measured_q20, &v);",
        "  frame_turn(d->estimate.frames, &v);",
        "  unknown(&d->estimate.observer);",
        "  clear(&d->control, sizeof d->control);",
        "  clear(d, sizeof *d);",
        "  clear(&drive, sizeof drive);",
        "  d->estimate = other;",
        "  d->modulation.overrun++;",
        "  drive_supervision_t* const v = &d->supervision; v->judged_at = d->heartbeat;",
        "  drive_estimate_t* const e = &d->estimate; e->trim.mismatch_q30 = 0;",
        "  clear(&d->supervision, sizeof d->supervision);",
        "  d->request.stop = true;",
        "  drive_request_t* const r = &d->request; r->speed = false;",
        "  d->control.limits |= LIMIT_VOLTAGE;",
        "  d->fault = FAULT_NONE;",
        "  d->heartbeat++;",
        "  d->source = &avv_source;",
        "  d->control.ramp.value = 0;",
        "  d->control.speed_ready = true;",
        "  machine_model_t* const m = &d->estimate.model; m->yd_q30 = 0;",
        "  drive.control = other;",
        "  drive_control_t* const c = &d->control;  *c = other;",
        "  *d = other;",
        "  estimator_frame_t* const f = d->estimate.frames;",
    ],
)
def test_member_of_a_period_that_somebody_else_writes_is_caught(tmp_path: Path, line: str) -> None:
    for path, text in PERIOD.items():
        plant(tmp_path, path, text)
    plant(tmp_path, "firmware/board/board.c", f"void look(drive_t* d) {{\n{line}\n}}\n")
    assert [(f.path, f.line) for f in writers.check(tmp_path)] == [("firmware/board/board.c", 2)]


@pytest.mark.parametrize(
    "line",
    [
        "  const int32_t q = d->control.references.current_q20.q;",
        "  const dq_t* const r = &d->control.references.current_q20;",
        "  if (d->schedule.slot == SLOT_LOOK) d->estimate.seen_here = d->estimate.selected;",
        "  frame_turn(&v, &d->estimate.measured_q20);",
        "  schedule_next(d, &d->schedule);  // whose it is to write",
        "  d->source->follow(d, &d->estimate.measured_q20);",
        "  use(d->estimate.measured_q20, sizeof(d->estimate.model));",
        "  const drive_control_t* const c = &d->control;",
        "  const int32_t all = 2 * d->heartbeat;",
        "  clear(&spare, sizeof d->control);",
    ],
)
def test_member_of_a_period_that_is_read_passes(tmp_path: Path, line: str) -> None:
    for path, text in PERIOD.items():
        plant(tmp_path, path, text)
    plant(tmp_path, "firmware/board/board.c", f"void look(drive_t* d) {{\n{line}\n}}\n")
    assert writers.check(tmp_path) == []


@pytest.mark.parametrize(
    ("path", "line"),
    [
        ("firmware/mode/mode.c", "d->flags.shorted = true;"),  # it clears them all
        ("firmware/start/start.c", "d->flags.frozen = true;"),  # of COMMISSION
        ("firmware/start/start.c", "d->flags = none;"),
        ("firmware/start/start.c", "d->modulation.running = 0;"),
        ("firmware/drive/speed.c", "d->control.references.closed = true;"),
        ("firmware/mode/mode.c", "d->control.references.feed_forward_q16 = 0;"),
        ("firmware/drive/protection.c", "d->supervision.missing = 0;"),
    ],
)
def test_member_that_the_writer_of_its_neighbour_writes_is_caught(tmp_path: Path, path: str, line: str) -> None:
    plant(tmp_path, path, f"void act(drive_t* d) {{\n  {line}\n}}\n")
    assert [(f.path, f.line) for f in writers.check(tmp_path)] == [(path, 2)]


def test_member_without_a_writer_is_caught(tmp_path: Path) -> None:
    known = "typedef struct drive {\n  drive_state_t state;\n  drive_control_t control;\n"
    plant(tmp_path, writers.DRIVE, f"{known}  const int32_t *seen, old[2];\n}} drive_t;\n")
    control = "typedef struct {\n  ramp_t ramp;  // of speed\n  volatile bool ready;\n} drive_control_t;\n"
    group = plant(tmp_path, "firmware/interfaces/period.h", control)
    found = [(f.path, f.line, f.message.partition(":")[0].split()[-1]) for f in writers.check(tmp_path)]
    place = "firmware/interfaces/period.h"
    assert found == [(place, 3, "control.ready"), (writers.DRIVE, 4, "seen"), (writers.DRIVE, 4, "old")]
    group.write_text(control.replace("ready", "speed_ready"), encoding="utf-8")
    plant(tmp_path, writers.DRIVE, f"{known}}} drive_t;\n")
    assert writers.check(tmp_path) == []


def test_every_member_of_the_drive_is_looked_at() -> None:
    seen = writers.members(ROOT)
    assert {
        "state",
        "modulation.sliced",
        "source",
        "config",
        "request.speed_rpm_q16",
        "flags.over",
        "estimate.frames",
    } <= set(seen)
    groups = {name for name in writers.GROUPS.values() if any(member.startswith(f"{name}.") for member in seen)}
    assert groups == set(writers.GROUPS.values())


def test_each_writer_writes() -> None:
    assert writers.check(ROOT) == []
    writes = writers.Writes(ROOT)
    for member, owners in writers.WRITERS.items():
        found = {file for source in writes.texts for _, to in writes.of(source, member) for file in (source, to)}
        assert all(any(path.startswith(owner) for path in found) for owner in owners), member
    assert all(list(writes.whole(owner, group)) for group, owners in writers.AT_ONCE.items() for owner in owners)
