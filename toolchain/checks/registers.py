"""The register map against what is known of the chip: addresses, widths, fields, protection, vectors, values, pins.

``toolchain/f2808/*.csv`` is the chip as public descriptions have it; each row says what it is known from. Every macro
of the map that drivers and virtual chip share (registers.h, f2808_values.h in hal/f2808) must be there and agree, and
so must the pins of every board (hal/boards/).
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from checks import Finding
from checks.f2808_tables import Field, Register, read, read_fields, read_registers
from checks.preprocessor import lines

HAL = "hal/f2808"
BOARDS = "hal/boards"
MAPS = (f"{HAL}/registers.h", f"{HAL}/registers_can.h")

# How registers.h names a table's block: prefix, what is cut off the device's own name, base macro of the offsets.
_PLAIN = ("REG_", "", "")
NAMING: dict[str, tuple[str, str, str]] = {
    "EPWM": ("EPWM_", "", "EPWM_BASE"),
    "EQEP": ("EQEP_", "", "EQEP_BASE"),
    "SCI": ("SCI_", "SCI", "SCI_BASE"),
    "I2C": ("I2C_", "I2C", "I2C_BASE"),
    "CpuTimer": ("CPUTIMER_", "", "CPUTIMER_BASE"),
}
MAILBOX = {"LAM", "MOTS", "MOTO", "MSGID", "MSGCTRL", "MDL", "MDH"}

# Masks of registers_can.h that are no single field of the device's headers: register and fields that make them up.
JOINT: dict[str, tuple[str, tuple[str, ...]]] = {
    "CAN_COUNTER": ("CANTEC", ("TEC",)),
    "CANMSGID_EXTENDED": ("MSGID", ("EXTMSGID_L", "EXTMSGID_H", "STDMSGID")),
    "CANMSGID_STANDARD": ("MSGID", ("STDMSGID",)),
    **{
        f"CANGIF_{n}": ("CANGIF0", (f"{n}0",)) for n in ("MIV", "WLIF", "EPIF", "BOIF", "RMLIF", "WDIF", "AAIF", "GMIF")
    },
}
# Not of a register: counts and conventions.
OTHER = {"ECAN_MAILBOXES", "VECTOR_COUNT", "VECTOR_PIE_FIRST", "EPWM_SYNC_DELAY_TICKS"}
# Fields that the manufacturer's headers do not name; the tables have the whole register.
UNNAMED = {"GPACTRL_QUALPRD2": ("GPACTRL", 16, 8)}

_NUMBER = re.compile(r"\b(0[xX][0-9a-fA-F]+|\d+)[uUlL]*\b")


@dataclass(frozen=True)
class Macro:
    """A #define: where it stands, its parameter if it has one, its value as text, the comment behind it."""

    path: str
    line: int
    name: str
    parameter: str
    text: str
    comment: str

    def value(self, argument: int | None = None) -> int:
        """The expression's value."""
        text = self.text.replace("(uint32_t)", "")
        if self.parameter:
            text = re.sub(rf"\b{self.parameter}\b", str(argument), text)
        return int(eval(_NUMBER.sub(r"\1", text), {"__builtins__": {}}))  # noqa: S307: this repository's own header


def macros(root: Path, path: str) -> Iterator[Macro]:
    """The definitions of one header that have a value."""
    text = (root / path).read_text(encoding="utf-8")
    raw = text.split("\n")
    for number, line in lines(text):
        match = re.match(r"#define (\w+)(?:\((\w+)\))? +(.+?) *$", line)
        if match:
            comment = raw[number - 1].partition("//")[2]
            yield Macro(path, number, match[1], match[2] or "", match[3], comment)


def macro_name(register: Register) -> str:
    """What registers.h calls a register of the tables."""
    if register.block == "ECAN" and register.name in MAILBOX:
        return f"REG_CAN{register.name}"
    prefix, cut, _ = NAMING.get(register.block, _PLAIN)
    name = register.name.removeprefix(cut)
    return prefix + name.replace(".", "_")


