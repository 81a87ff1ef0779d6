#!/usr/bin/env python3
"""The arithmetic's and estimators' vectors on several processors, against a model in Python's integers.

Usage: toolchain/vectors.py OUT [--defects]     (make vectors)

tests/vectors makes cases by a generator with a fixed seed and hashes the results: on this computer, on an ATmega1284P
(avr-gcc and simavr: an int of 16 bits on a real machine), on a Cortex-M3 and an M4 (QEMU). toolchain/presets.json has a
preset for each. Each has to print what tests/vectors/model.py finds from the functions' definitions. With --defects,
every defect of DEFECTS is planted into a copy of the sources and has to be seen where it says.
"""

import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "vectors"))

import model  # noqa: E402
import planted  # noqa: E402

COPIED = (
    *("CMakeLists.txt", "CMakePresets.json", "toolchain", "hal", "control", "estimators", "tests/vectors"),
    *("tests/m3/startup.c", "tests/m3/m3.ld"),
)
MCU = "atmega1284p"
SECONDS = 120
CASES = model.BLOCKS * model.CASES * len(model.Vectors().groups)


@dataclass(frozen=True)
class Target:
    """A processor: the preset that compiles for it, and what runs a program of it."""

    preset: str
    runner: tuple[str, ...]

    def build(self, tree: Path, out: Path) -> Path:
        """The program, made of a tree's sources."""
        place = out / self.preset
        if not place.exists():
            run(["cmake", "--preset", self.preset, "-B", str(place)], tree)
        run(["cmake", "--build", str(place)], tree)
        return place / "tests" / "vectors" / "stillspin_vectors"

    def lines(self, tree: Path, out: Path) -> list[str]:
        """What the program prints; simavr prints it in colour, a point for a line's end, after lines of its own."""
        printed = re.sub(r"\x1b\[[0-9;]*m", "", run([*self.runner, str(self.build(tree, out))], tree))
        lines = (line.removesuffix(".") for line in printed.splitlines())
        return [line for line in lines if line and not line.startswith(("Loaded", "UART"))]


