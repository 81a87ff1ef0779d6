"""`stillspin schema`: the JSON schema of motor, profile and scenario files, for editors."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from stillspin import core
from stillspin.cases import file_schema
from stillspin.commands import parameter_file
from stillspin.errors import InputError, did_you_mean


def schema(
    *,
    kind: Annotated[str, typer.Argument(metavar="KIND", help="motor, profile or scenario.")],
    out: Annotated[Path | None, typer.Option("--out", "-o", help="File to write [default: to the terminal].")] = None,
) -> None:
    """Write the JSON schema of a kind of file; editors check a file with it whose first line is #:schema FILE."""
    if kind not in file_schema.KINDS:
        raise InputError(f"there is no kind of file '{kind}'{did_you_mean(kind, file_schema.KINDS)}")
    native = core.load()
    made = file_schema.schema(kind, core.plant_schema(native), core.parameters(native))
    content = json.dumps(made, indent=2, ensure_ascii=False) + "\n"
    if out is None:
        print(content, end="")
        return
    parameter_file.write(out, content)
    print(f"see {out}; begin a {kind} file beside it with: #:schema ./{out.name}")
