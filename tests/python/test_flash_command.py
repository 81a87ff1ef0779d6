"""`stillspin flash` as a user has it: a serial port (a pseudo-terminal), a virtual board behind it, files."""

from __future__ import annotations

import os
import re
import struct
from contextlib import contextmanager

import desk
import flash_files as make
import pytest
from desk import needs_board

from stillspin import cli
from stillspin.flash.kernel import Kernel
from stillspin.flash.program import Block
from stillspin.link.errors import LinkError

pytestmark = needs_board

_SPEED = "10"
NEW = [*make.image_blocks(2, boot=()), Block(0x3E9000, tuple(range(300)))]


@pytest.fixture
def files(tmp_path):
    """Image files old and new, the kernel beside them."""
    (tmp_path / "old.out").write_bytes(make.coff(make.image_blocks(1, boot=())))
    (tmp_path / "new.hex").write_bytes(make.intel_hex(NEW))
    (tmp_path / "kernel.txt").write_bytes(make.boot_ascii(make.kernel_blocks(400), make.KERNEL_ENTRY))
    return tmp_path


@contextmanager
def virtual(files):
    """A board in serial boot as a process; yields its port."""
    link = files / "port"
    options = ["--kernel", str(files / "kernel.txt"), "--serial-link", str(link), "--speed", _SPEED]
    with desk.process(files / "loader.log", (link,), "loader", str(files / "flash.bin"), *options):
        yield str(link)


@pytest.fixture
def flash(capsys):
    """`stillspin flash` with these arguments: exit status, what was said, complaint."""

    def run(*arguments):
        with pytest.raises(SystemExit) as ended:
            cli.app(["flash", *map(str, arguments)])
        said = capsys.readouterr()
        return ended.value.code, said.out, said.err

    return run


def test_a_board_gets_an_image_another_one_and_is_compared(files, flash):
    kernel = ["--kernel", files / "kernel.txt"]
    with virtual(files) as port:
        status, said, complaint = flash(files / "old.out", *kernel, "--port", port)
        assert (status, complaint) == (0, "")
        assert "before: TMS320F2808 revision 3, no complete image" in said
        assert "image complete" in said
        status, said, _ = flash(files / "new.hex", *kernel, "--port", port, "--verify")
        assert status == 4
        assert "the board has not this image: sectors D, C, B differ" in said
        status, said, _ = flash(files / "new.hex", *kernel, "--port", f"serial://{port}")
        assert status == 0
        assert re.search(r"sectors D, C, B erased, \d+ words written and verified", said)
        assert flash(files / "new.hex", *kernel, "--port", port, "--verify")[0] == 0
    assert "the chip runs: the drive" in (files / "loader.log").read_text()
    words = struct.unpack("<65536H", (files / "flash.bin").read_bytes())
    assert list(words[: make.UPDATE_END - make.START]) == make.cells(NEW)[: make.UPDATE_END - make.START]


def test_a_board_without_an_image_says_at_its_end_that_no_drive_runs(files):
    with virtual(files):
        pass
    assert "the chip runs: its boot code, which waits for an image; no drive" in (files / "loader.log").read_text()


def test_nobody_at_the_port_is_one_line_with_a_remedy(files, flash):
    master, slave = os.openpty()
    try:
        status, _, complaint = flash(files / "old.out", "--kernel", files / "kernel.txt", "--port", os.ttyname(slave))
    finally:
        os.close(master)
        os.close(slave)
    assert status == 3
    assert "set the jumpers to serial boot" in complaint
    assert complaint.count("\n") == 1


def test_port_that_is_not_there_is_one_line(files, flash):
    status, _, complaint = flash(files / "old.out", "--kernel", files / "kernel.txt", "--port", files / "ttyNothing")
    assert status == 3
    assert "there is no serial port" in complaint


@pytest.mark.parametrize(("cause", "status"), [(KeyboardInterrupt(), 130), (LinkError("the port is lost"), 3)])
def test_an_update_that_is_broken_off_says_what_is_on_the_chip_and_what_to_do(files, flash, monkeypatch, cause, status):
    def fails(*_):
        raise cause

    image, kernel = files / "new.hex", ["--kernel", files / "kernel.txt"]
    with virtual(files) as port:
        assert flash(files / "old.out", *kernel, "--port", port)[0] == 0
        with monkeypatch.context() as broken:
            broken.setattr(Kernel, "write", fails)
            ended, _, complaint = flash(image, *kernel, "--port", port)
        again = f"stillspin flash {image} --kernel {kernel[1]} --port {port}"
        assert (ended, complaint.count("\n")) == (status, 1), complaint
        assert "no complete image is on the chip: it stays in its boot code and runs no drive" in complaint
        assert f"leave the jumpers in serial boot, reset the board, then: {again}\n" in complaint
        assert flash(*again.split()[2:])[0] == 0


def test_flash_file_of_another_size_is_one_line(files, capsys):
    (files / "flash.bin").write_bytes(b"short")
    with pytest.raises(SystemExit) as ended:
        cli.app(["loader", str(files / "flash.bin"), "--kernel", str(files / "kernel.txt")])
    assert ended.value.code == 2
    assert "has 5 octets, must have 131072" in capsys.readouterr().err
