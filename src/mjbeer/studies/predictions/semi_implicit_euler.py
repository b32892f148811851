"""The errors of semi-implicit Euler that theory predicts: of angle and energy.

Semi-implicit Euler, v += h a(q, v), q += h v, is MuJoCo's "Euler". On models without damping "implicitfast" and
"discrete" are the same method, and "implicit" differs from it only in forces that grow with the square of the rate.
"""

import numpy as np
from scipy.integrate import solve_ivp

from mjbeer.theory.scene import Scene

_DIFFERENCE = 1e-5
"""Step of the central differences [rad, or rad/s in units of sqrt(g/a)]: their relative error is 1e-10."""
_TOLERANCE = 1e-10
"""Tolerance of the perturbed motion: a timestep is to show in it by far more."""
_SIGN = {"Euler": 1, "implicitfast": 1, "discrete": 1, "implicit": -1}
"""Sign of the energy that forces proportional to the square of the rate add in each step."""
_NODES = 40
"""Nodes of the quadrature over a swing. The integrand is smooth: the error is 1e-15 at an amplitude of 1 rad."""


def euler_motion(scene: Scene, times: np.ndarray, timestep: float, integrator: str, phi0: float) -> np.ndarray:
    """Return phi [rad] at `times` [s] of the motion from rest that semi-implicit Euler follows, up to h^2.

    By backward error analysis a reduced model follows q' = v + h/2 a, v' = a - h/2 (a_q v + a_v a) (E. Hairer,
    C. Lubich, G. Wanner, Geometric Numerical Integration, chapter IX). With "implicit" a_v a has the opposite sign.
    """
    sign, half = _SIGN[integrator], timestep / 2

    def slopes(_: float, state: np.ndarray) -> np.ndarray:
        q, v = state
        a, a_q, a_v = _acceleration(scene, q, v)
        return np.array([v + half * a, a - half * (a_q * v + sign * a_v * a)])

    span, start = (0.0, float(times[-1])), [phi0, 0.0]
    return solve_ivp(slopes, span, start, method="DOP853", t_eval=times, rtol=_TOLERANCE, atol=_TOLERANCE).y[0]


def _acceleration(scene: Scene, q: float, v: float) -> tuple[float, float, float]:
    """Return the exact acceleration a [rad/s^2] and its derivatives a_q and a_v by angle and rate."""
    rate = float(np.sqrt(scene.gravity / scene.can.radius)) or 1.0
    acceleration, dq, dv = scene.oscillator.acceleration, _DIFFERENCE, _DIFFERENCE * rate
    a_q = float(acceleration(q + dq, v) - acceleration(q - dq, v)) / (2 * dq)
    a_v = float(acceleration(q, v + dv) - acceleration(q, v - dv)) / (2 * dv)
    return float(acceleration(q, v)), a_q, a_v


def energy_per_swing(scene: Scene, amplitude: float, timestep: float, integrator: str) -> float | None:
    """Return the energy that a swing gains in each period over its energy, to first order in the timestep.

    With the perturbation of `euler_motion`, dE/dt = -h J d(v a)/dt / 2. Over a period this leaves h/2 times the
    integral of J' v^2 dv, that of J' sqrt(w) w' / 2 over the swing with w = v^2: 0 where J is constant. For methods of
    higher order the result is None. The swing is symmetric about the equilibrium, with an `amplitude` [rad].
    """
    sign = _SIGN.get(integrator)
    if sign is None:
        return None
    oscillator, rest = scene.oscillator, scene.equilibrium()
    node, weight = np.polynomial.legendre.leggauss(_NODES)
    # phi = rest + amplitude sin(x) makes sqrt(w) smooth at its zeros, the turning points.
    x = np.pi / 2 * node
    phi, stretch = rest + amplitude * np.sin(x), amplitude * np.cos(x) * np.pi / 2 * weight
    inertia = oscillator.inertia(phi)
    inertia_slope = oscillator.chord * np.sin(phi) / 2 + oscillator.swing * np.sin(2 * phi)
    w = 2 * oscillator.drop(phi, rest + amplitude) / inertia
    torque = -oscillator.depth * np.sin(phi - oscillator.bottom)
    w_slope = (2 * torque + 2 * oscillator.slope - inertia_slope * w) / inertia
    gain = timestep / 2 * np.sum(inertia_slope * np.sqrt(np.maximum(w, 0)) * w_slope * stretch)
    return float(sign * gain / oscillator.drop(rest, rest + amplitude))
