# /// script
# requires-python = ">=3.11"
# dependencies = ["scipy==1.17.1", "numpy==2.4.6"]
# ///
"""No engine: SciPy integrates the equation of a can that rolls without slip.

A contact costs what its curve is above this one. The timestep is that of the output; the tolerance
falls with its fourth power, so that there is a curve.
"""

import time
from math import cos, sin

import numpy as np
from common import INTERVAL, Case, Motion, Setting, State, answer
from scipy.integrate import solve_ivp

SETTINGS = [Setting("equation", "default")]


def roll(case: Case, timestep: float, setting: Setting) -> Motion:
    """Roll the can with DOP853, to a tolerance of 1e-8 at a timestep of a millisecond."""
    mass, radius, offset = case.mass, case.radius, case.offset

    def rates(_: float, state: np.ndarray) -> list[float]:
        phi, phi_dot = state
        inertia = case.inertia + mass * (radius**2 + offset**2 - 2 * radius * offset * cos(phi))
        slope = mass * radius * offset * sin(phi)  # half the derivative of the inertia
        weight_x = case.gravity_x * (radius - offset * cos(phi))
        weight_z = case.gravity_z * offset * sin(phi)
        torque = mass * (weight_x + weight_z)
        return [phi_dot, (torque - slope * phi_dot**2) / inertia]

    samples = round(case.duration / INTERVAL) + 1
    times = INTERVAL * np.arange(samples)
    tolerance = min(1e-3, max(1e-13, 1e-8 * (1e3 * timestep) ** 4))
    motion = Motion()
    begin = time.process_time()
    solution = solve_ivp(
        rates,
        (0, times[-1]),
        [case.phi0, case.phi_dot0],
        method="DOP853",
        t_eval=times,
        rtol=tolerance,
        atol=tolerance,
    )
    motion.seconds = time.process_time() - begin
    for phi, phi_dot in solution.y.T:
        motion.add(State(phi, radius * phi, phi_dot, radius * phi_dot))
    return motion


if __name__ == "__main__":
    answer("SciPy", SETTINGS, roll, ("scipy",))
