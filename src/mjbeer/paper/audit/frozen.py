"""Claims of appendix A about beer frozen to its can, equations (50)-(55): motion, equilibrium, small oscillations."""

import math
from collections.abc import Iterator
from functools import cache

import mujoco
import numpy as np
from scipy.optimize import brentq

from mjbeer.model.build import build
from mjbeer.model.setting import DOP853
from mjbeer.paper.audit.claim import Claim, confirmed, corrected, limit
from mjbeer.paper.audit.motions import (
    CONTACT,
    DRIFT,
    EQUALITY,
    EXACT,
    HELD,
    ROUNDING,
    SMALL,
    footnote,
    long_swing,
    rolling_down,
)
from mjbeer.paper.audit.witness import examine
from mjbeer.paper.equations import frozen as equations
from mjbeer.paper.letters import Terms
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.named import frozen
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

_CREEP = 1e-3
"""A can counts as slipping if it slips by more than this in a second, in radii; one that holds slips by 1e-7."""


def claims() -> Iterator[Claim]:
    """Yield the claims of this chapter."""
    yield from _motion()
    yield from _rest()
    yield from _small()


def _motion() -> Iterator[Claim]:
    motion = rolling_down()
    q = motion.quantities
    for form, name in enumerate(("u = a phi", "s = a phi - b sin(phi)")):
        yield confirmed(
            "(50)",
            name,
            witness=CONTACT,
            terms=lambda form=form: equations.eq_50(examine(_rocking_in_contact()).quantities)[form],
            bound=1e-6,
            reason="the can slips a little in its soft contact",
        )
    yield confirmed(
        "(51)",
        "T",
        witness=EQUALITY,
        terms=lambda: (*equations.kinetic_51(q), -motion.kinetic),
        bound=HELD,
        reason=DRIFT,
    )
    yield confirmed(
        "(51)",
        "V",
        witness=EQUALITY,
        terms=lambda: (*equations.potential_51(q), -motion.potential),
        bound=EXACT,
        reason=ROUNDING,
    )
    yield confirmed(
        "(52)",
        "equation of motion of phi",
        witness=EQUALITY,
        terms=lambda: equations.eq_52(q),
        bound=HELD,
        reason=DRIFT,
    )
    cm = footnote().quantities
    yield corrected(
        "footnote 8",
        "the equation as typed in: 3(1) sin(x) (x')^2; printed 3(0.5)",
        witness=EQUALITY,
        printed=lambda: equations.footnote_8(cm),
        right=lambda: equations.eq_52(cm),
        misses_by=0.32,
        bound=HELD,
        reason=DRIFT,
    )


def _rest() -> Iterator[Claim]:
    ice = frozen()
    yield confirmed(
        "(53)",
        "angle at which nothing turns the can",
        witness=EQUALITY,
        terms=lambda: (
            math.sin(_equilibrium(ice) + ice.incline),
            -1 / ice.load.offset * ice.can.radius * math.sin(ice.incline),
        ),
        bound=EXACT,
        reason=ROUNDING,
    )
    yield confirmed(
        "(53)",
        "there the centre of mass is above the contact",
        witness=EQUALITY,
        terms=lambda: _centre_of_mass_above_contact(ice),
        bound=EXACT,
        reason=ROUNDING,
    )
    yield confirmed(
        "sec. A.1",
        "steepest incline with an equilibrium, sin(alpha) = 4/(3 pi)",
        witness=EQUALITY,
        terms=lambda: (math.sin(_steepest_incline()), -4 / (3 * math.pi)),
        bound=EXACT,
        reason=ROUNDING,
    )
    yield confirmed(
        "sec. A.1",
        "that is 25 degrees",
        witness=EQUALITY,
        terms=lambda: (25.0, -math.degrees(_steepest_incline())),
        bound=2e-2,
        reason="half a unit of the last digit",
    )
    yield confirmed(
        "footnote 7",
        "least friction coefficient at which the can stays: tan(alpha)",
        witness=CONTACT,
        terms=lambda: (_least_friction(), -math.tan(ice.incline)),
        bound=1e-3,
        reason="bisection, and what counts as slipping",
    )


