"""Rows of the audit: appendix A, equations (50)-(55), beer frozen to its can."""

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
    rolling_down,
    still,
    swung,
)
from mjbeer.paper.audit.witness import examine
from mjbeer.paper.equations import frozen as equations
from mjbeer.paper.letters import Terms
from mjbeer.paper.scenarios import balanced, footnote_scene
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.exact import exact
from mjbeer.theory.scene import Scene, frozen
from mjbeer.theory.trajectory import Trajectory

_CREEP = 1e-3
"""How far a can that slips has gone after a second, in radii, at the least; one that holds has gone 1e-7."""


def claims() -> Iterator[Claim]:
    """The rows."""
    yield from _motion()
    yield from _rest()
    yield from _small()
    yield from _rolling()


def _motion() -> Iterator[Claim]:
    seen = rolling_down()
    q = seen.quantities
    for form, name in enumerate(("u = a phi", "s = a phi - b sin(phi)")):
        yield confirmed(
            "(50)", name, CONTACT, lambda form=form: equations.eq_50(examine(_touching()).quantities)[form], 1e-6,
            "the can slips a little in its soft contact",
        )  # fmt: skip
    yield confirmed("(51)", "T", EQUALITY, lambda: (*equations.kinetic_51(q), -seen.kinetic), HELD, DRIFT)
    yield confirmed(
        "(51)", "V", EQUALITY, lambda: (*equations.potential_51(q), -seen.potential), EXACT, ROUNDING,
    )  # fmt: skip
    yield confirmed("(52)", "equation of motion of phi", EQUALITY, lambda: equations.eq_52(q), HELD, DRIFT)
    cm = footnote().quantities
    yield corrected(
        "footnote 8", "the equation as typed in: 3(1) sin(x) (x')^2; printed 3(0.5)", EQUALITY,
        lambda: equations.footnote_8(cm), lambda: equations.eq_52(cm), 0.32, HELD, DRIFT,
    )  # fmt: skip


def _rest() -> Iterator[Claim]:
    ice = frozen()
    yield confirmed(
        "(53)", "angle at which nothing turns the can", EQUALITY,
        lambda: (math.sin(_at_rest(ice) + ice.incline), -1 / ice.load.offset * ice.can.radius * math.sin(ice.incline)),
        EXACT, ROUNDING,
    )  # fmt: skip
    yield confirmed(
        "(53)", "there the centre of mass is above the contact", EQUALITY, lambda: _plumb(ice), EXACT, ROUNDING
    )
    yield confirmed(
        "sec. A.1", "steepest incline with an equilibrium, sin(alpha) = 4/(3 pi)", EQUALITY,
        lambda: (math.sin(_steepest()), -4 / (3 * math.pi)), EXACT, ROUNDING,
    )  # fmt: skip
    yield confirmed(
        "sec. A.1", "that is 25 degrees", EQUALITY, lambda: (25.0, -math.degrees(_steepest())), 2e-2,
        "half a unit of the last digit",
    )  # fmt: skip
    yield confirmed(
        "footnote 7", "least friction coefficient at which the can stays: tan(alpha)", CONTACT,
        lambda: (_least_friction(), -math.tan(ice.incline)), 1e-3, "bisection, and what counts as slipping",
    )  # fmt: skip


def _small() -> Iterator[Claim]:
    ice = frozen()
    rest, swing = ice.equilibrium(), 1e-3
    turned = rest + swing
    yield confirmed(
        "(54)", "change of cos(phi) to first order", "Taylor's series",
        lambda: (math.cos(turned) - math.cos(rest), -equations.cosine_54(math.sin(rest), swing)), 3e-3,
        "the next order: swing cot(phi_0)/2 = 2e-3",
    )  # fmt: skip
    change = math.sin(ice.incline + turned) - math.sin(ice.incline + rest)
    cosine = math.cos(ice.incline + rest)
    yield corrected(
        "(54)",
        "change of sin(alpha + phi) to first order: its sign",
        "Taylor's series",
        lambda: (change, -equations.printed_54(cosine, swing)),
        lambda: (change, -equations.sine_54(cosine, swing)),
        2.0,
        3e-4,
        "the next order: swing tan(alpha + phi_0)/2 = 2e-4",
    )
    measured, rocks = (swung(ice, start, rolling="equality").frequency() for start in (rest + SMALL, 0.0))
    yield corrected(
        "(55)", "omega of small oscillations: 2ab cos(phi_0); printed ab cos(phi_0)", EQUALITY,
        printed=lambda: (equations.printed_frequency_55(ice), -measured),
        right=lambda: (equations.frequency_55(ice), -measured),
        misses_by=0.21, bound=1e-6, reason="the amplitude: 3e-7",
    )  # fmt: skip
    yield limit(
        "sec. A.2", "from phi = 0 the can rocks with omega of (55): there, and within, at 1e-3 rad", EQUALITY,
        lambda: (equations.frequency_55(ice), -rocks), lambda: (equations.frequency_55(ice), -measured), 0.0154, 1e-6,
        "the amplitude: 3e-7",
    )  # fmt: skip


