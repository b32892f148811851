"""A second exact motion, by Taylor series, which shares no code with `mjbeer.theory`.

A load at the angle phi is at s = u - b sin(phi) along the incline and at -b cos(phi) across it.
With M = m + m_can + I_can/a^2, and g_s and g_c for gravity along and across the incline,

    T = 1/2 (M - m) u'^2 + 1/2 m ((u' - b cos(phi) phi')^2 + (b sin(phi) phi')^2) + 1/2 I phi'^2,
    V = -(m + m_can) g_s u - m b (g_c cos(phi) - g_s sin(phi)).

A sliding load has both coordinates free: (M u - m b sin(phi))'' = (m + m_can) g_s, and with u''
eliminated, so that nothing is left that cancels,

    (M I + m b^2 (M - m) + (m b sin(phi))^2) phi''
      = -m b (M g_c sin(phi) + I_can/a^2 g_s cos(phi)) - (m b)^2 sin(phi) cos(phi) phi'^2.

A frozen load has u = a phi, and with h = phi/2

    (I + I_can + m_can a^2 + m (a - b)^2 + 4 m a b sin(h)^2) phi''
      = g_s (m_can a + m (a - b)) + 2 m b g_s sin(h)^2 - 2 m b (g_c + a phi'^2) sin(h) cos(h).

With s = sin(f phi), c = cos(f phi) and v = phi' both have the form

    phi'' = (t0 + t1 s^2 + n1 s + n2 c - (t2 + t3 v^2) s c) / (d0 + d1 s^2).

The coefficients of the power series of phi(t) follow one after the other from those of s, c and v
(A. Jorba and M. Zou, A software package for the numerical integration of ODEs by means of
high-order Taylor methods, Experimental Mathematics 14, 2005).
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from mjbeer.exceptions import ToleranceError
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.scene import Scene

MOST_STEPS = 400_000
"""Largest number of steps of a motion: they take about two seconds. A swing takes about twenty."""
_ORDER = 28
"""Order of the series. Between 24 and 32 the run time for a given error is the same within 10 %."""
_TAIL = 1e-18
"""Size of the last terms of a step relative to the rate: 1 % of the rounding of a double."""
_LAST = 3
"""Number of last terms that must be small, as one or two may be small by chance."""


class Law(NamedTuple):
    """The coefficients of phi'' as above, in a unit of time; s = sin(f phi) has the factor f."""

    factor: float
    t0: float
    t1: float
    n1: float
    n2: float
    t2: float
    t3: float
    d0: float
    d1: float


def series(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float = 0.0) -> Coordinates:
    """Return the undamped motion at increasing `times` [s].

    It starts from `phi0` [rad] with `phi_dot0` [rad/s] at time 0: a sliding load at s = 0 with
    s' = 0, a frozen one at u = a phi. The unit of time is a power of two near the fastest time of
    the motion, so that no conversion is rounded, and no coefficient overflows.

    Raises:
      ToleranceError: if the motion takes more than `MOST_STEPS` steps.
    """
    time = np.asarray(times, dtype=float)
    radius = scene.can.radius
    fastest = abs(phi_dot0) + math.sqrt(scene.gravity / radius)  # [rad/s]
    unit = 2.0 ** math.frexp(1 / fastest)[1] if fastest > 0 else 1.0
    law = _law(scene, unit)
    samples = np.empty((len(time), 2))
    if not _integrate(law, phi0, phi_dot0 * unit, time / unit, samples, MOST_STEPS):
        raise ToleranceError(f"the motion takes more than {MOST_STEPS} steps")
    phi = samples[:, 0]
    phi_dot = samples[:, 1] / unit
    if scene.attachment == "sliding":
        u, u_dot = _sliding_axis(scene, time, phi, phi_dot, phi0, phi_dot0)
    else:
        u = radius * phi
        u_dot = radius * phi_dot
    return Coordinates(
        time=time,
        u=u,
        u_dot=u_dot,
        lift=0 * u,
        lift_dot=0 * u,
        phi=phi,
        phi_dot=phi_dot,
        roll=u / radius,
        roll_dot=u_dot / radius,
    )


def _law(scene: Scene, unit: float) -> Law:
    """Return the law of a scene in a unit of time [s]."""
    a = scene.can.radius
    m_can = scene.can.mass
    b = scene.load.offset
    m = scene.load.mass
    g_s = scene.gravity * unit**2 * math.sin(scene.incline)
    g_c = scene.gravity * unit**2 * math.cos(scene.incline)
    if scene.attachment == "sliding":
        rim = scene.can.inertia / a**2
        total = m + m_can + rim
        square = (m * b) ** 2 / total
        return Law(
            factor=1.0,
            t0=0.0,
            t1=0.0,
            n1=-m * b * g_c,
            n2=-m * b * rim * g_s / total,
            t2=0.0,
            t3=square,
            d0=scene.load.inertia + m * b**2 * (m_can + rim) / total,
            d1=square,
        )
    return Law(
        factor=0.5,
        t0=g_s * (m_can * a + m * (a - b)),
        t1=2 * m * b * g_s,
        n1=0.0,
        n2=0.0,
        t2=2 * m * b * g_c,
        t3=2 * m * b * a,
        d0=scene.load.inertia + scene.can.inertia + m_can * a**2 + m * (a - b) ** 2,
        d1=4 * m * b * a,
    )


def _sliding_axis(
    scene: Scene,
    time: np.ndarray,
    phi: np.ndarray,
    phi_dot: np.ndarray,
    phi0: float,
    phi_dot0: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Return u [m] and u' [m/s]: M u - m b sin(phi) falls freely from its value at the start."""
    b = scene.load.offset
    m = scene.load.mass
    rest = scene.can.mass + scene.can.inertia / scene.can.radius**2
    place = rest * b * math.sin(phi0)
    speed = rest * b * math.cos(phi0) * phi_dot0
    fall = (m + scene.can.mass) * scene.gravity * math.sin(scene.incline)
    u = (place + speed * time + fall * time**2 / 2 + m * b * np.sin(phi)) / (m + rest)
    u_dot = (speed + fall * time + m * b * np.cos(phi) * phi_dot) / (m + rest)
    return u, u_dot


