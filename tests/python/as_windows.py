"""Imports every module of the client as if this were Windows; run as a program. Says what a pseudo-terminal says there.

Other people's modules are loaded before: they choose their way by the same name of the platform.
"""

import builtins
import importlib
import os
import pkgutil
import signal
import sys

OTHERS = (
    *("aiohttp.web", "can.interfaces.slcan", "cantools.database", "concurrent.futures.process"),
    *("prompt_toolkit.history", "rich.live", "rich.progress", "serial.tools.list_ports", "typer.core"),
)
ABSENT = {"fcntl", "grp", "pty", "pwd", "resource", "termios", "tty"}
DRAWS = {f"stillspin.report.{name}" for name in ("canvas", "explain_plot", "plots", "special_plots")}
"""Need matplotlib, which the client alone has not, and are loaded by what has asked for it."""
as_ever = builtins.__import__


def as_on_windows(name, *others, **named):
    """Import, but for the modules that Windows does not have."""
    names = others[0] if others else named.get("globals")
    if name in ABSENT and (names or {}).get("__name__", "").startswith("stillspin"):
        raise ModuleNotFoundError(f"No module named {name!r}", name=name)
    return as_ever(name, *others, **named)


for other in OTHERS:
    importlib.import_module(other)
builtins.__import__ = as_on_windows
sys.platform = "win32"
for absent in ("openpty", "sched_getaffinity", "getuid", "fork", "ttyname", "mkfifo"):
    delattr(os, absent)
for absent in ("SIGALRM", "SIGHUP", "SIGKILL", "SIGPIPE", "SIGUSR1"):
    delattr(signal, absent)

package = importlib.import_module("stillspin")
for module in pkgutil.walk_packages(package.__path__, "stillspin."):
    if module.name not in DRAWS | {"stillspin.__main__"}:
        importlib.import_module(module.name)
assert importlib.import_module("stillspin.options").processors() >= 1
try:
    importlib.import_module("stillspin.board.pseudo_terminal").PseudoTerminal()
except importlib.import_module("stillspin.errors").InputError as error:
    print(error)
