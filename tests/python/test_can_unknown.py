"""What the drive does not know is 0 on the CAN bus, and said to be unknown."""

import pytest

from stillspin import can, core

PLANT = {"solver": {"method": "rk4"}, "adc": {"noise": 2.0}}
PERIODS = {"can_status_period": 2.0, "can_telemetry_period": 2.0}


class Listener:
    """A board and its bus.

    Attributes:
        told: of each TELEMETRY_1, with the STATUS before and behind it where both say the same of state and flag.
        sensed: what a current sensor read, every millisecond.
    """

    def __init__(self, board) -> None:
        self.board, self.bus = board, can.database()
        self.told, self.sensed = [], []
        self.before, self.between = None, []

    def listen(self, milliseconds: int) -> None:
        for _ in range(milliseconds):
            self.board.advance(100_000)
            self.sensed.append(self.board.signals()["current_a"])
            for _, identifier, *_, data in self.board.can_read():
                if identifier == 0x201:
                    self.between.append(self.bus.decode_message(identifier, data))
                if identifier == 0x181:
                    self.pair(self.bus.decode_message(identifier, data))

    def pair(self, behind) -> None:
        if self.before and all(self.before[name] == behind[name] for name in ("STATE", "SPEED_KNOWN")):
            self.told += [{**self.before, **values} for values in self.between]
        self.before, self.between = behind, []


def test_what_is_unknown_is_0_but_the_currents_of_a_start():
    """Without an angle there is no d and no q of what sensors read. The start's test pulses are some amperes."""
    board = core.load().VirtualBoard(plant=PLANT, parameters=PERIODS, seed=1)
    listener = Listener(board)
    try:
        board.can_open(500_000)
        listener.listen(300)
        at_rest = set(listener.sensed)
        board.serial_write(b"ref 300\rstart free\r")
        listener.listen(800)
        board.serial_write(b"coast\r")
        listener.listen(100)
    finally:
        board.close()
    unknown = [row for row in listener.told if not row["SPEED_KNOWN"]]
    start = [row for row in unknown if str(row["STATE"]) == "start"]
    rest = [row for row in unknown if str(row["STATE"]) != "start"]
    run = [row for row in listener.told if row["SPEED_KNOWN"]]
    assert min(map(len, (start, rest, run, at_rest))) > 20
    assert {row[name] for row in unknown for name in ("SPEED", "LOAD_TORQUE")} == {0}
    assert {row[name] for row in rest for name in ("CURRENT_D", "CURRENT_Q")} == {0}
    assert max(abs(row["CURRENT_Q"]) for row in start) > 1.0
    assert max(row["SPEED"] for row in run) == pytest.approx(300.0, abs=15.0)
    assert any(row["CURRENT_D"] for row in run) and any(row["CURRENT_Q"] for row in run)
