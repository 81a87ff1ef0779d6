"""The real native module and the fake one agree, and what ships runs on the real one.

Everything else in this folder trusts the fake; here it is held against the module that is built.
"""

import importlib

import pytest

import fake_core
from stillspin import core
from stillspin.cases import profile, scenario_file
from stillspin.core import Entry
from stillspin.runs import execute

FAKE_ONLY = {"inverter.dead_short"}  # makes the fake fail on purpose


@pytest.fixture(scope="module")
def native():
    return importlib.import_module("stillspin._core")


def names(schema):
    return {f"{section}.{key}" for section, keys in schema.items() for key in keys}


def test_the_fake_has_no_entry_that_the_plant_does_not_have(native):
    assert names(core.plant_schema(fake_core)) - names(core.plant_schema(native)) <= FAKE_ONLY


def test_the_fake_has_no_parameter_that_the_firmware_does_not_have(native):
    real, fake = core.parameters(native), core.parameters(fake_core)
    assert set(fake) <= set(real)
    assert all((real[name].number, real[name].unit) == (fake[name].number, fake[name].unit) for name in fake)


def test_both_record_the_same_signals(native):
    assert [row["name"] for row in fake_core.signals()] == [row["name"] for row in native.signals()]


@pytest.mark.parametrize("name", ["bench", "ideal"])
def test_the_profiles_fit_the_real_plant(native, name):
    assert profile.load(name, core.plant_schema(native), core.parameters(native)).plant


@pytest.mark.parametrize("identifier", scenario_file.ids())
def test_the_scenarios_fit_the_real_firmware(native, identifier):
    settings = execute.Settings(profile.Profile("bench", "", {}), profile.Changes(), 1, "r")
    assert execute.prepare(scenario_file.load(identifier), settings, native)


def test_every_default_is_within_its_own_range(native):
    entries = [entry for keys in core.plant_schema(native).values() for entry in keys.values()]
    for entry in [*entries, *core.parameters(native).values()]:
        assert isinstance(entry, Entry)
        entry.check(entry.default, entry.name)
        assert entry.help
