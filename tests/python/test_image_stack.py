"""Who calls whom in the image: the stack, calls through a pointer, what an interrupt must not call."""

import sys
from pathlib import Path

import pytest
from stand_in import ROOT, compiled

sys.path.insert(0, str(ROOT / "toolchain"))

from image import hooks, stack
from image.elf import read_object
from image.interrupts import dear_calls
from image.stack import build_graph, stack_depth


@pytest.mark.parametrize(
    ("quotient", "complaints"),
    [
        ("int f(int a, int b) { return a / b; }", []),
        (
            "long long f(long long a, long long b) { return a / b; }",
            ["f, which an interrupt may run, calls __aeabi_ldivmod"],
        ),
        (
            "float f(float a, float b) { return a * b; }",
            ["f, which an interrupt may run, calls __aeabi_fmul"],
        ),
    ],
)
def test_a_dear_function_of_the_library_in_an_interrupt_is_caught(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    quotient: str,
    complaints: list[str],
) -> None:
    """Through a pointer that the table of indirect calls knows."""
    code = f"void control_isr(void);\nvoid window_isr(void);\n__attribute__((noinline)) {quotient}\n"
    code += "void (*hook)(void);\nvoid window_isr(void) { hook(); }\nvoid control_isr(void) {}\n"
    (tmp_path / "calls.txt").write_text("window_isr -> f\n")
    monkeypatch.setattr(stack, "TABLE", tmp_path / "calls.txt")
    assert dear_calls([read_object(compiled(tmp_path, code))]) == complaints


def test_stack_of_modes_that_exclude_each_other(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    code = """
#define KEEP __attribute__((noinline))
void use(volatile int* p);
KEEP void use(volatile int* p) { p[0]++; }
KEEP static void large(void) { volatile int room[50]; use(room); }
KEEP static void small(void) { volatile int room[5]; use(room); }
int (*choice)(void);
void control_isr(void);
void window_isr(void);
void control_isr(void) { large(); }
void window_isr(void) { small(); }
int main(void) { small(); large(); return 0; }
"""
    objects = [read_object(compiled(tmp_path, code))]
    table = tmp_path / "calls.txt"
    monkeypatch.setattr(stack, "TABLE", table)

    def total(lines: str) -> int:
        table.write_text(lines)
        return stack_depth(objects).total

    one, other = "[one]\nlarge is not called\n", "[other]\nsmall is not called\n"
    assert total(one) + 90 <= total(other) < total("")
    assert total(one + other) == total(other)
    table.write_text("[one]\nnobody is not called\n")
    assert "calls.txt: nobody is no function" in stack_depth(objects).complaints
    table.write_text("large is sometimes called\n")
    assert "not understood: large is sometimes called" in "; ".join(stack_depth(objects).complaints)


STATES = """
#include <stddef.h>
#include "firmware/interfaces/state.h"
void by_step(struct drive* d);
void by_begin(struct drive* d, drive_state_t s);
extern const state_t start_state;
"""
LOOP = "int main(void) { drive_states[0]->step(NULL); return 0; }\nvoid control_isr(void);\nvoid window_isr(void);\n"
LOOP += "void control_isr(void) {}\nvoid window_isr(void) {}\n"
OWN = "void by_step(struct drive* d) { (void)d; }\n"
OWN += "void by_begin(struct drive* d, drive_state_t s) { (void)d, (void)s; }\n"


@pytest.mark.parametrize(
    ("calls", "complaints"),
    [
        ("main -> @drive_states.step", []),
        ("main -> @drive_states.stop", ["calls.txt: @drive_states.stop is no table"]),
        ("main -> @drive_status.step", ["calls.txt: @drive_status.step is no table"]),
        # What belongs to a feature that is not linked goes for nothing, what no feature has does not.
        ("main -> @drive_states.step\nhysteresis_step -> hal_tick", []),
        ("main -> @drive_states.step hysteresis_samples", []),
        (
            "main -> @drive_states.step hysteresis_sample",
            ["calls.txt: hysteresis_sample is no function"],
        ),
        ("main -> @drive_states.step\nhil_step is not called", []),
        (
            "main -> @drive_states.step\nhysteresis_stop -> hal_tick",
            ["calls.txt: hysteresis_stop is no function"],
        ),
        # A function of the tree that every edition has is missed.
        (
            "main -> @drive_states.step interlock_refusal",
            ["calls.txt: interlock_refusal is no function"],
        ),
    ],
)
def test_calls_through_a_pointer_follow_the_edition(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, calls: str, complaints: list[str]
) -> None:
    rows = "const state_t start_state = {by_begin, by_step, NULL, NULL};\n"
    tables = "const state_t* const drive_states[] = {&start_state, NULL};\n"
    objects = [read_object(compiled(tmp_path, STATES + own)) for own in (LOOP + OWN, rows, tables)]
    (tmp_path / "calls.txt").write_text(calls + "\n")
    monkeypatch.setattr(stack, "TABLE", tmp_path / "calls.txt")
    assert stack_depth(objects).complaints == complaints
    assert hooks.reached(objects, "drive_states.step") == {"by_step"}
    assert hooks.reached(objects, "drive_states.begin") == {"by_begin"}
    assert hooks.reached(objects, "drive_states.abandon") == set()


def test_stack_sees_frames_recursion_and_pointers(tmp_path: Path) -> None:
    code = """
#define KEEP __attribute__((noinline))
void use(volatile int* p);
void (*hook)(void);
KEEP void use(volatile int* p) { p[0]++; }
KEEP static void deep(void) { volatile int room[50]; use(room); }
KEEP void main_loop(int n);
KEEP void main_loop(int n) { deep(); if (n > 0) main_loop(n - 1); use(&n); }
KEEP static void by_pointer(void) { hook(); volatile int x; use(&x); }
int main(void) { main_loop(3); by_pointer(); return 0; }
"""
    objects = [read_object(compiled(tmp_path, code))]
    graph = build_graph(objects)
    assert graph.frames["deep"] >= 100 and graph.by_pointer == {"by_pointer"}
    complaints = "; ".join(stack_depth(objects).complaints)
    assert "recursion: main_loop > main_loop" in complaints
    assert "by_pointer calls through a pointer" in complaints
