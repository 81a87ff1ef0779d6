"""The current gains that the stator-flux paper prints, in the sampled loop: what docs/papers.md says of them."""

import math
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
R, STEP = 0.175, 200e-6
AXES = {"d": (0.76e-3, 4.775), "q": (1.63e-3, 10.116)}
INTEGRAL = 1099.6


def largest_eigenvalue(axis: str, delay: float, share: float = 1.0) -> float:
    """Of i, the voltage that is held and the integral; `share` of the printed gains, the voltage `delay` s late."""
    inductance, proportional = AXES[axis]
    kp, ki = share * proportional, share * INTEGRAL * STEP
    keeps = math.exp(-R * STEP / inductance)
    new = (1.0 - math.exp(-R * (STEP - delay) / inductance)) / R
    old = (1.0 - keeps) / R - new
    loop = np.array([[keeps - new * (kp + ki), old, new], [-(kp + ki), 0.0, 1.0], [-ki, 0.0, 1.0]])
    return float(np.max(np.abs(np.linalg.eigvals(loop))))


def stable_up_to(axis: str, delay: float) -> float:
    """The share of the gains at which the loop begins to grow."""
    low, high = 0.1, 4.0
    for _ in range(50):
        middle = (low + high) / 2.0
        low, high = (middle, high) if largest_eigenvalue(axis, delay, middle) < 1.0 else (low, middle)
    return low


def test_the_printed_gains_are_those_of_one_bandwidth() -> None:
    for axis, within in (("d", 1e-4), ("q", 0.013)):
        inductance, proportional = AXES[axis]
        assert 2000.0 * math.pi * inductance == pytest.approx(proportional, rel=within)
    assert 2000.0 * math.pi * R == pytest.approx(INTEGRAL, rel=1e-4)


@pytest.mark.parametrize("delay", [200e-6, 150e-6, 100e-6])
def test_the_book_says_where_they_are_stable(delay: float) -> None:
    page = (ROOT / "docs/papers.md").read_text(encoding="utf-8")
    row = next(line for line in page.splitlines() if line.startswith("|") and f"{delay * 1e6:.0f} µs" in line)
    _, values, limits = (cell.strip() for cell in row.strip("|").split("|"))
    found = [largest_eigenvalue(axis, delay) for axis in AXES]
    shares = [stable_up_to(axis, delay) for axis in AXES]
    assert [float(word) for word in values.split(";")] == pytest.approx(found, abs=0.006)
    assert [float(word) for word in limits.split(" of ")[0].split(";")] == pytest.approx(shares, rel=0.03)


def test_the_speed_gains_are_the_schemes() -> None:
    """1.539 and 0.138 as A s/rad and that in each step of 1 ms, on the inertia of the motor's file."""
    per_amp = 1.5 * 4 * 0.0865 * 1e-3 / 2e-3  # rad/s in a step
    text = (ROOT / "sim_host/schemes/paper_flux.toml").read_text(encoding="utf-8")
    told = dict(line.split(" = ") for line in text.split("[parameters]")[1].strip().splitlines())
    step, damping = float(told["speed_pi_bandwidth"]) * 1e-3, float(told["speed_pi_damping"])
    assert 2.0 * damping * step / per_amp == pytest.approx(1.539, rel=0.01)
    assert step**2 / per_amp == pytest.approx(0.138, rel=0.01)
