"""The three ways in (docs/way-*.md): their commands are carried out as they stand; those of other pages can be."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest
from function_desk import Desk
from test_bring_up import STAGES, SwitchedOn, agrees, shape
from typer.main import get_command

from stillspin import cli, core
from stillspin.cases import profile

pytest.importorskip("stillspin._core", reason="the native module is not built")

ROOT = Path(__file__).resolve().parents[2]
PATIENCE = 700  # ms for the answer to a line
STILLSPIN = ".venv/bin/stillspin "
SET = ("set", "ref", "start", "version")  # what they answer was not measured, but for a time
STAYS = ("board", "console", "tune")  # they stay open; test_board.py and test_client_on_board.py run them


def page(name: str) -> str:
    return (ROOT / f"docs/way-{name}.md").read_text(encoding="utf-8")


def blocks(name: str, language: str = "") -> list[str]:
    """The page's fenced blocks of a language; those of the shell and of the console name none."""
    found = re.findall(r"^```(\w*)\n(.*?)^```$", page(name), re.MULTILINE | re.DOTALL)
    return [text for said, text in found if said == language]


def shell_lines(name: str) -> list[str]:
    return [line for block in blocks(name) for line in block.splitlines() if line.startswith((STILLSPIN, "cmp "))]


def same_words(_command: str, said: str, expected: str) -> bool:
    return shape(said) == shape(expected)


def blocks_of_the_console() -> list[str]:
    text = (ROOT / "docs/console.md").read_text(encoding="utf-8")
    return [block for block in re.findall(r"^```\n(.*?)^```$", text, re.M | re.S) if block.startswith("> ")]


@pytest.mark.parametrize(("name", "changes"), [("tune", []), ("board", ["link.source_voltage=1"])])
def test_the_console_answers_what_the_way_says(name: str, changes: list[str]) -> None:
    desk = SwitchedOn(*changes)
    command, came = "", [""]
    try:
        for line in (line for block in blocks(name) if block.startswith("> ") for line in block.splitlines()):
            if line.startswith("> "):
                command = line[2:]
                came = desk.type(command, PATIENCE).splitlines()
            elif line.startswith("-- "):
                desk.wait(1000 * float(line.split()[1]))
            else:
                alike = agrees if command.split()[0] in SET else same_words
                assert any(alike(command, answer, line) for answer in came), f"{command}: {line!r} is not in {came}"
    finally:
        desk.board.close()


@pytest.mark.parametrize("block", blocks_of_the_console(), ids=lambda block: block.splitlines()[0][2:])
def test_the_console_answers_what_its_page_says(block: str) -> None:
    """What is set or refused to the letter, what is measured with the same words."""
    native = core.load()
    bench = profile.load("bench", core.plant_schema(native), core.parameters(native), "A")
    desk = Desk(bench.parameters, {**bench.plant, "solver": {"method": "rk4"}}, wait=250)
    try:
        if "> look" in block:  # behind a stop with `coast`, as the page says
            desk.run(1200)
            desk.wait(1000)
            desk.type("coast")
        for command, answers in asked(block):
            came = desk.type(command, PATIENCE).splitlines()
            alike = agrees if command.split()[0] in SET else same_words
            for answer in answers:
                assert any(alike(command, line, answer) for line in came), f"{command}: {answer!r} is not in {came}"
    finally:
        desk.board.close()


def asked(block: str) -> list[tuple[str, list[str]]]:
    """Lines typed, and what the page shows below each."""
    parts = re.split(r"^> (.*)\n", block, flags=re.MULTILINE)[1:]
    return [(command, answers.splitlines()) for command, answers in zip(parts[::2], parts[1::2], strict=True)]


def test_the_commands_of_the_way_to_tests_end_as_it_says(tmp_path: Path) -> None:
    """One after the other in the same place; the run with the open phase fails, all others pass."""
    lines = shell_lines("test")
    assert len(lines) >= 7
    for line in lines:
        words = shlex.split(line.replace("/tmp", str(tmp_path)))
        run = [sys.executable, "-m", "stillspin", *words[1:]] if line.startswith(STILLSPIN) else words
        done = subprocess.run(run, capture_output=True, text=True, cwd=tmp_path, check=False)
        assert done.returncode == (1 if "open_phase" in line else 0), f"{line}\n{done.stdout}\n{done.stderr}"
        assert "Traceback" not in done.stdout + done.stderr, line


