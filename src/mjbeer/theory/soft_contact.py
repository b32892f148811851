"""A can on MuJoCo's soft contact: how deep it sinks, how fast it creeps, how it then rolls.

MuJoCo's contact is not rigid. Each direction of it is a row of the constraints with a force f
[N] and an acceleration a [m/s^2] that obey (manual, chapter Computation, "Constraint solver")

    R f = -b v - k r - a,

for the velocity v and the depth r of the row. The softness R is (1 - d)/d times an inverse mass,
where the impedance d grows with the depth. A row of friction has no spring, k = 0. Where nothing
accelerates, its force is a velocity times b/R: **MuJoCo's friction at rest is viscous**, and what
pulls at a contact moves it with

    v = F R/b.                                                                    (creep)

The normal row has a spring, which a weight N presses in until k r = R N. The point of contact lies
in the middle of this depth. A sunken can therefore rolls on a radius of a - r/2, not a.

**Cones.** In an elliptic cone the normal row has the softness R, and friction R/impratio. A
pyramid has four edges, each of which pushes and rubs at once. Together they act like a row of
normal force and two of friction, but their impedance refers to the mass that an edge moves: the
inverse mass is 1 + mu^2 times that of an elliptic cone. With mu = 1, a can on a pyramid creeps
twice as fast.

**Validity.** The rows are linear as long as all of them push: for an elliptic cone |F| < mu N, for
a pyramid |F| < mu N/2. `roll` refuses motions that leave this range. No number in this file was
taken from a run of MuJoCo.
"""

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple, get_args

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from mjbeer import require
from mjbeer.exceptions import ParameterError, UnsupportedError
from mjbeer.theory.scene import Scene

Cone = Literal["pyramidal", "elliptic"]
CONES: tuple[Cone, ...] = get_args(Cone)
TOLERANCE = 1e-7
"""Relative tolerance of DOP853 in `roll`, which is far below what the timestep does to a run."""
_DEEPEST = 1.0
"""Depth [m] that no can reaches: the upper end of the search for the depth at rest."""


