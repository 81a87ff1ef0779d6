"""Which effect makes a scenario's figures what they are: each switched off in turn, and each alone on `ideal`.

The drive is commissioned once, on the plant as it is, and keeps what it found. Where an effect is itself something that
commissioning measures, it is commissioned anew on the plant that has changed: else the drive would be wrong about
what is no longer there.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from rich.console import Console

from stillspin import core
from stillspin.cases import profile
from stillspin.cases.scenario import Scenario
from stillspin.drive.own import firmware
from stillspin.options import by_mark
from stillspin.report import explain_report, output
from stillspin.report.explanation import Explanation
from stillspin.report.progress import Bar
from stillspin.revision import revision
from stillspin.runs import campaign, commission, effects, execute
from stillspin.runs.assess import ScenarioResult
from stillspin.runs.effects import ALONE, WITHOUT, Case, Effect, Worlds
from stillspin.runs.execute import Settings
from stillspin.runs.reporting import report
from stillspin.runs.workers import Task, Where, workers

IDEAL = "ideal"


@dataclass(frozen=True)
class Options:
    """What is wanted.

    Attributes:
        profile: a name or a path; out: the directory of the results; where: by whom.
        params: a parameter file instead of the commissioning on the plant as it is.
        only: marks of effects, none for all; alone: whether to run each alone on `ideal`, too.
    """

    profile: str
    seed: int
    out: Path
    where: Where = field(default_factory=Where)
    params: Path | None = None
    only: Sequence[str] = ()
    alone: bool = True


def carry_out(scenario: Scenario, options: Options) -> Explanation:
    """Run everything and write `metrics.json`, `explain.svg` and the records; these appear whole or not at all.

    Raises:
        InputError: something asked for does not exist or does not fit together.
        CampaignError: a commissioning broke off, or a worker died.
    """
    native = core.load()
    schema, known = core.plant_schema(native), core.parameters(native)
    worlds = Worlds(
        profile.load(options.profile, schema, known, scenario.motor),
        profile.load(IDEAL, schema, known, scenario.motor),
        schema,
        known,
    )
    profile.say_not_stated(worlds.own)
    listed = [item for item in by_mark(effects.load(schema, known), options.only, "effect") if worlds.differs(item)]
    told = commission.load(options.params, known, worlds.own.parameters) if options.params else None
    execute.prepare(scenario, _settings(worlds.own, options.seed, told or {}), native)  # complains at once
    cases = _cases(worlds, listed, told, options)
    with output.fresh_directory(options.out) as directory:
        todo = [(each.scenario(scenario), each.settings) for each in cases]
        jobs = [job for varied, settings in todo for job in execute.prepare(varied, settings, native)]
        runs = directory / output.RUNS
        plan = campaign.Plan([varied for varied, _ in todo], jobs, runs, worlds.own.name)
        with Bar(Console(stderr=True)) as bar:
            results = campaign.run_all(plan, options.where, bar)
        found = _explanation(scenario, cases, results, options)
        explain_report.write(directory, found, cases[0].settings)
    return found


def _settings(where: profile.Profile, seed: int, told: dict[str, float]) -> Settings:
    parameters = {**where.parameters, **told}
    return Settings(replace(where, parameters=parameters), profile.Changes(), seed, revision(), firmware=firmware())


def _cases(worlds: Worlds, listed: Sequence[Effect], told: dict[str, float] | None, options: Options) -> list[Case]:
    """As it is, without each, ideal, each alone; commissioned where that is called for."""
    seed = options.seed
    own, plain = _settings(worlds.own, seed, {}), _settings(worlds.ideal, seed, {})
    new = [effects.case(WITHOUT, item, own, worlds) for item in listed if item.commission and not item.exact]
    if options.alone:
        new += [effects.case(ALONE, item, plain, worlds) for item in listed if item.commission and not item.exact]
    measures = worlds.own.commission
    first = [Case(WITHOUT, None, own)] if told is None and measures else []
    found = dict(zip([each.mark for each in [*first, *new]], _found([*first, *new], options.where), strict=True))
    base = _settings(worlds.own, seed, found.get(f"{WITHOUT}-nothing", told or {}))
    cases = [Case(WITHOUT, None, base)]
    cases += [_with(effects.case(WITHOUT, item, base, worlds), own, found, worlds) for item in listed]
    if options.alone:
        cases.append(Case(ALONE, None, plain))
        alone = [effects.case(ALONE, item, plain, worlds) for item in listed if not item.exact]
        cases += [_with(each, plain, found, worlds) for each in alone]
    return cases


def _with(each: Case, before: Settings, found: dict[str, dict[str, float]], worlds: Worlds) -> Case:
    """The case on a commissioning of its own, where it has one."""
    if each.mark not in found:
        return each
    fresh = effects.case(each.kind, each.effect, before, worlds)
    parameters = {**fresh.settings.profile.parameters, **found[each.mark]}
    return replace(
        fresh, settings=replace(fresh.settings, profile=replace(fresh.settings.profile, parameters=parameters))
    )


def _found(cases: Sequence[Case], where: Where) -> list[dict[str, float]]:
    """What each case's commissioning believes to have found."""
    found: dict[int, dict[str, float]] = {}
    with workers(where) as crew:
        for task, told in crew.finished(deque(Task(_commission, (case,), number) for number, case in enumerate(cases))):
            found[task.tag] = told
    return [found[number] for number in range(len(cases))]


def _commission(each: Case) -> dict[str, float]:
    settings = each.settings
    native, seed = core.load(), settings.seed
    return commission.run(native, settings.profile, settings.changes, seed, lambda share, _phase: report(0, share)).told


def _explanation(
    scenario: Scenario, cases: Sequence[Case], results: Sequence[ScenarioResult], options: Options
) -> Explanation:
    by_case = {each.mark: result for each, result in zip(cases, results, strict=True)}
    listed = list({each.effect.mark: each.effect for each in cases if each.effect}.values())
    return Explanation(scenario, listed, by_case, options.alone)
