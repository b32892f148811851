"""Appendix A.4 of the paper: a hoop of mass M with a point mass m on its rim, which may hop.

The point mass falls from the top. The paper has no equations for this; those here hold while the
hoop rolls without slipping on level ground. `ratio` is M/m, and phi [rad] is 0 where the point mass
is at the bottom.
"""

import math
from functools import cache, partial
from types import SimpleNamespace
from typing import Any

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from mjbeer.model.setting import Rolling
from mjbeer.paper.claim import Bound, Claim, Limit, Witness
from mjbeer.paper.witness import CONTACT, GRIP
from mjbeer.simulation.run import Run
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.paper_scenes import hoop
from mjbeer.theory.scene import Scene

RATIO = 1 / 20  # M/m of the hoop that hops
MU = 0.8  # friction coefficient of the hoop that skids: the kinetic one in the paper's last figure
TOP = math.pi - 0.05
"""Angle phi [rad] at which a hoop is let go: a little beside pi, where it would stay in balance."""


def rate_squared(ratio: float, phi: float | np.ndarray) -> Any:
    """Return phi_dot^2 a/g of a hoop that fell from rest at the top, phi = pi.

    Energy is conserved: (2 M + 4 m sin^2(phi/2)) a^2 phi_dot^2/2 = m g a (1 + cos(phi)).
    """
    return 2 * np.cos(phi / 2) ** 2 / (ratio + 2 * np.sin(phi / 2) ** 2)


def acceleration(ratio: float, phi: float | np.ndarray) -> Any:
    """Return phi_ddot a/g, which is half the derivative of `rate_squared` by phi."""
    return -np.sin(phi) * (1 + ratio / 2) / (ratio + 2 * np.sin(phi / 2) ** 2) ** 2


def normal(ratio: float, phi: float | np.ndarray) -> Any:
    """Return N/(m g) = 1 + M/m + (sin(phi) phi_ddot + cos(phi) phi_dot^2) a/g."""
    return (
        1 + ratio + np.sin(phi) * acceleration(ratio, phi) + np.cos(phi) * rate_squared(ratio, phi)
    )


def friction(ratio: float, phi: float | np.ndarray) -> Any:
    """Return F/(m g), positive uphill or, on level ground, against the rolling.

    F/(m g) = -((1 + M/m) phi_ddot - cos(phi) phi_ddot + sin(phi) phi_dot^2) a/g.
    """
    turning = acceleration(ratio, phi)
    return -((1 + ratio) * turning - np.cos(phi) * turning + np.sin(phi) * rate_squared(ratio, phi))


def _least_normal(ratio: float) -> tuple[float, float]:
    """Return the least N/(m g) during the fall, and the phi [rad] at which it is."""
    least = minimize_scalar(
        lambda phi: normal(ratio, phi), bounds=(0.3, 3.1), options={"xatol": 1e-9}
    )
    return float(least.fun), float(least.x)


def lift_off(ratio: float) -> float:
    """Return the angle from the top [rad] at which N = 0; NaN if N stays positive."""
    least, phi_of_least = _least_normal(ratio)
    if least >= 0:
        return math.nan
    lifts = brentq(lambda phi: normal(ratio, phi), phi_of_least, math.pi, xtol=1e-14)
    return math.pi - float(lifts)


def slip(ratio: float, mu: float) -> float:
    """Return the angle from the top [rad] at which |F| first reaches mu N; NaN if it never does."""

    def margin(phi: float | np.ndarray) -> Any:
        return mu * normal(ratio, phi) - np.abs(friction(ratio, phi))

    angles = math.pi * (1 - np.arange(1, 2000) / 2000)
    slips = np.flatnonzero(margin(angles[1:]) < 0)
    if not slips.size:
        return math.nan
    return math.pi - float(brentq(margin, angles[slips[0] + 1], angles[slips[0]], xtol=1e-14))


def _threshold() -> float:
    """Return the M/m below which the least N is negative."""
    return float(brentq(lambda ratio: _least_normal(ratio)[0], 0.05, 0.1, xtol=1e-14))


def _hoop(ratio: float) -> Scene:
    """Return a hoop of the mass ratio M/m on level ground."""
    return hoop(hoop_mass=0.2 * ratio, load_mass=0.2)


def fall(ratio: float, friction: float, timestep: float) -> Run:
    """Return half a second of a hoop in contact that is let go at `TOP`.

    Within this time it lifts off, if it does so at all.
    """
    return simulate(_hoop(ratio), 0.5, TOP, rolling="contact", timestep=timestep, friction=friction)


