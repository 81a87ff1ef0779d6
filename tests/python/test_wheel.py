"""The client's wheel in an environment without a compiler, against a virtual board of the whole installation."""

import re
import subprocess
import sys
import urllib.request
from email.parser import Parser
from pathlib import Path
from urllib.parse import urljoin
from zipfile import ZipFile

import desk
import pytest
from desk import needs_board
from empty_environment import Environment, closure
from test_pages_named import PAGES
from typer.testing import CliRunner

import stillspin
from stillspin.cli import app
from stillspin.commands import schema
from stillspin.revision import revision

pytestmark = needs_board

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def wheels(tmp_path_factory):
    """The two wheels: the client's, the virtual drive's."""
    out = tmp_path_factory.mktemp("dist")
    subprocess.run([sys.executable, ROOT / "toolchain" / "wheel.py", out], check=True, timeout=120)
    (client,), (virtual,) = out.glob("stillspin-*.whl"), out.glob("stillspin_virtual-*.whl")
    return client, virtual


def needs(wheel):
    with ZipFile(wheel) as file:
        (metadata,) = (name for name in file.namelist() if name.endswith(".dist-info/METADATA"))
        return Parser().parsestr(file.read(metadata).decode()).get_all("Requires-Dist")


@pytest.fixture(scope="module")
def client(wheels, tmp_path_factory):
    """The client alone."""
    made = Environment(tmp_path_factory.mktemp("client"))
    made.lend(closure(needs(wheels[0])))
    made.install(wheels[0])
    return made


@pytest.fixture(scope="module")
def board(tmp_path_factory):
    """The port of a virtual board; `can` beside it is its SLCAN adapter."""
    with desk.board(tmp_path_factory.mktemp("board")) as port:
        yield port


def test_the_wheel_is_pure_python_and_has_every_file_of_the_package(wheels):
    client, virtual = wheels
    assert client.name == f"stillspin-{stillspin.__version__}-py3-none-any.whl"
    assert f"stillspin-virtual=={stillspin.__version__}" in "".join(needs(client))
    assert "none-any" not in virtual.name
    listed = subprocess.run(["git", "ls-files", "sim_host"], cwd=ROOT, check=True, capture_output=True, text=True)
    ours = {Path(line).relative_to("sim_host") for line in listed.stdout.splitlines()}
    kinds = {".py", ".toml", ".dbc", ".j2", ".js", ".css", ".html", ".typed"}
    code = {str(path) for path in ours if path.parts[0] == "stillspin" and path.suffix in kinds}
    data = {f"stillspin/{path}" for path in ours if path.parts[0] in {"motors", "profiles", "scenarios", "schemes"}}
    with ZipFile(client) as file:
        inside = set(file.namelist())
    assert {name for name in inside if name.endswith((".so", ".pyd", ".dll"))} == set()
    assert code | data | {"stillspin/py.typed", "stillspin/parameters.json"} <= inside


def test_the_client_needs_neither_plots_nor_tables_nor_a_compiler(client):
    asked = "import importlib.util as u, shutil; print([n for n in {} if u.find_spec(n)], shutil.which('cc'))"
    said = client.run(
        "python", "-c", asked.format(["matplotlib", "pyarrow", "pandas", "jinja2", "jsonschema", "stillspin._core"])
    )
    assert said.stdout.strip() == "[] None", said.stderr


def test_parameters_are_read_compared_and_set(client, board):
    assert client.run("stillspin", "params", "dump", "here.toml", "--drive", board).returncode == 0
    said = client.run("stillspin", "console", "--drive", board, "-c", "set speed_ramp 777")
    assert said.returncode == 0, said.stderr
    said = client.run("stillspin", "params", "diff", "here.toml", "--drive", board)
    assert "speed_ramp" in said.stdout
    assert "1 of" in said.stdout, said.stderr
    assert client.run("stillspin", "params", "load", "here.toml", "--drive", board).returncode == 0
    assert "0 of" in client.run("stillspin", "params", "diff", "here.toml", "--drive", board).stdout


RUN = """
import sys
from stillspin.drive import Drive, Trigger
with Drive.open(sys.argv[1]) as drive:
    with drive.running(300, timeout=30):
        print(drive.status().energised)
        drive.capture("speed", trigger=Trigger("speed", 250, "above"))
    print(drive.status().energised)
"""


def test_the_motor_starts_guarded_and_stops(client, board):
    said = client.run("python", "-c", RUN, board)
    assert said.stdout.split() == ["True", "False"], said.stderr


def test_what_is_captured_without_the_packages_for_tables_is_csv(client, board):
    said = client.run("stillspin", "scope", "speed", "current_q", "--drive", board)
    assert said.returncode == 0, said.stderr
    assert "see capture.csv" in said.stdout
    lines = (client.home / "capture.csv").read_text().splitlines()
    assert re.match(r"# firmware: stillspin \S+ \(edition \w+, board \w+, .*table [0-9a-f]{8}\)$", lines[0])
    assert next(line for line in lines if line[0] != "#") == "time [s],speed [rpm],current_q [A]"


