"""`stillspin type-test`: what a motor does with its drive, from the first start to its top speed."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from stillspin import catalogue, csv_table, resources
from stillspin.campaign import units
from stillspin.campaign.judge import End
from stillspin.commands.campaign_options import CampaignOptions, bar, is_default, with_campaign_options
from stillspin.counted import counted
from stillspin.drive.own import firmware
from stillspin.exit_codes import ExitCode
from stillspin.options import CommissionOption
from stillspin.report import junit, output, tables
from stillspin.report.progress import Counter
from stillspin.revision import revision
from stillspin.studies.reproduction import write_found
from stillspin.type_test import carry_out, duties, findings
from stillspin.type_test.carry_out import Row
from stillspin.type_test.findings import Finding

NAME = "type-test"
EXAMPLES = (
    "Examples: `stillspin type-test compressor_12a` is a motor of the catalogue with the profile of its name; "
    "`stillspin type-test pump.toml --few` is one of your own, with six initial angles; `stillspin type-test "
    "--catalogue` is all that ship."
)
CASES = "duties.csv"
_SHOWN = 10  # failures in words on the terminal; all are in the table


@with_campaign_options
def type_test(
    *,
    context: typer.Context,
    motors: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[MOTOR]...",
            help="Names from `stillspin list` or the catalogue, or files [default: A].",
            show_default=False,
        ),
    ] = None,
    all_: Annotated[bool, typer.Option("--catalogue", help="All motors that ship.")] = False,
    few: Annotated[
        bool, typer.Option("--few", help=f"Start from {duties.FEW} initial angles in the place of {duties.ANGLES}.")
    ] = False,
    common: CampaignOptions,
    commission_first: CommissionOption = True,
    out: Annotated[Path, typer.Option("--out", "-o", help="Directory of the results.")] = Path("results-type-test"),
) -> None:
    """Commission the drive, then try starts, crawling, load, reversal, weakening and rest, sized by the motor's data.

    Every initial angle, direction and load of a start, rated torque at four speeds, a shaft that turns already, and so
    on; each judged on the true shaft. What a motor without saliency cannot do by its nature is not asked of it. A motor
    takes a minute or two. Exit status 1 when in some run the shaft did not do what was asked and the drive had not said
    so before.
    """
    named = _motors(motors or [], all_)
    profile = None if is_default(context, "profile_name") else common.profile_name
    wish = units.Wish(
        named, common.seed, profile, firmware(), common.changes, common.params, common.scheme, commission_first
    )
    plain = units.nominal(wish)
    with junit.Report(common.junit_file, NAME, firmware) as verdicts, output.fresh_directory(out) as place:
        told = units.told(wish, plain, bar, common.where)
        todo = [
            (unit, duty) for unit in told.units for duty in carry_out.asked(unit, duties.FEW if few else duties.ANGLES)
        ]
        with Counter(Console(stderr=True), len(todo)) as counter:
            rows = carry_out.run(todo, common.where, counter.one_more)
        verdicts.add(map(_verdict, rows))
        found = [
            findings.of(unit, told.found.get(unit.motor), [row for row in rows if row.motor == unit.motor])
            for unit in told.units
        ]
        _write(place, wish, told, rows, found)
    tables.type_test(row for one in found for row in one.rows())
    _say(rows, found)
    print(f"see {out / output.MARK} and {out / CASES}")
    if any(one.failed for one in found):
        raise typer.Exit(ExitCode.SHORT)


def _motors(words: Sequence[str], all_: bool) -> list[str]:
    """The motors named, each once; with `all_` those that ship behind them; A where there is none."""
    ship = [*resources.names("motors"), *(entry.name for entry in catalogue.entries())] if all_ else []
    return list(dict.fromkeys([*words, *ship])) or [resources.DEFAULT_MOTOR]


def _write(place: Path, wish: units.Wish, told: units.Told, rows: Sequence[Row], found: Sequence[Finding]) -> None:
    by_name = {unit.motor: unit for unit in told.units}
    for motor, result in told.found.items():
        settings = by_name[motor].settings
        write_found(place / f"params-{settings.profile.motor}.toml", result, settings)
    about = {
        "revision": revision(),
        "firmware": wish.firmware,
        "seed": wish.seed,
        "profiles": {unit.motor: unit.profile for unit in told.units},
        "doubted": told.doubted,
        "motors": {one.motor: one.published() for one in found},
    }
    (place / output.MARK).write_text(json.dumps(about, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
    names = ("motor", "duty", "of", "end", "words", "wrong_s", "off_s", "angle_error_deg")
    head = {key: about[key] for key in ("firmware", "revision", "seed")}
    csv_table.write(place / CASES, head, names, map(_cells, rows))


def _cells(row: Row) -> tuple[object, ...]:
    ended = row.verdict
    return (row.motor, row.duty.kind, row.duty.of, ended.end, ended.words, ended.wrong, ended.off, ended.error)


def _verdict(row: Row) -> junit.TestCase:
    kind = {End.GOOD: "", End.REFUSED: "skipped", End.FAILED: "failure"}[row.verdict.end]
    return junit.TestCase(f"{NAME}.{row.motor}", f"{row.duty.kind}, {row.duty.of}", 0.0, kind, row.verdict.words)


def _say(rows: Sequence[Row], found: Sequence[Finding]) -> None:
    failed = [row for row in rows if row.verdict.failed]
    for row in failed[:_SHOWN]:
        print(f"stillspin: {row.motor}, {row.duty.kind}, {row.duty.of}: failed: {row.verdict.words}", file=sys.stderr)
    if len(failed) > _SHOWN:
        print(f"stillspin: and {len(failed) - _SHOWN} more, see {CASES}", file=sys.stderr)
    for one in found:
        if one.refusal:
            print(f"{one.motor}: refused: {one.refusal}")
    print(f"{counted(len(failed), 'run', len(rows))} failed")
