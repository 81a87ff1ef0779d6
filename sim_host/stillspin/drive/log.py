"""A stretch of the slow stream, kept."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

from stillspin.drive.recording import Recording
from stillspin.drive.stream import Sample, Stream
from stillspin.errors import InputError

_WAIT = 0.1


@dataclass(frozen=True)
class Log(Recording):
    """Signals as the stream brought them; `time` counts from when the drive was switched on."""

    lost: int
    """Samples that did not arrive."""
    version: str  # of the firmware, with board, build and table
    """Of the firmware."""

    @property
    def about(self) -> dict[str, Any]:
        """Firmware, and how many samples are missing."""
        return {"firmware": self.version, "lost": self.lost}


def keep(stream: Stream, duration: float, version: str) -> Log:
    """The samples of so many seconds.

    Args:
        stream: open.
        duration: s of this computer's clock.
        version: of the firmware, with board, build and table.

    Raises:
        InputError: a duration that is not above 0.
        LinkError: the way to the drive is lost.
    """
    if not duration > 0:
        raise InputError(f"duration of a log: must be above 0 s, not {duration:g} s")
    samples: list[Sample] = []
    end = time.monotonic() + duration
    while time.monotonic() < end:
        sample = stream.next(_WAIT)
        if sample is not None:
            samples.append(sample)
    import numpy as np  # noqa: PLC0415 - takes long to load, and not all need it

    values = np.array([sample.values for sample in samples], dtype=np.float64).reshape(-1, len(stream.signals))
    times = np.array([sample.time for sample in samples], dtype=np.float64)
    signals = {signal.name: values[:, at] for at, signal in enumerate(stream.signals)}
    units = {signal.name: signal.unit for signal in stream.signals}
    return Log(times, signals, units, stream.lost, version)
