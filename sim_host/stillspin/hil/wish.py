"""What is to be stepped through, as it is asked for."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from stillspin import core
from stillspin.cases import profile
from stillspin.hil import runs
from stillspin.hil.runs import LoopRun
from stillspin.revision import revision
from stillspin.runs import commission, execute, variant


@dataclass(frozen=True)
class Wish:
    """Runs by their names.

    Attributes:
        scenarios, check: see runs.named.
        only: names of runs, all when empty.
        profile, seed, changes, params, scheme: of the plant and of the drive, as for `stillspin run`.
    """

    scenarios: tuple[str, ...]
    check: bool = False
    only: tuple[str, ...] = ()
    profile: str = "bench"
    seed: int = 1
    changes: tuple[str, ...] = ()
    params: Path | None = None
    scheme: str | None = None

    def runs(self, native: core.NativeCore) -> list[LoopRun]:
        """The runs that are meant.

        Raises:
            InputError: there is no such scenario, profile or parameter.
        """
        schema, known = core.plant_schema(native), core.parameters(native)

        def settings(motor: str) -> execute.Settings:
            chosen = profile.load(self.profile, schema, known, motor)
            if self.params:
                chosen = replace(
                    chosen, parameters={**chosen.parameters, **commission.load(self.params, known, chosen.parameters)}
                )
            if self.scheme:
                chosen = variant.scheme(self.scheme).told(chosen, known)
            changes = profile.changes(self.changes, schema, known, chosen.parameters)
            return execute.Settings(chosen, changes, self.seed, revision())

        found = runs.named(self.scenarios, settings, native, check=self.check)
        return [run for run in found if not self.only or run.name in self.only]
