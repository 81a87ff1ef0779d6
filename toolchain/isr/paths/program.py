"""A linked Thumb-2 program as functions of basic blocks, from GNU objdump and addr2line.

A block ends at a jump, at a call, and where something jumps to. The source's functions that its instructions come from,
inlined ones first, are in `frames`. Instructions in an IT block that leave the function go on to the next one, too.
"""

import re
import subprocess
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TypeVar

Fact = TypeVar("Fact")

OBJDUMP, ADDRESSES = "arm-none-eabi-objdump", "arm-none-eabi-addr2line"
BY_POINTER = "*"
_CONDITIONS = "eq|ne|cs|cc|hs|lo|mi|pl|vs|vc|hi|ls|ge|lt|gt|le"
_JUMP, _CALL = re.compile(rf"b({_CONDITIONS})?"), re.compile(rf"bl(x)?({_CONDITIONS})?")
_LINE = re.compile(r"\s+([0-9a-f]+):\t([0-9a-f ]+?)\s*\t(\S+)(?:\t(.*))?")
_DATA = {".word": 4, ".short": 2, ".byte": 1}
# What the compiler appends to the copies of a function.
_COPY = re.compile(r"\.(lto_priv|isra|part|constprop|cold)(\.\d+)?")


@dataclass(frozen=True)
class Frame:
    """Where an instruction comes from: a function of the source, its file, the line."""

    function: str
    file: str
    line: str

    def names(self) -> tuple[str, str, str]:
        """What facts may call it: its line, the function and its file, or the function."""
        return f"{self.file}:{self.line}", f"{self.file}:{self.function}", self.function

    def __str__(self) -> str:
        """As a message has it."""
        return f"{self.function} ({self.file}:{self.line})"


FramesOf = Callable[[list[int]], Mapping[int, tuple[Frame, ...]]]


def fact_on(frame: Frame, facts: Mapping[str, Fact]) -> Fact | None:
    """What is said of a function."""
    return next((facts[name] for name in frame.names() if name in facts), None)


def shared(stacks: Iterable[tuple[Frame, ...]]) -> Frame:
    """The innermost function of the source that all these instructions come from."""
    first, *others = stacks
    depth = len(first)
    for frames in others:
        same = 0
        for a, b in zip(first[::-1], frames[::-1], strict=False):
            if (a.function, a.file) != (b.function, b.file):
                break
            same += 1
        depth = min(depth, same)
    return first[-max(depth, 1)]


@dataclass
class Block:
    """Instructions that run one after the other, and where they go on."""

    address: int
    instructions: list[int] = field(default_factory=list)
    successors: list[int] = field(default_factory=list)
    call: str = ""  # what its last instruction calls
    returns: bool = False
    frames: list[tuple[Frame, ...]] = field(default_factory=list)  # of each instruction

    def is_of(self, functions: set[str]) -> bool:
        """Whether all of it comes from one of these functions of the source, or what it calls is called there.

        An instruction may be moved out of its function, a call is not.
        """
        last = self.frames[-1:] if self.call else []
        return any(
            all(any(not functions.isdisjoint(frame.names()) for frame in frames) for frames in asked)
            for asked in (self.frames, last)
            if asked
        )


@dataclass
class Function:
    """A function as it is linked."""

    name: str
    entry: int
    blocks: dict[int, Block]


@dataclass(frozen=True)
class _Instruction:
    address: int
    size: int
    name: str  # without the width
    operands: str

    @property
    def next(self) -> int:
        return self.address + self.size

    @property
    def target(self) -> int:
        found = re.search(r"\b([0-9a-f]+) <", self.operands)
        if found is None:
            raise ValueError(f"no target at {self.address:x}: {self.name} {self.operands}")
        return int(found[1], 16)


@dataclass(frozen=True)
class _Exit:
    """Where an instruction leads, whether it ends the function, and what it calls."""

    successors: list[int]
    returns: bool = False
    call: str = ""


def plain(name: str) -> str:
    """A function's name in the source."""
    return _COPY.sub("", name)


