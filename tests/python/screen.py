"""A program on a terminal, and what it draws there."""

import fcntl
import os
import pty
import struct
import subprocess
import sys
import termios
import time


def terminal(arguments, environment, seconds, size=(30, 100)):
    """What a program draws on a terminal of that size, whatever size the environment speaks of."""
    environment = {name: value for name, value in environment.items() if name not in {"COLUMNS", "LINES"}}
    master, slave = pty.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", *size, 0, 0))
    process = subprocess.Popen(
        [sys.executable, "-m", "stillspin", *arguments], stdin=slave, stdout=slave, stderr=slave, env=environment
    )
    os.close(slave)
    os.set_blocking(master, False)
    seen, end = b"", time.monotonic() + seconds
    while process.poll() is None and time.monotonic() < end:
        try:
            seen += os.read(master, 65536)
        except (BlockingIOError, OSError):
            time.sleep(0.02)
    process.terminate()
    process.wait()
    os.close(master)
    return seen.decode(errors="replace")
