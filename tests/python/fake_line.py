"""The line between the fake drive and its client: a pseudo-terminal, never waited for."""

import contextlib
import os
import pty
import time
import tty


class Line:
    """`name` is what the client opens."""

    def __init__(self):
        self._master, self._slave = pty.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self.name = os.ttyname(self._slave)
        self._open = True

    def hang_up(self):
        if self._open:
            self._open = False
            os.close(self._master)
            os.close(self._slave)

    def write(self, octets):
        while octets:
            with contextlib.suppress(BlockingIOError):
                octets = octets[os.write(self._master, octets) :]

    def read(self):
        try:
            return os.read(self._master, 4096)
        except (BlockingIOError, OSError):
            time.sleep(0.001)
            return b""