class Program:
    """What is linked; functions are taken apart when they are asked for."""

    def __init__(self, disassembly: str, constants: dict[str, bytes], frames_of: FramesOf) -> None:
        """From GNU objdump's text; constants by their names in the source; frames_of: those of addresses."""
        self.code: dict[str, list[_Instruction]] = {}
        self.constants = constants
        self._frames_of = frames_of
        self._data: dict[int, int] = {}  # octets
        self._names: dict[int, str] = {}
        self._functions: dict[str, Function] = {}
        code: list[_Instruction] = []
        for line in disassembly.splitlines():
            if head := re.fullmatch(r"([0-9a-f]+) <(.+)>:", line):
                code = self.code.setdefault(head[2], [])
                self._names[int(head[1], 16)] = head[2]
            elif found := _LINE.fullmatch(line):
                address, operands = (
                    int(found[1], 16),
                    (found[4] or "").split("@")[0].strip(),
                )
                if size := _DATA.get(found[3]):
                    value = int(operands.split()[0], 16)
                    self._data.update((address + k, value >> 8 * k & 255) for k in range(size))
                else:
                    size = len(found[2].replace(" ", "")) // 2
                    code.append(_Instruction(address, size, found[3].split(".")[0], operands))

    def table(self, name: str) -> set[str]:
        """The functions in a table of pointers."""
        octets = self.constants.get(name, b"")
        words = (int.from_bytes(octets[k : k + 4], "little") for k in range(0, len(octets) - 3, 4))
        return {self._names[word & ~1] for word in words if word & 1 and word & ~1 in self._names}

    def function(self, name: str) -> Function:
        """A function as blocks; KeyError where there is none."""
        if name not in self._functions:
            self._functions[name] = self._take_apart(name)
        return self._functions[name]

    def taken_apart(self) -> list[Function]:
        """The functions that somebody has asked for."""
        return list(self._functions.values())

    def _table_of_jumps(self, code: list[_Instruction], at: int) -> list[int]:
        """Where the table behind a jump through one leads."""
        jump = code[at]
        inside = {instruction.address for instruction in code}
        start = next(address for address in range(jump.next, jump.next + 4) if address in self._data)
        width = {"tbb": 1, "tbh": 2}.get(jump.name, 4)
        found: set[int] = set()
        end = start + width * self._entries_asked_for(code, at)
        while start + width - 1 in self._data and start < end:
            entry = int.from_bytes((self._data[start + k] for k in range(width)), "little")
            target = entry & ~1 if width == 4 else jump.next + 2 * entry  # addresses, or half words from here
            if target not in inside:
                break
            found.add(target)
            start += width
        return sorted(found)

    @staticmethod
    def _entries_asked_for(code: list[_Instruction], at: int) -> int:
        """How many entries the comparison before a jump through a table admits: literals may lie behind the table."""
        for before in reversed(code[max(at - 4, 0) : at]):
            compared = re.fullmatch(r"r\d+, #(\d+)\b.*", before.operands)
            if compared and before.name.startswith("cmp"):
                return int(compared[1]) + 1
        raise ValueError(f"not understood at {code[at].address:x}: no comparison before a jump through a table")

    def _exits(self, code: list[_Instruction], at: int, inside: range, on: list[int]) -> _Exit | None:
        """Where an instruction leads that does not just go on; on: the next one, where it stands in an IT block."""
        i = code[at]
        target = i.operands.partition("<")[2].rstrip(">")
        if call := _CALL.fullmatch(i.name):
            return _Exit([i.next], call=BY_POINTER if call[1] else target)
        if i.name in ("cbz", "cbnz"):
            return _Exit([i.target, i.next])
        if jump := _JUMP.fullmatch(i.name):
            on = [i.next] if jump[1] else on
            return _Exit([i.target, *on]) if i.target in inside else _Exit(on, returns=True, call=target)
        if i.name in ("tbb", "tbh") or (i.name == "ldr" and re.match(r"pc, \[r\d+, r\d+", i.operands)):
            return _Exit(self._table_of_jumps(code, at))
        if i.name.startswith("bx"):
            return _Exit(on, returns=True, call="" if i.operands == "lr" else BY_POINTER)
        return self._return(i, on)

    @staticmethod
    def _return(i: _Instruction, on: list[int]) -> _Exit | None:
        """With the program counter from the stack."""
        is_pop = i.name.startswith(("pop", "ldm")) and re.search(r"\bpc\b", i.operands)
        if is_pop or (i.name.startswith("ldr") and i.operands.startswith("pc, [sp]")):
            return _Exit(on, returns=True)
        if re.match(r"pc\b", i.operands):
            raise ValueError(f"not understood at {i.address:x}: {i.name} {i.operands}")
        return None

    def _take_apart(self, name: str) -> Function:
        code = self.code[name]
        inside = range(code[0].address, code[-1].next)
        exits: dict[int, _Exit] = {}
        left = 0  # instructions of the IT block
        for at, i in enumerate(code):
            found = self._exits(code, at, inside, [i.next] if left > 0 else [])
            left = len(i.name) - 1 if re.fullmatch("it[te]*", i.name) else max(left - 1, 0)
            if found is not None:
                exits[i.address] = found
        starts = {
            code[0].address,
            *(to for found in exits.values() for to in found.successors),
        }
        blocks: dict[int, Block] = {}
        block = Block(code[0].address)
        for i in code:
            if i.address in starts:
                if block.instructions and not block.successors and not block.returns:
                    block.successors = [i.address]
                block = blocks[i.address] = Block(i.address)
            block.instructions.append(i.address)
            if i.address in exits:
                found = exits[i.address]
                block.successors, block.returns, block.call = found.successors, found.returns, found.call
                block = Block(i.next)  # nothing gets there unless something jumps there
        return self._reached(Function(name, code[0].address, blocks))

    def _reached(self, function: Function) -> Function:
        """Without what nothing leads to: padding, and what stands between literals."""
        reached: dict[int, Block] = {}
        waiting = [function.entry]
        while waiting:
            address = waiting.pop()
            if address not in reached:
                reached[address] = function.blocks[address]
                waiting += reached[address].successors
        function.blocks = reached
        frames = self._frames_of([address for block in reached.values() for address in block.instructions])
        for block in reached.values():
            block.frames = [frames[address] for address in block.instructions]
        return function


