#!/usr/bin/env python3
"""What the boards' files say, as the tables of docs/board.md.

Usage: toolchain/board_table.py [--write]

Prints the tables, or puts them between the two marks in docs/board.md. Scalings are recalculated here as the firmware
calculates them (firmware/config/config.c, firmware/board/derating.c), so that the rounding errors stand beside them.
"""

import math
import re
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/board.md"
BEGIN, END = "<!-- boards: toolchain/board_table.py --write -->\n", "<!-- end of boards -->\n"
ROW = re.compile(r"^#define (BOARD_\w+) +(.+?)(?: +// (.*))?$")
FROM_HERE_TO_THERE = (-20, 120)  # degrees Celsius over which the NTC's error is looked at
KELVIN = 273.15


@dataclass(frozen=True)
class Board:
    """One file of hal/boards/: texts of the macros and what is said of each, under the headings of the file."""

    name: str
    values: dict[str, str]
    notes: dict[str, str]
    groups: dict[str, list[str]]

    def number(self, macro: str) -> int:
        """The value of a macro that is a number."""
        return int(self.values[f"BOARD_{macro}"].strip("()u"))

    def numbers(self, macro: str) -> list[int]:
        """The values of a macro that is a list."""
        return [int(part) for part in self.values[f"BOARD_{macro}"].strip("{}").split(",")]


def read(path: Path) -> Board:
    """The board of one file."""
    values: dict[str, str] = {}
    notes: dict[str, str] = {}
    groups: dict[str, list[str]] = {}
    for line in path.read_text(encoding="utf-8").replace("\\\n", " ").splitlines():
        if line.startswith("// ---- "):
            groups[line.removeprefix("// ---- ")] = []
        match = ROW.match(line)
        if match:
            values[match[1]] = " ".join(match[2].split())
            notes[match[1]] = match[3] or ""
            if groups:
                list(groups.values())[-1].append(match[1])
    return Board(path.stem, values, notes, groups)


def boards(root: Path = ROOT) -> list[Board]:
    """All boards, by name."""
    return [read(path) for path in sorted((root / "hal/boards").glob("*.h"))]


def ntc_code(board: Board, celsius: float) -> float:
    """Code of the converter at a temperature."""
    r25, beta, pull_up = (board.number(f"NTC_{name}") for name in ("R25", "BETA", "PULL_UP"))
    ohms = r25 * math.exp(beta * (1 / (celsius + KELVIN) - 1 / (25 + KELVIN)))
    return 4096 * ohms / (ohms + pull_up)


def ntc_celsius(board: Board, code: float) -> float:
    """What the firmware makes of a code: straight lines between the table's points."""
    codes = board.numbers("NTC_CODES")
    first, step = board.number("NTC_FIRST"), board.number("NTC_STEP")
    k = next((n for n in range(1, len(codes)) if code >= codes[n]), len(codes) - 1)
    return first + step * (k - 1 + (codes[k - 1] - code) / (codes[k - 1] - codes[k]))


def ntc_error(board: Board) -> float:
    """Largest error of those lines, K."""
    low, high = FROM_HERE_TO_THERE
    return max(abs(ntc_celsius(board, ntc_code(board, t / 4)) - t / 4) for t in range(4 * low, 4 * high + 1))


@dataclass(frozen=True)
class Scaling:
    """A constant of the firmware beside what it should be."""

    what: str
    constant: str
    fraction_bits: int
    exact: float
    raw: int

    @property
    def error_ppm(self) -> float:
        """Relative rounding error."""
        return (self.raw / 2**self.fraction_bits / self.exact - 1) * 1e6


def nearest(value: float) -> int:
    """Rounded as the firmware rounds: halves up."""
    return math.floor(value + 0.5)


def scalings(board: Board) -> list[Scaling]:
    """The board's analogue scalings as firmware/config/config.c makes them of the parameters' defaults."""
    amps, volts = board.number("CURRENT_RANGE") / 100, board.number("LINK_RANGE") / 10
    amps_q20, volts_q16 = nearest(amps * 2**20), nearest(volts * 2**16)
    per_code_q30 = nearest(amps_q20 / 2)
    return [
        Scaling("current, A per code", "amps_per_code_q30", 30, amps / 2048, per_code_q30),
        Scaling("current, codes per A", "codes_per_amp_q16", 16, 2048 / amps, nearest(2**46 / per_code_q30)),
        Scaling("DC link, V per code", "volts_per_code_q16", 16, volts / 4096, nearest(volts_q16 / 4096)),
    ]


def tables(root: Path = ROOT) -> str:
    """The tables in Markdown."""
    known = boards(root)
    names = " | ".join(f"`{board.name}`" for board in known)
    out = [f"| in the file | {names} | meaning |", "| --- |" + " --- |" * (len(known) + 1)]
    for group, macros in known[0].groups.items():
        out.append(f"| **{group.partition(':')[0].rstrip('.')}** |" + " |" * (len(known) + 1))
        for macro in macros:
            cells = " | ".join(board.values[macro].rstrip("u").strip("{}") for board in known)
            notes = {board.notes[macro] for board in known}
            out.append(f"| `{macro}` | {cells} | {' / '.join(sorted(notes))} |")
    out += ["", "| scaling | constant | " + " | ".join(f"`{b.name}`: value | rounding" for b in known) + " |"]
    out.append("| --- | --- |" + " --- | --- |" * len(known))
    for rows in zip(*(scalings(board) for board in known), strict=True):
        cells = " | ".join(f"{row.raw} | {row.error_ppm:+.2f} ppm" for row in rows)
        out.append(f"| {rows[0].what} | `{rows[0].constant}` | {cells} |")
    cells = " | ".join(f"{board.number('NTC_POINTS')} points | {ntc_error(board):.1f} K at most" for board in known)
    out.append(f"| heat sink, −20 to 120 °C | `BOARD_NTC_CODES` | {cells} |")
    return "\n".join(out) + "\n"


def main() -> None:
    """Print or write."""
    if sys.argv[1:] == ["--write"]:
        before, _, rest = PAGE.read_text(encoding="utf-8").partition(BEGIN)
        PAGE.write_text(before + BEGIN + tables() + END + rest.partition(END)[2], encoding="utf-8")
    else:
        print(tables(), end="")


if __name__ == "__main__":
    main()