def takeoff(run: Run) -> float | None:
    """Return the load's angle from the top [rad] when the hoop lifts off; None if it stays.

    A hoop up to 1e-9 radii above the ground counts as touching: a soft contact sinks in by more.
    """
    above = run.lift > 1e-9 * run.scene.can.radius
    return math.pi - float(run.phi[np.argmax(above)]) if above.any() else None


@cache
def _lifts_off() -> SimpleNamespace:
    """Return the angle from the top [rad] at which the hoop lifts off, simulated and by theory."""
    return SimpleNamespace(angle=takeoff(fall(RATIO, GRIP, 2e-5)), theory=lift_off(RATIO))


@cache
def _skids() -> SimpleNamespace:
    """Return the angle from the top [rad] at which the rim begins to slide, also by theory.

    It counts as sliding above 1e-5 of the largest speed of the axis.
    """
    run = fall(RATIO, MU, 2e-5)
    rim = np.abs(run.u_dot - run.scene.can.radius * run.roll_dot)
    slides = rim > 1e-5 * np.abs(run.u_dot).max()
    angle = math.pi - float(run.phi[np.argmax(slides)])
    return SimpleNamespace(angle=angle, theory=slip(RATIO, MU))


@cache
def _height(rolling: Rolling) -> np.ndarray:
    """Return the height of the axis [radii] at each sample, for a hoop that starts with a push."""
    run = simulate(_hoop(RATIO), 0.3, -3.0, 16.0, rolling=rolling, timestep=1e-4, friction=GRIP)
    return 1 + np.maximum(run.lift / run.scene.can.radius, 0.0)


def _friction_at_lift_off(ratio: float) -> float:
    """Return |F|/(m g) when the hoop lifts off, by theory."""
    return abs(friction(ratio, math.pi - lift_off(ratio)))


_THEORY = "exact theory"

CLAIMS = (
    Claim(
        "sec. A.4",
        "Littlewood: lifts off at 90 degrees: beyond, at M/m = 1/20; within, at 1e-9",
        Witness(_THEORY, partial(lift_off, 1e-9)),
        Bound(1e-8, "M/m"),
        residual="pi/2 - observed",
        limit=Limit(0.091, partial(lift_off, RATIO)),
        quote="The hoop lifts off the ground when the radius vector to the weight becomes "
        "horizontal.",
    ),
    Claim(
        "sec. A.4",
        "angle of lift-off at M/m = 1/20, by theory 99.0 degrees",
        Witness(CONTACT, _lifts_off),
        Bound(5e-3, "penetration of the contact, which unloads late"),
        residual="angle - theory",
        quote="the can leaves the surface briefly",
    ),
    Claim(
        "sec. A.4",
        "Pritchett: hops from rest below M/m = 1/13",
        Witness(_THEORY, _threshold),
        Bound(1e-9, "the search for the least N"),
        residual="1/13 - observed",
        quote="valid only if the mass of the unloaded hoop is nonzero",
    ),
    Claim(
        "sec. A.4",
        "in practice it skids first: at mu = 0.8 from 94.2 degrees on, by theory",
        Witness(CONTACT, _skids),
        Bound(5e-3, "what counts as skidding, and the start 0.05 rad beside the top"),
        residual="angle - theory",
        quote="In actual practice the hoop skids first.",
    ),
    Claim(
        "sec. A.4",
        "rolling without slipping cannot hop: beyond, held by friction alone; within, by a "
        "constraint",
        Witness(CONTACT, partial(_height, "equality")),
        Bound(0.0, "it hops or not"),
        residual="observed - 1",
        limit=Limit(0.58, partial(_height, "contact")),
        quote="A rigid can that is somehow constrained to roll without slipping cannot hop.",
    ),
    Claim(
        "footnote 10",
        "nothing pushes at 90 degrees: beyond, the friction at lift-off for M/m = 1/20; within, "
        "1e-9",
        Witness(_THEORY, partial(_friction_at_lift_off, 1e-9)),
        Bound(1e-8, "M/m"),
        residual="observed",
        scale="1",  # friction is in weights
        limit=Limit(0.146, partial(_friction_at_lift_off, RATIO)),
        quote="valid only if the mass of the unloaded hoop is nonzero, in contrast to Littlewood's "
        "idealization",
    ),
)