@njit(cache=True)
def _integrate(law, phi0, phi_dot0, times, samples, most):
    """Fill `samples` with phi and phi' at increasing `times`; return whether `most` steps sufficed.

    What a step adds is computed in doubles. The sums over all steps are kept as pairs of doubles,
    so that their rounding does not add up.
    """
    phi = np.zeros(_ORDER + 1)
    s = np.zeros(_ORDER + 1)
    c = np.zeros(_ORDER + 1)
    work = np.zeros((4, _ORDER + 1))
    factor = law.factor
    sample = 0
    angle, angle_low = phi0, 0.0
    rate, rate_low = phi_dot0, 0.0
    now, now_low = 0.0, 0.0
    for _ in range(most):
        sine = math.sin(factor * angle)
        cosine = math.cos(factor * angle)
        s[0] = sine + cosine * factor * angle_low
        c[0] = cosine - sine * factor * angle_low
        phi[0] = angle
        phi[1] = rate + rate_low
        _expand(law, phi, s, c, work)
        step = (times[-1] - now) - now_low
        pace = abs(phi[1]) + math.sqrt(abs(2 * phi[2]))
        for k in range(_ORDER - _LAST, _ORDER):
            if phi[k + 1] != 0.0:
                step = min(step, (_TAIL * pace / abs((k + 1) * phi[k + 1])) ** (1 / k))
        while sample < len(times):
            time = (times[sample] - now) - now_low
            if time > step:
                break
            turned, gained = _move(phi, time)
            samples[sample, 0] = angle + (angle_low + turned)
            samples[sample, 1] = rate + (rate_low + gained)
            sample += 1
        if sample == len(times):
            return True
        turned, gained = _move(phi, step)
        angle, angle_low = _add(angle, angle_low, turned)
        rate, rate_low = _add(rate, rate_low, gained)
        now, now_low = _add(now, now_low, step)
    return False


@njit(cache=True)
def _expand(law, phi, s, c, work):
    """Fill the series of phi, s and c in time from their first coefficients (two of phi)."""
    vv = work[0]
    ss = work[1]
    sc = work[2]
    acceleration = work[3]
    for k in range(_ORDER - 1):
        if k > 0:
            sine = cosine = 0.0
            for j in range(1, k + 1):
                sine += j * phi[j] * c[k - j]
                cosine += j * phi[j] * s[k - j]
            s[k] = law.factor * sine / k
            c[k] = -law.factor * cosine / k
        vv[k] = ss[k] = sc[k] = 0.0
        for j in range(k + 1):
            vv[k] += (j + 1) * phi[j + 1] * (k - j + 1) * phi[k - j + 1]
            ss[k] += s[j] * s[k - j]
            sc[k] += s[j] * c[k - j]
        rest = law.t1 * ss[k] + law.n1 * s[k] + law.n2 * c[k] - law.t2 * sc[k]
        rest += law.t0 if k == 0 else 0.0
        for j in range(k + 1):
            rest -= law.t3 * vv[j] * sc[k - j]
            if j > 0:
                rest -= law.d1 * ss[j] * acceleration[k - j]
        acceleration[k] = rest / (law.d0 + law.d1 * ss[0])
        phi[k + 2] = acceleration[k] / ((k + 1) * (k + 2))


@njit(cache=True)
def _move(phi, time):
    """Return by how much phi and phi' change in a time, from the series of phi."""
    turned = gained = 0.0
    for k in range(_ORDER, 1, -1):
        turned = turned * time + phi[k]
        gained = gained * time + k * phi[k]
    return (turned * time + phi[1]) * time, gained * time


@njit(cache=True)
def _add(high, low, more):
    """Return the sum of a pair of doubles and a double, as a pair: the sum and its rounding."""
    total = high + more
    part = total - high
    rounding = (high - (total - part)) + (more - part) + low
    result = total + rounding
    return result, rounding - (result - total)
