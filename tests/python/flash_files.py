"""Small images and kernels as files of every format, made by encoders of their own; a board that takes them."""

from __future__ import annotations

import contextlib
import random
import struct

from stillspin import core
from stillspin.flash.program import Block
from stillspin.link.errors import LinkError

TICKS_PER_SECOND = 100_000_000
ERASED = 0xFFFF
START, UPDATE_END, END = 0x3E8000, 0x3F4000, 0x3F8000
IDENTITY = 0x3E8020
ENTRY = 0x3F7FF6
MARK = 0x5AA5
NO_SUM = (0xFFFF,) * 4

BOOT = (Block(0x3F4000, (0x561F, 0x7029, 0x761F, 0x0001)), Block(ENTRY, (0x007F, 0x4000)))
"""In the place of boot.asm's two sections."""
KERNEL_ENTRY = 0x3FA004


def kernel_blocks(words=12):
    """A stand-in for the kernel's words, which no compiler made."""
    noise = random.Random(7)
    return [Block(0x3FA000, (0x464B, 0, 0, 0, *(noise.randrange(0x10000) for _ in range(words))))]


def name_words(name):
    """Two characters a word, the low octet first."""
    return struct.unpack("<8H", name.encode().ljust(16, b"\0"))


def image_blocks(seed, *, words=8, boot=BOOT, revision=0xC0FFEE00, edition=""):
    """A stand-in for an image of the drive: identity, and words in all three sectors."""
    noise = random.Random(seed)
    built = (revision & 0xFFFF, revision >> 16, 0, 0x1234, 0x5678)
    identity = (MARK, 1, 0, 1, seed, *built, *NO_SUM, *name_words(edition))
    places = (0x3E8000, 0x3E8040, 0x3EC010, 0x3F3FF0)
    code = [Block(at, tuple(noise.randrange(0x10000) for _ in range(words))) for at in places]
    return [code[0], Block(IDENTITY, identity), *code[1:], *boot]


def cells(blocks):
    """All words of the flash with these blocks in them, the rest erased."""
    words = [ERASED] * (END - START)
    for block in blocks:
        words[block.address - START : block.end - START] = block.words
    return words


def word(value):
    return struct.pack("<H", value)


def boot_binary(blocks, entry):
    out = word(0x08AA) + bytes(16) + word(entry >> 16) + word(entry & 0xFFFF)
    for block in blocks:
        out += word(len(block.words)) + word(block.address >> 16) + word(block.address & 0xFFFF)
        out += b"".join(map(word, block.words))
    return out + word(0)


def boot_ascii(blocks, entry):
    octets = boot_binary(blocks, entry)
    lines = [octets[k : k + 24].hex(" ").upper() for k in range(0, len(octets), 24)]
    return b"\x02$A000000,\n" + "\n".join(lines).encode() + b" \n\x03"


def _hex_line(address, kind, body):
    octets = bytes((len(body), address >> 8 & 0xFF, address & 0xFF, kind)) + body
    return f":{(octets + bytes((-sum(octets) & 0xFF,))).hex().upper()}\n"


def intel_hex(blocks):
    lines = []
    for block in blocks:
        for at in range(0, len(block.words), 16):
            address, words = block.address + at, block.words[at : at + 16]
            lines.append(_hex_line(0, 4, struct.pack(">H", address >> 16)))
            lines.append(_hex_line(address & 0xFFFF, 0, struct.pack(f">{len(words)}H", *words)))
    return "".join([*lines, ":00000001FF\n"]).encode()


def coff(blocks, entry=0x3F7FF6, *, target=0x009D, flags=0x1103, heads_of=lambda address: (address, address), empty=()):
    """An executable; one section is without content, as .ebss, and one a dummy.

    heads_of: the two addresses in the head of a section that is loaded to one.
    empty: names, addresses and words of more sections without content.
    """
    others = [(b".ebss", 0x8000, 100, 0, 0x80), (b"dummy", 0x9000, 1, 1, 1)]
    others += [(name, address, size, 0, 0x80) for name, address, size in empty]
    count = len(blocks) + len(others)
    raw = 22 + 28 + 48 * count
    heads, content = b"", b""
    for name, address, size, pointer, kind in others:
        heads += struct.pack("<8sIIIIIIIIIHH", name, address, address, size, pointer and raw, 0, 0, 0, 0, kind, 0, 0)
    for index, block in enumerate(blocks):
        name, at = f"sect{index}".encode(), raw + len(content)
        size = len(block.words)
        both = heads_of(block.address)
        heads += struct.pack("<8sIIIIIIIIIHH", name, *both, size, at, 0, 0, 0, 0, 0x20, 0, 0)
        content += b"".join(map(word, block.words))
    head = struct.pack("<HHIIIHHH", 0x00C2, count, 0, 0, 0, 28, flags, target)
    optional = struct.pack("<HHIIIIII", 0x0108, 0, 0, 0, 0, entry, 0, 0)
    return head + optional + heads + content


class Board:
    """A virtual board without a power stage, and what its flash has to hold."""

    def __init__(self, image, kernel=None):
        self.native = core.load().LoaderBoard(
            entry=KERNEL_ENTRY, blocks=[(block.address, list(block.words)) for block in kernel or kernel_blocks()]
        )
        self.first = cells(image)
        self.native.flash = self.first
        self.cycle(serial=True)

    def cycle(self, *, serial):
        """Jumpers, then off and on, and a millisecond for the boot ROM."""
        self.native.set_serial_boot(serial)
        self.native.power_cycle()
        self.native.advance(TICKS_PER_SECOND // 1000)

    def boots(self):
        """What runs when the board is switched on with the jumpers in flash boot."""
        self.cycle(serial=False)
        return self.native.running


@contextlib.contextmanager
def board(image, kernel=None):
    it = Board(image, kernel)
    try:
        yield it
        assert it.native.driven == 0, "a pin has left its pull-down"
    finally:
        it.native.close()


class BoardLine:
    """The board's serial port without a port: its time passes while somebody reads."""

    name = "the board"

    def __init__(self, board):
        self._board = board.native
        self._heard = b""

    def set_rate(self, rate):
        self._board.serial_rate = rate

    def write(self, octets):
        self._board.serial_write(octets)

    def read(self, most, timeout):
        if not self._heard:
            self._board.advance_until_heard(round(timeout * TICKS_PER_SECOND))
            self._heard = self._board.serial_read()
        octets, self._heard = self._heard[:most], self._heard[most:]
        return octets


class CutLine(BoardLine):
    """A cable that is pulled when so many octets have passed, both ways counted."""

    def __init__(self, board, cut_at):
        super().__init__(board)
        self.left = cut_at
        self.passed = 0
        self.whole = True
        """The last thing that was written has arrived."""

    def _pass(self, octets):
        through = octets[: self.left]
        self.left -= len(through)
        self.passed += len(through)
        return through, len(through) == len(octets)

    def write(self, octets):
        through, self.whole = self._pass(octets)
        super().write(through)
        if not self.whole:
            raise LinkError("the cable is out")

    def read(self, most, timeout):
        through, whole = self._pass(super().read(most, timeout))
        if not whole:
            raise LinkError("the cable is out")
        return through
