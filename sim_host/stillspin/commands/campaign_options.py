"""The options that campaigns have in common, listed once: a command takes them as one argument."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import typer
from rich.console import Console

from stillspin.campaign.units import Show
from stillspin.options import (
    ChangeOption,
    ClusterOption,
    JobsOption,
    ParamsOption,
    ProfileOption,
    SchemeOption,
    SeedOption,
    processors,
)
from stillspin.report.junit import JunitOption
from stillspin.report.progress import PhaseBar
from stillspin.runs.workers import Where


@dataclass(frozen=True)
class CampaignOptions:
    """What plant and drive are, who works, and where the verdicts go."""

    profile_name: ProfileOption = "bench"
    seed: SeedOption = 1
    change: ChangeOption = None
    params: ParamsOption = None
    scheme: SchemeOption = None
    jobs: JobsOption = None
    cluster: ClusterOption = ""
    junit_file: JunitOption = None

    @property
    def changes(self) -> list[str]:
        """As `--set` has them."""
        return self.change or []

    @property
    def where(self) -> Where:
        """Who works."""
        return Where(self.jobs or processors(), self.cluster)


def with_campaign_options(command: Callable[..., None]) -> Callable[..., None]:
    """The command with each of these options in the place of its argument `common`."""
    own = inspect.signature(command, eval_str=True).parameters
    each = inspect.signature(CampaignOptions, eval_str=True).parameters
    spread = [field.replace(kind=inspect.Parameter.KEYWORD_ONLY) for field in each.values()]
    parameters = [new for old in own.values() for new in (spread if old.annotation is CampaignOptions else [old])]

    @functools.wraps(command)
    def called(**given: Any) -> None:
        common = CampaignOptions(**{name: given.pop(name) for name in each})
        command(**given, common=common)

    called.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    called.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return called


def is_default(context: typer.Context, name: str) -> bool:
    """Whether nobody has given the option."""
    source = context.get_parameter_source(name)
    return source is not None and source.name == "DEFAULT"


@contextmanager
def bar() -> Iterator[Show]:
    """How far a commissioning is, on the terminal."""
    with PhaseBar(Console(stderr=True)) as drawn:
        yield drawn.show
