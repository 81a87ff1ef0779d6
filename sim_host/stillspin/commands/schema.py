"""`stillspin schema`: the JSON schema of the files that people write, for editors."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from stillspin import core, whole_file
from stillspin.campaign import faults, spread
from stillspin.cases import file_schema
from stillspin.errors import InputError, did_you_mean
from stillspin.resources import PACKAGE

_OF_CAMPAIGNS = {"spread": spread.schema, "faults": faults.schema}
KINDS = (*file_schema.KINDS, *_OF_CAMPAIGNS)
SHIPPED = Path("schemas")
"""In a wheel, which has no native module to ask: KIND.json for each, put there by toolchain/wheel.py."""


def schema(
    *,
    kind: Annotated[str, typer.Argument(metavar="KIND", help="motor, profile, scenario, spread or faults.")],
    out: Annotated[Path | None, typer.Option("--out", "-o", help="File to write [default: to the terminal].")] = None,
) -> None:
    """Write the JSON schema of a kind of file, for editors: they check a file whose first line is #:schema FILE."""
    if kind not in KINDS:
        raise InputError(f"there is no kind of file '{kind}'{did_you_mean(kind, KINDS)}")
    content = text(kind)
    if out is None:
        print(content, end="")
        return
    whole_file.write(out, content)
    print(f"see {out}; begin a {kind} file beside it with: #:schema ./{out.name}")


def text(kind: str) -> str:
    """The schema of a kind of file, one of KINDS.

    Raises:
        InputError: there is neither a shipped one nor a virtual drive to ask.
    """
    shipped = PACKAGE / SHIPPED / f"{kind}.json"
    return shipped.read_text(encoding="utf-8") if shipped.is_file() else made(kind)


def made(kind: str) -> str:
    """The same by the virtual drive's own entries and parameters.

    Raises:
        InputError: there is no virtual drive to ask.
    """
    native = core.load()
    entries = core.plant_schema(native)
    of_campaign = _OF_CAMPAIGNS.get(kind)
    known = core.at_some_scale(core.parameters(native))
    found = of_campaign(entries) if of_campaign else file_schema.schema(kind, entries, known)
    return json.dumps(found, indent=2, ensure_ascii=False) + "\n"
