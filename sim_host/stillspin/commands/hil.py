"""`stillspin hil`: a board computes scenarios period by period and has to agree with the virtual drive to the bit."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from stillspin import core
from stillspin.board import image as images
from stillspin.commands.campaign_options import CampaignOptions, is_default, with_campaign_options
from stillspin.commands.connection import DriveOption, wanted
from stillspin.core import Progress
from stillspin.counted import counted
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.flash.files import read_boot_rom
from stillspin.hil import Difference, boards, built, campaign, runs
from stillspin.hil.boards import Board
from stillspin.hil.recording import RecordingWriter
from stillspin.hil.results import Results, Row, begun
from stillspin.hil.runs import LoopRun
from stillspin.hil.wish import Wish
from stillspin.link import address
from stillspin.link.errors import NoAnswerError
from stillspin.options import NEEDS_IMAGE, RomOption
from stillspin.report import junit, tables
from stillspin.report.progress import Counter, PhaseBar
from stillspin.revision import revision
from stillspin.runs.workers import Where

_VIRTUAL = "virtual"
_WITH_PLAY = {"play", "port", "can", "where", "image", "rom", "file", "junit_file", "scenarios"}
"""What means something where a recording is played: the board, and where the verdicts go."""


@with_campaign_options
def hil(
    *,
    context: typer.Context,
    scenarios: Annotated[
        list[str] | None,
        typer.Argument(metavar="ID...", help="Scenarios, such as A10; commission; all for everything."),
    ] = None,
    port: Annotated[
        str,
        typer.Option(
            "--port",
            metavar="PORT",
            help="The board's serial port: /dev/ttyUSB0, or with ?baud=390625; virtual for boards of its own.",
        ),
    ] = "",
    can: Annotated[
        str,
        typer.Option(
            "--can",
            metavar="ADAPTER",
            help="An SLCAN adapter: /dev/ttyACM0?node=1; socketcan:can0; virtual for boards of its own.",
        ),
    ] = "",
    where: DriveOption = "",
    image: Annotated[
        Path | None,
        typer.Option("--image", metavar="FILE", help="A virtual board that executes this image of the C28x."),
    ] = None,
    rom: RomOption = None,
    check: Annotated[
        bool, typer.Option("--check", help=f"Only the start and the first {runs.CHECK:g} s of every run.")
    ] = False,
    file: Annotated[Path | None, typer.Option("--json", metavar="FILE", help="Add the results to this file.")] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Leave out runs that FILE has as identical, made from these sources.")
    ] = False,
    common: CampaignOptions,
    only: Annotated[list[str] | None, typer.Option("--run", help="Only this run of the scenario. Repeatable.")] = None,
    recording: Annotated[
        Path | None,
        typer.Option("--record", metavar="FILE", help="Keep what board and computer say for --play; runs take longer."),
    ] = None,
    play: Annotated[
        Path | None,
        typer.Option("--play", metavar="FILE", help="A recording in the place of scenarios: needs no virtual drive."),
    ] = None,
) -> None:
    """Step a board through scenarios: this computer runs the plant, and compares every answer bit for bit.

    The board is compared with a virtual drive of its own edition. Its power stage stays off; at the end of the
    command a reset takes it out of this mode.
    Virtual boards do as many runs at a time as --jobs says, a real one does one.
    Exit status 0 when every run is identical, 4 when one differs.
    """
    of = revision()
    if rom and not image:
        raise InputError(NEEDS_IMAGE)
    if (play is None) != bool(scenarios):
        raise InputError("name scenarios, such as A10, or give --play FILE: one of the two")
    if play:
        _refuse_what_a_recording_has(context)
    if resume and not file:
        raise InputError("--resume: leaves out what a file of results has; name it with --json FILE")
    board = _executing(context, image, rom, port or can or where) if image else _address(port, can, where)
    is_virtual = board.partition(":")[0] == _VIRTUAL
    if is_virtual and (recording or play):  # what a recording takes is said by one board
        board = context.with_resource(Board(boards.memory())).wait(_kind(board))
        is_virtual = False
    if play:
        _play(play, board, Results(file), common.junit_file)
        return
    if not is_virtual:
        if (common.jobs or 1) != 1 or common.cluster:
            raise InputError("--jobs, --cluster: a board does one run at a time, and is at this computer")
        core.require()  # before anything is asked of the board
        runs.ids(scenarios or ())
        core.follow_edition(_edition(board, image))
    wish = Wish(
        tuple(scenarios or ()),
        check,
        tuple(only or ()),
        common.profile_name,
        common.seed,
        tuple(common.changes),
        common.params,
        common.scheme,
    )
    everything = wish.runs(core.load())
    if not everything:
        raise InputError(f"--run {' '.join(only or [])}: there is no such run in {' '.join(scenarios or ())}")
    results = Results(file)
    kind = _kind(board)
    left = {number for number, run in enumerate(everything) if not (resume and _is_done(results, run, kind, of))}
    chosen = [everything[number] for number in runs.broad(everything) if number in left]
    skipped = [begun(run, kind, of) for number, run in enumerate(everything) if number not in left]
    taken = context.with_resource(RecordingWriter(recording, len(chosen))) if recording else None
    rows = _on_virtual(chosen, kind, of, common.where) if is_virtual else _on_one(chosen, board, of, taken)
    _tell_all(rows, skipped, results, common.junit_file)


def _refuse_what_a_recording_has(context: typer.Context) -> None:
    """Options that say which runs there are, of what drive, and who does them."""
    given = [
        option.opts[0]
        for option in context.command.params
        if not is_default(context, option.name or "") and option.name not in _WITH_PLAY
    ]
    if given:
        raise InputError(f"{', '.join(given)}: no meaning with --play, which asks one board what is in the recording")


def _play(recording: Path, board: str, results: Results, junit_file: Path | None) -> None:
    """Everything in a recording, on a board."""
    with PhaseBar(Console(stderr=True)) as bar:
        rows = campaign.played(recording, board, lambda run: partial(bar.show, phase=f"{run.scenario} {run.run}"))
        _tell_all(rows, [], results, junit_file)


def _tell_all(rows: Iterable[Row], skipped: Sequence[Row], results: Results, junit_file: Path | None) -> None:
    """The rows as they come, in words, in the files and as the exit status."""
    done = []
    with junit.Report(junit_file, "hil") as verdicts:
        verdicts.add(map(junit.left_out, skipped))
        for new in rows:
            verdicts.add([junit.of_loop(new)])
            done.append(_tell(new, results))
    if len(done) > 1:
        tables.loop(done)
    worst = max((new.exit_code for new in done), default=ExitCode.DONE)
    if worst:
        raise typer.Exit(worst)


def _address(port: str, can: str, where: str) -> str:
    """The one address that is meant."""
    if (port != "") + (can != "") > 1:
        raise InputError("give either --port or --can, not both")
    if _VIRTUAL in {port, can}:
        return f"{_VIRTUAL}:{'serial' if port else 'can'}"
    if port:
        return port if port.startswith("serial:") else f"serial://{port}"
    if can:
        interface, colon, _ = can.partition(":")
        return f"can:{can}" if colon and "/" not in interface else f"can:slcan:{can}"
    return wanted(where)


def _executing(context: typer.Context, image: Path, rom: Path | None, other: str) -> str:
    """The address of a virtual board that executes an image, until the command ends."""
    if other:
        raise InputError(f"--image: a virtual board of its own executes it; leave out {other}")
    images.load(image)  # files that cannot be used are said to be so before anything starts
    if rom:
        read_boot_rom(rom)
    board = context.with_resource(Board(boards.memory(), image, rom))
    return board.wait("serial")


def _edition(board: str, image: Path | None) -> str:
    """Of the drive that is there."""
    try:
        return built.edition_at(board)
    except NoAnswerError as error:
        if image is None:
            raise
        raise NoAnswerError(
            f"{image}: answers no request of the record protocol, so it is no image of the drive; hil steps one of "
            "edition hil or lab, and `stillspin run --image` lets any program run under a scenario's load"
        ) from error


def _kind(board: str) -> str:
    """The way to it: serial or can."""
    virtual, _, kind = board.partition(":")
    if virtual == _VIRTUAL:
        return kind or "serial"
    return address.parse(board).kind


def _is_done(results: Results, run: LoopRun, kind: str, of: str) -> bool:
    row = results.rows.get(begun(run, kind, of).key)
    return row is not None and row.identical and row.revision == of


def _on_one(chosen: Sequence[LoopRun], board: str, of: str, recording: RecordingWriter | None) -> Iterator[Row]:
    with PhaseBar(Console(stderr=True)) as bar:

        def progress(run: LoopRun) -> Progress:
            return partial(bar.show, phase=f"{run.scenario} {run.name}")

        yield from campaign.on_one(chosen, board, of, progress, recording)


def _on_virtual(chosen: Sequence[LoopRun], kind: str, of: str, where: Where) -> Iterator[Row]:
    if not chosen:
        return
    with Counter(Console(stderr=True), len(chosen)) as counter:
        for row in campaign.on_virtual(chosen, kind, of, replace(where, jobs=min(where.jobs, len(chosen)))):
            counter.one_more(row)
            yield row


def _tell(new: Row, results: Results) -> Row:
    results.add(new)
    title = f"{new.scenario} {new.run}" + ("" if new.whole else " (its start)")
    rate = f"{counted(new.steps, 'step')} in {new.seconds:.1f} s ({new.rate:.0f} steps/s)"
    if new.lost:
        print(f"{title}: BROKE OFF: {new.lost}", flush=True)
    elif new.step is not None:
        print(f"{title}: DIFFERS at {Difference(new.step, new.words)}; {rate}", flush=True)
    else:
        end = f"; the run ended: {new.ended}" if new.ended else ""
        print(f"{title}: identical, log {new.board[:16]}, {rate}{end}", flush=True)
    return new
