"""`stillspin motor`: a file from what a nameplate says, and what will work with it."""

from __future__ import annotations

import json
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from stillspin import catalogue, core, json_schema, whole_file
from stillspin.called import called
from stillspin.cases import flux_table, motor_check, nameplate, profile, questions, similarity
from stillspin.cases.flux_table import Columns
from stillspin.cases.motor_told import Motor
from stillspin.commands import motor_defaults, schema
from stillspin.counted import counted
from stillspin.drive.own import firmware
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.one_line_errors import OneLineErrors
from stillspin.options import ProfileOption
from stillspin.report import tables
from stillspin.revision import revision

app = typer.Typer(cls=OneLineErrors, help="Motor files: make one, check one; the catalogue.", rich_markup_mode=None)


@app.command(name="list")
def list_(
    *,
    checked: Annotated[
        bool, typer.Option("--check", help="Say of each what `motor check` says with the profile of its name.")
    ] = False,
    out: Annotated[
        Path | None, typer.Option("--json", metavar="FILE", help="Write for programs what --check says.")
    ] = None,
) -> None:
    """The catalogue: motors of public data that `--motor` knows by name, and where the data are from.

    Each has a profile of the same name, a power stage and sensors that suit it: `--motor NAME --profile NAME`.
    """
    motors = catalogue.entries()
    verdicts = {}
    if checked or out:
        native = core.load()
        verdicts = {entry.name: catalogue.verdict(entry.name, native) for entry in motors}
    tables.catalogue(motors, verdicts)
    if out:
        said = {name: asdict(verdict) for name, verdict in verdicts.items()}
        content = {"revision": revision(), "firmware": firmware(), "motors": said}
        whole_file.write(out, json.dumps(content, indent=1, ensure_ascii=False) + "\n")


@app.command()
def check(
    *,
    file: Annotated[str, typer.Argument(metavar="FILE", help="A motor's file, or the name of one that ships.")],
    profile_name: ProfileOption = "bench",
) -> None:
    """Say what will work with a motor and what will not, with numbers; exit status 1 when something will not."""
    native = core.load()
    entries, known = core.plant_schema(native), core.parameters(native)
    chosen = profile.load(profile_name, entries, known, file, checked=False)
    known = core.at_scale(known, chosen.parameters)
    found = motor_check.findings(Motor(chosen, entries, known), native)
    for words in chosen.not_stated:
        print(f"note   {words}")
    for words in motor_defaults.notes(known, chosen.plant, chosen.parameters, chosen.by_rule):
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
    option: typer.models.OptionInfo = typer.Option(
        flag, prompt=prompt, parser=partial(_answer, asked), metavar="NUMBER", help=f"{prompt}."
    )
    return option


def _answer(asked: questions.Question, typed: str) -> float:
    """A complaint of this kind has the question asked again."""
    try:
        return asked.range.read(typed, asked.name)
    except InputError as error:
        raise typer.BadParameter(str(error)) from None


@app.command()
def new(
    *,
    file: Annotated[Path, typer.Argument(help="The file to write; one that exists is not touched.")],
    pole_pairs: Annotated[float, _asked("pole_pairs")],
    resistance: Annotated[float, _asked("resistance")],
    inductance_d: Annotated[float, _asked("inductance_d")],
    inductance_q: Annotated[float, _asked("inductance_q")],
    emf: Annotated[float, _asked("emf")],
    rated_current: Annotated[float, _asked("rated_current")],
    inertia: Annotated[float, _asked("inertia")],
    voltage: Annotated[float, _asked("voltage")],
    current_range: Annotated[float, _asked("current_range")],
    speed: Annotated[float, _asked("speed")],
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
    answers = questions.read(typed)
    plant = questions.plant(answers)
    _expect_in_range(plant)
    whole_file.write(file, questions.file_text(file.stem, answers))
    stated = questions.stated(answers)
    told = {**nameplate.following(plant, stated), **stated}
    known = core.at_scale(core.known_parameters(), told)
    sized = similarity.follow(plant, told, known)
    for words in motor_defaults.notes(known, plant, told | sized, sized):
        print(words)
    print(f"{file} written; what will work with it: {called()} motor check {file}")


def _expect_in_range(plant: core.Plant) -> None:
    """Complain about what no motor's file may say."""
    sections = json.loads(schema.text("motor"))["properties"]
    for section, values in plant.items():
        for key, value in values.items():
            if allowed := json_schema.number_range(sections[section]["properties"][key]):
                allowed.read(value, f"{section}.{key}")


@app.command()
def flux(
    *,
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A table of flux over current: .mat, .npz or .csv.")],
    out: Annotated[
        Path, typer.Option("--out", help="The table as the plant reads it; one that exists is not touched.")
    ],
) -> None:
    """Take over a machine's flux from a finite-element program or a measurement, for `flux_map` of a motor's file."""
    if out.exists():
        raise InputError(f"{out}: exists already; name another file")
    rows, turned = flux_table.along_d(flux_table.read(file))
    flux_table.write(out, rows, file.name)
    try:
        found = flux_table.told(str(out), core.load())
    except InputError:
        out.unlink()
        raise
    if turned:
        print("note: turned by a quarter of a turn: the magnet is along +d now, as the plant has it")
    print(f"{out}: {counted(len(rows), 'point')}, i_d {_span(rows[:, 0])}, i_q {_span(rows[:, 1])}")
    print(
        f"at zero current Ld {1e3 * found.inductance_d:.4g} mH, Lq {1e3 * found.inductance_q:.4g} mH, "
        f"magnet {found.magnet_flux:.4g} Vs; what is interpolated is off by at most {1e3 * found.misfit:.3g} mVs"
    )
    print(f'in the motor\'s file: [machine] flux_map = "{out.name}"')


def _span(values: Columns) -> str:
    return f"{values.min():.4g} … {values.max():.4g} A"
