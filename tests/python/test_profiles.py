"""Profiles and --set: every entry is checked against what plant and firmware know, and complaints are one line."""

import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

import fake_core
from stillspin import core, resources
from stillspin.cases import profile
from stillspin.errors import InputError

SCHEMA = core.plant_schema(fake_core)
KNOWN = core.parameters(fake_core)


def changed(*words):
    return profile.changes(words, SCHEMA, KNOWN)


def complaint(*words):
    with pytest.raises(InputError) as caught:
        changed(*words)
    message = str(caught.value)
    assert "\n" not in message
    return message


def written(tmp_path, text):
    path = tmp_path / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


@pytest.mark.parametrize("name", ["bench", "ideal"])
def test_the_profiles_load(name):
    loaded = profile.load(name, SCHEMA, KNOWN)
    assert loaded.name == name
    assert loaded.description


def test_the_ideal_profile_states_everything_that_bench_spoils():
    """A default of the plant must not leak a flaw into `ideal`: what bench states, ideal states, or it is harmless."""
    bench, ideal = (profile.load(name, SCHEMA, KNOWN).plant for name in ("bench", "ideal"))
    stated = {f"{section}.{key}" for section, keys in ideal.items() for key in keys}
    harmless = {
        # A stiff link has no impedance and no brake; no ring means that its frequency does not matter.
        "link.source_resistance", "link.capacitance", "link.ripple_frequency", "link.rectifier", "link.brake_chopper",
        "sensor.ring_frequency", "sensor.ring_decay",
    }  # fmt: skip
    assert {f"{section}.{key}" for section, keys in bench.items() for key in keys} - stated == harmless


def test_the_ideal_firmware_knows_that_there_is_nothing_to_compensate():
    file = resources.directory("profiles") / "ideal.toml"
    loaded = profile.load("ideal", SCHEMA, KNOWN).parameters
    told = {name: loaded[name] for name in tomllib.loads(file.read_text(encoding="utf-8"))["parameters"]}
    assert told.pop("map_known") == 1.0
    assert set(told.values()) == {0.0}


def test_a_profile_can_be_a_file(tmp_path):
    loaded = profile.load(written(tmp_path, "[adc]\nnoise = 3\n[parameters]\nspeed_ramp = 100\n"), SCHEMA, KNOWN)
    assert (loaded.name, loaded.plant["adc"]["noise"], loaded.parameters["speed_ramp"]) == ("mine", 3.0, 100.0)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[adc]\nnose = 1\n", "did you mean 'noise'"),
        ("[acd]\nnoise = 1\n", "did you mean 'adc'"),
        ("[adcs]\n", "did you mean 'adc'"),
        ("[adc]\nnoise = 101\n", "0 … 100 LSB"),
        ("[adc]\nnoise = '1'\n", "adc.noise = '1': must be a number, 0 … 100 LSB"),
        ("[adc]\nnoise = true\n", "adc.noise = True: must be a number, 0 … 100 LSB"),
        ("[sensor]\ncount = 2.5\n", "whole number"),
        ("[link]\nstiff = 1\n", "true or false"),
        ("[solver]\nmethod = 3\n", "must be one of rk4, erkstep, reference"),
        ("[solver]\nmethod = 'erk'\n", "known: erkstep, reference, rk4"),
        ("noise = 1\n", "unknown key 'noise'"),
        ("description = 1\n", "must be text"),
        ("[parameters]\nspeed_rmp = 1\n", "did you mean 'speed_ramp'"),
        ("[parameters]\nspeed_ramp = -1\n", "0 … 100000 rpm/s"),
        ("[adc\n", "not valid TOML"),
    ],
)
def test_a_wrong_profile_is_refused_in_one_line(tmp_path, text, said):
    path = written(tmp_path, text)
    with pytest.raises(InputError) as caught:
        profile.load(path, SCHEMA, KNOWN)
    message = str(caught.value)
    assert said in message
    assert path in message
    assert "\n" not in message


