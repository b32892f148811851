"""The motions of many scenes at once by Taylor series in extended precision, without energy or quadrature.

The reduced equation J phi_ddot + J' phi_dot^2 / 2 = -V' is integrated with its coefficients in 40 digits from the
Lagrangian, and phi only ever as the sine and cosine of its half. All series are by recurrence.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from mpmath import MPContext

from mjbeer import Scene

EXTENDED = np.longdouble
ENOUGH = float(np.finfo(EXTENDED).eps) < 1e-18
"""Whether this machine's `long double` has 64 bits of digits, as on x86; elsewhere it may be a double."""
_ORDER = 26
_LOCAL = EXTENDED(1e-20)
"""Local error relative to each quantity."""
_STEPS = 4000
"""Most steps; a motion that needs more is given up."""

mp = MPContext()
mp.dps = 40


@dataclass(frozen=True)
class Case:
    """A scene, its start, and increasing times; all cases of a run have the same number of times."""

    scene: Scene
    phi0: float
    phi_dot0: float
    time: np.ndarray


def coefficients(scene: Scene) -> dict[str, Any]:
    """The coefficients of J and V in 40 digits."""
    can, load = scene.can, scene.load
    a, can_mass, can_inertia = (mp.mpf(each) for each in (can.radius, can.mass, can.inertia))
    m, b, inertia = (mp.mpf(each) for each in (load.mass, load.offset, load.inertia))
    g, alpha = mp.mpf(scene.gravity), mp.mpf(scene.incline)
    if scene.attachment == "frozen":
        return {
            "base": inertia + m * (a - b) ** 2 + can_inertia + can_mass * a**2,
            "chord": 4 * m * a * b,
            "swing": mp.mpf(0),
            "slope": (m + can_mass) * g * a * mp.sin(alpha),
            "cosine": m * g * b * mp.cos(alpha),
            "sine": m * g * b * mp.sin(alpha),
        }
    rolling = can_mass + can_inertia / a**2
    whole = m + rolling
    return {
        "base": inertia + m * b**2 * rolling / whole,
        "chord": mp.mpf(0),
        "swing": (m * b) ** 2 / whole,
        "slope": mp.mpf(0),
        "cosine": m * b * g * mp.cos(alpha),
        "sine": m * b * (g * mp.sin(alpha) - (m + can_mass) * g * mp.sin(alpha) / whole),
    }


def _extended(numbers: Sequence[Any]) -> np.ndarray:
    """The doubles nearest to the numbers, and what they leave."""
    return np.array([EXTENDED(float(each)) + EXTENDED(float(each - mp.mpf(float(each)))) for each in numbers])


def _product(x: list[np.ndarray], y: list[np.ndarray]) -> np.ndarray:
    """The last known coefficient of the product of two series."""
    return sum((x[i] * y[-1 - i] for i in range(1, len(y))), start=x[0] * y[-1])


def _value(series: list[np.ndarray], step: np.ndarray) -> np.ndarray:
    total = series[-1]
    for coefficient in reversed(series[:-1]):
        total = total * step + coefficient
    return total


def integrate(cases: Sequence[Case]) -> tuple[np.ndarray, np.ndarray]:
    """How far phi has turned and phi_dot, of shape (cases, times); NaN for a motion that takes too many steps."""
    known = [coefficients(case.scene) for case in cases]
    terms = {name: _extended([each[name] for each in known]) for name in known[0]}
    halves = [mp.mpf(case.phi0) / 2 for case in cases]
    s, c = _extended([mp.sin(half) for half in halves]), _extended([mp.cos(half) for half in halves])
    v, ends = np.array([EXTENDED(case.phi_dot0) for case in cases]), np.array([case.time for case in cases], EXTENDED)
    turned, now, sample = np.zeros_like(v), np.zeros_like(v), np.zeros(len(cases), int)
    turns, rates = np.full(ends.shape, np.nan, EXTENDED), np.full(ends.shape, np.nan, EXTENDED)
    active = np.arange(len(cases))
    for _ in range(_STEPS):
        sines, cosines, speeds = _series(
            {name: each[active] for name, each in terms.items()}, s[active], c[active], v[active]
        )
        left = ends[active, sample[active]] - now[active]
        step = _step(sines, cosines, speeds)
        there = step >= left
        step = np.where(there, left, step)
        turned[active] += step * _value([each / (k + 1) for k, each in enumerate(speeds)], step)
        s[active], c[active], v[active] = (_value(each, step) for each in (sines, cosines, speeds))
        length = np.hypot(s[active], c[active])
        s[active], c[active] = s[active] / length, c[active] / length
        now[active] = np.where(there, ends[active, sample[active]], now[active] + step)
        done = active[there]
        turns[done, sample[done]], rates[done, sample[done]] = turned[done], v[done]
        sample[done] += 1
        active = active[sample[active] < ends.shape[1]]
        if not len(active):
            break
    return turns, rates


def _series(terms: dict[str, np.ndarray], s: np.ndarray, c: np.ndarray, v: np.ndarray) -> tuple[list, list, list]:
    """The Taylor series in time of sin(phi/2), cos(phi/2) and phi_dot."""
    base, chord, swing, slope, cosine, sine = (
        terms[name] for name in ("base", "chord", "swing", "slope", "cosine", "sine")
    )
    sines, cosines, speeds = [s], [c], [v]
    sin_phi, cos_phi, inertia, half_slope, squares, accelerations = [], [], [], [], [], []
    for k in range(_ORDER):
        first = 1 if k == 0 else 0
        square = _product(sines, sines)
        sin_phi.append(2 * _product(sines, cosines))
        cos_phi.append(first - 2 * square)
        inertia.append(first * base + chord * square + swing * _product(sin_phi, sin_phi))
        half_slope.append(chord * sin_phi[-1] / 4 + swing * _product(sin_phi, cos_phi))
        squares.append(_product(speeds, speeds))
        torque = first * slope - cosine * sin_phi[-1] - sine * cos_phi[-1] - _product(half_slope, squares)
        known = sum((inertia[i] * accelerations[k - i] for i in range(1, k + 1)), start=np.zeros_like(v))
        accelerations.append((torque - known) / inertia[0])
        change = _product(cosines, speeds), _product(sines, speeds)
        speeds.append(accelerations[-1] / (k + 1))
        sines.append(change[0] / 2 / (k + 1))
        cosines.append(-change[1] / 2 / (k + 1))
    return sines, cosines, speeds


def _step(sines: list[np.ndarray], cosines: list[np.ndarray], speeds: list[np.ndarray]) -> np.ndarray:
    """The step at which the last terms of all series are as small as they should be."""
    fastest = np.abs(speeds[0]) + np.sqrt(np.abs(speeds[1])) + EXTENDED(1e-300)
    steps = [
        (_LOCAL * scale / np.maximum(np.abs(series[k]), np.finfo(EXTENDED).tiny)) ** (EXTENDED(1) / k)
        for series, scale in ((sines, 1), (cosines, 1), (speeds, fastest))
        for k in (_ORDER - 1, _ORDER)
    ]
    return np.min(steps, axis=0)
