"""Ripples of a load that loops: amplitudes at the mean rate of turning and at its multiples, from simulated motions."""

import math
from dataclasses import dataclass

import numpy as np

from mjbeer import require
from mjbeer.model.setting import DOP853
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.scene import Scene

_SAMPLES = 256
"""Samples of one turn; ripples up to the 128th multiple of the rate can be measured."""


@dataclass(frozen=True)
class Looping:
    """The ripples of a load that loops, over one turn."""

    rate: float
    """Mean rate Omega of phi [rad/s]."""
    phi: np.ndarray
    """Amplitudes [rad] of sin(k Omega t) in phi - Omega t, at index k."""
    sway: np.ndarray
    """Amplitudes [m] of sin(k Omega t) in u less its steady acceleration, at index k."""


def loop(scene: Scene, phi_dot0: float) -> Looping:
    """Simulate one turn from phi = 0 and return its ripples; `phi_dot0` [rad/s] must be enough for a turn."""
    turn = 2 * math.pi / require.positive("phi_dot0", phi_dot0, "rad/s")
    for _ in range(8):  # Newton's method for the time of a turn
        end = simulate(scene, turn, 0.0, phi_dot0, integrator=DOP853, timestep=turn / 64, times=np.array([0, turn]))
        turn += (2 * math.pi - end.phi[-1]) / end.phi_dot[-1]
    times = turn * np.arange(_SAMPLES) / _SAMPLES
    run = simulate(scene, turn, 0.0, phi_dot0, integrator=DOP853, timestep=turn / 64, times=times)
    rate = 2 * math.pi / turn
    steady = scene.acceleration() * times**2 / 2
    return Looping(rate, sines(run.phi - rate * times), sines(run.u - steady))


def sines(values: np.ndarray) -> np.ndarray:
    """Return the amplitudes of sin(2 pi k x), at index k, in values that are evenly spaced over one period of x."""
    return -np.fft.rfft(values).imag * 2 / len(values)


def cosines(values: np.ndarray) -> np.ndarray:
    """Return the amplitudes of cos(2 pi k x), as `sines` does; the one at k = 0 is twice the mean."""
    return np.fft.rfft(values).real * 2 / len(values)
