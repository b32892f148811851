"""Gauss-Jackson, a multistep method for undamped motions, 5 to 10 times as fast as DOP853.

Everything works without this folder, only slower: `method.py` says what a step does, and
docs/gauss-jackson.md why.

    law = SwingLaw(base, chord, coupling, ramp, depth, bottom, arm)
    first = first_timestep(law, phi0, phi_dot0, duration, tolerance)
    time = sundman_time(law, law.inertia(phi0), 1e-3 * tolerance, first.largest_turn)
    states = GaussJackson(dynamics, first.timestep, time).run(start, times)
"""

from mjbeer.integrators.gauss_jackson.first_timestep import FirstTimestep, first_timestep
from mjbeer.integrators.gauss_jackson.method import GaussJackson
from mjbeer.integrators.gauss_jackson.sundman_time import SundmanTime, sundman_time
from mjbeer.integrators.gauss_jackson.swing_law import SwingLaw

__all__ = [
    "FirstTimestep",
    "GaussJackson",
    "SundmanTime",
    "SwingLaw",
    "first_timestep",
    "sundman_time",
]
