"""`stillspin schema`: the JSON schema of the files that people write, for editors."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from stillspin import core
from stillspin.campaign import faults, spread
from stillspin.cases import file_schema
from stillspin.commands import parameter_file
from stillspin.errors import InputError, did_you_mean

_OF_CAMPAIGNS = {"spread": spread.schema, "faults": faults.schema}


def schema(
    *,
    kind: Annotated[str, typer.Argument(metavar="KIND", help="motor, profile, scenario, spread or faults.")],
    out: Annotated[Path | None, typer.Option("--out", "-o", help="File to write [default: to the terminal].")] = None,
) -> None:
    """Write the JSON schema of a kind of file; editors check a file with it whose first line is #:schema FILE."""
    if kind not in (*file_schema.KINDS, *_OF_CAMPAIGNS):
        raise InputError(f"there is no kind of file '{kind}'{did_you_mean(kind, (*file_schema.KINDS, *_OF_CAMPAIGNS))}")
    native = core.load()
    entries = core.plant_schema(native)
    of_campaign = _OF_CAMPAIGNS.get(kind)
    made = of_campaign(entries) if of_campaign else file_schema.schema(kind, entries, core.parameters(native))
    content = json.dumps(made, indent=2, ensure_ascii=False) + "\n"
    if out is None:
        print(content, end="")
        return
    parameter_file.write(out, content)
    print(f"see {out}; begin a {kind} file beside it with: #:schema ./{out.name}")
