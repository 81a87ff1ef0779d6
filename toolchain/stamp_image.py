#!/usr/bin/env python3
"""Gives a linked image its check sum, by which the drive tests its flash at power-up (hal/hal_image.h).

Usage: toolchain/stamp_image.py IMAGE.out     (the build does it)
Exit status 0, or 2 for a file that is no image of the drive.
"""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "sim_host"))

from image.link import NO_CODE  # noqa: E402

from stillspin.errors import InputError  # noqa: E402
from stillspin.flash.image_sum import stamp  # noqa: E402


def main(path: Path) -> int:
    """Rewrites the file; see the module's text."""
    data = path.read_bytes()
    if data == NO_CODE.encode():
        print(f"{path.name}: {NO_CODE.strip()}; nothing to give a check sum to")
        return 0
    try:
        data, end, crc = stamp(data, str(path))
    except InputError as error:
        print(error, file=sys.stderr)
        return 2
    whole = path.with_suffix(".stamped")
    whole.write_bytes(data)
    whole.replace(path)
    print(f"{path.name}: CRC-32 0x{crc:08X} over 0x3E8000 to 0x{end - 1:06X}")
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
