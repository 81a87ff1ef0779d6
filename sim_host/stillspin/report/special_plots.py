"""Drawings that are no panels over time: trajectories, spectra, gate signals, sweeps."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure as Canvas
from matplotlib.ticker import ScalarFormatter

from stillspin.cases.scenario import Scenario
from stillspin.core import Signals
from stillspin.measure import bound, deviation_sweep, flux_metrics, metrics, pieces, ripple, speed_profile, waveforms
from stillspin.measure.pieces import Extras
from stillspin.report.canvas import subplots
from stillspin.report.style import COLOURS, RUN_COLOURS, WIDTH

_DASHED = (0, (4, 2))
_MAPPED = (0.2, 30.0)  # ° el., the ends of a map's colours
_RIPPLE_END = 42e3  # Hz, of its drawing


@dataclass(frozen=True)
class Shown:
    """What is drawn: records by run, cut to the plot's window, and what else is known of the runs."""

    scenario: Scenario
    records: Mapping[str, Signals]
    extras: Mapping[str, Extras]

    def title(self, name: str) -> str:
        """The run in words."""
        return self.scenario.run(name).title or name

    def looked(self) -> dict[str, Extras]:
        """The runs that were looked into."""
        known = {name: self.extras[name] for name in self.records if name in self.extras}
        return {name: extras for name, extras in known.items() if extras.waveform}


def trajectories(shown: Shown) -> Canvas:
    """The current vector's path in the stationary frame, one square per run, all to the same scale."""
    count = max(1, len(shown.records))
    canvas, grid = subplots(1, count, squeeze=False, figsize=(WIDTH, WIDTH / 2.3))
    paths = {name: metrics.current_vector(signals) for name, signals in shown.records.items()}
    limit = 1.08 * max((float(np.max(np.hypot(*path))) for path in paths.values()), default=1.0)
    for axes, (name, (alpha, beta)) in zip(_flat(grid), paths.items(), strict=False):
        axes.plot(alpha, beta, color=COLOURS["true"], linewidth=0.6)
        mean = float(np.mean(np.hypot(alpha, beta)))
        turn = np.linspace(0.0, 2.0 * np.pi, 200)
        axes.plot(
            mean * np.cos(turn), mean * np.sin(turn), color=COLOURS["reference"], linestyle=_DASHED, linewidth=0.9
        )
        axes.set(xlabel="$i_α$ (A)", ylabel="$i_β$ (A)", title=shown.title(name), aspect="equal")
        axes.set_xlim(-limit, limit)
        axes.set_ylim(-limit, limit)
    return canvas


def _flat(grid: Any) -> list[Axes]:
    return list(grid.ravel())


def sweeps(shown: Shown) -> Canvas:
    """The q-axis current deviation over the angle error, faint: with the drops; dashed: derived from the machine."""
    canvas, axes = subplots(figsize=(WIDTH, WIDTH / 2.2))
    for number, (name, signals) in enumerate(shown.records.items()):
        colour = RUN_COLOURS[number % len(RUN_COLOURS)]
        machine = shown.extras.get(name, pieces.NOTHING_ELSE).machine
        try:
            found = deviation_sweep.sweep(metrics.position_error(signals), signals, machine)
        except ValueError:
            continue
        axes.plot(found.error, found.deviation, "o", markersize=3.5, color=colour, label=shown.title(name))
        axes.plot(found.error, found.raw, ".", markersize=4.0, color=colour, alpha=0.35)
        axes.plot(found.error, found.sine, color=colour, linewidth=0.9)
        if found.derived.size:
            axes.plot(found.error, found.derived, color=colour, linestyle=_DASHED, linewidth=0.9)
    axes.axhline(0.0, color="#888888", linewidth=0.8, zorder=1)
    axes.axvline(0.0, color="#888888", linewidth=0.8, zorder=1)
    axes.set(xlabel="position error (° el)", ylabel="q-axis current deviation (A/s)")
    axes.set_xticks(np.arange(-90.0, 91.0, 30.0))
    _legend(axes)
    return canvas


