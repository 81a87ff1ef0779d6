"""A virtual board in this process, with a console and what hangs on its plugs."""

import importlib
from typing import Any

MS = 100_000  # ticks
READY, RUN, FAULT, COMMISSION = 2, 4, 6, 7
EMERGENCY, PRECHARGE, TEMPERATURE, OVERLOAD, BRAKE_RESISTOR, GATE_ENABLE, SELF_TEST = range(14, 21)
LINK_HIGH = 4
POWER_UP = 80  # ms to READY, parameters told, and the functions have seen them

Plant = dict[str, dict[str, Any]]


class Desk:
    """A virtual board with a console."""

    def __init__(self, parameters: dict[str, float], plant: Plant | None = None, *, wait: int = POWER_UP) -> None:
        native = importlib.import_module("stillspin._core")
        chosen = {"solver": {"method": "rk4"}, **(plant or {})}
        self.board = native.VirtualBoard(plant=chosen, parameters=parameters, seed=1)
        self.wait(wait)

    def wait(self, ms: float) -> None:
        self.board.advance(round(ms * MS))

    def type(self, line: str, ms: int = 60) -> str:
        """What comes back of a line within some time."""
        self.board.serial_write(line.encode() + b"\r")
        self.wait(ms)
        return str(self.board.serial_read().decode())

    def status(self, title: str) -> str:
        """A line of the command status."""
        lines = self.type("status", 250).splitlines()
        return next(line.removeprefix(title).strip() for line in lines if line.startswith(title))

    def until(self, state: int, ms: int = 2000) -> bool:
        """Whether the drive gets there."""
        for _ in range(ms // 5):
            if self.state == state:
                return True
            self.wait(5)
        return self.state == state

    def run(self, rpm: float) -> None:
        self.type(f"ref {rpm} rpm")
        self.type("start free")
        assert self.until(RUN), self.status("fault")

    @property
    def state(self) -> int:
        return int(self.board.signals()["state"])

    @property
    def fault(self) -> int:
        return int(self.board.signals()["fault"])

    def truth(self, name: str) -> float:
        return float(self.board.truth()[name])

    def mean_current(self) -> float:
        """Torque current without the excitation's ripple, A."""
        seen = []
        for _ in range(100):
            self.wait(0.137)
            seen.append(abs(self.truth("i_q")))
        return sum(seen) / len(seen)

    def output(self, name: str) -> float:
        return float(self.board.outputs()[name])