class Comparison:
    """The map's macros, ticked off as the tables explain them."""

    def __init__(self, root: Path) -> None:
        self.registers = read_registers(root)
        self.fields = read_fields(root)
        self.macros = {macro.name: macro for path in MAPS for macro in macros(root, path)}
        self.explained = set(OTHER)
        self.findings: list[Finding] = []

    def complain(self, macro: Macro, message: str) -> None:
        """Notes what is wrong with a macro."""
        self.findings.append(Finding(macro.path, macro.line, f"{macro.name}: {message}"))

    def expect(self, macro: Macro, value: int, wanted: int, what: str) -> None:
        """Compares one number."""
        if value != wanted:
            self.complain(macro, f"{what} is 0x{value:X} here, 0x{wanted:X} in the tables")

    def address(self, register: Register, macro: Macro, index: int) -> int:
        """The address that the map gives to one of a register's copies."""
        base = self.macros.get(NAMING.get(register.block, _PLAIN)[2])
        if base is not None:
            self.explained.add(base.name)
            return base.value(register.first + index) + macro.value()
        return macro.value(register.first + index)

    def compare_register(self, register: Register) -> None:
        """Address of every copy, width and protection."""
        name = macro_name(register)
        macro = self.macros.get(name) or self.macros.get(name + "0")  # the first of a row of results
        if macro is None:
            return
        self.explained.add(macro.name)
        copies = 1 if macro.name.endswith("RESULT0") else register.count
        for index in range(copies):
            wanted = register.address + index * register.step
            self.expect(macro, self.address(register, macro, index), wanted, f"address of number {index}")
        said = macro.comment
        if (register.width == 32) != bool(re.search(r"\b32\)", said)):
            self.complain(macro, f"has {register.width} bits in the tables; the comment says otherwise")
        if ("eallow" in register.access) != ("(EALLOW" in said):
            self.complain(macro, f"access is '{register.access}' in the tables; the comment says otherwise")

    def compare_field(self, register: Register, field: Field) -> None:
        """Lowest bit and mask."""
        prefix = macro_name(register)
        if not prefix.startswith(("EPWM_", "EQEP_", "SCI_", "I2C_", "CPUTIMER_")):
            prefix = prefix.removeprefix("REG_")
        self.compare_bits(f"{prefix}_{field.name}", field.lsb, field.mask)

    def compare_bits(self, name: str, lsb: int, mask: int) -> None:
        """A pair of macros for a field, of which either may be missing."""
        for suffix, wanted in (("_LSB", lsb), ("_MASK", mask)):
            macro = self.macros.get(name + suffix)
            if macro is not None:
                self.explained.add(macro.name)
                self.expect(macro, macro.value(), wanted, suffix[1:].lower())

    def compare_joint(self) -> None:
        """Masks made of several fields."""
        for name, (register, parts) in JOINT.items():
            fields = [field for field in self.fields if field.register == register and field.name in parts]
            if len(fields) == len(parts):
                self.compare_bits(name, min(field.lsb for field in fields), sum(field.mask for field in fields))

    def compare_vectors(self, root: Path) -> None:
        """Places in the vector table; the group and channel follow from the place and are compared with the table's."""
        for row in read(root, "vectors"):
            index = int(row["index"])
            if row["group"] and index != 32 + 8 * (int(row["group"]) - 1) + int(row["channel"]) - 1:
                where = "toolchain/f2808/vectors.csv"
                self.findings.append(Finding(where, 0, f"{row['name']}: group and channel do not make {index}"))
            macro = self.macros.get(f"VECTOR_{row['name']}")
            if macro is not None:
                self.explained.add(macro.name)
                self.expect(macro, macro.value(), index, "place")

    def run(self, root: Path) -> list[Finding]:
        """All findings."""
        by_key = {(register.block, register.name): register for register in self.registers}
        for register in self.registers:
            self.compare_register(register)
        for field in self.fields:
            self.compare_field(by_key[field.block, field.register], field)
        self.compare_joint()
        self.compare_vectors(root)
        for name, macro in self.macros.items():
            if name not in self.explained:
                self.complain(macro, "not in toolchain/f2808")
        return self.findings


