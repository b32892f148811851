"""Rows of the audit: appendix A.4, the hoop that hops."""

import math
from collections.abc import Iterator
from functools import cache

import numpy as np

from mjbeer.paper.audit.claim import Claim, confirmed, limit
from mjbeer.paper.audit.motions import CONTACT, THEORY
from mjbeer.paper.equations import hopping
from mjbeer.paper.letters import Terms
from mjbeer.paper.scenarios import GRIP, MU, RATIO, TOP
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.scene import Scene, hoop
from mjbeer.theory.trajectory import Trajectory


def claims() -> Iterator[Claim]:
    """The rows."""
    yield limit(
        "sec. A.4", "Littlewood: lifts off at 90 degrees: beyond, at M/m = 1/20; within, at 1e-9", THEORY,
        lambda: (math.pi / 2, -hopping.lift_off(RATIO)), lambda: (math.pi / 2, -hopping.lift_off(1e-9)), 0.091, 1e-8,
        "M/m",
    )  # fmt: skip
    yield confirmed(
        "sec. A.4", "angle of lift-off at M/m = 1/20, by theory 99.0 degrees", CONTACT,
        lambda: (_parts(), -hopping.lift_off(RATIO)), 5e-3, "penetration of the contact, which unloads late",
    )  # fmt: skip
    yield confirmed(
        "sec. A.4", "Pritchett: hops from rest below M/m = 1/13", THEORY, lambda: (1 / 13, -hopping.threshold()), 1e-9,
        "the search for the least N",
    )  # fmt: skip
    yield confirmed(
        "sec. A.4", "in practice it skids first: at mu = 0.8 from 94.2 degrees on, by theory", CONTACT,
        lambda: (_skids(), -hopping.slip(RATIO, MU)), 5e-3, "what counts as skidding, and the push that starts it",
    )  # fmt: skip
    yield limit(
        "sec. A.4", "rolling without slipping cannot hop: beyond, held by friction alone; within, by a constraint",
        CONTACT, lambda: _heights("contact"), lambda: _heights("equality"), 0.58, 0.0, "it hops or not",
    )  # fmt: skip
    yield limit(
        "footnote 10", "nothing pushes at 90 degrees: beyond, the friction at lift-off for M/m = 1/20; within, 1e-9",
        THEORY, lambda: _push(RATIO), lambda: _push(1e-9), 0.146, 1e-8, "M/m",
    )  # fmt: skip


@cache
def fall(friction: float = GRIP) -> Trajectory:
    """The fall of a hoop with M/m = 1/20 in contact, from beside the top until its load has passed level."""
    return simulate(_hoop(), 0.5, TOP, rolling="contact", timestep=2e-5, friction=friction)


def _hoop() -> Scene:
    return hoop(hoop_mass=0.2 * RATIO, load_mass=0.2)


def _parts() -> float:
    """Angle from the top [rad] at which the can lifts off, if it never slips."""
    seen = fall().takeoff()
    return math.nan if seen is None else seen


def _skids() -> float:
    """Angle from the top [rad] at which the rim first moves along the ground, at 1e-5 of the axis's speed."""
    run = fall(MU)
    rim = np.abs(run.u_dot - run.scene.can.radius * run.roll_dot)
    return math.pi - float(run.phi[np.argmax(rim > 1e-5 * np.abs(run.u_dot).max())])


def _heights(rolling: str) -> Terms:
    """How high the axis of a hoop that is pushed gets, over the radius, and 1."""
    run = simulate(_hoop(), 0.3, -3.0, 16.0, rolling=rolling, timestep=1e-4, friction=GRIP)
    height = 1 + np.maximum(run.lift / run.scene.can.radius, 0.0)
    return height, -np.ones_like(height)


def _push(ratio: float) -> Terms:
    """The friction force over m g when N = 0, and 1."""
    return 1.0, abs(hopping.friction(ratio, math.pi - hopping.lift_off(ratio))), -1.0
