"""A file that appears whole: what is there before is there until all is written, and nothing is left beside it."""

import errno
import os
import stat
from pathlib import Path

import pytest

from stillspin import whole_file
from stillspin.errors import InputError


@pytest.mark.parametrize(("content", "octets"), [("0,5 °\n", b"0,5 \xc2\xb0\n"), (b"\x00\xff", b"\x00\xff")])
def test_a_file_has_its_new_content_and_everybody_may_read_it(tmp_path, content, octets):
    file = tmp_path / "kept"
    file.write_bytes(b"of yesterday")
    whole_file.write(file, content)
    assert file.read_bytes() == octets
    assert stat.S_IMODE(file.stat().st_mode) == 0o644
    assert [there.name for there in tmp_path.iterdir()] == ["kept"]


def test_what_cannot_take_its_place_leaves_everything_as_it_was(tmp_path):
    (tmp_path / "kept").mkdir()
    with pytest.raises(InputError, match=r"^--json .*kept: cannot be written \(Is a directory\)$"):
        whole_file.write(tmp_path / "kept", "new", "--json")
    assert [there.name for there in tmp_path.iterdir()] == ["kept"]


def test_a_full_disk_leaves_the_old_file(tmp_path, monkeypatch):
    file = tmp_path / "kept"
    file.write_bytes(b"of yesterday")

    def full(_self: Path, _content: bytes) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(InputError, match=r"^/.*kept: cannot be written \(No space left on device\)$"):
        whole_file.write(file, "new")
    assert file.read_bytes() == b"of yesterday"
    assert [there.name for there in tmp_path.iterdir()] == ["kept"]
