"""The equations of motion of a scene as one writes them by hand, for solvers of ordinary differential equations.

A frozen load has the state (phi, phi_dot), and u = a phi; a sliding one (u, phi, u_dot, phi_dot). With
p = depth sin(bottom) and q = depth cos(bottom) of the scene's `Oscillator`, and M_e = m + m_can + I_can/a^2,

    frozen:   phi_ddot = (slope + p cos(phi) - (q + chord/4 phi_dot^2) sin(phi))
                         / (base + chord/2 - chord/2 cos(phi)),                               eq. (52)
    sliding:  phi_ddot = (p cos(phi) - (q + swing phi_dot^2 cos(phi)) sin(phi)) / (base + swing sin^2(phi)),
              u_ddot = A + m b/M_e (cos(phi) phi_ddot - sin(phi) phi_dot^2),                  eqs. (46), (47)

with A the steady acceleration of footnote 4. An evaluation needs one sine and one cosine. Damping c between can and
load is a torque c w with w = u_dot/a - phi_dot. It adds c w (1 - m b/(M_e a) cos(phi)) to the numerator of phi_ddot,
and -c w/(M_e a) to u_ddot.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from mjbeer.exceptions import UnsupportedError
from mjbeer.theory.scene import Scene

RightHandSide = Callable[[float, Sequence[float]], tuple[float, ...]]


def right_hand_side(
    scene: Scene, sin: Callable[[Any], Any] = math.sin, cos: Callable[[Any], Any] = math.cos
) -> RightHandSide:
    """Return the function f(t, state) that gives the rates of change of a scene's state [rad, m, and per s].

    Pass the state as plain floats: with NumPy's scalars the function takes four times as long. With the `sin` and `cos`
    of a library of symbols, it returns symbols.

    Raises:
      UnsupportedError: if the scene has drag, or damping that is not proportional to the slip rate.
    """
    if scene.drag or any(scene.damping_law.coefficients[1:]):
        raise UnsupportedError("the equations written by hand have linear damping alone: leave out drag and the rest")
    return _frozen(scene, sin, cos) if scene.attachment == "frozen" else _sliding(scene, sin, cos)


def start(scene: Scene, phi0: float, phi_dot0: float) -> tuple[float, ...]:
    """Return the initial state for `phi0` [rad] and `phi_dot0` [rad/s], with u and u_dot from `Scene.start`.

    The variables are in the order of `right_hand_side`.
    """
    if scene.attachment == "frozen":
        return phi0, phi_dot0
    u, u_dot = scene.start(phi0, phi_dot0)
    return u, phi0, u_dot, phi_dot0


def coordinates(scene: Scene, states: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return phi [rad] and u [m] of states with one row for each sample."""
    if scene.attachment == "frozen":
        return states[:, 0], scene.can.radius * states[:, 0]
    return states[:, 1], states[:, 0]


def _frozen(scene: Scene, sin: Callable[[Any], Any], cos: Callable[[Any], Any]) -> RightHandSide:
    form = scene.oscillator
    slope, p, q = form.slope, form.depth * math.sin(form.bottom), form.depth * math.cos(form.bottom)
    half, quarter, middle = form.chord / 2, form.chord / 4, form.base + form.chord / 2

    def rates(_: float, state: Sequence[float]) -> tuple[float, ...]:
        phi, phi_dot = state
        s, c = sin(phi), cos(phi)
        return phi_dot, (slope + p * c - (q + quarter * (phi_dot * phi_dot)) * s) / (middle - half * c)

    return rates


def _sliding(scene: Scene, sin: Callable[[Any], Any], cos: Callable[[Any], Any]) -> RightHandSide:
    form, can, load = scene.oscillator, scene.can, scene.load
    p, q = form.depth * math.sin(form.bottom), form.depth * math.cos(form.bottom)
    base, swing = form.base, form.swing
    effective_mass = scene.mass + can.inertia / can.radius**2
    steady = scene.drive / effective_mass
    share = load.moment / effective_mass
    damping, radius = scene.damping_law.linear, can.radius
    lever, pull = share / radius, 1 / (effective_mass * radius)

    def rates(_: float, state: Sequence[float]) -> tuple[float, ...]:
        _u, phi, u_dot, phi_dot = state
        s, c, square = sin(phi), cos(phi), phi_dot * phi_dot
        phi_ddot = (p * c - (q + swing * square * c) * s) / (base + swing * (s * s))
        return u_dot, phi_dot, steady + share * (c * phi_ddot - s * square), phi_ddot

    def damped(_: float, state: Sequence[float]) -> tuple[float, ...]:
        _u, phi, u_dot, phi_dot = state
        s, c, square = sin(phi), cos(phi), phi_dot * phi_dot
        torque = damping * (u_dot / radius - phi_dot)
        turned = p * c - (q + swing * square * c) * s + torque * (1 - lever * c)
        phi_ddot = turned / (base + swing * (s * s))
        return u_dot, phi_dot, steady + share * (c * phi_ddot - s * square) - pull * torque, phi_ddot

    return damped if damping else rates