def check_values(root: Path) -> list[Finding]:
    """Values of fields: as the table has them, and no wider than the field."""
    path = f"{HAL}/f2808_values.h"
    known = {row["name"]: row for row in read(root, "values")}
    widths = {(field.register, field.name): field.bits for field in read_fields(root)}
    findings = []
    for macro in macros(root, path):
        if macro.name in OTHER:
            continue
        if (stem := macro.name.rpartition("_")[0]) in UNNAMED:
            _, lsb, bits = UNNAMED[stem]
            wanted = lsb if macro.name.endswith("_LSB") else ((1 << bits) - 1) << lsb
            if macro.value() != wanted:
                findings.append(Finding(path, macro.line, f"{macro.name}: 0x{wanted:X} wanted"))
            continue
        row = known.get(macro.name)
        if row is None:
            findings.append(Finding(path, macro.line, f"{macro.name}: not in toolchain/f2808/values.csv"))
            continue
        if macro.value() != int(row["value"]):
            findings.append(Finding(path, macro.line, f"{macro.name}: {row['value']} in toolchain/f2808/values.csv"))
        for field in row["fields"].split():
            bits = widths.get((row["register"], field))
            if bits is None or macro.value() >= 1 << bits:
                message = f"{macro.name}: does not fit {row['register']}.{field}"
                findings.append(Finding(path, macro.line, message))
    return findings


# What the board's pins are connected to inside the chip, by GPIO_MUX_FIRST; the rest are plain pins.
PIN_FUNCTIONS = {
    "BOARD_PIN_FIRST_GATE": "EPWM{BOARD_FIRST_LEG_MODULE}A",
    "BOARD_PIN_OVER_CURRENT": "TZ{BOARD_TRIP_INPUT}",
    "BOARD_PIN_EMERGENCY": "TZ{BOARD_EMERGENCY_TRIP}",
    "BOARD_PIN_ENCODER_A": "EQEP1A",
    "BOARD_PIN_ENCODER_B": "EQEP1B",
    "BOARD_PIN_ENCODER_INDEX": "EQEP1I",
    "BOARD_PIN_SERIAL_IN": "SCIRXDA",
    "BOARD_PIN_SERIAL_OUT": "SCITXDA",
    "BOARD_PIN_CAN_RECEIVE": "CANRXA",
    "BOARD_PIN_CAN_TRANSMIT": "CANTXA",
    "BOARD_PIN_SDA": "SDAA",
    "BOARD_PIN_SCL": "SCLA",
}


def check_pins(root: Path) -> list[Finding]:
    """Pins that a peripheral drives must have it as their first function, and no pin has two wires."""
    functions = {int(row["pin"]): row["function"] for row in read(root, "pins") if row["mux"] == "1"}
    findings = []
    for file in sorted((root / BOARDS).glob("*.h")):
        path = file.relative_to(root).as_posix()
        numbers = {m.name: m for m in macros(root, path) if re.fullmatch(r"\d+u", m.text)}
        chosen = {name: m.value() for name, m in numbers.items()}
        gates = range(chosen["BOARD_PIN_FIRST_GATE"] + 1, chosen["BOARD_PIN_FIRST_GATE"] + chosen["BOARD_GATE_PINS"])
        wired = list(gates)
        for name, macro in numbers.items():
            if not name.startswith("BOARD_PIN_"):
                continue
            wanted = PIN_FUNCTIONS.get(name, "").format(**chosen)
            if wanted and functions.get(macro.value()) != wanted:
                message = f"{name}: {wanted} is not the first function of GPIO{macro.value()}"
                findings.append(Finding(path, macro.line, message))
            if macro.value() in wired:
                findings.append(Finding(path, macro.line, f"{name}: GPIO{macro.value()} has another wire already"))
            wired.append(macro.value())
    return findings


def check(root: Path) -> list[Finding]:
    """Every difference between the headers and the tables."""
    return [*Comparison(root).run(root), *check_values(root), *check_pins(root)]
