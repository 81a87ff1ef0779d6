"""`stillspin campaign`: Monte Carlo over what differs from unit to unit, judged on the true shaft."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from stillspin import core, resources
from stillspin.campaign import carry_out, directory, faults, results, spread, tally, units
from stillspin.campaign.draw import Case, Drawer, Unit
from stillspin.campaign.judge import End, Verdict
from stillspin.campaign.results import Row
from stillspin.commands.campaign_options import CampaignOptions, bar, is_default, with_campaign_options
from stillspin.counted import counted
from stillspin.drive.own import firmware
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.options import CommissionOption, number, whole
from stillspin.report import junit, output
from stillspin.report.progress import Counter
from stillspin.revision import revision
from stillspin.runs.workers import Where

NAME = "campaign"
EXAMPLES = (
    "Examples: `stillspin campaign -n 200` is motor A; `stillspin campaign --motors A,B --faults usual -n 100 "
    "--json cases.jsonl` adds faults and keeps each case, so that the same with --resume goes on; "
    "`stillspin campaign --case 17` runs one case again and says what was drawn for it."
)
_SHOWN = 10  # failures in words on the terminal; all are in the table
_MOST = 100_000  # cases of a motor


@with_campaign_options
def campaign(
    *,
    context: typer.Context,
    motors: Annotated[
        list[str] | None,
        typer.Option(
            "--motors", metavar="NAME,…", help="Names from `stillspin list`, or files; repeatable [default: A]."
        ),
    ] = None,
    spread_name: Annotated[
        str,
        typer.Option(
            "--spread",
            metavar="NAME",
            help="What differs from unit to unit: a name from `stillspin list`, or a TOML file.",
        ),
    ] = "manufacturing",
    faults_name: Annotated[
        str,
        typer.Option(
            "--faults",
            metavar="NAME",
            help="What breaks: a name from `stillspin list`, or a TOML file [default: nothing].",
        ),
    ] = "",
    count: Annotated[
        int,
        typer.Option(
            "--runs", "-n", metavar="N", parser=whole("--runs", 1, _MOST), help="How many cases of each motor."
        ),
    ] = 100,
    case: Annotated[
        list[int] | None,
        typer.Option(
            "--case", metavar="N", parser=whole("--case", 1, _MOST), help="Only the case of this number. Repeatable."
        ),
    ] = None,
    may_fail: Annotated[
        int,
        typer.Option(
            "--may-fail",
            metavar="N",
            parser=whole("--may-fail", 0, _MOST),
            help="How many cases may fail before the exit status is 1.",
        ),
    ] = 0,
    may_refuse: Annotated[
        float,
        typer.Option(
            "--may-refuse",
            metavar="PERCENT",
            parser=number("--may-refuse", 0, 100, "%"),
            help="What share of the cases without a fault the drive may refuse before the exit status is 1.",
        ),
    ] = 5.0,
    smallest: Annotated[
        int,
        typer.Option(
            "--shrink",
            metavar="N",
            parser=whole("--shrink", 0, _MOST),
            help="Of up to so many failed cases find what alone makes each fail, and write it as a scenario file.",
        ),
    ] = 3,
    file: Annotated[
        Path | None, typer.Option("--json", metavar="FILE", help="Keep each case in this file as a line of JSON.")
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with the FILE of --json: leave out the cases that it has.")
    ] = False,
    common: CampaignOptions,
    commission_first: CommissionOption = True,
    out: Annotated[Path, typer.Option("--out", "-o", help="Directory of the results.")] = Path("results-campaign"),
) -> None:
    """Run motors with values drawn at random through one duty, judge the true shaft, and say what share fails.

    Each case is drawn by the seed and its number alone. The drive is commissioned once on the nominal unit. A motor of
    the catalogue has the profile of its name, where --profile names none. Exit status 1 when more cases fail than
    --may-fail says, or more are refused than --may-refuse says.
    """
    named_motors = _motors(motors or [])
    schema = core.plant_schema(core.load())
    broken = faults.load(faults_name, schema) if faults_name else faults.Faults()
    drawer = Drawer(spread.load(spread_name, schema), broken, common.seed)
    wish = units.Wish(
        named_motors,
        common.seed,
        None if is_default(context, "profile_name") else common.profile_name,
        firmware(),
        common.changes,
        common.params,
        common.scheme,
        commission_first,
    )
    plain = units.nominal(wish)
    carry_out.check(plain, drawer)
    about = _about(wish, plain, drawer)
    kept = results.Results(file, about, resume)
    numbers = sorted(set(case)) if case else range(1, count + 1)
    wanted = [(motor, each) for motor in named_motors for each in numbers]
    with junit.Report(common.junit_file, NAME, firmware) as verdicts, output.fresh_directory(out) as place:
        told = units.told(wish, plain, bar, common.where)
        named = {unit.motor: unit for unit in told.units}
        todo = [(named[motor], drawer.case(each)) for motor, each in wanted if (motor, each) not in kept.rows]
        try:
            _run(todo, drawer, common.where, kept)
            kept.put_in_order()
        finally:
            rows = [kept.rows[key] for key in wanted if key in kept.rows]
            verdicts.add(map(_verdict, rows))
        failed = [row for row in rows if row.verdict.failed]
        small = _shrunk(failed[:smallest], named, drawer, common.where)
        shrunk = directory.write(place, out, directory.Outcome(about, rows, small, named, told.found, drawer))
    _say(rows, failed, drawer, named_motors, bool(case))
    for words in [*shrunk, *told.doubted]:
        print(f"stillspin: {words}", file=sys.stderr)
    print(f"see {out / output.MARK} and {out / directory.CASES}")
    if len(failed) > may_fail or told.doubted or tally.tally(tally.plain(rows)).refused_share > may_refuse:
        raise typer.Exit(ExitCode.SHORT)


def _motors(words: Sequence[str]) -> list[str]:
    """The motors named, each once; A where none is."""
    named = [name.strip() for word in words for name in word.split(",")]
    if "" in named:
        raise InputError(f"--motors '{','.join(words)}': has a comma with no motor beside it")
    return list(dict.fromkeys(named)) or [resources.DEFAULT_MOTOR]


def _about(wish: units.Wish, plain: Sequence[Unit], drawer: Drawer) -> dict[str, object]:
    """What makes a campaign this one: a case of another is none of its cases."""
    return {
        "revision": revision(),
        "firmware": wish.firmware,
        "profiles": {unit.motor: unit.profile for unit in plain},
        "spread": drawer.spread.name,
        "faults": drawer.faults.name,
        "seed": wish.seed,
        "commission": wish.commission,
        "drawn_from": drawer.mark,
        "units": {unit.motor: unit.mark for unit in plain},
    }


def _run(todo: Sequence[tuple[Unit, Case]], drawer: Drawer, where: Where, kept: results.Results) -> None:
    """All cases that are left; a motor that the drive refuses altogether is refused in each of them."""
    with Counter(Console(stderr=True), len(todo)) as counter:

        def done(row: Row) -> None:
            kept.add(row)
            counter.one_more(row)

        for unit, case in todo:
            if unit.refusal:
                done(Row(unit.motor, case, Verdict(End.REFUSED, unit.refusal)))
        carry_out.run([each for each in todo if not each[0].refusal], drawer, where, done)


def _shrunk(failed: Sequence[Row], named: Mapping[str, Unit], drawer: Drawer, where: Where) -> list[carry_out.Small]:
    if not failed:
        return []
    print(f"shrinking {counted(len(failed), 'failure')}", file=sys.stderr)
    with Counter(Console(stderr=True), len(failed)) as counter:
        return carry_out.shrink_all([(named[row.motor], row) for row in failed], drawer, where, counter.one_more)


def _verdict(row: Row) -> junit.TestCase:
    verdict = row.verdict
    kind = {End.GOOD: "", End.REFUSED: "skipped", End.FAILED: "failure"}[verdict.end]
    return junit.TestCase(f"{NAME}.{row.motor}", f"case {row.case.number}", 0.0, kind, verdict.words)


def _say(rows: Sequence[Row], failed: Sequence[Row], drawer: Drawer, motors: Sequence[str], each: bool) -> None:
    """What came of it; `each`: also of every case, with what was drawn for it."""
    for row in rows if each else ():
        print(f"{row.motor}, case {row.case.number}: {row.verdict.end}; {drawer.words(row.case)}")
    for row in failed[:_SHOWN]:
        print(f"stillspin: {row.motor}, case {row.case.number}: failed: {row.verdict.words}", file=sys.stderr)
    if len(failed) > _SHOWN:
        print(f"stillspin: and {len(failed) - _SHOWN} more, see {directory.CASES}", file=sys.stderr)
    for words, times in tally.reasons(rows).most_common():
        print(f"refused, {counted(times, 'case')}: {words}")
    for line in tally.lines(rows, motors):
        print(line)