def _rolling() -> Iterator[Claim]:
    yield confirmed("footnote 9", "b = 0: phi = g sin(alpha) t^2/(3a)", EQUALITY, _cylinder, 1e-7, DRIFT)
    paper_s, nearly = footnote_scene(), footnote_scene(0.01)
    yield limit(
        "sec. A.3", "mean acceleration of a long roll-down (2/3) g sin(alpha): b = a/3; within, b = a/300", EQUALITY,
        lambda: (mean_acceleration(paper_s), -paper_s.acceleration()),
        lambda: (mean_acceleration(nearly), -nearly.acceleration()), 0.0264, 1e-3,
        "the start, of whose waves 1e-4 is left between 8 s and 16 s",
    )  # fmt: skip
    yield confirmed(
        "sec. A.3", "the same by exact theory: that over (mean of sqrt(J))^2 / (3 m a^2/2)", EQUALITY,
        lambda: (mean_acceleration(paper_s), -equations.long_run(paper_s.oscillator) * paper_s.can.radius), 1e-3,
        "the start, as above",
    )  # fmt: skip
    yield confirmed(
        "figure of A.3", "phi(t) of the roll-down from phi = pi, a = 3 cm, b = 1 cm", EQUALITY,
        lambda: (footnote().quantities.phi, -exact(paper_s, footnote().time, math.pi).phi), 1e-7, DRIFT,
    )  # fmt: skip
    yield confirmed(
        "figure of A.3", "time at which N = 0, after which a real can is not on the incline: 0.848 s", CONTACT,
        lambda: (_parts(paper_s), -exact(paper_s, np.linspace(0, 1, 10_001), math.pi).rolls_until()), 4e-3,
        "the soft contact, and that the can slips a moment before",
    )  # fmt: skip


@cache
def _parts(scene: Scene) -> float:
    """When the can has lifted off by a millionth of its radius [s], in contact, rolling down from the top."""
    run = simulate(scene, 0.9, math.pi, rolling="contact", timestep=1e-4, friction=1e3)
    return float(run.time[np.argmax(run.lift > 1e-6 * scene.can.radius)])


@cache
def _touching() -> Trajectory:
    return simulate(frozen(), 0.5, 0.0, rolling="contact", times=np.linspace(0, 0.5, 51))


def _turning(scene: Scene, phi: float) -> float:
    """phi_ddot [rad/s^2] of the can at rest at `phi` [rad], by MuJoCo."""
    model = build(scene, "equality", integrator=DOP853)
    data = mujoco.MjData(model)
    data.joint("slide").qpos[0], data.joint("roll").qpos[0] = scene.can.radius * phi, phi
    mujoco.mj_forward(model, data)
    return float(data.joint("roll").qacc[0])


def _at_rest(scene: Scene) -> float:
    """The angle [rad] between 0 and 60 degrees at which MuJoCo's acceleration changes sign."""
    return float(brentq(lambda phi: _turning(scene, phi), 0.0, math.pi / 3, xtol=1e-15))


def _plumb(scene: Scene) -> Terms:
    """The horizontal distances from the axis of the centre of mass and of the contact, uphill [m]."""
    phi = _at_rest(scene)
    return scene.load.offset * math.sin(phi + scene.incline), -scene.can.radius * math.sin(scene.incline)


@cache
def _steepest() -> float:
    """The incline [rad] from which on MuJoCo's can rolls off from everywhere."""
    return float(brentq(lambda incline: _turning(frozen(incline), math.pi / 2 - incline), 0.2, 0.8, xtol=1e-15))


@cache
def _least_friction() -> float:
    """By bisection, the friction coefficient from which on the can stays in a contact run of a second."""
    ice, low, high = frozen(), 0.1, 0.3
    while high - low > 1e-4:
        middle = (low + high) / 2
        low, high = (middle, high) if slides(ice, middle) else (low, middle)
    return high


def slides(scene: Scene, friction: float) -> bool:
    """Whether the can slides off its equilibrium, in contact at a friction coefficient."""
    run = simulate(scene, 1.0, scene.equilibrium(), rolling="contact", friction=friction)
    return float(np.abs(run.slip).max()) > _CREEP * scene.can.radius


def _cylinder() -> Terms:
    seen = still(balanced(0.5), "equality")
    q = seen.quantities
    return q.phi, -q.g * q.sin_alpha * seen.time**2 / (3 * q.a)


@cache
def mean_acceleration(scene: Scene) -> float:
    """Of the axis [m/s^2], between two passages of phi = pi (mod 2 pi) after 8 s and 16 s of a roll-down."""
    run = simulate(scene, 16, math.pi, rolling="equality", integrator=DOP853)
    moments, turned = [], []
    for time in (8.0, 16.0):
        last = float(np.interp(time, run.time, run.phi))
        whole = math.pi + 2 * math.pi * math.floor((last - math.pi) / (2 * math.pi))
        turned.append(whole - math.pi)
        moments.append(float(np.interp(whole, run.phi, run.time)))
    # sqrt(phi) grows evenly: phi = A t^2/2
    growth = (math.sqrt(turned[1]) - math.sqrt(turned[0])) / (moments[1] - moments[0])
    return 2 * growth**2 * scene.can.radius
