"""The virtual board's serial port: a pseudo-terminal, its link, and what becomes of octets."""

from __future__ import annotations

import subprocess
import sys

import pytest
from desk import open_port

from stillspin.board.pseudo_terminal import BACKLOG, PseudoTerminal
from stillspin.errors import InputError


def test_octets_pass_unchanged_both_ways(port):
    everything = bytes(range(256))
    with open_port(port.name) as client:
        client.write(everything)
        client.flush()
        assert port.read() == everything
        port.write(everything)
        assert client.read(256) == everything


def test_what_comes_while_nobody_has_the_port_open_is_lost(port):
    assert not port.is_open
    port.write(b"before")
    with open_port(port.name) as client:
        assert port.is_open
        port.write(b"after")
        assert client.read(5) == b"after"
    assert not port.is_open
    port.write(b"between")
    with open_port(port.name) as client:
        port.write(b"again")
        assert client.read(5) == b"again"


@pytest.mark.parametrize("rate", [9600, 115200, 250000, 230400])
def test_rate_is_the_one_that_the_program_sets(port, rate):
    assert port.rate == 115200
    with open_port(port.name, rate):
        assert port.is_open
        assert port.rate == rate
    assert not port.is_open
    assert port.rate == 115200


def test_what_a_program_wrote_before_it_died_arrives(port):
    writer = f"import os; os.write(os.open({port.device!r}, os.O_RDWR | os.O_NOCTTY), b'last words'); os._exit(9)"
    subprocess.run([sys.executable, "-c", writer], check=False)
    assert port.read() == b"last words"
    assert port.read() == b""


def test_a_program_that_does_not_read_is_not_waited_for(port):
    with open_port(port.name) as client:
        for _ in range(40):
            port.write(b"x" * 4096)
        assert port.dropped > 0
        client.reset_input_buffer()
        assert BACKLOG + port.dropped <= 40 * 4096


def test_link_is_made_replaced_and_removed(tmp_path):
    link = tmp_path / "drive"
    link.symlink_to("/dev/pts/no-such")
    port = PseudoTerminal(link)
    assert port.name == str(link)
    assert str(link.readlink()) == port.device
    with open_port(link) as client:
        client.write(b"?")
        client.flush()
        assert port.read() == b"?"
    port.close()
    port.close()
    assert not link.is_symlink()
    assert list(tmp_path.iterdir()) == []


def test_link_of_a_board_that_runs_is_not_taken_over(tmp_path):
    link = tmp_path / "drive"
    first = PseudoTerminal(link)
    with pytest.raises(InputError, match="another virtual board that runs"):
        PseudoTerminal(link)
    assert str(link.readlink()) == first.device
    first.close()
    second = PseudoTerminal(link)
    assert str(link.readlink()) == second.device
    second.close()


def test_link_that_is_not_ours_any_more_is_left_alone_at_the_end(tmp_path):
    port = PseudoTerminal(tmp_path / "drive")
    (tmp_path / "drive").unlink()
    (tmp_path / "drive").symlink_to("/dev/null")
    port.close()
    assert str((tmp_path / "drive").readlink()) == "/dev/null"


def test_link_that_cannot_be_made_is_refused(tmp_path):
    (tmp_path / "file").write_text("precious")
    with pytest.raises(InputError, match="not a symbolic link"):
        PseudoTerminal(tmp_path / "file")
    with pytest.raises(InputError, match="cannot be made"):
        PseudoTerminal(tmp_path / "none" / "drive")
    assert (tmp_path / "file").read_text() == "precious"
