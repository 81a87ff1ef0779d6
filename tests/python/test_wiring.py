"""The wiring guide says the pins, addresses and rates that the firmware has."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
GUIDE = (ROOT / "docs" / "wiring.md").read_text(encoding="utf-8")
GATES = 6


def source(path: str) -> str:
    return (ROOT / path).read_text(encoding="utf-8")


def pins_of_the_firmware() -> dict[str, int]:
    """Those of the usual board."""
    found = re.findall(r"#define (BOARD_PIN_\w+) (\d+)u", source("hal/boards/bench.h"))
    return {name: int(pin) for name, pin in found}


def pins_of_the_guide() -> dict[str, int]:
    rows = re.findall(r"^\| GPIO(\d+)[^|]*\| `(BOARD_PIN_\w+)` \|", GUIDE, re.MULTILINE)
    return {name: int(pin) for pin, name in rows}


def parameter(name: str) -> list[int]:
    """Smallest, largest and default value in the units of its decimals."""
    lists = sorted((ROOT / "firmware").rglob("parameter_list.h"))
    rows = "".join(path.read_text(encoding="utf-8") for path in lists)
    row = re.search(rf"PARAMETER\(\d+, {name}, ([^)]*)", rows)
    assert row
    fields = [field.strip() for field in row[1].split(",")]
    return [int(field) for field in fields[3:6]]


def test_every_pin_is_the_firmware_s() -> None:
    assert len(pins_of_the_firmware()) >= 13
    assert pins_of_the_guide() == pins_of_the_firmware()


def test_the_gates_are_six_in_a_row() -> None:
    assert f"#define BOARD_GATE_PINS {GATES}u" in source("hal/boards/bench.h")
    first = pins_of_the_firmware()["BOARD_PIN_FIRST_GATE"]
    assert f"| GPIO{first} … GPIO{first + GATES - 1} |" in GUIDE


def test_no_pin_has_two_wires() -> None:
    pins = pins_of_the_firmware()
    gates = set(range(pins["BOARD_PIN_FIRST_GATE"], pins["BOARD_PIN_FIRST_GATE"] + GATES))
    others = [pin for name, pin in pins.items() if name != "BOARD_PIN_FIRST_GATE"]
    assert len(set(others)) == len(others)
    assert not gates & set(others)


def test_what_is_measured_where() -> None:
    """The guide names both halves of the pairs in the board's file."""
    pairs = dict(re.findall(r"#define BOARD_ADC_(\w+) (\d)u", source("hal/boards/bench.h")))
    names = {
        "A" + pairs["CURRENTS"]: "current of phase a",
        "B" + pairs["CURRENTS"]: "current of phase b",
        "A" + pairs["SLOW"]: "DC link",
        "B" + pairs["SLOW"]: "heat sink's temperature",
        "A" + pairs["SPEED"]: "DC link once more",
        "B" + pairs["SPEED"]: "speed command",
        "A" + pairs["REFERENCE"]: "ground",
        "B" + pairs["REFERENCE"]: "reference of 1.5 V",
    }
    assert dict(re.findall(r"^\| ADCIN(\w\d) \| ([^|]*) \|", GUIDE, re.MULTILINE)) == names


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("baud_rate", "{2} Bd, 8N1\n(`baud_rate` up to {1}"),
        ("can_node", "The drive is node {2} at"),
        ("can_rate", "at {2} kbit/s (`can_node`,\n`can_rate`)"),
    ],
)
def test_rates_are_the_defaults(name: str, words: str) -> None:
    assert words.format(*parameter(name)) in GUIDE


def test_the_memory_is_the_driver_s() -> None:
    driver = source("hal/f2808/eeprom.c")
    device = re.search(r"with a (\w+) at address (0x[0-9A-F]+)", driver)
    assert device
    assert f"{device[1]} or an equal" in GUIDE
    assert f"(address {device[2]})" in GUIDE
    clocks = re.search(r"Module clock (\d+) MHz; (\d+) clocks low and (\d+) high", source("hal/f2808/i2c.c"))
    assert clocks
    rate = int(clocks[1]) * 1000 // (int(clocks[2]) + int(clocks[3]))
    assert f"runs at {rate} kHz" in GUIDE


def test_boot_pins_that_the_drive_uses_are_named() -> None:
    """GPIO18, 29 and 34 choose where the boot ROM goes."""
    used = {pin for pin in pins_of_the_firmware().values() if pin in {18, 29, 34}}
    assert used == {29, 34}
    for pin in used:
        assert re.search(rf"^\| GPIO{pin} \|.*high at reset", GUIDE, re.MULTILINE)
    assert "reads GPIO18, GPIO29 and GPIO34" in GUIDE
