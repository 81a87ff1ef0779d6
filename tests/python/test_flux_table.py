"""Tables of flux over current: what other programs write is taken over, and the plant runs on it."""

import importlib

import numpy as np
import pytest
import scipy.io
from typer.testing import CliRunner

from stillspin import cli, core
from stillspin.cases import flux_table, profile
from stillspin.errors import InputError

LAMBDA, LD, LQ, KNEE, CROSS = 0.16, 4.9e-3, 7.8e-3, 21.8, 1.1e-5


@pytest.fixture(scope="module")
def native():
    return importlib.import_module("stillspin._core")


def fluxes(i_d, i_q):
    """Motor A with saturation: the gradient of one energy."""
    return (
        LAMBDA + LD * i_d + 0.5 * CROSS * i_q**2,
        KNEE * LQ * np.arctan(i_q / KNEE) + CROSS * i_d * i_q,
    )


def grid():
    i_d, i_q = np.meshgrid(np.linspace(-20, 20, 21), np.linspace(-24, 24, 25))
    return i_d, i_q, *fluxes(i_d, i_q)


def told(*arguments):
    return CliRunner().invoke(cli.app, ["motor", "flux", *map(str, arguments)])


def by_syre(path, i_d, i_q, psi_d, psi_q):
    scipy.io.savemat(
        path,
        {
            "Id": i_d,
            "Iq": i_q,
            "Fd": psi_d,
            "Fq": psi_q,
            "T": psi_d * i_q - psi_q * i_d,
        },
    )


def by_axes(path, i_d, i_q, psi_d, psi_q):
    scipy.io.savemat(
        path,
        {"id_map": i_d[0], "iq_map": i_q[:, 0], "psid_map": psi_d, "psiq_map": psi_q},
    )


def by_motulator(path, i_d, i_q, psi_d, psi_q):
    np.savez(path, i_s_dq=i_d + 1j * i_q, psi_s_dq=psi_d + 1j * psi_q)


def by_columns(path, *tables):
    np.savetxt(
        path,
        np.column_stack([table.ravel() for table in tables]),
        delimiter=",",
        header="i_d,i_q,psi_d,psi_q",
    )


WAYS = {
    "syre.mat": by_syre,
    "axes.mat": by_axes,
    "motulator.npz": by_motulator,
    "columns.csv": by_columns,
}


@pytest.mark.parametrize("name", WAYS)
def test_tables_of_other_programs_are_taken_over(native, tmp_path, name):
    WAYS[name](tmp_path / name, *grid())
    result = told(tmp_path / name, "--out", tmp_path / "map.csv")
    assert result.exit_code == 0, result.output
    assert "525 points, i_d -20 … 20 A, i_q -24 … 24 A" in result.output
    assert "Ld 4.9 mH, Lq 7.8" in result.output
    assert "magnet 0.16 Vs" in result.output
    assert "turned" not in result.output
    found = flux_table.told(str(tmp_path / "map.csv"), native)
    assert found.inductance_d == pytest.approx(LD, rel=1e-4)
    assert found.inductance_q == pytest.approx(LQ, rel=3e-3)  # curvature of a spline with cells of 2 A


def test_a_table_with_the_magnet_along_minus_q_is_turned(native, tmp_path):
    """As those have it who call the axis of the larger inductance d."""
    i_d, i_q, psi_d, psi_q = grid()
    by_syre(tmp_path / "sr.mat", i_q, -i_d, psi_q, -psi_d)
    result = told(tmp_path / "sr.mat", "--out", tmp_path / "map.csv")
    assert "turned by a quarter" in result.output
    rows = np.loadtxt(tmp_path / "map.csv", delimiter=",", skiprows=2)
    np.testing.assert_allclose(rows[:, 2], fluxes(rows[:, 0], rows[:, 1])[0], atol=1e-7)
    np.testing.assert_allclose(rows[:, 3], fluxes(rows[:, 0], rows[:, 1])[1], atol=1e-7)


def test_what_no_machine_can_have_leaves_nothing_behind(tmp_path):
    i_d, i_q, psi_d, psi_q = grid()
    by_columns(tmp_path / "wrong.csv", i_d, i_q, psi_d + 0.004 * i_q, psi_q)
    result = told(tmp_path / "wrong.csv", "--out", tmp_path / "map.csv")
    assert result.exit_code == 2
    assert "contradict each other" in result.output
    assert not (tmp_path / "map.csv").exists()


def test_a_file_without_the_four_quantities_says_what_it_has(tmp_path):
    scipy.io.savemat(tmp_path / "other.mat", {"speed": np.arange(4.0)})
    with pytest.raises(InputError, match=r"has speed; must have Id, Iq, Fd, Fq; or"):
        flux_table.read(tmp_path / "other.mat")


MOTOR = """
[machine]
pole_pairs = 4
resistance = 0.32
flux_map = "map.csv"
rated_peak_current = 10.9

[mechanics]
inertia = 0.00455
viscous_friction = 0.003

[link]
source_voltage = 300.0

[adc]
current_range = 20.0
voltage_range = 450.0

[parameters]
current_limit = 14.0
speed_limit = 3300
"""


def test_a_motor_on_a_table_has_its_nameplate_from_it_and_runs(native, tmp_path):
    by_columns(tmp_path / "map.csv", *grid())
    (tmp_path / "mine.toml").write_text(MOTOR, encoding="utf-8")
    schema, known = core.plant_schema(native), core.parameters(native)
    chosen = profile.load("ideal", schema, known, str(tmp_path / "mine.toml"))
    assert chosen.parameters["inductance_d"] == pytest.approx(4.9, rel=1e-3)
    assert chosen.parameters["inductance_q"] == pytest.approx(7.8, rel=3e-3)
    assert chosen.parameters["magnet_flux"] == pytest.approx(0.16, rel=1e-4)
    assert not chosen.not_stated
    result = native.run(
        plant=profile.merged(chosen.plant, {"solver": {"method": "rk4"}}),
        parameters=chosen.parameters,
        commands=[(0.1, "speed_ref_rpm", 300.0)],
        load=[],
        duration=1.0,
        max_start=5.0,
        record_every=10,
        waveform=(0.0, 0.0, 1),
        seed=1,
        progress=None,
    )
    assert result.completed, result.reason
    assert result.signals["true_speed"][-1] == pytest.approx(300.0, abs=3.0)
