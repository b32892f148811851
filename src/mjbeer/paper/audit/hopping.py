"""Claims of appendix A.4 about the hoop that hops."""

import math
from collections.abc import Iterator
from functools import cache

import numpy as np

from mjbeer.model.setting import Rolling
from mjbeer.paper.audit.claim import Claim, confirmed, limit
from mjbeer.paper.audit.motions import CONTACT, THEORY
from mjbeer.paper.equations import hopping
from mjbeer.paper.letters import Terms
from mjbeer.paper.scenarios import GRIP, MU, RATIO, TOP
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.named import hoop
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory


def claims() -> Iterator[Claim]:
    """Yield the claims of this chapter."""
    yield limit(
        "sec. A.4",
        "Littlewood: lifts off at 90 degrees: beyond, at M/m = 1/20; within, at 1e-9",
        witness=THEORY,
        beyond=lambda: (math.pi / 2, -hopping.lift_off(RATIO)),
        within=lambda: (math.pi / 2, -hopping.lift_off(1e-9)),
        misses_by=0.091,
        bound=1e-8,
        reason="M/m",
    )
    yield confirmed(
        "sec. A.4",
        "angle of lift-off at M/m = 1/20, by theory 99.0 degrees",
        witness=CONTACT,
        terms=lambda: (_lift_off_angle(), -hopping.lift_off(RATIO)),
        bound=5e-3,
        reason="penetration of the contact, which unloads late",
    )
    yield confirmed(
        "sec. A.4",
        "Pritchett: hops from rest below M/m = 1/13",
        witness=THEORY,
        terms=lambda: (1 / 13, -hopping.threshold()),
        bound=1e-9,
        reason="the search for the least N",
    )
    yield confirmed(
        "sec. A.4",
        "in practice it skids first: at mu = 0.8 from 94.2 degrees on, by theory",
        witness=CONTACT,
        terms=lambda: (_skid_angle(), -hopping.slip(RATIO, MU)),
        bound=5e-3,
        reason="what counts as skidding, and the push that starts it",
    )
    yield limit(
        "sec. A.4",
        "rolling without slipping cannot hop: beyond, held by friction alone; within, by a constraint",
        witness=CONTACT,
        beyond=lambda: _axis_height_is_radius("contact"),
        within=lambda: _axis_height_is_radius("equality"),
        misses_by=0.58,
        bound=0.0,
        reason="it hops or not",
    )
    yield limit(
        "footnote 10",
        "nothing pushes at 90 degrees: beyond, the friction at lift-off for M/m = 1/20; within, 1e-9",
        witness=THEORY,
        beyond=lambda: _friction_is_zero(RATIO),
        within=lambda: _friction_is_zero(1e-9),
        misses_by=0.146,
        bound=1e-8,
        reason="M/m",
    )


@cache
def fall(friction: float = GRIP) -> Trajectory:
    """Return the fall of a hoop with M/m = 1/20 in contact, from beside the top until its load is below the axis."""
    return simulate(_hoop(), 0.5, TOP, rolling="contact", timestep=2e-5, friction=friction)


def _hoop() -> Scene:
    return hoop(hoop_mass=0.2 * RATIO, load_mass=0.2)


def _lift_off_angle() -> float:
    """Return the angle from the top [rad] at which the hoop lifts off if it does not slip; NaN if it stays down."""
    angle = fall().takeoff()
    return math.nan if angle is None else angle


def _skid_angle() -> float:
    """Return the angle from the top [rad] at which the rim slides faster than 1e-5 of the axis's top speed."""
    run = fall(MU)
    rim = np.abs(run.u_dot - run.scene.can.radius * run.roll_dot)
    return math.pi - float(run.phi[np.argmax(rim > 1e-5 * np.abs(run.u_dot).max())])


def _axis_height_is_radius(rolling: Rolling) -> Terms:
    """Return the terms of: the axis of a hoop that starts with a push stays one radius high, in radii."""
    run = simulate(_hoop(), 0.3, -3.0, 16.0, rolling=rolling, timestep=1e-4, friction=GRIP)
    height = 1 + np.maximum(run.lift / run.scene.can.radius, 0.0)
    return height, -np.ones_like(height)


def _friction_is_zero(ratio: float) -> Terms:
    """Return the terms of F/(m g) = 0 at the moment when N = 0; 1, added and subtracted, sets the error's scale."""
    return 1.0, abs(hopping.friction(ratio, math.pi - hopping.lift_off(ratio))), -1.0
