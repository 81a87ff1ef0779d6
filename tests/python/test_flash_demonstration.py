"""`stillspin demo-image` as a user has it, and that nothing but a virtual board gets what it makes."""

import os
import threading
from contextlib import contextmanager

import desk
import flash_files as make
import pytest
from desk import needs_board

from stillspin import cli
from stillspin.errors import InputError
from stillspin.flash import demonstration, update, virtual
from stillspin.flash.files import drive_image, kernel_program
from stillspin.flash.line import SerialLine

IMAGE, KERNEL = demonstration.IMAGE_NAME, demonstration.KERNEL_NAME


@pytest.fixture
def stillspin(capsys):
    """The command with these arguments: exit status, what was said, complaint."""

    def run(*arguments):
        with pytest.raises(SystemExit) as ended:
            cli.app(list(map(str, arguments)))
        said = capsys.readouterr()
        return ended.value.code, said.out, said.err

    return run


@needs_board
def test_one_command_makes_all_that_an_update_of_a_virtual_board_needs(tmp_path, stillspin):
    assert stillspin("demo-image", tmp_path / "demo")[0] == 0
    image, port = tmp_path / "demo" / IMAGE, tmp_path / "port"
    loader = ("loader", str(tmp_path / "demo" / "flash.bin"), "--serial-link", str(port), "--speed", "10")
    with desk.process(tmp_path / "log", (port,), *loader):
        status, said, complaint = stillspin("flash", image, "--port", port)
        assert (status, complaint) == (0, "")
        assert "0.1.0 (a demonstration, for a virtual board alone)" in said
        assert "image complete" in said
        assert stillspin("flash", image, "--port", port, "--verify")[0] == 0
    assert "the chip runs: the drive" in (tmp_path / "log").read_text()


def test_the_same_files_every_time(tmp_path):
    one, other = demonstration.write(tmp_path / "one"), demonstration.write(tmp_path / "other")
    assert [file.read_bytes() for file in one] == [file.read_bytes() for file in other]
    assert drive_image(one[0]).summed


@contextmanager
def terminal(behave):
    """A program at the other end of a pseudo-terminal that is no virtual board; the port, and what it has heard."""
    master, slave = os.openpty()
    heard = bytearray()

    def listen():
        while True:
            try:
                octets = os.read(master, 64)
            except OSError:
                return
            heard.extend(octets)
            os.write(master, behave(octets))

    thread = threading.Thread(target=listen, daemon=True)
    thread.start()
    try:
        yield os.ttyname(slave), heard
    finally:
        os.close(slave)
        thread.join(5)
        os.close(master)


def mixed(tmp_path, which):
    """Image and kernel, of which both or one is a demonstration's."""
    image, kernel = demonstration.write(tmp_path)
    if which == "kernel":
        image = tmp_path / "real.hex"
        image.write_bytes(make.intel_hex(make.image_blocks(1, boot=())))
    if which == "image":
        kernel = tmp_path / "kernel.txt"
        kernel.write_bytes(make.boot_ascii(make.kernel_blocks(), make.KERNEL_ENTRY))
    return image, kernel


@pytest.mark.parametrize("which", ["both", "image", "kernel"])
@pytest.mark.parametrize(
    "behave",
    [
        pytest.param(lambda octets: octets, id="echo, as a boot ROM does"),
        pytest.param(lambda octets: b"", id="silence"),
        pytest.param(lambda octets: b"unknown command\r\n> " * 4, id="a console"),
    ],
)
def test_what_is_no_virtual_board_gets_no_demonstration(tmp_path, monkeypatch, stillspin, behave, which):
    monkeypatch.setattr(virtual, "_WAIT", 0.3)
    image, kernel = mixed(tmp_path, which)
    with terminal(behave) as (port, heard):
        status, _, complaint = stillspin("flash", image, "--kernel", kernel, "--port", port)
    assert status == 2
    assert "no virtual board is there" in complaint
    assert complaint.count("\n") == 1
    assert len(heard) <= virtual.LENGTH


@pytest.mark.parametrize("action", [update.update, update.verify])
def test_a_port_with_a_cable_hears_nothing_of_a_demonstration(tmp_path, action):
    image, kernel = demonstration.write(tmp_path)

    with terminal(lambda octets: b"") as (port, heard), SerialLine(port) as line:
        line.is_pseudo_terminal = False  # as where an adapter is
        with pytest.raises(InputError, match="no virtual board is there"):
            action(line, kernel_program(kernel), drive_image(image), lambda _what, _share: None)
    assert heard == b""


def test_ports_of_adapters_are_no_pseudo_terminals(tmp_path):
    (tmp_path / "link").symlink_to("/dev/ttyUSB0")
    ports = ("/dev/ttyUSB0", "/dev/ttyACM0", "/dev/cu.usbserial-1410", "COM3", str(tmp_path / "link"))
    assert not any(SerialLine.is_pseudo(port) for port in ports)
    assert SerialLine.is_pseudo("/dev/pts/3")


def test_an_answer_to_another_question_does_not_count():
    question = b"stillspin: virtual board? " + b"0" * 32
    assert virtual.answer(question) != virtual.answer(question[:-1] + b"1")
