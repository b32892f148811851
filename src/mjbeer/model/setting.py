"""How a scene is rolled and stepped: the names and defaults of ways of rolling and integrators."""

import mujoco

from mjbeer.theory.scene import Scene

ROLLINGS = ("reduced", "equality", "contact")
INTEGRATORS = {
    "Euler": mujoco.mjtIntegrator.mjINT_EULER,
    "implicit": mujoco.mjtIntegrator.mjINT_IMPLICIT,
    "implicitfast": mujoco.mjtIntegrator.mjINT_IMPLICITFAST,
    "discrete": mujoco.mjtIntegrator.mjINT_DISCRETE,
    "RK4": mujoco.mjtIntegrator.mjINT_RK4,
}
"""MuJoCo's own integrators, by their names in MJCF."""
DOP853 = "DOP853"
FRICTION = 1.0
"""Default friction coefficient of a contact, MuJoCo's own default."""


def supported(scene: Scene, way: str) -> bool:
    """Whether MuJoCo has a model: it moves no massless body."""
    return way == "reduced" or scene.can.mass > 0 or scene.attachment == "frozen"
