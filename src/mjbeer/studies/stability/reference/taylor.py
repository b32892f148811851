"""The compiled Taylor method for one angle phi whose acceleration is a quotient of trigonometric polynomials.

With s = sin(f phi), c = cos(f phi) and v = phi_dot, both kinds of scene have the acceleration

    phi_ddot = (t0 + t1 s^2 + n1 s + n2 c - (t2 + t3 v^2) s c) / (d0 + d1 s^2).

The coefficients of the power series of phi(t) follow one after the other from those of s, c and v (A. Jorba and
M. Zou, A software package for the numerical integration of ODEs by means of high-order Taylor methods, Experimental
Mathematics 14, 2005). The steps are so short that the series is cut off below the rounding of doubles. What a step
adds is computed in doubles, but the sums over all steps are kept as pairs of doubles, so that their rounding does not
add up.
"""

import math

import numpy as np
from numba import njit

ORDER = 28
"""Order of the series. Between 24 and 32 the run time for a given error is the same within a tenth."""
_TAIL = 1e-18
"""Size of the last terms of a step relative to the largest: a hundredth of the rounding of a double."""
_LAST = 3
"""Number of last terms that must be small: one or two may be small by chance."""
_HUGE = 1e200
"""Terms of a step that is far too long may be larger than this, or infinite, and then compare with nothing."""
_SHRINK, _GROW, _REDO = 0.9, 3.0, 0.02
"""Factors by which a step is shortened until its last terms are small; by which it may exceed the step before; and by
which it may fall below it, as the coefficients are in units of the step before."""


@njit(cache=True)
def _add(high, low, more):
    """Return the sum of a pair of doubles and a double, as a pair whose second double is the rounding of the first."""
    total = high + more
    part = total - high
    rounding = (high - (total - part)) + (more - part) + low
    result = total + rounding
    return result, rounding - (result - total)


@njit(cache=True)
def _product(left, right, k):
    """Return the coefficient k of the product of two series."""
    total = 0.0
    for j in range(k + 1):
        total += left[j] * right[k - j]
    return total


@njit(cache=True)
def _expand(form, unit, phi, s, c, work):
    """Fill the series of phi, s and c in time over `unit`; their first coefficients (two of phi) must be there."""
    factor, t0, t1, n1, n2, t2, t3, d0, d1 = form
    v, vv, ss, sc, acceleration = work
    v[0] = phi[1]
    for k in range(ORDER + 1):
        if k > 0:
            sine = cosine = 0.0
            for j in range(1, k + 1):
                sine += j * phi[j] * c[k - j]
                cosine += j * phi[j] * s[k - j]
            s[k], c[k] = factor * sine / k, -factor * cosine / k
        if k > ORDER - 2:
            continue
        vv[k], ss[k], sc[k] = _product(v, v, k), _product(s, s, k), _product(s, c, k)
        torque = t1 * ss[k] + n1 * s[k] + n2 * c[k] - t2 * sc[k]
        if k == 0:
            torque += t0
        rest = unit * unit * torque - t3 * _product(vv, sc, k)
        for j in range(1, k + 1):
            rest -= d1 * ss[j] * acceleration[k - j]
        acceleration[k] = rest / (d0 + d1 * ss[0])
        v[k + 1] = acceleration[k] / (k + 1)
        phi[k + 2] = v[k + 1] / (k + 2)


@njit(cache=True)
def _longest(v):
    """Return the longest step, in units of time and at most `_GROW`, whose last terms of v are small."""
    step = _GROW
    while step > _REDO:
        largest = last = 0.0
        power = 1.0
        for k in range(ORDER):
            term = abs(v[k]) * power
            largest = max(largest, term)
            if k >= ORDER - _LAST:
                last = max(last, term)
            power *= step
        if last <= _TAIL * largest and largest < _HUGE:
            break
        step *= _SHRINK
    return step


@njit(cache=True)
def _terms(series, first, time):
    """Return the sum of the terms of a series from the order `first` on."""
    total = 0.0
    for k in range(ORDER, first - 1, -1):
        total = total * time + series[k]
    return total * time**first


@njit(cache=True)
def _rates(series, first, time):
    """Return the time derivative of the same sum."""
    total = 0.0
    for k in range(ORDER, first - 1, -1):
        total = total * time + k * series[k]
    return total * time ** (first - 1)


@njit(cache=True)
def integrate(form, phi0, phi_dot0, times, samples, most):
    """Fill `samples` with phi and phi_dot at increasing `times`; return the number of steps, -1 if there are too many.

    Args:
      form: f, t0, t1, n1, n2, t2, t3, d0, d1 of the acceleration.
      phi0: phi at time 0.
      phi_dot0: phi_dot at time 0.
      times: the times of the samples, at or after 0.
      samples: array of shape (samples, 2).
      most: largest number of steps.
    """
    phi, s, c = np.zeros(ORDER + 1), np.zeros(ORDER + 1), np.zeros(ORDER + 1)
    work = np.zeros((5, ORDER + 1))
    factor = form[0]
    angle, angle_low, rate, rate_low, now, now_low = phi0, 0.0, phi_dot0, 0.0, 0.0, 0.0
    unit, sample = 1.0, 0
    for count in range(most):
        sine, cosine = math.sin(factor * angle), math.cos(factor * angle)
        s[0] = sine + cosine * factor * angle_low
        c[0] = cosine - sine * factor * angle_low
        phi[0], phi[1] = angle, (rate + rate_low) * unit
        _expand(form, unit, phi, s, c, work)
        longest = _longest(work[0])
        if longest <= _REDO:  # coefficients in a unit so much longer than the step may have overflowed
            unit *= _REDO
            continue
        left = (times[-1] - now) - now_low
        step = min(longest * unit, left)
        while sample < len(times):
            time = (times[sample] - now) - now_low
            if time > step:
                break
            samples[sample, 0] = angle + (angle_low + _terms(phi, 1, time / unit))
            samples[sample, 1] = rate + (rate_low + _rates(phi, 2, time / unit) / unit)
            sample += 1
        if sample == len(times):
            return count + 1
        angle, angle_low = _add(angle, angle_low, _terms(phi, 1, step / unit))
        rate, rate_low = _add(rate, rate_low, _rates(phi, 2, step / unit) / unit)
        now, now_low = _add(now, now_low, step)
        unit = step
    return -1