def run(command: list[str], tree: Path) -> str:
    """Its output; an error when it fails."""
    done = subprocess.run(command, cwd=tree, capture_output=True, text=True, check=False, timeout=SECONDS)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(command[:6])} ..: {done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout + done.stderr


def qemu(machine: str) -> tuple[str, ...]:
    """A board in QEMU, with semihosting."""
    quiet = ("-nographic", "-monitor", "none", "-serial", "none")
    return ("qemu-system-arm", "-M", machine, *quiet, "-semihosting-config", "enable=on,target=native", "-kernel")


TARGETS = {
    "this computer": Target("vectors-native", ()),
    "ATmega1284P": Target("avr", ("simavr", "-m", MCU, "-f", "20000000")),
    "Cortex-M3": Target("cortex-m3", qemu("mps2-an385")),
    "Cortex-M4": Target("cortex-m4", qemu("mps2-an386")),
}


@dataclass(frozen=True)
class Defect:
    """One change of the sources, which groups of cases see it, and where."""

    file: str
    right: str
    wrong: str
    groups: frozenset[str]
    targets: frozenset[str]


ALL = frozenset(TARGETS)
AVR = frozenset({"ATmega1284P"})
NOT_AVR = ALL - AVR
DEFECTS = (
    Defect("hal/qmath/qarith.h", "q_sat64((int64_t)a + b)", "q_sat64((int32_t)((uint32_t)a + (uint32_t)b))",
           frozenset({"sums"}), ALL),
    Defect("hal/qmath/qarith.h", "q_product(a, b) + ((int64_t)1 << (shift - 1))", "q_product(a, b)",
           frozenset({"products", "quotients", "tracking_observer", "blend"}), ALL),
    Defect("hal/qmath/qtrig.c", "((uint32_t)1 << (SEGMENT_BITS - 1))", "(1u << (SEGMENT_BITS - 1))",
           frozenset({"angles", "frames"}), AVR),
    Defect("hal/qmath/qarith.h", "q_shr((int32_t)a * b + 0x4000L, 15)", "q_shr(a * b + 0x4000L, 15)",
           frozenset({"halves"}), AVR),
    Defect("hal/qmath/qquotient.c", "(rest >= den - rest) ? 1 : 0", "0", frozenset({"quotients"}), ALL),
    Defect("hal/qmath/qsqrt.c", "* inverse_q30) >> 54)", "* inverse_q30) >> 55)", frozenset({"roots"}), ALL),
    Defect("hal/qmath/qsqrt.c", "(rest > root && root != UINT32_MAX)", "((rest >> 16) > (root >> 16))",
           frozenset({"roots"}), ALL),
    Defect("hal/qmath/qtrig.c", "= ANGLE_BAM_QUARTER_TURN - angle;", "= ANGLE_BAM_QUARTER_TURN - angle - 1;",
           frozenset({"angles"}), ALL),
    Defect("control/frame.h", "v.beta, r.cos_q30, -v.alpha,", "v.beta, r.cos_q30, v.alpha,",
           frozenset({"frames"}), ALL),
    Defect("estimators/tracking_observer.c", "q_mul(error_bam, 3 * x2_q30, 30)", "q_mul(error_bam, 2 * x2_q30, 30)",
           frozenset({"tracking_observer"}), ALL),
    Defect("estimators/blend.c", "s->share_q15 + (s->share_q15 >> 14)", "s->share_q15", frozenset({"blend"}), ALL),
)  # fmt: skip


def wrong_groups(name: str, tree: Path, out: Path, wanted: list[str]) -> set[str]:
    """Groups whose lines differ from the model's; all of them where the output is not even of its length."""
    lines = TARGETS[name].lines(tree, out)
    if len(lines) != len(wanted):
        return {line.split()[0] for line in wanted}
    return {right.split()[0] for right, line in zip(wanted, lines, strict=True) if right != line}


def on_all(tree: Path, out: Path, wanted: list[str]) -> dict[str, set[str]]:
    """The wrong groups of every target."""
    with ThreadPoolExecutor(2) as pool:
        return dict(zip(TARGETS, pool.map(lambda name: wrong_groups(name, tree, out, wanted), TARGETS), strict=True))


def missed(defect: Defect, tree: Path, out: Path, wanted: list[str]) -> list[str]:
    """Where a defect that is planted into the copy is not seen as it should be. The copy is as it was again."""
    complaints = planted.change(tree, [(defect.file, defect.right, defect.wrong)])
    if complaints:
        return complaints
    for name, seen in on_all(tree, out, wanted).items():
        expected = defect.groups if name in defect.targets else frozenset()
        if seen != expected:
            complaints.append(f"{name}: {defect.wrong!r} is seen by {sorted(seen)}, not by {sorted(expected)}")
    shutil.copy(ROOT / defect.file, tree / defect.file)  # with a new time, so that it is compiled again
    return complaints


def main() -> int:
    """Runs the vectors everywhere, or plants the defects."""
    out = Path(sys.argv[1]).resolve()
    out.mkdir(parents=True, exist_ok=True)
    wanted = list(model.expected())
    built = out / ("defects" if "--defects" in sys.argv else "programs")
    shutil.rmtree(built, ignore_errors=True)
    if "--defects" in sys.argv:
        tree = out / "tree"
        planted.copy(tree, COPIED)
        complaints = [complaint for defect in DEFECTS for complaint in missed(defect, tree, built, wanted)]
        print(f"vectors: {len(DEFECTS)} defects planted, {len(complaints)} times not seen where they have to be")
    else:
        found = on_all(ROOT, built, wanted)
        complaints = [f"{name}: {', '.join(sorted(groups))} differ" for name, groups in found.items() if groups]
        print(f"vectors: {CASES} cases on {', '.join(TARGETS)}: {'as the model' if not complaints else 'DIFFERENT'}")
    for complaint in complaints:
        print(f"vectors: {complaint}")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
