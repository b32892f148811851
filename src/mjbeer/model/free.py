"""Cans that are free in space: their specifications, and the numbers of their models.

The pendulums of a standing can's slosh are on ball joints: two hinges diverge in a can that
tumbles, and two slides do not follow gravity.
"""

import functools
import pathlib
import xml.etree.ElementTree as ET
from typing import NamedTuple

import mujoco
import numpy as np

from mjbeer import require
from mjbeer.exceptions import TemplateError, UnsupportedError
from mjbeer.model import looks, mjcf_file
from mjbeer.model.mjcf_file import Parameters
from mjbeer.model.setting import MUJOCO_INTEGRATORS, Setting
from mjbeer.theory.can import Can
from mjbeer.theory.scene import Scene, sliding
from mjbeer.theory.segment import segment
from mjbeer.theory.standing import Standing, standing

BREAKING = 0.02
"""Damping ratio that breaking waves add to a mode whose pendulum turns at the rate omega; it grows with
the square of that rate. It is chosen, not computed: with it thrown cans are stable at 5 ms. At an
elevation of 0.1 R it adds 2e-4."""
_LEAST_BOB_SHARE = 1e-3
"""Least share of a pendulum's inertia that its bob has about itself: MuJoCo moves nothing without
inertia. The bob is heavier by as much, and nearer to the pivot, so that the motion is exactly the
pendulum's."""
_BOB_SHARE_PER_DAMPING = 0.1
"""That share divided by the damping ratio: with less, the damping of a spin is too stiff for
RK4."""


def standing_spec(can: Standing, setting: Setting, visuals: bool, free: bool) -> mujoco.MjSpec:
    """Return the specification of a standing can; only a `free` one has a free joint and a
    floor."""
    integrator = require.choice("integrator", setting.integrator, MUJOCO_INTEGRATORS)
    root, path = _read_mechanics("standing", setting.folder)
    if not free:
        mjcf_file.remove(root, "freejoint", "geom[@name='surface']")
    _repeat_modes(root, can.moving_modes)
    options: Parameters = {
        ("option", "integrator"): integrator,
        ("option", "timestep"): (setting.timestep,),
    }
    mjcf_file.write(root, standing_parameters(can) | options, path)
    return looks.drawn_spec(root, path, can) if visuals else mjcf_file.parse_spec(root, path)


def attached_spec(can: Standing | Scene, visuals: bool = True) -> mujoco.MjSpec:
    """Return the specification of a can that is to be attached; it has no free joint yet."""
    if not isinstance(can, Scene):
        require.instance("can", can, Standing)
        return standing_spec(can, Setting(), visuals, free=False)
    root, path = _read_mechanics("lying", Setting().folder)
    mjcf_file.remove(root, "freejoint")
    if can.attachment == "frozen":
        mjcf_file.remove(root, "joint[@name='swing']", "jointpos", "jointvel")
    at_origin: Parameters = {
        ("body incline", "euler"): (0, 0, 0),
        ("body can", "euler"): (0, 0, 0),
        ("body can", "pos"): (0, 0, 0),
    }
    mjcf_file.write(root, lying_parameters(can) | at_origin, path)
    return looks.drawn_spec(root, path, can) if visuals else mjcf_file.parse_spec(root, path)


def _read_mechanics(name: str, folder: pathlib.Path) -> tuple[ET.Element, pathlib.Path]:
    """Return a mechanics file without keyframes, and its path; edited numbers are an error."""
    path = folder / "mechanics" / f"{name}.xml"
    root = mjcf_file.read(path)
    edited = mjcf_file.differences(root, _paper_parameters(name))
    if edited:
        raise TemplateError(f"{path} has numbers of its own in {', '.join(edited)}, into which mjbeer writes a can's")
    mjcf_file.remove(root, "keyframe")
    return root, path