def test_unknown_profiles_are_refused_with_what_there_is():
    with pytest.raises(InputError, match=r"did you mean 'bench'\? Or give a path"):
        profile.load("bensch", SCHEMA, KNOWN)
    with pytest.raises(InputError, match="no such file"):
        profile.load("./bench.toml.orig/none.toml", SCHEMA, KNOWN)


def test_later_plants_win_entry_by_entry():
    over = profile.merged({"adc": {"noise": 1.0, "inl": 2.0}}, {"adc": {"noise": 3.0}, "link": {"stiff": True}})
    assert over == {"adc": {"noise": 3.0, "inl": 2.0}, "link": {"stiff": True}}


def test_set_tells_plant_entries_from_parameters():
    both = changed("adc.noise=0.5", "speed_ramp = 1e3", "link.stiff=True", "solver.method=erkstep", "sensor.count=3")
    assert both.plant == {
        "adc": {"noise": 0.5},
        "link": {"stiff": True},
        "solver": {"method": "erkstep"},
        "sensor": {"count": 3},
    }
    assert both.parameters == {"speed_ramp": 1000.0}
    assert both.words[1] == "speed_ramp=1e3"


def test_the_last_of_two_changes_counts():
    assert changed("adc.noise=1", "adc.noise=2").plant == {"adc": {"noise": 2.0}}


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("adc.noise", "section.entry=value"),
        ("=3", "section.entry=value"),
        ("adc.noise=", "section.entry=value"),
        ("adc.nose=1", "did you mean 'noise'"),
        ("adcx.noise=1", "did you mean 'adc'"),
        ("noise=1", "did you mean 'adc.noise'"),
        ("speed_rmp=1", "did you mean 'speed_ramp'"),
        ("adc.noise=1A", "is in LSB, not in A"),
        ("inverter.turn_on_delay=1us", "is in ticks, not in us"),
        ("speed_ramp=300rpm", "is in rpm/s, not in rpm"),
        ("adc.noise=-0.1", "0 … 100 LSB"),
        ("adc.noise=loud", "'loud' is no number; 0 … 100 LSB"),
        ("adc.noise=true", "'true' is no number; 0 … 100 LSB"),
        ("adc.noise=1,5", "no comma"),
        ("adc.noise=1e999", "1e999 LSB is no number"),
        ("link.stiff=2", "true or false"),
    ],
)
def test_a_wrong_change_is_refused_with_its_value_and_what_is_allowed(word, said):
    message = complaint(word)
    assert said in message
    assert word.partition("=")[0] in message


@given(st.floats(0.0, 100.0))
def test_every_number_in_range_arrives_exactly(value):
    assert changed(f"adc.noise={value!r}").plant["adc"]["noise"] == value


@given(st.floats(allow_nan=True).filter(lambda value: not 0.0 <= value <= 100.0))
def test_no_number_out_of_range_arrives(value):
    assert "adc.noise" in complaint(f"adc.noise={value!r}")


@given(st.integers(-10, 10))
def test_whole_numbers_stay_whole(value):
    if value in (2, 3):
        assert type(changed(f"sensor.count={value}").plant["sensor"]["count"]) is int
    else:
        assert "2 … 3" in complaint(f"sensor.count={value}")


@given(st.text(max_size=40))
def test_any_word_is_either_taken_or_refused_in_one_line(word):
    """No input leads to another exception than the one that is shown as a line."""
    try:
        profile.changes([word], SCHEMA, KNOWN)
    except InputError as error:
        assert str(error)


def test_choices_of_parameters_may_be_given_by_name():
    law = core.Entry("speed_law", "", 0.0, 1.0, 0.0, "", choices=("predictive", "pi"))
    assert core.parameter({"speed_law": law}, "speed_law", "pi", "here") == 1.0
    with pytest.raises(InputError, match="known: pi, predictive"):
        core.parameter({"speed_law": law}, "speed_law", "p", "here")
