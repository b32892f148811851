"""Small motions of a frozen load on the level, held to rolling by soft constraints: equations of motion as matrices.

    q'' = -P q + G (c - J (-P q)),   c_i = -b_i (J q')_i - k_i (J q)_i,   G = M^-1 J^T (J M^-1 J^T + R)^-1

with P = M^-1 times the stiffness of gravity and MuJoCo's regularizer R. They come to q'' = -K q - B q'.
"""

from dataclasses import dataclass

import numpy as np

from mjbeer.predictions.linear_stability import amplification
from mjbeer.predictions.soft_constraint import SoftRow
from mjbeer.theory.scene import Scene


@dataclass(frozen=True, eq=False)
class System:
    """Mass matrix, gravity's stiffness and constraint rows of a few coordinates q."""

    coordinates: tuple[str, ...]
    """The joints of the model, in the order of the matrices."""
    mass: np.ndarray
    gravity: np.ndarray
    rows: tuple[tuple[np.ndarray, str], ...]
    """Each row's Jacobian, and what it is: "equality", "normal" or "friction"."""
    excess: float = 1.0
    """By what MuJoCo overestimates an equality's diagonal."""
    impratio: float = 1.0
    """How much harder the friction rows are than the normal ones."""

    def step(self, integrator: str, row: SoftRow, timestep: float) -> np.ndarray:
        """The matrix of one step of (q, h q')."""
        solved = row.at_end_of_step(timestep) if integrator == "discrete" else row
        slipping = SoftRow(0.0, row.damping, row.impedance)
        slipped = slipping.at_end_of_step(timestep) if integrator == "discrete" else slipping
        jacobian = np.array([each for each, _ in self.rows])
        across = np.linalg.solve(self.mass, jacobian.T)
        delassus = jacobian @ across
        softness = (1 - solved.impedance) / solved.impedance * delassus[0, 0]
        soft = {"equality": self.excess * softness, "normal": softness, "friction": softness / self.impratio}
        regularizer = np.diag([soft[kind] for _, kind in self.rows])
        pulled = across @ np.linalg.inv(delassus + regularizer)
        stiffness = np.diag([0.0 if kind == "friction" else solved.stiffness for _, kind in self.rows])
        damping = np.diag([(slipped if kind == "friction" else solved).damping for _, kind in self.rows])
        free = np.linalg.solve(self.mass, self.gravity)
        total = free - pulled @ jacobian @ free + pulled @ stiffness @ jacobian
        return amplification(integrator, total * timestep**2, pulled @ damping @ jacobian * timestep)


def by_equality(scene: Scene, excess: float = 1.0) -> System:
    """A frozen load on the level with the joint equality u = a roll."""
    mass, gravity = _frozen(scene)
    return System(("slide", "roll"), mass, gravity, ((np.array([1.0, -scene.can.radius]), "equality"),), excess)


def by_contact(scene: Scene, depth: float, points: int, impratio: float) -> System:
    """A frozen load on the level with a cylinder on a plane, which touches in several `points`.

    The can lies in the plane by a `depth` [m] and rolls as one of the radius a - depth/2, where MuJoCo's contact is.
    """
    flat, restoring = _frozen(scene)
    mass, gravity = np.diag([0.0, scene.mass, 0.0]), np.zeros((3, 3))
    mass[np.ix_([0, 2], [0, 2])], gravity[np.ix_([0, 2], [0, 2])] = flat, restoring
    normal, friction = np.array([0.0, 1.0, 0.0]), np.array([-1.0, 0.0, scene.can.radius - depth / 2])
    rows = ((normal, "normal"), (friction, "friction")) * points
    return System(("slide", "lift", "roll"), mass, gravity, rows, impratio=impratio)


def _frozen(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Mass matrix and stiffness of gravity of (u, roll) at the equilibrium phi = 0."""
    moment = scene.load.mass * scene.load.offset
    inertia = scene.can.inertia + scene.load.inertia + moment * scene.load.offset
    mass = np.array([[scene.mass, -moment], [-moment, inertia]])
    return mass, np.diag([0.0, moment * scene.gravity])
