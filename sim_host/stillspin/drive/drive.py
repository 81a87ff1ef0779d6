"""The drive as an object. Values are in the units that the drive's table states; angles in turns."""

from __future__ import annotations

from collections.abc import Callable

from stillspin.drive.acquisition import Acquisition
from stillspin.drive.commissioning import OnProgress, Report, follow
from stillspin.drive.connect import connect
from stillspin.drive.protocol import Command


class Drive(Acquisition):
    """One drive. Every method may be called from any thread; use it as a context, so that the port is given back."""

    @classmethod
    def open(cls, where: str, *, timeout: float = 0.6, progress: Callable[[float], None] | None = None) -> Drive:
        """The drive at an address such as serial:///dev/ttyUSB0?baud=115200 or can:slcan:/dev/ttyACM0?node=1.

        Raises:
            InputError: no address.
            DriveError: nothing can be opened there, or nothing answers.
        """
        return cls(connect(where), timeout=timeout, progress=progress)

    @classmethod
    def virtual(
        cls, profile: str = "bench", changes: list[str] | None = None, *, speed: float = 1.0, seed: int = 1
    ) -> Drive:
        """A virtual board in this process; `drive.link.transport` has its shaft (set_load, truth).

        Args:
            profile: the plant, a name from `stillspin list` or a TOML file.
            changes: as `run --set` takes them.
            speed: multiple of real time; 0 is as fast as possible.
            seed: of the noise.
        """
        from stillspin.board.virtual_transport import VirtualTransport  # noqa: PLC0415 - takes long to load

        return cls(VirtualTransport(profile, changes, speed=speed, seed=seed), timeout=2.0)

    def commission(self, on_progress: OnProgress | None = None) -> Report:
        """Let the drive measure machine and inverter. It takes about a minute and a half and turns the shaft.

        It ends with this program: the drive stops by itself when it hears nothing from this client.

        Args:
            on_progress: gets the share done, 0 to 1, and the phase in words, at the end what is not saved; False from
                it stops.

        Raises:
            DriveError: it was stopped, or ended in a fault.
        """
        with self.kept_alive():
            self.command(Command.COMMISSION, self.hold())
            return follow(self, on_progress)
