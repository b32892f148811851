"""The equations of motion against the Lagrangian of can and load, put into equations by SymPy."""

import math
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import MPContext

from mjbeer import Scene, exact, frozen, sliding
from mjbeer.exceptions import UnsupportedError
from mjbeer.studies.benchmark.peers import equations
from mjbeer.theory.can import Can
from mjbeer.theory.damping import Damping
from mjbeer.theory.equations import accelerations
from tests.support.scenes import METAL, SCENES, scenes

pytestmark = pytest.mark.slow

# Some ten roundings (1.1e-16) of terms that are each at most the scale that they are compared with; measured: 5e-16.
ROUNDING = 1.5e-15

mp = MPContext()
mp.dps = 30
mpf = Any  # numbers of that context

PARAMETERS = RADIUS, CAN, CAN_INERTIA, LOAD, OFFSET, INERTIA, GRAVITY, INCLINE = sp.symbols(
    "a m_can I_can m b I_cm g alpha"
)
PHI, U, PHI_DOT, U_DOT = STATE = sp.symbols("phi u phi_dot u_dot")


@cache
def lagrange(attachment: str) -> Callable[..., tuple[sp.Matrix, sp.Matrix]]:
    """Mass matrix and forces of Lagrange's equations in (phi, u), or in phi alone where u = a phi, compiled."""
    along = U_DOT - OFFSET * sp.cos(PHI) * PHI_DOT
    away = OFFSET * sp.sin(PHI) * PHI_DOT
    roll = U_DOT / RADIUS
    kinetic = (CAN * U_DOT**2 + CAN_INERTIA * roll**2 + LOAD * (along**2 + away**2) + INERTIA * PHI_DOT**2) / 2
    height = -OFFSET * sp.cos(PHI) * sp.cos(INCLINE) - (U - OFFSET * sp.sin(PHI)) * sp.sin(INCLINE)
    lagrangian = kinetic - GRAVITY * (LOAD * height - CAN * U * sp.sin(INCLINE))
    coordinates, rates = (PHI, U), (PHI_DOT, U_DOT)
    if attachment == "frozen":
        lagrangian = lagrangian.subs({U: RADIUS * PHI, U_DOT: RADIUS * PHI_DOT})
        coordinates, rates = (PHI,), (PHI_DOT,)
    momenta = sp.Matrix([lagrangian]).jacobian(rates).T
    forces = sp.Matrix([lagrangian]).jacobian(coordinates).T - momenta.jacobian(coordinates) * sp.Matrix(rates)
    names = {"sin": mp.sin, "cos": mp.cos, "ImmutableDenseMatrix": mp.matrix}
    return sp.lambdify([*PARAMETERS, *STATE], (momenta.jacobian(rates), forces), modules=[names])


def solved(scene: Scene, phi: float, phi_dot: float) -> list[mpf]:
    """phi_ddot, and u_ddot of a sliding load, in 30 digits at the very doubles of the scene."""
    can, load = scene.can, scene.load
    numbers = (can.radius, can.mass, can.inertia, load.mass, load.offset, load.inertia, scene.gravity, scene.incline)
    # Nothing depends on where the axis is, or on how fast it moves.
    masses, forces = lagrange(scene.attachment)(*(mp.mpf(each) for each in (*numbers, phi, 0.7, phi_dot, -0.3)))
    return list(mp.lu_solve(masses, forces))


