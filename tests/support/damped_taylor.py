"""Damped motions by Taylor series in extended precision: Lagrange's two equations as they stand, solved order by order.

M u_ddot - m b (cos(phi) phi_ddot - sin(phi) phi_dot^2) = m_t g sin(alpha) - T(w)/a - drag u_dot |u_dot|
I phi_ddot - m b cos(phi) u_ddot = -m g b sin(alpha + phi) + T(w),    w = u_dot/a - phi_dot
"""

from typing import Any

import numpy as np

from mjbeer import Scene
from tests.support.taylor import EXTENDED, value

_ORDER = 26
_LOCAL = EXTENDED(1e-21)


def integrate(scene: Scene, time: np.ndarray, phi0: float, phi_dot0: float) -> np.ndarray:
    """phi, u, phi_dot and u_dot at increasing times, of shape (times, 4)."""
    phi, rate = EXTENDED(phi0), EXTENDED(phi_dot0)
    offset = EXTENDED(scene.load.offset)
    state = np.array([phi, offset * np.sin(phi), rate, offset * np.cos(phi) * rate])
    radius, now, results = EXTENDED(scene.can.radius), EXTENDED(0), []
    for end in np.asarray(time, EXTENDED):
        while now < end:
            series = _series(scene, state)
            step = min(end - now, _step(series))
            slip = series[3] / radius - series[2]
            for has_corner, each in ((scene.damping_law.quadratic, slip), (scene.drag, series[3] / radius)):
                if has_corner:
                    each[0] = _clean(each[0], series[2, 0])
                    step = min(step, _corner(each, step))
            state = np.array([value(each, step) for each in series])
            now += step
        results.append(state)
    return np.array(results)


def _series(scene: Scene, state: np.ndarray) -> np.ndarray:
    """The Taylor series of phi, u, phi_dot and u_dot, of shape (4, _ORDER + 1)."""
    can, load = scene.can, scene.load
    a, can_mass, can_inertia = (EXTENDED(each) for each in (can.radius, can.mass, can.inertia))
    m, b, inertia = (EXTENDED(each) for each in (load.mass, load.offset, load.inertia))
    g, alpha, drag = (EXTENDED(each) for each in (scene.gravity, scene.incline, scene.drag))
    c1, c2, c3 = (EXTENDED(each) for each in scene.damping_law.coefficients)
    whole, axial = m + can_mass + can_inertia / a**2, inertia + m * b**2
    phi, u, p, v = series = np.zeros((4, _ORDER + 1), EXTENDED)
    series[:, 0] = state
    sin, cos, w, ww, vv, pp, phi_ddot, u_ddot = np.zeros((8, _ORDER + 1), EXTENDED)
    sin[0], cos[0] = np.sin(phi[0]), np.cos(phi[0])
    sides: list[float] = []
    for k in range(_ORDER):
        w[k] = v[k] / a - p[k]
        if k == 0:
            w[0] = _clean(w[0], p[0])
            corner_v = _clean(v[0] / a, p[0])
        ww[k], vv[k], pp[k] = _dot(w, w, k), _dot(v, v, k), _dot(p, p, k)
        if k < 2:  # the sign of what starts at zero is that of its derivative
            sides = [float(np.sign(first or each[1]) or 1.0) for first, each in ((w[0], w), (corner_v, v))]
        torque = c1 * w[k] + sides[0] * c2 * ww[k] + c3 * _dot(w, ww, k)
        first = 1 if k == 0 else 0
        along = first * (m + can_mass) * g * np.sin(alpha) - torque / a - sides[1] * drag * vv[k]
        along -= m * b * _dot(sin, pp, k)
        around = -m * g * b * (np.sin(alpha) * cos[k] + np.cos(alpha) * sin[k]) + torque
        along += m * b * (cos[1 : k + 1] @ phi_ddot[:k][::-1])
        around += m * b * (cos[1 : k + 1] @ u_ddot[:k][::-1])
        couple = m * b * cos[0]
        determinant = whole * axial - couple**2
        phi_ddot[k] = (whole * around + couple * along) / determinant
        u_ddot[k] = (axial * along + couple * around) / determinant
        phi[k + 1], u[k + 1] = p[k] / (k + 1), v[k] / (k + 1)
        p[k + 1], v[k + 1] = phi_ddot[k] / (k + 1), u_ddot[k] / (k + 1)
        sin[k + 1], cos[k + 1] = _dot(cos, p, k) / (k + 1), -_dot(sin, p, k) / (k + 1)
    return series


def _dot(x: np.ndarray, y: np.ndarray, k: int) -> np.ndarray:
    """Coefficient k of the product of two series."""
    return x[: k + 1] @ y[k::-1] if k else x[0] * y[0]


def _step(series: np.ndarray) -> np.ndarray:
    """The step at which the last terms are as small as they should be beside the rates."""
    scale = np.abs(series[2:, 0]) + np.sqrt(np.abs(series[2:, 1])) + EXTENDED(1e-300)
    powers = 1 / np.array([_ORDER - 2, _ORDER - 1], EXTENDED)
    last = np.maximum(np.abs(series[2:, -3:-1]), np.finfo(EXTENDED).tiny)
    return ((_LOCAL * scale[:, np.newaxis] / last) ** powers).min()


def _clean(rate: Any, beside: Any) -> Any:
    """A rate, or zero where a step has ended at its change of sign and only rounding is left."""
    return rate if abs(rate) > EXTENDED(1e-17) * abs(beside) else EXTENDED(0)


def _corner(series: np.ndarray, step: Any) -> Any:
    """The first time after which a series changes its sign within the step; infinite if it does not."""
    start = 0 if series[0] else 1
    times = step * np.linspace(0, 1, 33, dtype=EXTENDED)[start:]
    sign = np.sign(series[start])
    values = np.array([value(series, each) for each in times]) * sign
    below = np.flatnonzero(values < 0)
    if not len(below) or below[0] == 0:
        return EXTENDED(np.inf)
    low, high = times[below[0] - 1], times[below[0]]
    for _ in range(70):
        middle = (low + high) / 2
        low, high = (middle, high) if value(series, middle) * sign > 0 else (low, middle)
    return high
