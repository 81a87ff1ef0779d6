"""What captures and logs have in common: signals over time, with units, as tables of other tools."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from stillspin import tabular

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


@dataclass(frozen=True)
class Recording:
    """Signals over time; all arrays have one element per record."""

    time: npt.NDArray[np.float64]
    """Seconds."""
    signals: Mapping[str, npt.NDArray[np.float64]]
    """In users' units, by name; NaN where the drive did not know."""
    units: Mapping[str, str]
    """Of the signals, by name; empty where a signal has none."""

    @property
    def about(self) -> dict[str, Any]:
        """What is known beside the values, for tables and files."""
        return {}

    def table(self) -> Any:
        """A `pyarrow.Table` with the columns `time` and the signals.

        The metadata of each field has its `unit`, those of the schema have `about` as JSON under `stillspin`.

        Raises:
            InputError: pyarrow is not installed; says how to get it.
        """
        return tabular.arrow({"time": self.time, **self.signals}, {"time": "s", **self.units}, self.about)

    def frame(self) -> Any:
        """A `pandas.DataFrame` with the columns `time` and the signals; `attrs` has `units` and `about`.

        Raises:
            InputError: pandas is not installed; says how to get it.
        """
        return tabular.frame({"time": self.time, **self.signals}, {"time": "s", **self.units}, self.about)
