"""The stand-in for TI's compiler, for the tests of the image."""

import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FLASH = "toolchain/c28x/f2808_flash.cmd"


def compiled(tmp_path: Path, code: str) -> Path:
    """An object as the stand-in makes it."""
    source, target = tmp_path / "x.c", tmp_path / "x.obj"
    source.write_text(code, encoding="utf-8")
    cl2000 = ROOT / "toolchain/standin/bin/cl2000"
    run = [
        str(cl2000),
        "--compile_only",
        f"--c_file={source}",
        f"--include_path={ROOT}",
        f"--output_file={target}",
    ]
    subprocess.run(run, check=True)
    return target
