"""The numbers of the models of cans that are free in space: standing ones, and lying ones.

A pendulum stands for each mode of a standing can's slosh. Its joint is a ball: two hinges diverge
in a can that tumbles, and two slides do not follow gravity.
"""

from typing import NamedTuple

import numpy as np

from mjbeer.exceptions import UnsupportedError
from mjbeer.model.mjcf_file import Parameters
from mjbeer.theory.can import Can
from mjbeer.theory.scene import Scene
from mjbeer.theory.segment import segment
from mjbeer.theory.standing import Standing

BREAKING = 0.02
"""The damping that breaking waves add to a mode: a damping ratio of BREAKING (rate/omega)^2, where
`rate` is that of its pendulum. It is chosen, not computed: with it thrown cans are stable at 5 ms.
At an elevation of 0.1 R it adds 2e-4."""
_LEAST_BOB_SHARE = 1e-3
"""Least share of a pendulum's inertia that its bob has about itself: MuJoCo moves nothing without
inertia. The bob is heavier by as much, and nearer to the pivot, so that the motion is exactly the
pendulum's."""
_BOB_SHARE_PER_DAMPING = 0.1
"""That share divided by the damping ratio: with less, the damping of a spin is too stiff for
RK4."""


class Pendulums(NamedTuple):
    """The pendulums that stand for a liquid's modes; each array has shape (modes,)."""

    masses: np.ndarray
    """Masses of the bobs [kg]."""
    arms: np.ndarray
    """Distances of the bobs below their pivots [m]."""
    spins: np.ndarray
    """Moments of inertia of the bobs about themselves [kg m^2]."""
    pivots: np.ndarray
    """Heights of the pivots above the bottom [m]."""
    damping: np.ndarray
    """Torques divided by the rate [N m s]."""
    breaking: np.ndarray
    """Torques divided by the cube of the rate [N m s^3]."""


def pendulums(can: Standing) -> Pendulums:
    """Return the pendulums of a can's slosh."""
    share = bob_shares(can)
    omega = can.frequencies()
    masses = can.slosh_masses()
    lengths = can.gravity / omega**2
    critical_damping = 2 * omega * masses * lengths**2
    return Pendulums(
        masses=masses / (1 - share),
        arms=lengths * (1 - share),
        spins=share * masses * lengths**2,
        pivots=can.pivots(),
        damping=can.damping_ratios() * critical_damping,
        breaking=BREAKING / omega**2 * critical_damping,
    )


def bob_shares(can: Standing) -> np.ndarray:
    """Return the share of each pendulum's inertia that its bob has about itself.

    A pendulum does not change if part of its bob's inertia is about the bob itself, and the bob is
    heavier and nearer to the pivot. With a share s the bob gains the mass m s/(1 - s), which the
    rest of the liquid loses at the pivot. At least half of the mass and of the inertia of the rest
    is left, so that in a shallow liquid, which has a light rest, the shares are smaller.
    """
    masses = can.slosh_masses()
    if len(masses) == 0:
        return masses
    wanted = np.maximum(_LEAST_BOB_SHARE, _BOB_SHARE_PER_DAMPING * can.damping_ratios())
    moved = masses * wanted / (1 - wanted)
    # Heights above the middle of the liquid, and the moments of the rest about it.
    pivots = can.pivots() - can.height / 2
    bobs = pivots - can.gravity / can.frequencies() ** 2
    sloshing = [masses.sum(), masses @ bobs, masses @ bobs**2]
    mass, first, second = can.total_moments() - sloshing
    middle = first / mass
    inertia = second - mass * middle**2
    # Masses d_n are taken from the rest at distances r_n from its middle. With D = sum(d_n) and
    # Q = sum(d_n r_n^2) it keeps the mass m - D and the inertia I - Q - sum(d_n r_n)^2/(m - D)
    # about its new middle. By Schwarz's inequality sum(d_n r_n)^2 <= D Q, so that the inertia is
    # at least I - Q/(1 - D/m). With D <= m/2 and Q <= I/4 half of both is left.
    distances = pivots - middle
    scale = min(mass / 2 / moved.sum(), inertia / 4 / (moved @ distances**2))
    moved *= min(1.0, scale)
    return moved / (masses + moved)


