"""The schemas of motor, profile and scenario files: the loaders check by them, and others read the same from them."""

import copy
import json
import math
import random

import fastjsonschema
import jsonschema
import pytest
from typer.testing import CliRunner

from stillspin import cli, core, resources, toml_table
from stillspin.cases import file_schema, profile, scenario_file
from stillspin.errors import InputError

FILES = [(kind, name) for kind in file_schema.KINDS for name in resources.names(f"{kind}s")]
OTHERS = ["x", "", -1, 0, 1, 2.5, 1e9, True, [], [[]], {}, {"x": 1}, [0.1, 0.2], math.nan, math.inf]
CHANGES = 40  # of each file


def made(kind):
    """A motor or a profile at the scales of motor A's board; a scenario does not say on which board it runs."""
    native = core.load()
    known = core.parameters(native)
    if kind == "scenario":
        known = core.at_some_scale(known)
    return file_schema.schema(kind, core.plant_schema(native), known)


@pytest.fixture(scope="module")
def judges():
    """Another implementation than the loader's, by kind of file."""
    return {kind: fastjsonschema.compile(made(kind)) for kind in file_schema.KINDS}


def fits(judges, kind, data):
    try:
        judges[kind](data)
    except fastjsonschema.JsonSchemaValueException:
        return False
    return all(math.isfinite(value) for _, value in places(data) if isinstance(value, float))


def load(monkeypatch, kind, name, data):
    """What the loader says of a file of this content; a RelationError is of what a schema cannot say."""
    native, read = core.load(), toml_table.read
    own = resources.directory(f"{kind}s") / f"{name}.toml"
    with monkeypatch.context() as patch:
        patch.setattr(toml_table, "read", lambda p: toml_table.Table(data, str(p)) if p == own else read(p))
        try:
            if kind == "scenario":
                scenario_file.read(own)
            else:
                names = ("ideal", name) if kind == "motor" else (name, "A")
                profile.load(names[0], core.plant_schema(native), core.parameters(native), names[1], checked=False)
        except InputError as error:
            return error
    return None


def content(kind, name):
    return toml_table.read(resources.directory(f"{kind}s") / f"{name}.toml").items()


def places(data, path=()):
    """Every value of a file, with the keys that lead to it."""
    for key, value in data.items() if isinstance(data, dict) else enumerate(data):
        yield (*path, key), value
        if isinstance(value, dict | list):
            yield from places(value, (*path, key))


def changed(data, dice):
    """The content with one place of it left out, replaced, or with an unknown key beside it."""
    result = copy.deepcopy(data)
    *way, last = dice.choice([path for path, _ in places(result)])
    inside = result
    for key in way:
        inside = inside[key]
    change = dice.randrange(4)
    if change == 0:
        del inside[last]
    elif change == 1 and isinstance(inside, dict):
        inside["nonsense"] = inside[last]
    else:
        inside[last] = copy.deepcopy(dice.choice(OTHERS))
    return result, (change, *way, last)


@pytest.mark.parametrize("kind", file_schema.KINDS)
def test_a_schema_is_one(kind):
    jsonschema.Draft7Validator.check_schema(made(kind))


@pytest.mark.parametrize(("kind", "name"), FILES)
def test_every_file_that_ships_fits_its_schema(judges, kind, name):
    assert fits(judges, kind, content(kind, name))


@pytest.mark.parametrize(("kind", "name"), FILES)
def test_the_loader_takes_what_the_schema_takes_and_nothing_else(judges, monkeypatch, kind, name):
    dice, data = random.Random(name), content(kind, name)
    for _ in range(CHANGES):
        other, change = changed(data, dice)
        error = load(monkeypatch, kind, name, other)
        taken = error is None or isinstance(error, scenario_file.RelationError)
        assert taken == fits(judges, kind, other), (change, error)
        assert error is None or (f"{name}.toml: " in str(error) and "\n" not in str(error)), (change, error)


@pytest.mark.parametrize(
    ("place", "value", "words"),
    [
        (("machine", "pole_pairs"), 4.0, ""),
        (("machine", "pole_pairs"), 2.5, "machine.pole_pairs: 2.5 is not a whole number; 1 … 50"),
        (("machine", "pole_pairs"), 51, "machine.pole_pairs: 51 is out of range; 1 … 50"),
        (("machine", "poles"), 8, "machine: unknown key 'poles'; did you mean 'pole_pairs'?"),
        (("machines",), {}, "unknown key 'machines'; did you mean 'machine'?"),
        (("machine",), 4, "machine = 4: must be a table"),
        (("machine", "resistance"), "1", "machine.resistance = '1': must be a number"),
        (("machine", "resistance"), math.nan, "machine.resistance: nan ohm is no number"),
        (("link", "stiff"), 1, "link.stiff = 1: must be true or false"),
        (("link", "stiff"), True, ""),
        (("solver",), {"method": "rk4"}, ""),
        (("solver",), {"method": "rk5"}, "solver.method = 'rk5': not a choice; did you mean 'rk4'?"),
        (("parameters", "mtpa"), True, ""),
        (("parameters", "mtpa"), False, ""),
        (("parameters", "mtpa"), 1, ""),
        (("parameters", "pole_pairs"), True, "parameters.pole_pairs = True: must be a whole number"),
        (("parameters", "mtpa"), 2, "parameters.mtpa: 2 is out of range; 0 … 1"),
        (("parameters", "curent_limit"), 1, "unknown key 'curent_limit'; did you mean 'current_limit'?"),
        (("commission",), "yes", "commission = 'yes': must be true or false"),
    ],
)
def test_a_complaint_names_place_value_and_what_is_allowed(judges, monkeypatch, place, value, words):
    data = content("motor", "A")
    inside = data
    for key in place[:-1]:
        inside = inside[key]
    inside[place[-1]] = value
    error = load(monkeypatch, "motor", "A", data)
    assert (words == "") == (error is None) == fits(judges, "motor", data)
    assert words in str(error or "")


def test_the_command_writes_the_schema_and_says_how_an_editor_finds_it(tmp_path):
    path = tmp_path / "motor.schema.json"
    result = CliRunner().invoke(cli.app, ["schema", "motor", "--out", str(path)])
    assert result.exit_code == 0, result.stderr
    assert "#:schema ./motor.schema.json" in result.stdout
    written = json.loads(path.read_text(encoding="utf-8"))
    assert written["properties"]["machine"]["properties"]["resistance"]["description"].endswith("[ohm]")
    shown = CliRunner().invoke(cli.app, ["schema", "scenario"])
    assert "encoder_trim" in json.loads(shown.stdout)["definitions"]["parameters"]["properties"]
    assert CliRunner().invoke(cli.app, ["schema", "moter"]).exit_code == 2
