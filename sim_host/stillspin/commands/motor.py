"""`stillspin motor`: a file from what a nameplate says, and what will work with it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from stillspin import core
from stillspin.cases import motor_check, profile
from stillspin.commands import parameter_file
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.one_line_errors import OneLineErrors
from stillspin.options import ProfileOption
from stillspin.quantity import Range

app = typer.Typer(cls=OneLineErrors, help="Motor files: make one, check one.", rich_markup_mode=None)


@app.command()
def check(
    *,
    file: Annotated[str, typer.Argument(metavar="FILE", help="A motor's file, or the name of one that ships.")],
    profile_name: ProfileOption = "bench",
) -> None:
    """Say what will work with a motor and what will not, with numbers; status 1 where something will not."""
    native = core.load()
    schema, known = core.plant_schema(native), core.parameters(native)
    chosen = profile.load(profile_name, schema, known, file, checked=False)
    found = motor_check.findings(motor_check.Motor(chosen, schema, known), native)
    for words in chosen.not_stated:
        print(f"note   {words}")
    for finding in found:
        print(f"{'works' if finding.works else 'WRONG':<6} {finding.title}: {finding.words}")
    wrong = sum(not finding.works for finding in found)
    print(f"{wrong} of {len(found)} will not work" if wrong else f"nothing speaks against it, {len(found)} looked at")
    if wrong:
        raise typer.Exit(ExitCode.SHORT)


def _asked(flag: str, question: str, help_: str) -> typer.models.OptionInfo:
    option: typer.models.OptionInfo = typer.Option(flag, prompt=question, metavar="NUMBER", help=help_)
    return option


@app.command()
def new(
    *,
    file: Annotated[Path, typer.Argument(help="The file to write; one that exists is not touched.")],
    pole_pairs: Annotated[str, _asked("--pole-pairs", "Pole pairs (half the number of poles)", "Pole pairs.")],
    resistance: Annotated[
        str, _asked("--resistance", "Resistance of a phase (half of that between wires), ohm", "ohm")
    ],
    inductance_d: Annotated[str, _asked("--inductance-d", "d-axis inductance of a phase (the smaller one), mH", "mH")],
    inductance_q: Annotated[str, _asked("--inductance-q", "q-axis inductance of a phase, mH", "mH")],
    emf: Annotated[str, _asked("--emf", "Voltage constant, V rms between two wires at 1000 rpm", "V per 1000 rpm")],
    rated_current: Annotated[str, _asked("--rated-current", "Rated current, A rms", "A rms")],
    inertia: Annotated[str, _asked("--inertia", "Inertia of rotor and load, kg m2", "kgm2")],
    voltage: Annotated[str, _asked("--voltage", "DC-link voltage, V", "V")],
    current_range: Annotated[str, _asked("--current-range", "Range of the board's current sensors, A", "A")],
    speed: Annotated[str, _asked("--speed", "Largest speed, rpm", "rpm")],
) -> None:
    """Ask what a nameplate says, and write a motor's file; each question is an option, too."""
    if file.exists():
        raise InputError(f"{file}: is there already")
    pairs = Range(1, 20, whole=True).read_whole(pole_pairs, "pole pairs")

    def positive(typed: str, name: str, unit: str) -> float:
        return Range(1e-9, unit=unit).read(typed, name)

    # V rms between wires at 1000 rpm to Vs peak of a phase: sqrt(2/3) over the electrical speed.
    flux = positive(emf, "voltage constant", "V") * (2.0 / 3.0) ** 0.5 / (pairs * 104.719755)
    peak = positive(rated_current, "rated current", "A") * 2.0**0.5
    sensors = positive(current_range, "current range", "A")
    link = positive(voltage, "DC-link voltage", "V")
    content = f"""description = "{file.stem}"

[machine]
pole_pairs = {pairs}
resistance = {positive(resistance, "resistance", "ohm"):g}  # ohm, of a phase
inductance_d = {positive(inductance_d, "d-axis inductance", "mH") / 1e3:g}  # H
inductance_q = {positive(inductance_q, "q-axis inductance", "mH") / 1e3:g}  # H
magnet_flux = {flux:.6g}  # Vs, peak
rated_peak_current = {peak:.6g}  # A
cross_inductance = 0.0  # H, not on a nameplate

[mechanics]
inertia = {positive(inertia, "inertia", "kgm2"):g}  # kg m2, rotor and load
viscous_friction = 0.0  # N m s, not on a nameplate

[link]
source_voltage = {link:g}  # V
brake_on_voltage = {1.33 * link:.6g}
brake_off_voltage = {1.3 * link:.6g}

[adc]
current_range = {sensors:g}  # A, of the sensors
voltage_range = {1.5 * link:.6g}  # V, of the link's divider

[parameters]
current_limit = {min(1.3 * peak, 0.7 * sensors):.4g}  # A, peak
speed_limit = {positive(speed, "largest speed", "rpm"):g}  # rpm
"""
    parameter_file.write(file, content)
    print(f"see {file}; what will work: stillspin motor check {file}")