def spectra(shown: Shown) -> Canvas:
    """Phase current up to 50 kHz in percent of its fundamental, and three electrical periods of it beside."""
    looked = shown.looked()
    rows = max(1, len(looked))
    canvas, grid = subplots(rows, 2, squeeze=False, figsize=(WIDTH, 2.3 * rows), sharey="col", width_ratios=[1.0, 1.6])
    for (left, right), (name, extras) in zip(grid, looked.items(), strict=False):
        raster = extras.waveform["raster"]
        left.set(ylabel="$i_a$ (A)", title=shown.title(name))
        right.set(ylabel="% of the fundamental", title="spectrum, mean of the three phases")
        try:
            found = waveforms.spectrum(raster)
        except ValueError:
            continue
        period = 1.0 / found.frequency[found.fundamental]
        time = raster["time"] - raster["time"][0]
        early = time < 2.0 * period
        left.plot(1e3 * time[early][::2], raster["i_a"][early][::2], color=COLOURS["a"], linewidth=0.6)
        inside = found.frequency <= waveforms.HIGHEST
        share = 100.0 * np.sqrt(found.power[inside] / np.max(found.power))
        right.semilogy(1e-3 * found.frequency[inside], share, color=COLOURS["true"], linewidth=0.5)
        right.set_ylim(1e-3, 150.0)
    for axes, word in zip(grid[-1], ("time (ms)", "frequency (kHz)"), strict=True):
        axes.set_xlabel(word)
    return canvas


def gates(shown: Shown) -> Canvas:
    """One period between the vectors 110 and 010: gate signals, switching states, phase current and its samples."""
    looked = shown.looked()
    columns = max(1, len(looked))
    canvas, grid = subplots(2, columns, squeeze=False, figsize=(WIDTH, 4.2), sharex=True, height_ratios=[1.0, 1.6])
    for column, (name, extras) in enumerate(looked.items()):
        pattern = waveforms.sector_two(extras.waveform)
        grid[0, column].set_title(shown.title(name))
        if pattern is not None:
            _current(grid[0, column], extras, pattern)
            _gate_signals(grid[1, column], extras, pattern)
    return canvas


def _current(axes: Axes, extras: Extras, pattern: waveforms.Pattern) -> None:
    window = (pattern.start * 1e-8, (pattern.start + waveforms.PERIOD) * 1e-8)
    part = waveforms.cut(extras.waveform, window)
    time = 1e6 * (part["raster"]["time"] - window[0])
    axes.plot(time, part["raster"]["i_a"], color=COLOURS["a"])
    at = 1e6 * (part["samples"]["time"] - window[0])
    axes.plot(at, np.interp(at, time, part["raster"]["i_a"]), "|", markersize=9, color=COLOURS["error"])
    axes.set_ylabel("$i_a$ (A), samples")


def _gate_signals(axes: Axes, extras: Extras, pattern: waveforms.Pattern) -> None:
    for leg, word in enumerate("abc"):
        for offset, pin in ((0.45, "upper"), (0.0, "lower")):
            edges = extras.waveform["edges"]
            mine = edges["leg"] == leg
            time = 1e6 * edges["time"][mine] - 1e-2 * pattern.start
            level = edges[pin][mine]
            before = np.searchsorted(time, 0.0, side="right") - 1
            inside = (time > 0.0) & (time < 100.0)
            steps = np.concatenate([[0.0], time[inside], [100.0]])
            values = np.concatenate(
                [[level[max(0, before)]], level[inside], [level[inside][-1] if inside.any() else 0]]
            )
            base = 2.0 - leg + offset
            axes.step(steps, base + 0.36 * values, where="post", color=COLOURS[word], linewidth=1.2)
    for state, first, last in pattern.states:
        axes.axvspan(first / 100.0, last / 100.0, color="#e8eef5" if state in {"000", "111"} else "#fdf1e2", zorder=0)
        if last - first > 500:
            axes.text((first + last) / 200.0, 2.98, state, ha="center", va="bottom", fontsize=8.5)
    axes.set(xlabel="time in the period (µs)", yticks=[0.4, 1.4, 2.4], ylim=(-0.1, 3.25), xlim=(0.0, 100.0))
    axes.set_yticklabels(["c", "b", "a"])
    axes.set_ylabel("upper, lower gate")
    axes.grid(visible=False)


