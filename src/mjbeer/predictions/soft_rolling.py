"""Small motions of a frozen load on level ground that soft constraints keep rolling, as matrices.

    q'' = -P q + G (c - J (-P q)),   c_i = -b_i (J q')_i - k_i (J q)_i,   G = M^-1 J^T (J M^-1 J^T + R)^-1

with P = M^-1 times the stiffness of gravity, the Jacobian J of the constraint rows i, and MuJoCo's regularizer R.
Written out, they are q'' = -K q - B q'.
"""

from dataclasses import dataclass

import numpy as np

from mjbeer.predictions.linear_stability import amplification
from mjbeer.predictions.soft_constraint import SoftRow
from mjbeer.theory.scene import Scene


@dataclass(frozen=True, eq=False)
class System:
    """The linear equations of motion of a few coordinates q: masses, gravity and constraint rows."""

    coordinates: tuple[str, ...]
    """The joints of the model, in the order of the matrices."""
    mass: np.ndarray
    """Mass matrix M, shape (n, n)."""
    gravity: np.ndarray
    """Stiffness matrix of gravity, shape (n, n)."""
    rows: tuple[tuple[np.ndarray, str], ...]
    """The Jacobian and the kind of each row: "equality", "normal" or "friction"."""
    excess: float = 1.0
    """Factor by which MuJoCo overestimates the diagonal of an equality."""
    impratio: float = 1.0
    """Hardness of the friction rows over that of the normal rows."""

    def step(self, integrator: str, row: SoftRow, timestep: float) -> np.ndarray:
        """Return the matrix of one step of (q, h q') with a `timestep` h [s]; all but friction rows are like `row`."""
        friction = SoftRow(0.0, row.damping, row.impedance)
        if integrator == "discrete":
            row, friction = row.at_end_of_step(timestep), friction.at_end_of_step(timestep)
        jacobian = np.array([row_jacobian for row_jacobian, _ in self.rows])
        mass_to_rows = np.linalg.solve(self.mass, jacobian.T)
        delassus = jacobian @ mass_to_rows
        softness = (1 - row.impedance) / row.impedance * delassus[0, 0]
        soft = {"equality": self.excess * softness, "normal": softness, "friction": softness / self.impratio}
        regularizer = np.diag([soft[kind] for _, kind in self.rows])
        gain = mass_to_rows @ np.linalg.inv(delassus + regularizer)
        stiffness = np.diag([0.0 if kind == "friction" else row.stiffness for _, kind in self.rows])
        damping = np.diag([(friction if kind == "friction" else row).damping for _, kind in self.rows])
        free = np.linalg.solve(self.mass, self.gravity)
        total = free - gain @ jacobian @ free + gain @ stiffness @ jacobian
        return amplification(integrator, total * timestep**2, gain @ damping @ jacobian * timestep)


def by_equality(scene: Scene, excess: float = 1.0) -> System:
    """Return the system of a frozen load on level ground with the joint equality u = a roll."""
    mass, gravity = _mass_and_gravity(scene)
    rows = ((np.array([1.0, -scene.can.radius]), "equality"),)
    return System(("slide", "roll"), mass, gravity, rows=rows, excess=excess)


def by_contact(scene: Scene, depth: float, points: int, impratio: float) -> System:
    """Return the system of a frozen load in a cylinder on a level plane, which touches at several `points`.

    The can sinks into the plane by `depth` [m] and rolls as if its radius were a - depth/2, where MuJoCo's contact is.
    """
    mass, gravity = np.diag([0.0, scene.mass, 0.0]), np.zeros((3, 3))
    mass[np.ix_([0, 2], [0, 2])], gravity[np.ix_([0, 2], [0, 2])] = _mass_and_gravity(scene)
    normal, friction = np.array([0.0, 1.0, 0.0]), np.array([-1.0, 0.0, scene.can.radius - depth / 2])
    rows = ((normal, "normal"), (friction, "friction")) * points
    return System(("slide", "lift", "roll"), mass, gravity, rows=rows, impratio=impratio)


def _mass_and_gravity(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Return the mass matrix and the stiffness matrix of gravity for (u, roll) at the equilibrium phi = 0."""
    moment = scene.load.mass * scene.load.offset
    inertia = scene.can.inertia + scene.load.inertia + moment * scene.load.offset
    mass = np.array([[scene.mass, -moment], [-moment, inertia]])
    return mass, np.diag([0.0, moment * scene.gravity])