def test_signals_and_the_bus_are_shown(client, board):
    said = client.run("stillspin", "monitor", "link_voltage", "--duration", "0.5", "--drive", board)
    assert "\ntime [s]\tlink_voltage [V]\n" in said.stdout, said.stderr
    said = client.run("stillspin", "can", f"can:slcan:{Path(board).with_name('can')}", "--duration", "1")
    assert "node 1" in said.stdout, said.stderr


def test_the_page_is_served_from_the_wheel(client, board):
    serve = [client.bin / "stillspin", "tune", "--no-open", "--drive", board]
    with subprocess.Popen(serve, env=client.variables, stdout=subprocess.PIPE, text=True) as running:
        try:
            page = next(line for line in running.stdout if line.startswith("page: ")).split()[1]
            with urllib.request.urlopen(page, timeout=10) as answer:
                assert b"<script" in answer.read()
                given = {"Cookie": answer.headers["Set-Cookie"].partition(";")[0]}
            for name in ("tuning.md", "images/tuning-noise.png"):
                guide = urllib.request.Request(urljoin(page, f"/book/{name}"), headers=given)
                with urllib.request.urlopen(guide, timeout=10) as answer:
                    assert len(answer.read()) > 1000
        finally:
            running.terminate()


def test_the_pages_that_the_client_names_are_in_the_wheel(client):
    said = client.run("python", "-c", f"from stillspin import resources as r; print(*map(r.page, {PAGES}), sep='\\n')")
    paths = [Path(line) for line in said.stdout.splitlines()]
    assert [path.stem for path in paths] == PAGES, said.stderr
    assert all(path.is_file() and not path.is_relative_to(ROOT) for path in paths), paths


def test_a_recording_is_played_into_a_board_without_the_virtual_drive(client, tmp_path):
    recording = tmp_path / "a10.rec"
    made = CliRunner().invoke(app, ["hil", "A10", "--check", "--port", "virtual", "--record", str(recording)])
    assert made.exit_code == 0, made.output
    with desk.board(tmp_path, "--speed", "0") as port:
        said = client.run("stillspin", "hil", "--play", recording, "--port", port)
    assert said.returncode == 0, said.stderr
    assert "A10 creep (its start): identical" in said.stdout


def test_a_demonstration_is_made_and_flashed(client, tmp_path):
    assert client.run("stillspin", "demo-image", tmp_path).returncode == 0
    port, log = tmp_path / "port", tmp_path / "log"
    with desk.process(log, (port,), "loader", str(tmp_path / "flash.bin"), "--serial-link", str(port), "--speed", "10"):
        said = client.run("stillspin", "flash", tmp_path / "stillspin_demonstration.bin", "--port", port)
    assert said.returncode == 0, said.stderr
    assert "the chip runs: the drive" in log.read_text()


def test_the_firmwares_table_is_in_the_wheel(client):
    said = client.run("stillspin", "params")
    assert "pole_pairs" in said.stdout, said.stderr


@pytest.mark.parametrize("kind", schema.KINDS)
def test_the_schemas_for_editors_are_in_the_wheel_as_the_whole_installation_makes_them(client, kind):
    said = client.run("stillspin", "schema", kind)
    assert said.stdout == schema.made(kind), said.stderr


def test_letters_that_a_file_on_windows_does_not_take_are_no_traceback(client):
    said = client.run("stillspin", "params", PYTHONIOENCODING="ascii")
    assert (said.returncode, said.stderr) == (0, "")
    assert "?" in said.stdout


def test_it_says_which_sources_it_was_made_from(client):
    assert client.run("stillspin", "--version").stdout == f"stillspin {stillspin.__version__} ({revision()})\n"
    assert revision() != stillspin.__version__


@pytest.mark.parametrize(
    ("arguments", "extra"),
    [
        (("run", "A10"), "virtual"),
        (("board",), "virtual"),
        (("params", "dump", "--drive", "virtual:"), "virtual"),
        (("hil", "A10", "--port", "/dev/null"), "virtual"),
        (("scope", "speed", "--out", "x.parquet", "--drive", "/dev/null"), "tables"),
        (("scope", "speed", "--out", "x.svg", "--drive", "/dev/null"), "plots"),
    ],
)
def test_what_is_missing_is_one_line_with_the_remedy(client, arguments, extra):
    said = client.run("stillspin", *arguments)
    assert said.returncode == 2
    assert said.stderr.count("\n") == 1
    assert f"pip install --find-links dist 'stillspin[{extra}]'" in said.stderr


def test_the_extra_brings_the_virtual_drive(wheels, tmp_path):
    made = Environment(tmp_path)
    made.lend(closure([*needs(wheels[0]), "matplotlib", "pyarrow", "jinja2", "jsonschema"]))
    made.install(wheels[1])
    made.install(wheels[0])
    said = made.run("stillspin", "params", "dump", "--changed", "--drive", "virtual:")
    assert "[parameters]" in said.stdout, said.stderr


def test_nothing_wants_modules_of_unix_when_it_is_imported(client):
    said = client.run("python", Path(__file__).with_name("as_windows.py"))
    assert "run it under Linux or WSL" in said.stdout, said.stderr