def ripples(shown: Shown) -> Canvas:
    """Twelve periods of a phase current about its mean, and the spectrum of the ripple beside; shaded: audible."""
    looked = shown.looked()
    rows = max(1, len(looked))
    canvas, grid = subplots(rows, 2, squeeze=False, figsize=(WIDTH, 1.7 * rows), sharex="col", sharey="col")
    for (left, right), (name, extras) in zip(grid, looked.items(), strict=False):
        raster = extras.waveform["raster"]
        time = raster["time"] - raster["time"][0]
        early = time < 12.0 * ripple.PERIOD
        left.plot(1e3 * time[early], raster["i_a"][early] - np.mean(raster["i_a"][early]), color=COLOURS["a"])
        left.set(ylabel="$i_a$ − mean (A)", title=shown.title(name))
        frequency, squares = ripple.spectrum(raster)
        inside = (frequency > ripple.LOWEST) & (frequency < _RIPPLE_END)
        right.semilogy(1e-3 * frequency[inside], np.sqrt(squares[inside] / 3.0), color=COLOURS["true"], linewidth=0.5)
        right.axvspan(0.0, 1e-3 * ripple.AUDIBLE, color="#fdf1e2", zorder=0)
        right.set(ylabel="A rms per line", ylim=(1e-4, 1.0), xlim=(0.0, 1e-3 * _RIPPLE_END))
    grid[-1, 0].set_xlabel("time (ms)")
    grid[-1, 1].set_xlabel("frequency (kHz)")
    return canvas


def errors_over_speed(shown: Shown) -> Canvas:
    """Position error over the speed command while held: peak, rms dashed; a cross where the shaft did not follow.

    Below them the Cramér-Rao bound of the rms error, from the windows of the scenario's first run.
    """
    canvas, axes = subplots(figsize=(WIDTH, WIDTH / 2.4))
    for number, (name, signals) in enumerate(shown.records.items()):
        colour = RUN_COLOURS[number % len(RUN_COLOURS)]
        holds = speed_profile.holds(signals, metrics.position_error(signals))
        speed = [hold.reference for hold in holds]
        axes.plot(speed, [hold.peak for hold in holds], "o-", markersize=3.5, color=colour, label=shown.title(name))
        axes.plot(speed, [hold.rms for hold in holds], linestyle=_DASHED, color=colour, linewidth=0.9)
        lost = [hold for hold in holds if not hold.followed]
        axes.plot(
            [hold.reference for hold in lost], [hold.peak for hold in lost], "x", color=COLOURS["error"], zorder=4
        )
    _bound(axes, shown)
    axes.set_xscale("symlog", linthresh=10.0, linscale=0.5)
    axes.set_xticks([0, 5, 10, 30, 60, 100, 300, 600, 1000, 3000])
    axes.get_xaxis().set_major_formatter(ScalarFormatter())
    axes.set(xlabel="speed command (rpm)", ylabel="position error (° el): peak; dashed rms")
    if axes.dataLim.height > 0.0:  # an empty drawing has no logarithms
        axes.set_yscale("log")
    if len(axes.get_legend_handles_labels()[1]) > 0:
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)  # the lines leave no room inside
    return canvas


def _bound(axes: Axes, shown: Shown) -> None:
    for name, signals in list(shown.records.items())[:1]:
        extras = shown.extras.get(name, pieces.NOTHING_ELSE)
        try:
            least = bound.angle_bound(signals, bound.Expected.of(extras.machine, extras.observer))
        except ValueError:
            continue
        holds = speed_profile.holds(signals, least)
        axes.plot(
            [hold.reference for hold in holds],
            [hold.rms for hold in holds],
            "k-",
            linewidth=1.4,
            label="least rms: Cramér-Rao bound",
        )


