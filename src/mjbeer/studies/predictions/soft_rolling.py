"""Small motions of a can that soft constraints keep rolling, as matrices.

    q'' = F + G (c - J F),             F = -M^-1 (K q + D q'),
    G = M^-1 J^T (J M^-1 J^T + R)^-1,  c_i = -b_i (J q')_i - k_i (J q)_i

with the stiffness matrix K of gravity, the matrix D of the damping between can and load, the Jacobian J of the
constraint rows i, and MuJoCo's regularizer R. Written out, they are q'' = -P q - Q q'.

Damping is what an integrator may treat implicitly. "discrete" does so in everything: it solves the constraints and the
step with M + h D in place of M. "Euler", "implicit" and "implicitfast" solve the constraints with M, and then step with
q'' multiplied by (M + h D)^-1 M: the step does not obey the constraints which were solved. Only the damping of a tendon
is explicit under "Euler".
"""

import math
from dataclasses import dataclass

import numpy as np

from mjbeer.studies.predictions.linear_stability import RUNGE_KUTTA, amplification
from mjbeer.studies.predictions.soft_constraint import SoftRow
from mjbeer.theory.scene import Scene


@dataclass(frozen=True, eq=False, kw_only=True)
class System:
    """The linear equations of motion of a few coordinates q: masses, gravity, damping and constraint rows."""

    coordinates: tuple[str, ...]
    """The joints of the model, in the order of the matrices."""
    mass: np.ndarray
    """Mass matrix M, shape (n, n)."""
    gravity: np.ndarray
    """Stiffness matrix K of gravity, shape (n, n)."""
    damping: np.ndarray
    """Damping matrix D, shape (n, n)."""
    rows: tuple[tuple[np.ndarray, str], ...] = ()
    """The Jacobian and the kind of each row: "equality", "normal" or "friction"."""
    excess: float = 1.0
    """Factor by which MuJoCo overestimates the diagonal of an equality; 0 makes the equality hard."""
    impratio: float = 1.0
    """Hardness of the friction rows over that of the normal rows."""
    by_tendon: bool = False
    """Whether the damping is that of a tendon, which "Euler" takes explicitly."""

    def step(self, integrator: str, row: SoftRow, timestep: float) -> np.ndarray:
        """Return the matrix of one step of (q, h q') with a `timestep` h [s]; all but friction rows are like `row`."""
        friction = SoftRow(0.0, row.damping, row.impedance)
        mass, damped = self.mass, self.mass + timestep * self.damping
        if integrator == "discrete":
            mass, row, friction = damped, row.at_end_of_step(timestep), friction.at_end_of_step(timestep)
        stiffness, damping = np.linalg.solve(mass, self.gravity), np.linalg.solve(mass, self.damping)
        if self.rows:
            jacobian = np.array([row_jacobian for row_jacobian, _ in self.rows])
            gain = self._gain(mass, jacobian, row.impedance)
            k = [0.0 if kind == "friction" else row.stiffness for _, kind in self.rows]
            b = [(friction if kind == "friction" else row).damping for _, kind in self.rows]
            stiffness = stiffness + gain @ (np.diag(k) @ jacobian - jacobian @ stiffness)
            damping = damping + gain @ (np.diag(b) @ jacobian - jacobian @ damping)
        if integrator not in (*RUNGE_KUTTA, "discrete") and not (integrator == "Euler" and self.by_tendon):
            implicit = np.linalg.solve(damped, self.mass)
            stiffness, damping = implicit @ stiffness, implicit @ damping
        return amplification(integrator, stiffness * timestep**2, damping * timestep)

    def _gain(self, mass: np.ndarray, jacobian: np.ndarray, impedance: float) -> np.ndarray:
        """Return the matrix that makes accelerations of the coordinates from those asked of the rows."""
        mass_to_rows = np.linalg.solve(mass, jacobian.T)
        delassus = jacobian @ mass_to_rows
        softness = (1 - impedance) / impedance * delassus[0, 0]
        soft = {"equality": self.excess * softness, "normal": softness, "friction": softness / self.impratio}
        regularizer = np.diag([soft[kind] for _, kind in self.rows])
        return mass_to_rows @ np.linalg.inv(delassus + regularizer)