def test_the_python_of_the_way_to_tests_runs() -> None:
    (program,) = blocks("test", "python")
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["3000.0", "running"]


def test_a_board_says_what_its_page_shows(tmp_path: Path) -> None:
    shown = re.search(
        r"^```\n(\S*stillspin board .*?)\n\n(.*?)^```$", (ROOT / "docs/board.md").read_text(), re.M | re.S
    )
    assert shown
    words = shlex.split(shown[1].replace("/tmp", str(tmp_path)))[1:]
    run = [sys.executable, "-m", "stillspin", *words, "--for", "0.1"]
    done = subprocess.run(run, capture_output=True, text=True, check=False)

    def said(text: str) -> list[str]:
        return [re.sub(r"\S*stillspin console|/dev/pts/\d+", "", shape(line)) for line in text.splitlines()]

    expected = said(shown[2].replace("/tmp", str(tmp_path)))
    assert said(done.stdout)[: len(expected)] == expected, done.stdout


def test_the_way_to_a_board_names_the_boards_of_the_bring_up() -> None:
    rows = dict(re.findall(r"^\| ([1-9]) \| [^|]+ \| ([^|]+) \|$", page("board"), re.MULTILINE))
    assert sorted(rows) == [stage[-1] for stage in sorted(STAGES)]
    for stage, text in STAGES.items():
        (named,) = re.findall(r"^(`stillspin board.*`)$", text, re.MULTILINE)
        before = re.search(r"^(`stillspin board.*`)$", STAGES.get(f"Stage {int(stage[-1]) - 1}", ""), re.MULTILINE)
        said = rows[stage[-1]].replace(" --serial-link /tmp/drive", "")  # the one port of all its boards
        assert said == named or (said.startswith("the same") and before and before[1] == named), stage


def test_the_way_to_tuning_needs_few_commands() -> None:
    """Those that stay open, and files of parameters."""
    assert {shlex.split(line)[1] for line in shell_lines("tune") if line.startswith(STILLSPIN)} <= {*STAYS, "params"}


def commands_of_the_book() -> list[tuple[str, str]]:
    """Page and line of every command of stillspin in a fenced block, as one where it goes on in the next."""
    pages = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    fenced = [
        (at.name, block) for at in pages for block in re.findall(r"^```\n(.*?)^```$", at.read_text(), re.M | re.S)
    ]
    lines = [(name, line) for name, block in fenced for line in block.replace("\\\n", "").splitlines()]
    return [(name, line) for name, line in lines if re.match(r"(\.venv/bin/)?stillspin [a-z][a-z-]*( |$)", line)]


def test_the_commands_of_the_book_can_be_pasted() -> None:
    """The command, its options and what `--set` changes exist, and what is said beside it is a comment to the shell."""
    native = core.load()
    schema, known = core.plant_schema(native), core.parameters(native)
    lines = commands_of_the_book()
    assert len(lines) > 60
    for name, line in lines:
        command, words = get_command(cli.app), shlex.split(line, comments=True)[1:]
        while words and words[0] in getattr(command, "commands", {}):
            command = command.commands[words.pop(0)]
        assert getattr(command, "invoke_without_command", True), f"{name}: {line}"
        options = {spelt: option for option in command.params for spelt in option.opts + option.secondary_opts}
        assert {word for word in words if word.startswith("-")} <= options.keys(), f"{name}: {line}"
        places = [
            word
            for word, before in zip(words, ["", *words], strict=False)
            if not word.startswith("-") and (before not in options or options[before].is_flag)
        ]
        room = [option.nargs for option in command.params if option.param_type_name == "argument"]
        assert -1 in room or len(places) <= sum(room), f"{name}: {line}"
        profile.changes([after for word, after in pairwise(words) if word == "--set"], schema, known)