def flux_limits(shown: Shown) -> Canvas:
    """Stator flux over the current: of the firmware's references, and the limit up to which (27) has a root."""
    canvas, axes = subplots(figsize=(WIDTH, WIDTH / 2.4))
    for number, (name, signals) in enumerate(shown.records.items()):
        extras = shown.extras.get(name, pieces.NOTHING_ELSE)
        if not extras.machine:
            continue
        piece = pieces.Piece(signals, np.zeros(0), 0.0, 0.0, extras)
        current, flux, limit = flux_metrics.limit_flux(piece)
        order = np.argsort(current)
        if number == 0:
            axes.plot(current[order], limit[order], "k-", label="limit (23)")
        axes.plot(
            current, flux, ".", markersize=2.0, color=RUN_COLOURS[number % len(RUN_COLOURS)], label=shown.title(name)
        )
    axes.set(xlabel="current (A)", ylabel="stator flux (Vs)")
    _legend(axes)
    return canvas


def load_angles(shown: Shown) -> Canvas:
    """The load angle over the current: estimated, and dashed the true one; a colour for each run."""
    canvas, axes = subplots(figsize=(WIDTH, WIDTH / 2.2))
    for number, (name, signals) in enumerate(shown.records.items()):
        colour = RUN_COLOURS[number % len(RUN_COLOURS)]
        current = np.hypot(pieces.as_floats(signals["true_i_d"]), pieces.as_floats(signals["true_i_q"]))
        order = np.argsort(current)
        for of, line in (("load_angle", "-"), ("true_load_angle", "--")):
            angle = pieces.wrap_degrees(pieces.as_floats(signals[of]))
            label = shown.title(name) if of == "load_angle" else None
            axes.plot(current[order], angle[order], line, linewidth=0.9, color=colour, label=label)
    axes.set(xlabel="current (A)", ylabel="load angle (° el)")
    _legend(axes)
    return canvas


def error_maps(shown: Shown) -> Canvas:
    """Peak position error while a speed is held, a row per speed and a column per run; empty: not held."""
    found = {
        name: speed_profile.holds(signals, metrics.position_error(signals)) for name, signals in shown.records.items()
    }
    speeds = sorted({hold.reference for held in found.values() for hold in held})
    peaks = np.full((len(speeds), max(1, len(found))), np.nan)
    for column, held in enumerate(found.values()):
        for hold in held:
            if hold.followed:
                peaks[speeds.index(hold.reference), column] = hold.peak
    canvas, axes = subplots(figsize=(WIDTH, 1.6 + 0.42 * len(speeds)))
    if not speeds:
        return canvas
    shade = np.clip(peaks, *_MAPPED)
    image = axes.imshow(shade, norm=LogNorm(*_MAPPED), cmap="YlOrRd", aspect="auto", origin="lower")
    for (row, column), peak in np.ndenumerate(peaks):
        axes.text(column, row, "–" if np.isnan(peak) else f"{peak:.1f}", ha="center", va="center", fontsize=7)
    axes.set_yticks(range(len(speeds)), [f"{speed:g}" for speed in speeds])
    axes.set_xticks(range(len(found)), [shown.title(name) for name in found], rotation=60, ha="right", fontsize=7.5)
    axes.set_ylabel("speed (rpm)")
    axes.grid(visible=False)
    canvas.colorbar(image, label="position error, peak (° el)")
    return canvas


def _legend(axes: Axes) -> None:
    if len(axes.get_legend_handles_labels()[1]) > 0:
        axes.legend(loc="best")


SPECIAL: dict[str, Callable[[Shown], Canvas]] = {
    "trajectory": trajectories,
    "deviation_sweep": sweeps,
    "spectrum": spectra,
    "ripple": ripples,
    "gates": gates,
    "error_over_speed": errors_over_speed,
    "flux_limit": flux_limits,
    "load_angles": load_angles,
    "error_map": error_maps,
}
"""Panels that fill a drawing of their own."""
