"""Motions of damped scenes by SciPy's integrator on theory's accelerations, without MuJoCo."""

import numpy as np
from scipy.integrate import solve_ivp

from mjbeer.theory.equations import Coordinates, accelerations
from mjbeer.theory.scene import Scene

FINE = 1e-12
"""Relative tolerance of each step."""


def motion(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float = 0.0) -> Coordinates:
    """The motion from a start [rad, rad/s] at `times` [s], the first of which is 0."""

    def slope(_: float, state: np.ndarray) -> list[float]:
        u_ddot, phi_ddot = accelerations(scene, state[1], state[3], state[2])
        return [state[2], state[3], float(u_ddot), float(phi_ddot)]

    radius, (u, u_dot) = scene.can.radius, scene.start(phi0, phi_dot0)
    longest = float(np.diff(times).max()) / 8  # SciPy loses digits in long steps, and where drag turns round
    found = solve_ivp(
        slope, (0, times[-1]), [u, phi0, u_dot, phi_dot0], "DOP853", times, max_step=longest, rtol=FINE,
        atol=FINE * np.array([radius, 1.0, radius, 1.0]),
    )  # fmt: skip
    assert found.success
    u, phi, u_dot, phi_dot = found.y
    nothing = np.zeros_like(times)
    return Coordinates(
        time=times, u=u, phi=phi, u_dot=u_dot, phi_dot=phi_dot, roll=u / radius, roll_dot=u_dot / radius,
        lift=nothing, lift_dot=nothing,
    )  # fmt: skip
