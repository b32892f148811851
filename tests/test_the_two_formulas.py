"""The two formulas that everything here is named for: the closed forms beside MuJoCo.

First the files of `mjcf/mechanics` by plain MuJoCo, as anyone has it, then mjbeer's `simulate` for
the ways of rolling.
"""

import math
import pathlib

import mujoco
import numpy as np
import pytest

from mjbeer import frozen, simulate, sliding

MECHANICS = pathlib.Path(__file__).parents[1] / "mjcf" / "mechanics"
A = 0.033  # radius [m], gravity [m/s^2] and incline [rad] of the files
G = 9.81
ALPHA = math.radians(10)
B = (
    4 * A / (3 * math.pi)
)  # eq. (7): how far the centre of mass of half a can of beer is below its axis


def frequency(alpha: float) -> float:
    """Eq. (10), as it should be printed: half a massless can of beer that slides without friction
    [rad/s]."""
    return math.sqrt(24 * math.pi * G * math.cos(alpha) / ((9 * math.pi**2 - 32) * A))


def equilibrium(alpha: float) -> float:
    """Eq. (53): where half a can of beer that is frozen to its massless can rests [rad]."""
    return math.asin(A * math.sin(alpha) / B) - alpha


def load(name: str) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = mujoco.MjModel.from_xml_path(str(MECHANICS / f"{name}.xml"))
    return model, mujoco.MjData(model)


def test_small_oscillations_match_equation_10() -> None:
    model, data = load("sliding_reduced")
    data.joint("phi").qpos = 1e-4  # at which the period is longer by 1e-4^2/16, and less
    crossings = []
    before = 0.0
    while len(crossings) < 21:
        mujoco.mj_step(model, data)
        now = float(data.joint("phi").qpos[0])
        if before * now < 0:  # phi goes through 0, along a straight line: it has no curvature there
            crossings.append(data.time - model.opt.timestep * now / (now - before))
        before = now
    # RK4 has a phase error of (omega h)^4/120, 3e-9, and a crossing one of omega^2 h^3/16, 2e-8 s
    # in 1.7 s.
    measured = math.pi * 20 / (crossings[-1] - crossings[0])
    assert measured == pytest.approx(frequency(ALPHA), rel=1e-7)


@pytest.mark.parametrize("degrees", [1, 10, 30])
def test_small_oscillations_match_equation_10_on_any_incline(degrees: float) -> None:
    run = simulate(sliding(math.radians(degrees)), 2.0, phi0=1e-4, tolerance=1e-12)
    # At 1e-4 rad it is lower by 2e-9 of itself.
    assert run.frequency() == pytest.approx(frequency(math.radians(degrees)), rel=1e-8)


@pytest.mark.parametrize(
    ("name", "allowed"), [("reduced", 1e-6), ("equality", 1e-6), ("contact", 2e-5)]
)
def test_frozen_equilibrium_matches_equation_53(name: str, allowed: float) -> None:
    """From the keyframe it stays there for 5 s; the constraints are soft, and a contact creeps."""
    model, data = load(f"frozen_{name}")
    mujoco.mj_resetDataKeyframe(model, data, model.key("equilibrium").id)
    phi = data.joint("phi" if name == "reduced" else "roll").qpos
    assert phi[0] == pytest.approx(equilibrium(ALPHA), rel=1e-11)  # 12 digits
    for _ in range(5000):
        mujoco.mj_step(model, data)
        assert abs(phi[0] - equilibrium(ALPHA)) < allowed


@pytest.mark.parametrize(
    ("rolling", "allowed"), [("reduced", 1e-6), ("equality", 1e-6), ("contact", 2e-5)]
)
@pytest.mark.parametrize(
    ("fill", "degrees"), [(0.2, 1), (0.2, 10), (0.5, 3), (0.5, 20), (0.8, 1), (0.8, 5)]
)
def test_frozen_equilibrium_matches_equation_53_with_any_fill(
    rolling: str, allowed: float, fill: float, degrees: float
) -> None:
    """With b of eq. (35) for the fill h/2a of eq. (32)."""
    alpha = math.radians(degrees)
    beta = math.acos(1 - 2 * fill)
    b = 2 * A * math.sin(beta) ** 3 / (3 * (beta - math.sin(beta) * math.cos(beta)))
    rest = math.asin(A * math.sin(alpha) / b) - alpha
    run = simulate(frozen(alpha, fill), 2.0, phi0=rest, rolling=rolling)
    assert np.abs(run.phi - rest).max() < allowed
