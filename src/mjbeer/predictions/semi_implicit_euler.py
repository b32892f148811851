"""Numerical errors that theory gives in advance.

Semi-implicit Euler, v += h a(q, v), q += h v, is MuJoCo's "Euler" and, on models without damping, what "implicit",
"implicitfast" and "discrete" come to. What is said of a soft constraint holds for MuJoCo's, whatever integrates it.
"""

import numpy as np
from scipy.integrate import solve_ivp

from mjbeer.theory.scene import Scene

_DIFFERENCE = 1e-5
"""Step of the central differences [rad, or rad/s over the frequency scale]: their error is 1e-10 of the slope."""
_SIGN = {"Euler": 1, "implicitfast": 1, "discrete": 1, "implicit": -1}
"""Of what forces that go with the square of the rate do to the energy."""
_NODES = 40
"""Of a quadrature over a swing, whose integrand is smooth: 1e-15 at 1 rad."""


def frequency_shift(frequency: float, timestep: float) -> float:
    """Relative error of a small swing's `frequency` [rad/s] under semi-implicit Euler: (omega h)^2/24.

    The map has eigenvalues exp(+-i nu h) with sin(nu h/2) = omega h/2.
    """
    return (frequency * timestep) ** 2 / 24


def distance_excess(timestep: float, duration: float) -> float:
    """Relative error of the distance under semi-implicit Euler at constant acceleration, from rest: h/T.

    After n = T/h steps it is a h^2 n (n + 1)/2 instead of a T^2/2.
    """
    return timestep / duration


def euler_error(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float = 0.0) -> np.ndarray:
    """Error of phi under semi-implicit Euler, in the limit of small timesteps, per timestep [rad/s], at `times` [s].

    By backward error analysis the method follows q' = v + h/2 a, v' = a - h/2 (a_q v + a_v a) up to h^2 (E. Hairer,
    C. Lubich, G. Wanner, Geometric Numerical Integration, chapter IX); the error is that perturbation, carried along
    by the linearized motion. It holds where phi is a coordinate of the model, as in the reduced ones.
    """

    def slopes(_: float, state: np.ndarray) -> np.ndarray:
        q, v, dq, dv = state
        a, a_q, a_v = _acceleration(scene, q, v)
        return np.array([v, a, dv + a / 2, a_q * dq + a_v * dv - (a_q * v + a_v * a) / 2])

    span, start = (0.0, float(times[-1])), [phi0, phi_dot0, 0.0, 0.0]
    return solve_ivp(slopes, span, start, "DOP853", times, rtol=1e-8, atol=1e-8).y[2]


def euler_motion(scene: Scene, times: np.ndarray, timestep: float, integrator: str, phi0: float) -> np.ndarray:
    """phi [rad] at `times` [s] of the motion that semi-implicit Euler follows, up to h^2, from rest.

    The perturbed equations of `euler_error`, in full: they hold where the error is as large as the motion. "implicit"
    turns the sign of a_v a.
    """
    sign, half = _SIGN[integrator], timestep / 2

    def slopes(_: float, state: np.ndarray) -> np.ndarray:
        q, v = state
        a, a_q, a_v = _acceleration(scene, q, v)
        return np.array([v + half * a, a - half * (a_q * v + sign * a_v * a)])

    return solve_ivp(slopes, (0.0, float(times[-1])), [phi0, 0.0], "DOP853", times, rtol=1e-8, atol=1e-8).y[0]


def _acceleration(scene: Scene, q: float, v: float) -> tuple[float, float, float]:
    """The exact acceleration, and what it changes by with angle and rate."""
    form, rate = scene.oscillator, float(np.sqrt(scene.gravity / scene.can.radius)) or 1.0
    e, f = _DIFFERENCE, _DIFFERENCE * rate
    a_q = float(form.acceleration(q + e, v) - form.acceleration(q - e, v)) / (2 * e)
    a_v = float(form.acceleration(q, v + f) - form.acceleration(q, v - f)) / (2 * f)
    return float(form.acceleration(q, v)), a_q, a_v


def energy_per_swing(scene: Scene, amplitude: float, timestep: float, integrator: str) -> float | None:
    """Share of a swing's energy that semi-implicit Euler adds to it in each period, to first order in the timestep.

    With the perturbation of `euler_error`, dE/dt = -h J d(v a)/dt / 2, which over a period leaves h/2 times the
    integral of J' v^2 dv, or of J' sqrt(w) w' / 2 over the swing with w = v^2: nothing where J is constant, and the
    method symplectic. "implicit" treats the forces that go with v^2 implicitly, which turns the sign. None for methods
    of higher order. The swing is one of `amplitude` [rad], between turning points that lie symmetrically.
    """
    sign = _SIGN.get(integrator)
    if sign is None:
        return None
    form, rest = scene.oscillator, scene.equilibrium()
    psi, weight = np.polynomial.legendre.leggauss(_NODES)
    # phi = rest + amplitude sin(x) makes sqrt(w) smooth at its zeros, the turning points.
    x = np.pi / 2 * psi
    phi, stretch = rest + amplitude * np.sin(x), amplitude * np.cos(x) * np.pi / 2 * weight
    inertia, slope = form.inertia(phi), form.chord * np.sin(phi) / 2 + form.swing * np.sin(2 * phi)
    square = 2 * form.drop(phi, rest + amplitude) / inertia
    bend = (2 * -form.depth * np.sin(phi - form.bottom) + 2 * form.slope - slope * square) / inertia
    gained = timestep / 2 * np.sum(slope * np.sqrt(np.maximum(square, 0)) * bend * stretch)
    return float(sign * gained / form.drop(rest, rest + amplitude))