def standing_parameters(can: Standing) -> Parameters:
    """Return the parameters of a standing can, whose origin is the middle of its bottom, inside.

    Each mode is a body "slosh1", "slosh2" ... on a ball joint of its name, and the rest of the
    liquid is the body "liquid". Together they have theory's mass, first and second moments.
    """
    shell = can.can
    half_length = shell.length / 2
    across = transverse_inertia(shell)
    parameters: Parameters = {
        ("option", "gravity"): (0, 0, -can.gravity),
        ("geom can", "size"): (shell.radius, half_length),
        ("geom can", "pos"): (0, 0, half_length),
    }
    parameters |= _inertial("can", shell.mass, half_length, (across, across, shell.inertia))
    bobs = pendulums(can)
    for mode in range(len(bobs.masses)):
        name = f"slosh{mode + 1}"
        spin = float(bobs.spins[mode])
        mass = float(bobs.masses[mode])
        parameters |= _inertial(name, mass, -float(bobs.arms[mode]), (spin, spin, spin))
        parameters[f"body {name}", "pos"] = (0, 0, float(bobs.pivots[mode]))
        damping = (float(bobs.damping[mode]), 0, float(bobs.breaking[mode]))
        parameters[f"joint {name}", "damping"] = damping
    return parameters | _fixed_liquid(can, bobs)


def _fixed_liquid(can: Standing, bobs: Pendulums) -> Parameters:
    """Return the inertial of the rest: theory's moments of the liquid less those of the bobs."""
    middle = can.height / 2
    places = bobs.pivots - middle - bobs.arms
    sloshing = [
        bobs.masses.sum(),
        bobs.masses @ places,
        bobs.masses @ places**2 + bobs.spins.sum(),
    ]
    mass, first, second = can.total_moments() - sloshing
    level = second - first**2 / mass
    # A can that turns about its axis takes the liquid along only if that does not slosh at all.
    axial = 1e-9 * level if can.moving_modes else can.mass * can.can.radius**2 / 2
    return _inertial("liquid", mass, middle + first / mass, (level, level, axial))


def lying_parameters(scene: Scene) -> Parameters:
    """Return the parameters of a lying can, in whose file the origin is on the axis."""
    shell = scene.can
    liquid = scene.load
    if liquid.fill is None:
        raise UnsupportedError(
            f"a can that is free in space has beer in it, got a load without a fill: {scene!r}"
        )
    if scene.drag > 0:
        raise UnsupportedError(
            f"a can that is free in space has no drag of the air, got {scene.drag!r} kg/m"
        )
    parameters: Parameters = {("geom can", "size"): (shell.radius, shell.length / 2)}
    if scene.attachment == "sliding":
        if shell.inertia == 0:
            raise UnsupportedError(
                "MuJoCo moves no can without inertia around a sliding load: "
                "give it some, as can=Can.sheet_metal()"
            )
        parameters["joint swing", "damping"] = tuple(scene.damping_law.coefficients)
    across = transverse_inertia(shell)
    parameters |= _inertial("can", shell.mass, 0.0, (across, shell.inertia, across))
    # The integrals of x^2, y^2 and z^2 over the mass; y is the axis, and x is level.
    xx = liquid.mass * shell.radius**2 * segment(liquid.fill).mean_square_across
    if liquid.sloshes_in is not None:
        # Across the axis the liquid sloshes, which gives the sum xx + zz alone. Halved, it leaves
        # no moment of inertia larger than the sum of the other two, which MuJoCo would refuse. With
        # that of ice the moment about z would be up to 23 % larger in a can of 33 x 120 mm.
        xx = liquid.inertia / 2
    zz = liquid.inertia - xx
    yy = liquid.mass * shell.length**2 / 12
    inertia = (yy + zz, liquid.inertia, xx + yy)
    return parameters | _inertial("load", liquid.mass, -liquid.offset, inertia)


def _inertial(
    body: str, mass: float, height: float, inertia: tuple[float, float, float]
) -> Parameters:
    """Return the mass of a body, its centre of mass, and its inertia about x, y and z."""
    element = f"inertial {body}"
    return {
        (element, "mass"): (mass,),
        (element, "pos"): (0, 0, height),
        (element, "diaginertia"): inertia,
    }


def transverse_inertia(can: Can) -> float:
    """Return the moment of inertia of a can about a line across its middle [kg m^2].

    The can is taken as a thin wall with two flat ends. Its mass and its inertia about the axis give
    the mass of the ends, 2 (m - I/a^2), which is kept between 0 and m.
    """
    ends = min(max(2 * (can.mass - can.inertia / can.radius**2), 0.0), can.mass)
    return can.inertia / 2 + (can.mass + 2 * ends) * can.length**2 / 12