def by_coordinates(scene: Scene, angle: float) -> System:
    """Return the system of a sliding, damped load, in coordinates that allow nothing but rolling.

    `angle` is phi [rad], about which the load moves.
    """
    moment, ahead = scene.load.moment * math.cos(angle), np.array([-1 / scene.can.radius, 1.0])
    return System(
        coordinates=("slide", "phi"),
        mass=np.array([[scene.effective_mass, -moment], [-moment, scene.load.axis_inertia]]),
        gravity=np.diag([0.0, _stiffness(scene, angle)]),
        damping=scene.damping_law.linear * np.outer(ahead, ahead),
        by_tendon=True,
    )


def by_equality(scene: Scene, excess: float = 1.0, angle: float = 0.0) -> System:
    """Return the system of a load whose can rolls by the joint equality u = a roll, and which moves about an `angle`.

    A frozen load is on level ground, at phi = 0, its equilibrium.
    """
    joints, mass, gravity, damping = _matrices(scene, angle)
    row = np.array([1.0, -scene.can.radius, 0.0])[: len(joints)], "equality"
    return System(coordinates=joints, mass=mass, gravity=gravity, damping=damping, rows=(row,), excess=excess)


def by_contact(scene: Scene, depth: float, points: int, impratio: float, angle: float = 0.0) -> System:
    """Return the system of a load in a cylinder on a plane, which touches at several `points`, about an `angle`.

    The can sinks into the plane by `depth` [m] and rolls as if its radius were a - depth/2, where MuJoCo's contact is.
    A frozen load is on level ground, at phi = 0, its equilibrium.
    """
    joints, inertias, stiffness, between = _matrices(scene, angle)
    count = len(joints) + 1
    others = np.ix_([0, *range(2, count)], [0, *range(2, count)])
    mass, gravity, damping = np.zeros((3, count, count))
    mass[others], gravity[others], damping[others] = inertias, stiffness, between
    mass[1, 1] = scene.mass
    mass[1, 2:] = mass[2:, 1] = scene.load.moment * math.sin(angle)
    normal, sliding = np.array([[0.0, 1.0, 0.0, 0.0], [-1.0, 0.0, scene.can.radius - depth / 2, 0.0]])[:, :count]
    rows = ((normal, "normal"), (sliding, "friction")) * points
    names = (joints[0], "lift", *joints[1:])
    return System(coordinates=names, mass=mass, gravity=gravity, damping=damping, rows=rows, impratio=impratio)


def _matrices(scene: Scene, angle: float) -> tuple[tuple[str, ...], np.ndarray, np.ndarray, np.ndarray]:
    """Return the joints of a can and its load, and the matrices of mass, gravity and damping."""
    can, moment, inertia = scene.can, scene.load.moment * math.cos(angle), scene.load.axis_inertia
    stiffness = _stiffness(scene, angle)
    if scene.attachment == "frozen":
        mass = np.array([[scene.mass, -moment], [-moment, can.inertia + inertia]])
        return ("slide", "roll"), mass, np.diag([0.0, stiffness]), np.zeros((2, 2))
    mass = np.array(
        [[scene.mass, -moment, -moment], [-moment, can.inertia + inertia, inertia], [-moment, inertia, inertia]]
    )
    turned = np.array([0.0, 1.0, 1.0])  # phi is roll plus swing
    damping = np.diag([0.0, 0.0, scene.damping_law.linear])
    return ("slide", "roll", "swing"), mass, stiffness * np.outer(turned, turned), damping


def _stiffness(scene: Scene, angle: float) -> float:
    """Return the stiffness of gravity against a turn of the load about an angle phi [N m]."""
    return scene.load.moment * scene.gravity * math.cos(scene.incline + angle)
