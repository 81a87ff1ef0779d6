"""The commands of `stillspin`: each is imported when it is asked for, as most take long to load."""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

import typer

_PLACES = {
    "run": "campaigns.run",
    "reproduce": "campaigns.reproduce",
    "drift": "campaigns.drift",
    "explain": "explain.explain",
    "commission": "commission.commission",
    "board": "board.board",
    "startup-matrix": "startup.startup_matrix",
    "type-test": "type_test.type_test",
    "round-trips": "round_trips.round_trips",
    "campaign": "campaign.campaign",
    "console": "console.console",
    "schema": "schema.schema",
    "scope": "scope.scope",
    "monitor": "monitor.monitor",
    "can": "can_bus.bus",
    "tune": "tune.tune",
    "hil": "hil.hil",
    "flash": "flash.flash",
    "demo-image": "flash.demo_image",
    "loader": "loader.loader",
    "list": "about.list_",
    "version": "about.version",
    "params": "params.app",
    "motor": "motor.app",
    "image": "image.app",
}
"""Module and function, or group, of each, in the order of the help."""


class ByName(Mapping[str, Any]):
    """All commands as typer has them."""

    def __getitem__(self, name: str) -> Any:
        """See Mapping."""
        return _command(name)

    def __iter__(self) -> Iterator[str]:
        """See Mapping."""
        return iter(_PLACES)

    def __len__(self) -> int:
        """See Mapping."""
        return len(_PLACES)


def own_version() -> str:
    """What `stillspin --version` says, as `stillspin version`."""
    text: str = importlib.import_module(f"{__name__}.about").own()
    return text


@cache
def _command(name: str) -> Any:
    module, function = _PLACES[name].split(".")
    there = importlib.import_module(f"{__name__}.{module}")
    found, alone = getattr(there, function), typer.Typer(rich_markup_mode=None)
    if isinstance(found, typer.Typer):
        alone.add_typer(found, name=name)
    else:
        alone.command(name=name, epilog=getattr(there, "EXAMPLES", None))(found)
    return typer.main.get_group(alone).commands[name]
