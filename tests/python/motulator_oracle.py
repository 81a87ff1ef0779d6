"""What motulator's inverter, machine and shaft do under a given sequence of gate edges and loads.

motulator's own right-hand side is integrated from edge to edge; the equations are nowhere written down again. Ticks are
10 ns.
"""

from __future__ import annotations

import collections

import numpy as np
from motulator.common.utils import abc2complex
from motulator.drive.model import Drive, StiffMechanicalSystem, SynchronousMachine, VoltageSourceConverter
from motulator.drive.utils import SynchronousMachinePars
from scipy.integrate import solve_ivp

TICK = 1e-8  # s
CURRENTS = ("i_a", "i_b", "i_c", "i_d", "i_q")
COLUMNS = (*CURRENTS, "torque", "speed", "angle")


def built(plant, start):
    """motulator's drive with the numbers of `plant`, in the state `start`."""
    m, s = plant["machine"], plant["mechanics"]
    numbers = SynchronousMachinePars(
        n_p=m["pole_pairs"], R_s=m["resistance"], L_d=m["inductance_d"], L_q=m["inductance_q"], psi_f=m["magnet_flux"]
    )
    drive = Drive(
        VoltageSourceConverter(u_dc=plant["link"]["source_voltage"]),
        SynchronousMachine(numbers),
        StiffMechanicalSystem(J=s["inertia"], B_L=s["viscous_friction"]),
    )
    machine, shaft = drive.machine.state, drive.mechanics.state
    machine.psi_s = complex(m["magnet_flux"] + m["inductance_d"] * start["i_d"], m["inductance_q"] * start["i_q"])
    machine.exp_j_theta_m = np.exp(1j * m["pole_pairs"] * start["angle"])
    shaft.w_M = start["speed"]
    shaft.exp_j_theta_M = np.exp(1j * start["angle"])
    return drive


def load_between(points, begin, end):
    """The load (N m) as a function of time (s) in an interval inside of which no point lies."""
    late = [p for p in points if p[0] <= begin][-1]
    early = next((p for p in points if p[0] >= end), late)
    slope = (early[1] - late[1]) / (early[0] - late[0]) / TICK if early[0] > late[0] else 0.0
    return lambda t: late[1] + slope * (t - late[0] * TICK)


def integrate(drive, points, begin, end):
    """One interval without an edge."""
    drive.mechanics.tau_L = load_between(points, begin, end)
    t = (begin * TICK, end * TICK)
    state = np.array(drive.get_initial_values(), complex)
    solution = solve_ivp(drive.rhs, t, state, "DOP853", rtol=1e-11, atol=1e-12, first_step=t[1] - t[0])
    drive.set_states(list(solution.y[:, -1]))


def seen(drive):
    """The state in the order of COLUMNS."""
    machine, shaft = drive.machine, drive.mechanics
    currents = [*machine.meas_currents(), machine.i_s.real, machine.i_s.imag]
    return [*currents, machine.tau_M, shaft.meas_speed(), shaft.meas_position()]


def voltage_side(drive, leg, on, off):
    """1 when the leg lies on the positive rail. With both switches off a diode carries on: whose, the current says."""
    return int(on) if on != off else int(drive.machine.meas_currents()[leg] < 0.0)


def published(plant, start, edges, points, at):
    """Column -> values at the ticks `at`.

    Args:
        plant: the entries of the plant; an ideal one, motulator knows no other.
        start: i_d, i_q (A), speed (rad/s) and angle (rad mechanical) at the first tick of `at`.
        edges: (tick, leg, upper, lower) in the order of time. motulator has no diodes: while both switches of a leg are
            off its current is taken to keep its sign.
        points: (tick, N m), the load, linear in between; two at one tick are a jump.
        at: ticks in the order of time.
    """
    drive = built(plant, start)
    upper, rows, ahead, looks = [0, 0, 0], [], collections.deque(edges), set(at)
    stops = sorted({t for t in looks | {e[0] for e in edges} | {p[0] for p in points} if at[0] <= t <= at[-1]})
    for begin, end in zip(stops, [*stops[1:], None], strict=True):
        if begin in looks:
            rows.append(seen(drive))
        while ahead and ahead[0][0] <= begin:
            _, leg, on, off = ahead.popleft()
            upper[leg] = voltage_side(drive, leg, on, off)
        drive.converter.inp.q_cs = abc2complex(upper)
        if end is not None:
            integrate(drive, points, begin, end)
    return dict(zip(COLUMNS, np.array(rows).T, strict=True))