@dataclass(frozen=True)
class SoftContact:
    """A contact of MuJoCo, by its attributes; each default is MuJoCo's.

    Raises:
      ParameterError: if a number is outside its range, or the cone is none of MuJoCo's.
    """

    time_constant: float = 0.02
    """solref[0] [s]."""
    damping_ratio: float = 1.0
    """solref[1]."""
    impedance_at_surface: float = 0.9
    """solimp[0], the impedance of a contact that has not sunk."""
    impedance_at_width: float = 0.95
    """solimp[1], the impedance at the depth `width` and below."""
    width: float = 0.001
    """solimp[2] [m]."""
    midpoint: float = 0.5
    """solimp[3], the share of `width` where the impedance grows fastest."""
    power: float = 2.0
    """solimp[4], how sharply it grows."""
    friction: float = 1.0
    """Coefficient of sliding friction, mu."""
    cone: Cone = "pyramidal"
    impratio: float = 1.0
    """Softness of the normal row divided by that of friction."""
    points: int = 2
    """Number of points that share the load: 2 for a cylinder, 1 for a sphere."""

    def __post_init__(self) -> None:
        require.choice("cone", self.cone, CONES)
        require.within("points", self.points, 1, 100)
        for name in ("time_constant", "damping_ratio", "width", "friction", "impratio"):
            require.positive(name, getattr(self, name))
        for name in ("impedance_at_surface", "impedance_at_width"):
            require.within(name, getattr(self, name), 1e-4, 0.9999)
        require.within("midpoint", self.midpoint, 1e-6, 1 - 1e-6)
        require.within("power", self.power, 1, 100)

    @property
    def damping(self) -> float:
        """Return b of all rows, 2/(d_w tau) [1/s]."""
        return 2 / (self.impedance_at_width * self.time_constant)

    def stiffness(self, depth: float) -> float:
        """Return k of the normal row at a `depth` [m], d/(d_w tau zeta)^2 [1/s^2]."""
        slowness = self.impedance_at_width * self.time_constant * self.damping_ratio
        return self.impedance(depth) / slowness**2

    def impedance(self, depth: float) -> float:
        """Return d at a `depth` [m]: two powers that meet at the midpoint."""
        share = min(max(depth / self.width, 0.0), 1.0)
        if share <= self.midpoint:
            grown = self.midpoint * (share / self.midpoint) ** self.power
        else:
            rest = 1 - self.midpoint
            grown = 1 - rest * ((1 - share) / rest) ** self.power
        rise = self.impedance_at_width - self.impedance_at_surface
        return self.impedance_at_surface + grown * rise

    def _softness(self, depth: float, inverse_mass: float) -> float:
        """Return R [1/kg] of all points together, before the cone changes it.

        The rows of friction have the impedance of the normal row: MuJoCo sets their R from it.
        """
        d = self.impedance(depth)
        edge = 1 + self.friction**2 if self.cone == "pyramidal" else 1.0
        return edge * inverse_mass * (1 - d) / d / self.points

    def friction_softness(self, depth: float, inverse_mass: float) -> float:
        """Return R [1/kg] of friction at a `depth` [m].

        `inverse_mass` [1/kg] is that of the body in MuJoCo, `body_invweight0`.
        """
        return self._softness(depth, inverse_mass) / self.impratio

    def normal_softness(self, depth: float, inverse_mass: float) -> float:
        """Return R [1/kg] of the normal force at a `depth` [m].

        The four edges of a pyramid have 2 mu^2 R/impratio each, and push together.
        """
        softness = self._softness(depth, inverse_mass)
        if self.cone == "elliptic":
            return softness
        return softness * self.friction**2 / (2 * self.impratio)

    def sink(self, normal_force: float, inverse_mass: float) -> float:
        """Return the depth r [m] at which a constant force [N] holds: k r = R N."""
        force = require.positive("normal_force", normal_force, "N")

        def excess(depth: float) -> float:
            pushed_in = self.normal_softness(depth, inverse_mass) * force
            return self.stiffness(depth) * depth - pushed_in

        return float(brentq(excess, 0.0, _DEEPEST, xtol=1e-15, rtol=1e-12))

    def creep_speed(self, force: float, depth: float, inverse_mass: float) -> float:
        """Return the speed [m/s] at which a constant `force` [N] along the surface moves a body.

        The `depth` [m] is that of `sink`. This is v = F R/b.
        """
        return force * self.friction_softness(depth, inverse_mass) / self.damping


class SoftMotion(NamedTuple):
    """A motion on a soft contact, at some times."""

    phi: np.ndarray
    """[rad]"""
    u: np.ndarray
    """Position of the axis along the incline [m]."""
    depth: np.ndarray
    """How deep the can has sunk [m]."""
    friction: np.ndarray
    """Force of friction on the can, uphill [N]."""
    normal: np.ndarray
    """Force of the incline on the can [N]."""


def roll(
    scene: Scene,
    contact: SoftContact,
    time: np.ndarray,
    phi0: float,
    phi_dot0: float = 0.0,
    inverse_mass: float | None = None,
) -> SoftMotion:
    """Return how a can with a frozen load rolls on a soft contact at increasing times [s].

    It starts with u = a phi at depth 0, without slip, as runs of MuJoCo do. `inverse_mass` [1/kg]
    is MuJoCo's for the body: without one it is 1/m, that of a free body. A body on joints that
    leave it a plane has 2/3 of that, the mean of its three directions.

    Raises:
      UnsupportedError: if the load is not frozen.
      ParameterError: if a row of the contact would have to pull.
    """
    if scene.attachment != "frozen":
        raise UnsupportedError(f"only a frozen load rolls here, got {scene.attachment!r}")
    time = require.times("time", time, increasing=True)
    phi0, phi_dot0 = require.start(phi0, phi_dot0)
    if inverse_mass is None:
        inverse_mass = 1 / scene.mass
    equations = _Equations(scene, contact, inverse_mass)
    radius = scene.can.radius
    start = [radius * phi0, 0.0, phi0, radius * phi_dot0, 0.0, phi_dot0]
    solved = solve_ivp(
        equations.rates,
        (0.0, time[-1]),
        start,
        method="DOP853",
        t_eval=time,
        rtol=TOLERANCE,
        atol=TOLERANCE * radius,
    )
    forces = np.array([equations.forces(state) for state in solved.y.T])
    friction, normal = forces.T
    share = 1.0 if contact.cone == "elliptic" else 0.5
    if np.any(np.abs(friction) > share * contact.friction * normal + 1e-12 * scene.mass):
        raise ParameterError("the can leaves the cone of friction, where the rows are not linear")
    u, lift, phi = solved.y[:3]
    return SoftMotion(phi, u, -lift, friction, normal)


