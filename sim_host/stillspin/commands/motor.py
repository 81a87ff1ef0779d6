"""`stillspin motor`: a file from what a nameplate says, and what will work with it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from stillspin import core
from stillspin.called import called
from stillspin.cases import motor_check, profile, questions
from stillspin.cases.motor_told import Motor
from stillspin.commands import parameter_file
from stillspin.counted import counted
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.one_line_errors import OneLineErrors
from stillspin.options import ProfileOption

app = typer.Typer(cls=OneLineErrors, help="Motor files: make one, check one.", rich_markup_mode=None)


@app.command()
def check(
    *,
    file: Annotated[str, typer.Argument(metavar="FILE", help="A motor's file, or the name of one that ships.")],
    profile_name: ProfileOption = "bench",
) -> None:
    """Say what will work with a motor and what will not, with numbers; exit status 1 when something will not."""
    native = core.load()
    schema, known = core.plant_schema(native), core.parameters(native)
    chosen = profile.load(profile_name, schema, known, file, checked=False)
    found = motor_check.findings(Motor(chosen, schema, known), native)
    for words in chosen.not_stated:
        print(f"note   {words}")
    for finding in found:
        print(f"{'works' if finding.works else 'WRONG':<6} {finding.title}: {finding.words}")
    wrong = sum(not finding.works for finding in found)
    print(f"{wrong} of {len(found)} will not work" if wrong else f"no problem found in {counted(len(found), 'check')}")
    if wrong:
        raise typer.Exit(ExitCode.SHORT)


def _asked(key: str) -> typer.models.OptionInfo:
    asked = next(question for question in questions.QUESTIONS if question.key == key)
    prompt = f"{asked.text}, {asked.unit}" if asked.unit else asked.text
    flag = f"--{key.replace('_', '-')}"
    option: typer.models.OptionInfo = typer.Option(flag, prompt=prompt, metavar="NUMBER", help=f"{prompt}.")
    return option


@app.command()
def new(
    *,
    file: Annotated[Path, typer.Argument(help="The file to write; one that exists is not touched.")],
    pole_pairs: Annotated[str, _asked("pole_pairs")],
    resistance: Annotated[str, _asked("resistance")],
    inductance_d: Annotated[str, _asked("inductance_d")],
    inductance_q: Annotated[str, _asked("inductance_q")],
    emf: Annotated[str, _asked("emf")],
    rated_current: Annotated[str, _asked("rated_current")],
    inertia: Annotated[str, _asked("inertia")],
    voltage: Annotated[str, _asked("voltage")],
    current_range: Annotated[str, _asked("current_range")],
    speed: Annotated[str, _asked("speed")],
) -> None:
    """Ask what a nameplate says, and write a motor's file; each question is an option, too."""
    if file.exists():
        raise InputError(f"{file}: exists already; name another file")
    typed = {
        "pole_pairs": pole_pairs,
        "resistance": resistance,
        "inductance_d": inductance_d,
        "inductance_q": inductance_q,
        "emf": emf,
        "rated_current": rated_current,
        "inertia": inertia,
        "voltage": voltage,
        "current_range": current_range,
        "speed": speed,
    }
    parameter_file.write(file, questions.file_text(file.stem, questions.read(typed)))
    print(f"{file} written; what will work with it: {called()} motor check {file}")
