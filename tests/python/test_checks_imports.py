"""The check of the Python package's imports: no circle, no folder that imports one above it."""

import subprocess
import sys
from pathlib import Path

from planting import plant

ROOT = Path(__file__).resolve().parents[2]


def imports_found(tree: Path) -> list[str]:
    """In a process of its own: this one knows another stillspin."""
    code = "from pathlib import Path; from checks import circles; print(*circles.check(Path({!r})), sep='\\n')"
    command = [sys.executable, "-c", code.format(str(tree))]
    done = subprocess.run(command, cwd=ROOT / "toolchain", capture_output=True, text=True, check=True)
    return done.stdout.splitlines()


def test_import_of_a_folder_above_is_caught(tmp_path: Path) -> None:
    """Also of a folder by what lies beside the folders; an exception that nothing needs is one too many."""
    for folder in ("", "link/", "drive/", "runs/", "report/"):
        plant(tmp_path, f"sim_host/stillspin/{folder}__init__.py")
    plant(tmp_path, "sim_host/stillspin/link/wire.py", "def f():\n    import stillspin.drive.own\n")
    plant(tmp_path, "sim_host/stillspin/drive/own.py", "import stillspin.low\nimport stillspin.link\n")
    plant(tmp_path, "sim_host/stillspin/low.py", "import stillspin.report\n")
    plant(tmp_path, "sim_host/stillspin/runs/go.py", "import stillspin.report.page\n")
    plant(tmp_path, "sim_host/stillspin/report/page.py")
    plant(tmp_path, "toolchain/imports_left.txt", "# left\nruns: report\nlink: report\n")
    assert imports_found(tmp_path) == [
        "sim_host/stillspin/link/wire.py: link must not import drive, which lies above it: stillspin.drive.own",
        "sim_host/stillspin/low.py: low must not import report, which lies above it: stillspin.report",
        "toolchain/imports_left.txt:3: link does not import report any more; take it out",
    ]


def test_circle_of_imports_is_caught(tmp_path: Path) -> None:
    """Also one that is closed inside a function, or for a type checker alone."""
    plant(tmp_path, "sim_host/stillspin/__init__.py")
    plant(tmp_path, "sim_host/stillspin/a.py", "from stillspin import b\nfrom stillspin import d\n")
    plant(tmp_path, "sim_host/stillspin/b.py", "from stillspin.c import thing\n")
    plant(tmp_path, "sim_host/stillspin/c.py", "def thing():\n    import stillspin.a\n")
    typed = "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from stillspin.d import D\n"
    plant(tmp_path, "sim_host/stillspin/d.py", "from stillspin.e import E\n")
    plant(tmp_path, "sim_host/stillspin/e.py", typed)
    plant(tmp_path, "sim_host/stillspin/f.py", "from stillspin import a\n")
    found = [set(line.partition("imports: ")[2].split(" -> ")) for line in imports_found(tmp_path)]
    assert len(found) == 2
    assert {"stillspin.a", "stillspin.b", "stillspin.c"} in found
    assert {"stillspin.d", "stillspin.e"} in found
