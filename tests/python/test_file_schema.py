"""The JSON schema of motor and profile files says what the loader says."""

import importlib
import json
import tomllib

import jsonschema
import pytest
from typer.testing import CliRunner

from stillspin import cli, core, resources
from stillspin.cases import file_schema, profile
from stillspin.errors import InputError

FILES = [(kind, name) for kind in file_schema.KINDS for name in resources.names(f"{kind}s")]


@pytest.fixture(scope="module")
def native():
    return importlib.import_module("stillspin._core")


def complaints(native, kind, text):
    made = file_schema.schema(kind, core.plant_schema(native), core.parameters(native))
    jsonschema.Draft202012Validator.check_schema(made)
    return list(jsonschema.Draft202012Validator(made).iter_errors(tomllib.loads(text)))


@pytest.mark.parametrize(("kind", "name"), FILES)
def test_every_file_that_ships_fits_its_schema(native, kind, name):
    text = (resources.directory(f"{kind}s") / f"{name}.toml").read_text(encoding="utf-8")
    assert complaints(native, kind, text) == []


@pytest.mark.parametrize(
    ("text", "right"),
    [
        ("[machine]\npole_pairs = 4\n", True),
        ("[machine]\npole_pairs = 4.0\n", True),
        ("[machine]\npole_pairs = 2.5\n", False),
        ("[machine]\npole_pairs = 51\n", False),
        ("[machine]\npoles = 8\n", False),
        ("[machines]\npole_pairs = 4\n", False),
        ("[machine]\nresistance = '1'\n", False),
        ("[machine]\nresistance = 1\n", True),
        ("[link]\nstiff = 1\n", False),
        ("[link]\nstiff = true\n", True),
        ("[solver]\nmethod = 'rk4'\n", True),
        ("[solver]\nmethod = 'rk5'\n", False),
        ("[parameters]\nmtpa = true\n", True),
        ("[parameters]\nmtpa = 1\n", True),
        ("[parameters]\nmtpa = 2\n", False),
        ("[parameters]\ncurrent_limit = 1e6\n", False),
        ("[parameters]\ncurent_limit = 1\n", False),
        ("commission = 'yes'\n", False),
        ("description = 'A pump.'\n", True),
    ],
)
def test_the_schema_takes_what_the_loader_takes_and_nothing_else(native, tmp_path, text, right):
    assert (complaints(native, "motor", text) == []) == right
    (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
    schema, known = core.plant_schema(native), core.parameters(native)
    try:
        profile.load("ideal", schema, known, str(tmp_path / "mine.toml"), checked=False)
        taken = True
    except InputError:
        taken = False
    assert taken == right


def test_the_command_writes_the_schema_and_says_how_an_editor_finds_it(native, tmp_path):
    path = tmp_path / "motor.schema.json"
    result = CliRunner().invoke(cli.app, ["schema", "motor", "--out", str(path)])
    assert result.exit_code == 0, result.stderr
    assert "#:schema ./motor.schema.json" in result.stdout
    written = json.loads(path.read_text(encoding="utf-8"))
    assert written["properties"]["machine"]["properties"]["resistance"]["description"].endswith("[ohm]")
    assert CliRunner().invoke(cli.app, ["schema", "moter"]).exit_code == 2