def _frames_in(image: Path, addresses: list[int]) -> dict[int, tuple[Frame, ...]]:
    asked = "\n".join(f"{address:x}" for address in addresses)
    command = [ADDRESSES, "-e", str(image), "-f", "-i", "-a", "-s"]
    said = subprocess.run(command, input=asked, capture_output=True, text=True, check=True).stdout
    lines: dict[int, list[str]] = defaultdict(list)
    address = 0
    for line in said.splitlines():
        if line.startswith("0x"):
            address = int(line, 16)
        else:
            lines[address].append(line)
    found = {}
    for address, pairs in lines.items():
        frames = []
        for function, place in zip(pairs[::2], pairs[1::2], strict=True):
            file, _, number = place.partition(" ")[0].rpartition(":")
            frames.append(Frame(plain(function), file, number))
        found[address] = tuple(frames)
    return found


def _constants_in(image: Path) -> dict[str, bytes]:
    said = _dump(image, "-t")
    places = {}
    for line in said.splitlines():
        if found := re.fullmatch(r"([0-9a-f]{8}) .{7} \.(text|rodata)\t([0-9a-f]{8}) (\S+)", line):
            places[re.sub(r"\.\d+$", "", plain(found[4]))] = (
                int(found[1], 16),
                int(found[3], 16),
            )
    content: dict[int, int] = {}
    for line in _dump(image, "-s", "-j", ".text").splitlines():
        if found := re.match(r" ([0-9a-f]+) ((?:[0-9a-f]{2,8} ){1,4})", line):
            octets = bytes.fromhex(found[2].replace(" ", ""))
            content.update((int(found[1], 16) + k, octet) for k, octet in enumerate(octets))
    return {name: bytes(content.get(at + k, 0) for k in range(size)) for name, (at, size) in places.items() if size > 0}


def _dump(image: Path, *options: str) -> str:
    return subprocess.run([OBJDUMP, *options, image], capture_output=True, text=True, check=True).stdout


def read_program(image: Path) -> Program:
    """Of an ELF file. OSError or CalledProcessError without the Cortex-M3's tools."""
    return Program(_dump(image, "-d"), _constants_in(image), partial(_frames_in, image))
