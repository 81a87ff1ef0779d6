"""The campaign: what is asked of the drive while its interrupts are counted.

It is directed: every position source, every way to start, both ends of the speed and of the load, the voltage limit
with a link that is too low, a hold, a stop, a reversal, the commissioning, a scope that records. Nothing is drawn at
random: the same runs count the same instructions.
"""

from dataclasses import dataclass

import compose

PAPER = ("position_source=1", "id_low_speed=5", "window_minimum=20", "window_maximum=20", "synchronism_time=1000")
FLUX = {name: (f"position_source={number}",) for number, name in enumerate(("CONV", "PP-01", "PP-02", "active"), 5)}
HYSTERESIS = ("current_law=1", "position_source=0", "hysteresis_frequency=10", "slice_time=5")
SOURCES = {"observer": (), "paper": PAPER, **FLUX, "hysteresis": HYSTERESIS}
"""Of each scheme the parameters that choose it."""
DEFAULT = "observer"
EDITIONS = {"lab": tuple(SOURCES), "drive": (DEFAULT,), "hil": (DEFAULT,), "minimal": (DEFAULT,)}
"""The editions that are counted, and their schemes."""


@dataclass(frozen=True)
class Run:
    """A start and a load step: speed in rpm, load in N m, speed of the shaft at the start in rpm."""

    rpm: int
    load: int
    shaft: int = 0
    more: str = ""  # what else is different
    words: tuple[str, ...] = ()  # parameters, and what else tests/m3/record.cpp knows
    needs: str = ""  # the feature that an edition must have for it

    @property
    def name(self) -> str:
        """Its row."""
        return f"{self.rpm}{self.more and ', '}{self.more}"


HELD = ("hold_time=500",)
MAPPED = ("map_current=14", "lqq_1=97", "lqq_2=94", "lqq_3=90", "lqq_4=85", "ldq_2=0.05", "ldq_4=0.1", "map_known=1")
TURNED = ("start_method=1",)
SCOPED = Run(600, 8, 0, "scope", ("scope=1",), "scope")
BARE, LONGEST = Run(600, 8), Run(1500, 5, 0, "mapped, link of 240 V", (*MAPPED, "link=240"))
"""The scope is no step: it costs what the longest period of a run is longer with it than without."""
# The paper's scheme loses a shaft that it has to bring up from standstill; caught at 600 rpm it holds it. At 80 rpm
# both of its estimators are at work.
RUNS = {
    "observer": (
        *(Run(0, 5), Run(0, 5, 0, "held", HELD), Run(5, 5), Run(60, 5), Run(300, 8), BARE, Run(1200, 5), Run(1500, 5)),
        *(Run(600, 5, 600, "caught"), Run(600, 2, 0, "turned", TURNED), Run(1500, 5, 1500, "caught")),
        *(Run(600, 5, 0, "charged", ("bootstrap_time=15",)), Run(600, 12, 0, "overloaded"), Run(600, -6, 0, "driven")),
        *(Run(600, 5, 0, "reversed", ("then=-600",)), Run(600, 5, 0, "stopped", ("stop=1",))),
        *(Run(1500, 5, 0, "mapped", MAPPED), Run(2000, 5), Run(2000, 3, 0, "link of 240 V", ("link=240",))),
        *(Run(1500, 6, 0, "link of 220 V, stopped", ("link=220", "stop=1")), Run(3000, 1)),
        *(Run(3000, 1, 0, "link of 280 V, to 300", ("link=280", "then=300")), Run(3000, 1, -3000, "turned round")),
        *(LONGEST, SCOPED),
        Run(0, 0, 0, "commissioning", ("commission=1",), "commissioning"),
    ),
    "paper": (Run(0, 0), Run(80, 0, 600), Run(600, 5, 600), Run(1500, 3, 600), Run(2000, 3, 600), Run(3000, 1, 600)),
    # At 425 rpm the observer hands over and both are at work; above the flux is alone.
    **dict.fromkeys(FLUX, (Run(425, 5), Run(1000, 5, 600), Run(2000, 3, 600), Run(3000, 1, 600))),
    "hysteresis": (Run(0, 5), Run(600, 2), Run(1500, 5)),
}


BRIEF = {"hil", "minimal"}
"""Editions of which a few runs are enough: what they run is what another runs, which does more."""


def of(edition: str, scheme: str) -> tuple[Run, ...]:
    """What is asked of a scheme in an edition, of what it can."""
    features = {feature.name for feature in compose.read_edition(edition).features}
    asked = (BARE, LONGEST, SCOPED) if edition in BRIEF else RUNS[scheme]
    return tuple(run for run in asked if not run.needs or run.needs in features)
