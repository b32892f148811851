"""The motion of a scene from Lagrange's equations as they stand, by Taylor series in forty digits.

With both coordinates, A(phi) (u'', phi'') = f(phi, phi'); a frozen load has u = a phi, and one equation: the first
times a, plus the second. Nothing is eliminated or rearranged: what would cancel is left to the digits.
"""

from itertools import pairwise

import mpmath
import numpy as np

from mjbeer import Scene

_DIGITS, _ORDER = 40, 30
_TAIL = mpmath.mpf(10) ** -24
"""Size of the last terms of a step relative to the largest."""

Series = list[mpmath.mpf]


def motion(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float) -> tuple[np.ndarray, np.ndarray]:
    """Return phi and u/a [rad] at increasing `times` [s], the first of which must be 0."""
    with mpmath.workdps(_DIGITS):
        angle, rate = mpmath.mpf(phi0), mpmath.mpf(phi_dot0)
        if scene.attachment == "frozen":
            u, speed = scene.can.radius * angle, scene.can.radius * rate
        else:
            offset = mpmath.mpf(scene.load.offset)
            u, speed = offset * mpmath.sin(angle), offset * mpmath.cos(angle) * rate
        states = [(angle, u)]
        for begin, end in pairwise(mpmath.mpf(time) for time in times):
            left = end - begin
            while left > 0:
                phi, axis = _series(scene, angle, rate, u, speed)
                step = _step(phi, left)
                angle, rate = _value(phi, step), _slope(phi, step)
                u, speed = _value(axis, step), _slope(axis, step)
                left -= step
            states.append((angle, u))
        radius = mpmath.mpf(scene.can.radius)
        return np.array([float(phi) for phi, _ in states]), np.array([float(u / radius) for _, u in states])


def accelerations(scene: Scene, phi: float, phi_dot: float) -> tuple[mpmath.mpf, mpmath.mpf]:
    """Return u_ddot [m/s^2] and phi_ddot [rad/s^2], which neither u nor u_dot changes."""
    with mpmath.workdps(_DIGITS):
        angle, axis = _series(scene, mpmath.mpf(phi), mpmath.mpf(phi_dot), mpmath.mpf(0), mpmath.mpf(0))
        return 2 * axis[2], 2 * angle[2]


def _series(
    scene: Scene, angle: mpmath.mpf, rate: mpmath.mpf, u: mpmath.mpf, speed: mpmath.mpf
) -> tuple[Series, Series]:
    """Return the power series of phi and u in time."""
    can, load = scene.can, scene.load
    a, m = mpmath.mpf(can.radius), mpmath.mpf(load.mass)
    total = m + can.mass + can.inertia / a**2
    moment, inertia = m * load.offset, load.inertia + m * mpmath.mpf(load.offset) ** 2
    drive = (m + can.mass) * scene.gravity * mpmath.sin(scene.incline)
    torque_sine = moment * scene.gravity * mpmath.cos(scene.incline)  # of sin(alpha + phi) written out
    torque_cosine = moment * scene.gravity * mpmath.sin(scene.incline)
    phi, axis, sine, cosine = [angle, rate], [u, speed], [mpmath.sin(angle)], [mpmath.cos(angle)]
    square: Series = []
    accelerations: list[tuple[mpmath.mpf, mpmath.mpf]] = []
    for k in range(_ORDER - 1):
        if k:
            sine.append(sum(j * phi[j] * cosine[k - j] for j in range(1, k + 1)) / k)
            cosine.append(-sum(j * phi[j] * sine[k - j] for j in range(1, k + 1)) / k)
        square.append(sum((j + 1) * phi[j + 1] * (k - j + 1) * phi[k - j + 1] for j in range(k + 1)))
        force = (drive if k == 0 else 0) - moment * sum(sine[j] * square[k - j] for j in range(k + 1))
        torque = -torque_sine * sine[k] - torque_cosine * cosine[k]
        # couple u'' = -m b cos(phi) times the accelerations of lower order goes to the right-hand side
        force += moment * sum(cosine[j] * accelerations[k - j][1] for j in range(1, k + 1))
        torque += moment * sum(cosine[j] * accelerations[k - j][0] for j in range(1, k + 1))
        couple = -moment * cosine[0]
        if scene.attachment == "frozen":
            phi_ddot = (a * force + torque) / (a**2 * total + 2 * a * couple + inertia)
            u_ddot = a * phi_ddot
        else:
            determinant = total * inertia - couple**2
            u_ddot = (inertia * force - couple * torque) / determinant
            phi_ddot = (total * torque - couple * force) / determinant
        accelerations.append((u_ddot, phi_ddot))
        phi.append(phi_ddot / ((k + 1) * (k + 2)))
        axis.append(u_ddot / ((k + 1) * (k + 2)))
    return phi, axis


def _step(phi: Series, step: mpmath.mpf) -> mpmath.mpf:
    """Return a step, at most the given one, at which the last terms of phi' are small beside the largest."""
    while True:
        terms = [abs(k * phi[k]) * step**k for k in range(1, len(phi))]
        if max(terms[-3:]) <= _TAIL * max(terms):
            return step
        step *= mpmath.mpf("0.8")


def _value(series: Series, time: mpmath.mpf) -> mpmath.mpf:
    return mpmath.polyval(series[::-1], time)


def _slope(series: Series, time: mpmath.mpf) -> mpmath.mpf:
    return mpmath.polyval([k * series[k] for k in range(len(series) - 1, 0, -1)], time)
