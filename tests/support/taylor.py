"""J and V in 40 digits, and the motions of many scenes at once by Taylor series in extended precision, without energy.

The reduced equation J phi_ddot + J' phi_dot^2 / 2 = -V' is integrated with its coefficients in 40 digits from the
Lagrangian, and phi only ever as the sine and cosine of its half. All series are by recurrence.
"""

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from mpmath import MPContext
from mpmath.calculus.quadrature import GaussLegendre

from mjbeer import Scene

EXTENDED = np.longdouble
ENOUGH = float(np.finfo(EXTENDED).eps) < 1e-18
"""Whether this machine's `long double` has 64 bits of digits, as on x86; elsewhere it may be a double."""
_ORDER = 26
_LOCAL = EXTENDED(1e-20)
"""Local error relative to each quantity."""

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


def inertia(form: dict[str, Any], phi: Any) -> Any:
    """J at an angle [kg m^2]."""
    return form["base"] + form["chord"] * mp.sin(phi / 2) ** 2 + form["swing"] * mp.sin(phi) ** 2


def fall(form: dict[str, Any], begin: Any, end: Any) -> Any:
    """V(begin) - V(end) [J], as the plain difference."""

    def height(phi: Any) -> Any:
        return form["sine"] * mp.sin(phi) - form["cosine"] * mp.cos(phi) - form["slope"] * phi

    return height(begin) - height(end)


def well(form: dict[str, Any]) -> tuple[Any, Any, Any]:
    """The barrier uphill of the rest, the rest and the barrier downhill of it [rad], on either slope."""
    lean = mp.asin(form["slope"] / mp.hypot(form["cosine"], form["sine"]))
    bottom = -mp.atan2(form["sine"], form["cosine"])
    return bottom - mp.pi - lean, bottom + lean, bottom + mp.pi - lean


def integral(rate: Callable[[Any], Any], pieces: Sequence[Any]) -> Any:
    """By Gauss-Legendre with 24 nodes in each piece; mpmath's own `quad` doubles its nodes until two sums agree, and
    for pieces that are cut to fit only the last sum counts."""
    rule, total = GaussLegendre(mp), mp.mpf(0)
    for low, high in itertools.pairwise(pieces):
        total += mp.fdot((weight, rate(node)) for node, weight in rule.get_nodes(low, high, 4, mp.prec))
    return total


def _extended(numbers: Sequence[Any]) -> np.ndarray:
    """The doubles nearest to the numbers, and what they leave."""
    return np.array([EXTENDED(float(each)) + EXTENDED(float(each - mp.mpf(float(each)))) for each in numbers])


def _product(x: np.ndarray, y: np.ndarray, k: int) -> np.ndarray:
    """Coefficient k of the products of one or several pairs of series, of shape (..., order, cases)."""
    return np.einsum("...jn,...jn->...n", x[..., : k + 1, :], y[..., k::-1, :])  # with no array in between


def value(series: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Of series at a step, by Horner's rule."""
    total = series[-1]
    for coefficient in series[-2::-1]:
        total = total * step + coefficient
    return total


def integrate(cases: Sequence[Case], steps: int = 4000) -> tuple[np.ndarray, np.ndarray]:
    """How far phi has turned and phi_dot, of shape (cases, times); NaN for a motion that takes more steps than that."""
    known = [coefficients(case.scene) for case in cases]
    terms = {name: _extended([each[name] for each in known]) for name in known[0]}
    halves = [mp.mpf(case.phi0) / 2 for case in cases]
    s, c = _extended([mp.sin(half) for half in halves]), _extended([mp.cos(half) for half in halves])
    v, ends = np.array([EXTENDED(case.phi_dot0) for case in cases]), np.array([case.time for case in cases], EXTENDED)
    turned, now, sample = np.zeros_like(v), np.zeros_like(v), np.zeros(len(cases), int)
    turns, rates = np.full(ends.shape, np.nan, EXTENDED), np.full(ends.shape, np.nan, EXTENDED)
    active = np.arange(len(cases))
    for _ in range(steps):
        sines, cosines, speeds = _series(
            {name: each[active] for name, each in terms.items()}, s[active], c[active], v[active]
        )
        left = ends[active, sample[active]] - now[active]
        step = _step(sines, cosines, speeds)
        there = step >= left
        step = np.where(there, left, step)
        turned[active] += step * value(speeds / np.arange(1, _ORDER + 2)[:, np.newaxis], step)
        s[active], c[active], v[active] = (value(each, step) for each in (sines, cosines, speeds))
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


def _series(terms: dict[str, np.ndarray], s: np.ndarray, c: np.ndarray, v: np.ndarray) -> np.ndarray:
    """The Taylor series in time of sin(phi/2), cos(phi/2) and phi_dot, of shape (3, _ORDER + 1, cases)."""
    base, chord, swing, slope, cosine, sine = (
        terms[name] for name in ("base", "chord", "swing", "slope", "cosine", "sine")
    )
    series = np.empty((3, _ORDER + 1, len(v)), EXTENDED)
    sines, cosines, speeds = series
    sines[0], cosines[0], speeds[0] = s, c, v
    sin_phi, cos_phi = whole = np.empty((2, _ORDER, len(v)), EXTENDED)
    inertia, half_slope = lever = np.empty((2, _ORDER, len(v)), EXTENDED)
    accelerations, squares = driven = np.empty((2, _ORDER, len(v)), EXTENDED)
    for k in range(_ORDER):  # few calls on many numbers: where few cases are left, calls are what takes time
        first = 1 if k == 0 else 0
        square, half_sin_phi = _product(series[:2], sines, k)
        sin_phi[k], cos_phi[k] = 2 * half_sin_phi, first - 2 * square
        sin_phi_squared, sin_phi_cos_phi = _product(whole, sin_phi, k)
        inertia[k] = first * base + chord * square + swing * sin_phi_squared
        half_slope[k] = chord * sin_phi[k] / 4 + swing * sin_phi_cos_phi
        sines_slope, cosines_slope, squares[k] = _product(series, speeds, k)
        accelerations[k] = 0  # until it is known
        turning = _product(lever, driven, k).sum(axis=0)  # J phi_ddot + J' phi_dot^2 / 2
        accelerations[k] = (first * slope - cosine * sin_phi[k] - sine * cos_phi[k] - turning) / inertia[0]
        speeds[k + 1] = accelerations[k] / (k + 1)
        sines[k + 1] = cosines_slope / (2 * (k + 1))
        cosines[k + 1] = -sines_slope / (2 * (k + 1))
    return series


def _step(sines: np.ndarray, cosines: np.ndarray, speeds: np.ndarray) -> np.ndarray:
    """The step at which the last terms of all series are as small as they should be."""
    fastest = np.abs(speeds[0]) + np.sqrt(np.abs(speeds[1])) + EXTENDED(1e-300)
    steps = [
        (_LOCAL * scale / np.maximum(np.abs(series[k]), np.finfo(EXTENDED).tiny)) ** (EXTENDED(1) / k)
        for series, scale in ((sines, 1), (cosines, 1), (speeds, fastest))
        for k in (_ORDER - 1, _ORDER)
    ]
    return np.min(steps, axis=0)
