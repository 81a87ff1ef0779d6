"""What a shell's user expects of any command: -h, --version, help for a bare command, completion by Tab."""

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
import typer
from test_exit_codes import commands

from stillspin import cli

STILLSPIN = Path(sys.executable).with_name("stillspin")
TREE = list(commands(typer.main.get_command(cli.app)))
TOP = sorted({name.split()[0] for name in TREE})


@pytest.mark.parametrize("name", ["", *TREE])
def test_h_is_help(call, name):
    short, long = call(*name.split(), "-h"), call(*name.split(), "--help")
    assert (short.exit_code, short.stdout) == (0, long.stdout)
    assert short.stdout.startswith("Usage: ")


def test_a_bare_command_shows_the_help(call):
    bare = call()
    assert (bare.exit_code, bare.stdout) == (0, call("--help").stdout)


def test_the_help_says_of_every_command_a_whole_sentence(call):
    shown = call().stdout
    listed = shown.split("Commands:")[1]
    assert "..." not in listed
    assert "To begin:" in shown


@pytest.mark.parametrize(("on_path", "says"), [(False, str(STILLSPIN)), (True, "stillspin")])
def test_a_command_that_is_proposed_can_be_pasted(tmp_path, on_path, says):
    path = os.environ["PATH"].split(os.pathsep)
    others = [place for place in path if not (Path(place) / "stillspin").exists()]
    place = os.pathsep.join([str(STILLSPIN.parent), *others] if on_path else others)
    done = subprocess.run(
        [STILLSPIN, "demo-image", tmp_path / "demo"],
        env={**os.environ, "PATH": place},
        capture_output=True,
        text=True,
        check=True,
    )
    assert f"try:    {says} loader " in done.stdout


def test_a_command_loads_no_other():
    """Nor others' libraries: every start of a command and of a worker would wait for them."""
    asked = "import sys; from stillspin import cli; cli.app(['schema', 'motor'], standalone_mode=False)"
    code = f"{asked}; print(*sorted(sys.modules), file=sys.stderr)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    loaded = set(done.stderr.split())
    assert "stillspin.commands.schema" in loaded
    assert not loaded & {"cantools", "rich", "stillspin.commands.board", "stillspin.commands.hil"}


def test_a_run_with_its_pictures_loads_neither_pandas_nor_pyplot(tmp_path):
    """They take as long as the run itself."""
    pytest.importorskip("stillspin._core", reason="the native module is not built")
    words = ["run", "A18a", "--profile", "ideal", "--seed", "1", "--out", str(tmp_path)]
    asked = f"import sys; from stillspin import cli; cli.app({words!r}, standalone_mode=False)"
    code = f"{asked}; print(*sorted(sys.modules), file=sys.stderr)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=300)
    loaded = set(done.stderr.split())
    assert "matplotlib.figure" in loaded
    assert not loaded & {"pandas", "matplotlib.pyplot"}
    assert "svg+xml" in (tmp_path / "report.html").read_text()


def test_a_bare_group_shows_its_help(call, monkeypatch):
    group = typer.main.get_command(cli.app).commands["params"]
    monkeypatch.setattr(group, "invoke_without_command", False)
    monkeypatch.setattr(typer.main, "get_command", lambda _: group)
    bare = call()
    assert bare.exit_code == 0
    assert "dump" in bare.stdout
    assert bare.stdout.startswith("Usage: ")


def test_version_as_option_and_command(call):
    assert call("--version").stdout == call("version").stdout
    assert call("--version").exit_code == 0


def test_a_drive_tells_its_version_board_build_and_table(call, fake):
    *_, drive = call("version", "--drive", fake.port).stdout.splitlines()
    assert drive.startswith("drive: fake 1.0 (edition unknown, board ipm, commit 1234abcd, changed, table ")


def asked(tmp_path, **variables):
    """What the command line tells a shell that completes."""
    environment = {**os.environ, "HOME": str(tmp_path), **variables}
    done = subprocess.run([STILLSPIN], env=environment, capture_output=True, text=True, check=False, timeout=60)
    assert done.stderr == ""
    return done.stdout


def test_bash_completes_commands_and_options(tmp_path):
    def completed(*words):
        line = " ".join(map(shlex.quote, ("stillspin", *words)))
        script = (
            f"source <({STILLSPIN} --show-completion bash)\n"
            f"COMP_WORDS=({line}); COMP_CWORD={len(words)}\n"
            f"_stillspin_completion {STILLSPIN}; printf '%s\\n' \"${{COMPREPLY[@]}}\"; complete -p stillspin"
        )
        done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True, timeout=60)
        *found, registered = done.stdout.splitlines()
        assert registered.endswith("-F _stillspin_completion stillspin")
        return found

    assert sorted(completed("")) == TOP
    assert completed("repr") == ["reproduce"]
    assert completed("params", "d") == ["dump", "diff"]
    assert completed("flash", "--dr") == ["--dry-run"]


def test_zsh_is_told_every_command(tmp_path):
    told = asked(tmp_path, _STILLSPIN_COMPLETE="complete_zsh", _TYPER_COMPLETE_ARGS="stillspin ")
    for name in TOP:
        assert f'"{name}"' in told


def test_fish_is_told_every_command(tmp_path):
    how = {"_TYPER_COMPLETE_FISH_ACTION": "get-args", "_TYPER_COMPLETE_ARGS": "stillspin "}
    told = asked(tmp_path, _STILLSPIN_COMPLETE="complete_fish", **how)
    assert sorted(line.split("\t")[0] for line in told.splitlines() if "\t" in line) == TOP


@pytest.mark.parametrize(
    ("shell", "file", "hook"),
    [
        ("bash", ".bash_completions/stillspin.sh", ".bashrc"),
        ("zsh", ".zfunc/_stillspin", ".zshrc"),
        ("fish", ".config/fish/completions/stillspin.fish", None),
    ],
)
def test_one_command_installs_the_completion(tmp_path, shell, file, hook):
    environment = {**os.environ, "HOME": str(tmp_path), "_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION": "1"}
    command = [STILLSPIN, "--install-completion", shell]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 0, done.stderr
    assert "_STILLSPIN_COMPLETE" in (tmp_path / file).read_text()
    assert hook is None or (tmp_path / hook).read_text().strip()