def _repeat_modes(root: ET.Element, modes: int) -> None:
    """Replace the body and the sensor of "slosh1" by those of so many modes."""
    for parent in (*root.iterfind(".//body[@name='can']"), *root.iterfind("sensor")):
        for first in [child for child in parent if "slosh1" in child.get("name", "")]:
            parent.remove(first)
            text = ET.tostring(first, encoding="unicode")
            for mode in range(1, modes + 1):
                parent.append(ET.fromstring(text.replace("slosh1", f"slosh{mode}")))


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

    A share s makes a bob heavier by m s / (1 - s), as if so much of what does not slosh were moved
    to the pivot. Half of the mass and of the inertia of that part are left, which is light in a
    shallow liquid.
    """
    masses = can.slosh_masses()
    if len(masses) == 0:
        return masses
    wanted = np.maximum(_LEAST_BOB_SHARE, _BOB_SHARE_PER_DAMPING * can.damping_ratios())
    moved = masses * wanted / (1 - wanted)
    pivots = can.pivots() - can.height / 2
    bobs = pivots - can.gravity / can.frequencies() ** 2
    mass, first, second = can.total_moments() - [masses.sum(), masses @ bobs, masses @ bobs**2]
    middle = first / mass
    inertia = second - mass * middle**2
    # Without masses d_n at distances r_n from its middle, that part keeps I - sum(d_n r_n^2) less
    # what the shift of its middle takes: together no less than I - sum(d_n r_n^2) / (1 - sum(d_n) /
    # m), by Schwarz's inequality.
    most = min(mass / 2 / moved.sum(), inertia / 4 / (moved @ (pivots - middle) ** 2))
    moved *= min(1.0, most)
    return moved / (masses + moved)


def standing_parameters(can: Standing) -> Parameters:
    """Return the parameters of a standing can.

    Its origin is the middle of the inside of the bottom.

    What does not slosh is the body "liquid". Each mode is a body "slosh1", "slosh2" ... on a ball
    joint of its name. The masses, first and second moments of all of them together are those of
    theory, with the bobs as they are.
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
    """Return the inertial of what does not slosh: the moments of theory less those of the bobs."""
    middle = can.height / 2
    places = bobs.pivots - middle - bobs.arms
    sloshing = [
        bobs.masses.sum(),
        bobs.masses @ places,
        bobs.masses @ places**2 + bobs.spins.sum(),
    ]
    mass, first, second = can.total_moments() - sloshing
    level = second - first**2 / mass
    # Nothing drags a liquid along when the can turns about its axis, unless it is solid.
    axial = 1e-9 * level if can.moving_modes else can.mass * can.can.radius**2 / 2
    return _inertial("liquid", mass, middle + first / mass, (level, level, axial))


def lying_parameters(scene: Scene) -> Parameters:
    """Return the parameters of a lying can, in whose file the origin is on the axis."""
    shell = scene.can
    liquid = scene.load
    if liquid.fill is None:
        raise UnsupportedError(f"a can that is free in space has beer in it, got a load without a fill: {scene!r}")
    if scene.drag > 0:
        raise UnsupportedError(f"a can that is free in space has no drag of the air, got {scene.drag!r} kg/m")
    parameters: Parameters = {("geom can", "size"): (shell.radius, shell.length / 2)}
    if scene.attachment == "sliding":
        if shell.inertia == 0:
            raise UnsupportedError(
                "MuJoCo moves no can without inertia around a sliding load: give it some, as can=Can.sheet_metal()"
            )
        parameters["joint swing", "damping"] = tuple(scene.damping_law.coefficients)
    across = transverse_inertia(shell)
    parameters |= _inertial("can", shell.mass, 0.0, (across, shell.inertia, across))
    # The integrals of x^2 and y^2 over the mass; y is the axis, and x is level.
    xx = liquid.mass * shell.radius**2 * segment(liquid.fill).mean_square_across
    yy = liquid.mass * shell.length**2 / 12
    inertia = (liquid.inertia - xx + yy, liquid.inertia, xx + yy)
    return parameters | _inertial("load", liquid.mass, -liquid.offset, inertia)


@functools.cache
def _paper_parameters(name: str) -> Parameters:
    """Return the parameters that a mechanics file of mjbeer has as it stands."""
    if name == "lying":
        return lying_parameters(sliding(can=Can.sheet_metal()))
    return standing_parameters(standing())


def _inertial(body: str, mass: float, height: float, inertia: tuple[float, float, float]) -> Parameters:
    """Return the mass of a body, its centre of mass, and its inertia about x, y and z."""
    element = f"inertial {body}"
    return {
        (element, "mass"): (mass,),
        (element, "pos"): (0, 0, height),
        (element, "diaginertia"): inertia,
    }


def transverse_inertia(can: Can) -> float:
    """Return the moment of inertia of a can about a line across its middle [kg m^2].

    Mass and inertia about the axis leave one answer for a thin wall with two flat ends: the ends
    have the mass 2 (m - I/a^2), or as much of that as there is.
    """
    ends = min(max(2 * (can.mass - can.inertia / can.radius**2), 0.0), can.mass)
    return can.inertia / 2 + (can.mass + 2 * ends) * can.length**2 / 12
