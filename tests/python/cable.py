"""A serial cable to a virtual board that a test can pull: at its computer's end, or at the board's."""

import contextlib
import os
import threading
import tty
from pathlib import Path

import serial


class Cable:
    """`port` is the name of the computer's end; it exists while the cable is in."""

    def __init__(self, board: str, directory) -> None:
        self.port = str(directory / "cable")
        self._board = serial.Serial(board, 115200, timeout=0.005)
        self._end = threading.Event()
        self._lock = threading.Lock()
        self._master = None
        self.cut = False  # a cable that is in the computer and not in the board: nothing arrives
        self.plug()
        self._thread = threading.Thread(target=self._carry, daemon=True)
        self._thread.start()

    def plug(self):
        master, self._slave = os.openpty()
        tty.setraw(self._slave)
        os.set_blocking(master, False)  # before the thread reads from it
        self._master = master
        Path(self.port).symlink_to(os.ttyname(self._slave))

    def pull(self):
        with self._lock:
            Path(self.port).unlink()
            os.close(self._slave)
            os.close(self._master)
            self._master = None

    def _carry(self):
        while not self._end.is_set():
            from_board = self._board.read(self._board.in_waiting or 1)
            with self._lock:
                if self._master is None or self.cut:
                    continue
                with contextlib.suppress(BlockingIOError, OSError):
                    if from_board:
                        os.write(self._master, from_board)
                    self._board.write(os.read(self._master, 4096))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._end.set()
        self._thread.join()
        self._board.close()
        if self._master is not None:
            self.pull()
