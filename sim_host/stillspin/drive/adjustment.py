"""A drive whose parameters are read, changed and kept."""

from __future__ import annotations

import struct
import warnings
from collections.abc import Mapping

from stillspin.drive import values
from stillspin.drive.describe import unpack
from stillspin.drive.inspection import Inspection
from stillspin.drive.protocol import Command, Request
from stillspin.drive.values import ConflictWarning
from stillspin.scales import SCALES


class Adjustment(Inspection):
    """Its parameters."""

    def get(self, name: str) -> float:
        """The value of a parameter."""
        parameter = self.table.parameter(name)
        (raw,) = unpack("<i", self._ask(Request.PARAMETER_GET, struct.pack("<H", parameter.id)))
        return parameter.to_user(raw)

    def set(self, name: str, value: float | str) -> float:
        """Change a parameter until the drive is switched off; `save` keeps it.

        Args:
            name: of the parameter.
            value: in its unit; text may have the unit behind the number.

        Returns:
            The value that is in effect. A value that does not go together with the others, so that the drive would
            not start, is taken with a ConflictWarning: the next ones may put it right.

        Raises:
            InputError: no such parameter, no number, or out of range.
            RefusedError: the drive says why not.
        """
        change = self.change(name, value)
        if change.conflict:
            warnings.warn(change.conflict, ConflictWarning, stacklevel=2)
        return change.value

    def change(self, name: str, value: float | str) -> values.Change:
        """As `set`, with the drive's words about a conflict instead of a warning."""
        changed = values.change(self._ask, self.table.parameter(name), value)
        if name in SCALES:
            self._describe()
        return changed

    def set_scales(self, wanted: Mapping[str, float]) -> None:
        """Change the scales, if they are among these values and differ: before all that is then in other steps.

        Raises:
            RefusedError: the drive says why not.
        """
        for name in SCALES:
            if name in wanted and self.get(name) != wanted[name]:
                self.change(name, wanted[name])

    def parameters(self) -> dict[str, float]:
        """The values of all parameters, by name."""
        return {name: self.table.parameter(name).to_user(raw) for name, raw in self.raw_parameters().items()}

    def raw_parameters(self) -> dict[str, int]:
        """All parameters as the drive holds them."""
        return values.read_all(self._ask, self.table)

    def save(self) -> None:
        """Keep the present parameters in the drive's store; returns when they are there.

        Raises:
            DriveError: they are not.
        """
        values.save(self)

    def defaults(self) -> None:
        """Every parameter to its default; not kept until `save`."""
        self._replace(Command.DEFAULTS)

    def load(self) -> None:
        """Every parameter as the store has it."""
        self._replace(Command.LOAD)

    def _replace(self, command: Command) -> None:
        """Change all parameters at once, and with the scales the ranges and formats of the table."""
        here = [name for name in SCALES if self.table.has_parameter(name)]
        before = [self.get(name) for name in here]
        self.command(command)
        if [self.get(name) for name in here] != before:
            self._describe()