class _Equations:
    """The equations of motion of a rigid can on a soft contact, in u, lift and phi."""

    def __init__(self, scene: Scene, contact: SoftContact, inverse_mass: float) -> None:
        self.contact = contact
        self.inverse_mass = inverse_mass
        self.mass = scene.mass
        self.moment = scene.load.moment
        self.axis_inertia = scene.load.axis_inertia + scene.can.inertia
        self.radius = scene.can.radius
        self.gravity = scene.gravity
        self.incline = scene.incline

    def rates(self, _: float, state: np.ndarray) -> np.ndarray:
        """Return the derivative of u, lift, phi and their rates."""
        return np.concatenate([state[3:], self._accelerations(state)])

    def forces(self, state: np.ndarray) -> tuple[float, float]:
        """Return friction, uphill, and normal force [N]."""
        depth = -state[1]
        if depth <= 0:
            return 0.0, 0.0
        along, away = self._rows(depth) @ self._accelerations(state)
        wanted_along, wanted_away = self._wanted(state)
        friction_softness, normal_softness = self._softness(depth)
        return (along - wanted_along) / friction_softness, (wanted_away - away) / normal_softness

    def _accelerations(self, state: np.ndarray) -> np.ndarray:
        """Return the accelerations of u, lift and phi."""
        phi = state[2]
        phi_dot = state[5]
        sine = self.moment * math.sin(phi)
        cosine = self.moment * math.cos(phi)
        mass = np.array(
            [
                [self.mass, 0.0, -cosine],
                [0.0, self.mass, sine],
                [-cosine, sine, self.axis_inertia],
            ]
        )
        weight = self.mass * self.gravity
        force = np.array(
            [
                weight * math.sin(self.incline) - sine * phi_dot**2,
                -weight * math.cos(self.incline) - cosine * phi_dot**2,
                -self.moment * self.gravity * math.sin(self.incline + phi),
            ]
        )
        depth = -state[1]
        if depth > 0:
            # R f = wanted - rows @ acceleration adds a mass rows^T rows/R and a force.
            rows = self._rows(depth)
            weighted = rows.T / self._softness(depth)
            mass = mass + weighted @ rows
            force = force + weighted @ self._wanted(state)
        return np.linalg.solve(mass, force)

    def _rows(self, depth: float) -> np.ndarray:
        """Return the Jacobian of the point of contact, which lies in the middle of the depth."""
        return np.array([[1.0, 0.0, -(self.radius - depth / 2)], [0.0, 1.0, 0.0]])

    def _softness(self, depth: float) -> np.ndarray:
        """Return R [1/kg] of friction and of the normal force."""
        return np.array(
            [
                self.contact.friction_softness(depth, self.inverse_mass),
                self.contact.normal_softness(depth, self.inverse_mass),
            ]
        )

    def _wanted(self, state: np.ndarray) -> np.ndarray:
        """Return the reference acceleration -b v - k r of the two rows [m/s^2]."""
        depth = -state[1]
        wanted = -self.contact.damping * (self._rows(depth) @ state[3:])
        wanted[1] += self.contact.stiffness(depth) * depth
        return wanted