def _small() -> Iterator[Claim]:
    ice = frozen()
    rest, swing = ice.equilibrium(), 1e-3
    turned = rest + swing
    yield confirmed(
        "(54)",
        "change of cos(phi) to first order",
        witness="Taylor's series",
        terms=lambda: (math.cos(turned) - math.cos(rest), -equations.cosine_54(math.sin(rest), swing)),
        bound=3e-3,
        reason="the next order: swing cot(phi_0)/2 = 2e-3",
    )
    change = math.sin(ice.incline + turned) - math.sin(ice.incline + rest)
    cosine = math.cos(ice.incline + rest)
    yield corrected(
        "(54)",
        "change of sin(alpha + phi) to first order: its sign",
        witness="Taylor's series",
        printed=lambda: (change, -equations.printed_54(cosine, swing)),
        right=lambda: (change, -equations.sine_54(cosine, swing)),
        misses_by=2.0,
        bound=3e-4,
        reason="the next order: swing tan(alpha + phi_0)/2 = 2e-4",
    )
    measured, rocks = (long_swing(ice, start, rolling="equality").frequency() for start in (rest + SMALL, 0.0))
    yield corrected(
        "(55)",
        "omega of small oscillations: 2ab cos(phi_0); printed ab cos(phi_0)",
        witness=EQUALITY,
        printed=lambda: (equations.printed_frequency_55(ice), -measured),
        right=lambda: (equations.frequency_55(ice), -measured),
        misses_by=0.21,
        bound=1e-6,
        reason="the amplitude: 3e-7",
    )
    yield limit(
        "sec. A.2",
        "from phi = 0 the can rocks with omega of (55): there, and within, at 1e-3 rad",
        witness=EQUALITY,
        beyond=lambda: (equations.frequency_55(ice), -rocks),
        within=lambda: (equations.frequency_55(ice), -measured),
        misses_by=0.0154,
        bound=1e-6,
        reason="the amplitude: 3e-7",
    )


@cache
def _rocking_in_contact() -> Trajectory:
    """Return half a second of a can in contact, let go at phi = 0."""
    return simulate(frozen(), 0.5, 0.0, rolling="contact", times=np.linspace(0, 0.5, 51))


def _acceleration(scene: Scene, phi: float) -> float:
    """Return MuJoCo's phi_ddot [rad/s^2] of a can that is let go at `phi` [rad]."""
    model = build(scene, "equality", integrator=DOP853)
    data = mujoco.MjData(model)
    data.joint("slide").qpos[0], data.joint("roll").qpos[0] = scene.can.radius * phi, phi
    mujoco.mj_forward(model, data)
    return float(data.joint("roll").qacc[0])


def _equilibrium(scene: Scene) -> float:
    """Return the angle [rad] between 0 and 60 degrees at which MuJoCo's acceleration changes sign."""
    return float(brentq(lambda phi: _acceleration(scene, phi), 0.0, math.pi / 3, xtol=1e-15))


def _centre_of_mass_above_contact(scene: Scene) -> Terms:
    """Return the terms [m] of: the centre of mass and the contact have the same horizontal distance from the axis."""
    phi = _equilibrium(scene)
    return scene.load.offset * math.sin(phi + scene.incline), -scene.can.radius * math.sin(scene.incline)


@cache
def _steepest_incline() -> float:
    """Return the incline [rad] above which MuJoCo's can rolls off from any angle."""
    return float(brentq(lambda incline: _acceleration(frozen(incline), math.pi / 2 - incline), 0.2, 0.8, xtol=1e-15))


@cache
def _least_friction() -> float:
    """Return the least friction coefficient at which the can stays for a second in contact, by bisection."""
    ice, low, high = frozen(), 0.1, 0.3
    while high - low > 1e-4:
        middle = (low + high) / 2
        low, high = (middle, high) if _slides(ice, middle) else (low, middle)
    return high


def _slides(scene: Scene, friction: float) -> bool:
    """Return whether a can in contact slides off its equilibrium within a second, at a friction coefficient."""
    run = simulate(scene, 1.0, scene.equilibrium(), rolling="contact", friction=friction)
    return float(np.abs(run.slip).max()) > _CREEP * scene.can.radius