def state(scene: Scene, phi: float, phi_dot: float) -> list[float]:
    return [phi, phi_dot] if scene.attachment == "frozen" else [0.7, phi, -0.3, phi_dot]


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.one_of(st.sampled_from(list(SCENES.values())), scenes()), st.floats(-4, 4), st.floats(-5, 5))
def test_equations_are_lagrange_s(scene: Scene, phi: float, swing: float) -> None:
    form, now = scene.oscillator, float(scene.oscillator.inertia(phi))
    torque = form.depth + abs(form.slope)
    phi_dot = swing * math.sqrt(torque / form.base)
    rates = equations.right_hand_side(scene)(1.0, state(scene, phi, phi_dot))
    truth = solved(scene, phi, phi_dot)
    scale = (torque + (form.chord + form.swing) * phi_dot**2) / now
    # J of a frozen load is written as base + chord/2 less chord/2 cos(phi).
    worst = ROUNDING * scale * (1 + form.chord / now)
    assert abs(rates[-1] - truth[0]) <= worst
    if scene.attachment == "frozen":
        assert rates[0] == phi_dot
        return
    assert rates[:2] == (-0.3, phi_dot)
    share = scene.load.offset  # m/M_e is at most 1
    steady = abs(scene.acceleration())
    assert abs(rates[2] - truth[1]) <= ROUNDING * (steady + share * phi_dot**2) + share * worst


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES.keys())
def test_the_theory_has_the_same_accelerations(scene: Scene) -> None:
    for phi, phi_dot in ((0.0, 0.0), (1.0, -3.0), (-2.5, 20.0)):
        rates = equations.right_hand_side(scene)(0.0, state(scene, phi, phi_dot))
        u_ddot, phi_ddot = accelerations(scene, phi, phi_dot, 0.0)
        size = 1 + phi_dot**2
        assert rates[-1] == pytest.approx(phi_ddot, rel=0, abs=ROUNDING * size * scene.frequency() ** 2)
        if scene.attachment == "sliding":
            assert rates[2] == pytest.approx(u_ddot, rel=ROUNDING)


@pytest.mark.parametrize("damping", [1e-4, 1.0])
@pytest.mark.parametrize("can", [Can(), METAL])
def test_damped_loads_have_the_accelerations_of_the_theory(can: Can, damping: float) -> None:
    scene = sliding(can=can, damping=damping)
    for phi, phi_dot, u_dot in ((0.0, 0.0, 1.0), (1.0, -3.0, -0.3), (-2.5, 20.0, 0.0)):
        rates = equations.right_hand_side(scene)(0.0, [0.7, phi, u_dot, phi_dot])
        u_ddot, phi_ddot = accelerations(scene, phi, phi_dot, u_dot)
        assert rates[:2] == (u_dot, phi_dot)
        assert rates[2:] == pytest.approx((float(u_ddot), float(phi_ddot)), rel=20 * ROUNDING)


@pytest.mark.parametrize("scene", [sliding(drag=0.1), sliding(damping=Damping(0.1, 0.2))])
def test_other_losses_are_refused(scene: Scene) -> None:
    with pytest.raises(UnsupportedError, match="linear damping alone"):
        equations.right_hand_side(scene)


@pytest.mark.parametrize("scene", [sliding(), sliding(can=METAL), SCENES["pendulum"]])
def test_a_load_at_its_equilibrium_accelerates_steadily(scene: Scene) -> None:
    rates = equations.right_hand_side(scene)(0.0, state(scene, scene.equilibrium(), 0.0))
    assert rates[2] == pytest.approx(scene.acceleration(), rel=ROUNDING)
    assert rates[3] == pytest.approx(0, abs=ROUNDING * scene.frequency() ** 2)


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES.keys())
def test_states_start_where_motions_do(scene: Scene) -> None:
    start = equations.start(scene, 1.2, -0.4)
    truth = exact(scene, [0.0], 1.2, -0.4)
    phi, u = equations.coordinates(scene, np.array([start]))
    assert (phi, u) == (pytest.approx([1.2]), pytest.approx(truth.u))
    # The first half of the rates of a state is its second half.
    half = len(start) // 2
    assert equations.right_hand_side(scene)(0.0, start)[:half] == start[half:]
    rates = equations.coordinates(scene, np.array([start[half:] * 2]))
    assert rates == (pytest.approx([-0.4]), pytest.approx(truth.u_dot))


@pytest.mark.parametrize("scene", [frozen(), sliding(can=METAL)])
def test_other_kinds_of_numbers(scene: Scene) -> None:
    symbols = sp.symbols("x:4")[: len(state(scene, 0, 0))]
    rates = equations.right_hand_side(scene, sp.sin, sp.cos)(0.0, symbols)
    values = state(scene, 0.6, -2.0)
    written = [float(sp.sympify(rate).subs(dict(zip(symbols, values, strict=True)))) for rate in rates]
    assert written == pytest.approx(equations.right_hand_side(scene)(0.0, values), rel=ROUNDING)


def test_equations_import_no_simulator_and_no_solver() -> None:
    names = {"mujoco", "scipy", "numba", "heyoka"}
    code = f"import sys, mjbeer.studies.benchmark.peers.equations; print(sorted({names} & set(sys.modules)))"
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (ran.stdout.strip(), ran.stderr) == ("[]", "")
