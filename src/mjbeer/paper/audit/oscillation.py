"""Rows of the audit: small oscillations and loops in section 2, equations (6), (10) and (24)-(29)."""

import math
from collections.abc import Callable, Iterator
from functools import cache

import numpy as np

from mjbeer.model.setting import DOP853
from mjbeer.paper.audit.claim import Claim, confirmed, corrected, limit
from mjbeer.paper.audit.motions import LARGE, MODERATE, REDUCED, SMALL, swing, swung
from mjbeer.paper.audit.witness import watch
from mjbeer.paper.equations import sliding as equations
from mjbeer.paper.letters import Letters, Terms
from mjbeer.paper.looping import Looping, cosines, loop
from mjbeer.paper.scenarios import DECADE
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.scene import Scene, sliding

FAST = 350.0
"""phi_dot [rad/s] at phi = 0 of a load that loops fast: nine times what it takes."""
SLOW = 45.0
"""One that just loops: 39.4 rad/s is the least, and from 47.4 rad/s on the incline would have to pull."""
_HESITATION = 0.01
"""Amplitude [rad] of the swing whose hesitation is measured."""


def claims() -> Iterator[Claim]:
    """The rows."""
    yield from _frequency()
    yield from _hesitation()
    yield from _looping()


def _frequency() -> Iterator[Claim]:
    beer = sliding()
    c = Letters.of(beer)
    yield limit(
        "(6), (24)", "omega of small oscillations: beyond, a swing of 1 rad; within, of 1e-3 rad", REDUCED,
        lambda: (math.sqrt(equations.eq_6(c)), -swung(beer, MODERATE).frequency()),
        lambda: (math.sqrt(equations.eq_24(c)), -swung(beer, SMALL).frequency()), 0.15, 3e-7, "the amplitude: 2e-7",
    )  # fmt: skip
    yield corrected(
        "(10)", "omega^2, middle form: it lacks 1/a (in SI units)", REDUCED,
        lambda: (equations.printed_10(c, math.pi), -(swung(beer, SMALL).frequency() ** 2)),
        lambda: (equations.eq_10(c, math.pi), -(swung(beer, SMALL).frequency() ** 2)), 0.967, 6e-7,
        "the amplitude: 4e-7",
    )  # fmt: skip
    yield confirmed(
        "(10)", "omega^2 = 1.33 g cos(alpha)/a", REDUCED,
        lambda: (1.33 * c.g * c.cos_alpha / c.a, -(swung(beer, SMALL).frequency() ** 2)), 3.8e-3,
        "half a unit of the last digit",
    )  # fmt: skip


def _hesitation() -> Iterator[Claim]:
    phi0 = _HESITATION
    yield corrected(
        "(25)",
        "u - s = b sin(phi), eq. (12); printed b cos(phi)",
        REDUCED,
        lambda: equations.printed_25(swing(0.1).quantities),
        lambda: equations.ripple_25(swing(0.1).quantities),
        1.10,
        1e-12,
        "rounding",
    )
    yield corrected(
        "(25)", "amplitude of the ripple of u at omega: b phi_0; printed none", REDUCED,
        lambda: (_ripple(sliding())[1], 0.0), lambda: (_ripple(sliding())[1], -sliding().load.offset * phi0), 1.0,
        2e-5, "the amplitude: phi_0^2/8 = 1.2e-5, and phi is not quite a cosine",
    )  # fmt: skip
    yield corrected(
        "(25)", "amplitude of the ripple of u at 2 omega over that at omega: none; printed phi_0/2", REDUCED,
        lambda: _doubled(phi0**2 / 2), lambda: _doubled(0.0), phi0 / 2, 1e-9,
        "rounding: sin(phi) swings alike to both sides",
    )  # fmt: skip
    phase = np.linspace(0, 2 * math.pi, 65)
    yield corrected(
        "(25)", "last step, sin^2 = 1/2 - cos(2wt)/2: the coefficient of phi_0^2 cos(2wt) is 1/4, printed 1/2",
        "algebra", lambda: equations.printed_squares_25(np.sin(phase), np.cos(2 * phase)),
        lambda: equations.squares_25(np.sin(phase), np.cos(2 * phase)), 0.5, 1e-15, "rounding",
    )  # fmt: skip
    yield corrected(
        "sec. 2.3.1", "phi at which the surface is horizontal: -alpha; printed phi_0 = alpha", REDUCED,
        lambda: (_level(), -sliding().incline), lambda: (_level(), sliding().incline), 2.0, 1e-12, "rounding",
    )  # fmt: skip


def _looping() -> Iterator[Claim]:
    c = Letters.of(sliding())
    yield limit(
        "sec. 2.3.2", "no loop from rest: phi stays within its start; it loops from 1.01 times the separatrix's rate",
        REDUCED, lambda: _furthest(1.01), lambda: _furthest(0.0), 0.67, 1e-9, "DOP853",
    )  # fmt: skip
    yield limit(
        "sec. 2.3.2", "the can stays on the incline (N > 0) while its beer loops: beyond, at 350 rad/s; within, at 45",
        REDUCED, lambda: _pressed(FAST), lambda: _pressed(SLOW), 1.95, 0.0, "the sign of N",
    )  # fmt: skip
    yield corrected(
        "(26)", "ripple of phi at 2 Omega: delta/4, whatever Omega; printed none", REDUCED,
        lambda: (_loop(FAST).phi[2], 0.0), lambda: (_loop(FAST).phi[2], -equations.ripple_26(c)), 1.0, 8e-3,
        "the next order in delta = 0.22",
    )  # fmt: skip
    yield corrected(
        "(27), (28)", "epsilon, the ripple at Omega: 1 - 3 delta/8 of the printed one", REDUCED,
        lambda: _epsilon(equations.epsilon_28), lambda: _epsilon(equations.corrected_28), 0.076, 8e-3,
        "the next order in delta = 0.22",
    )  # fmt: skip
    yield confirmed(
        "(28)", "epsilon falls as Omega^-2 over a decade of Omega", REDUCED, lambda: (_slope(1), 2.0), 6e-3,
        "the slowest, at 35 rad/s, is near the separatrix",
    )  # fmt: skip
    yield confirmed(
        "(28)", "epsilon has the frequency Omega: with those at Omega to 16 Omega, phi is as simulated", REDUCED,
        _synthesis, 1e-5, "ripples beyond",
    )  # fmt: skip
    yield corrected(
        "(29)", "amplitude of the ripple of u at Omega: b (1 + delta/8); printed b", REDUCED,
        lambda: (_loop(FAST).sway[1], -c.b), lambda: (_loop(FAST).sway[1], -equations.sway_29(c)), 0.026, 1e-3,
        "the next order in delta = 0.22",
    )  # fmt: skip


def _pressed(phi_dot0: float) -> Terms:
    """|N| and -N [N] over some turns, by MuJoCo's acceleration of the load."""
    seen = watch(sliding(), "reduced", 3 * 2 * math.pi / phi_dot0, 0.0, phi_dot0)
    q = seen.quantities
    normal = q.m * (q.g * q.cos_alpha + seen.across[2])
    return np.abs(normal), -normal


@cache
def _ripple(scene: Scene) -> np.ndarray:
    """Amplitudes [m] of cos(k omega t) in u less its steady acceleration, over one measured period."""
    period = 2 * math.pi / swung(scene, _HESITATION).frequency()
    times = period * np.arange(64) / 64
    run = simulate(scene, period, _HESITATION, integrator=DOP853, times=times)
    return cosines(run.u - scene.acceleration() * times**2 / 2)


def _doubled(expected: float) -> Terms:
    ripple = _ripple(sliding())
    return ripple[1], abs(ripple[2]) + sliding().load.offset * expected, -ripple[1]


def _level() -> float:
    """phi [rad] less MuJoCo's angle between gravity and the line to the centre of mass."""
    seen = swing(LARGE)
    return float(seen.quantities.phi[0] - seen.theta[0])


@cache
def _loop(phi_dot0: float) -> Looping:
    return loop(sliding(), phi_dot0)


def _epsilon(formula: Callable[[Letters, float], float]) -> Terms:
    seen = _loop(FAST)
    return seen.phi[1], -formula(Letters.of(sliding()), seen.rate)


def _slope(harmonic: int) -> float:
    """Slope of log(amplitude) over log(Omega)."""
    seen = [_loop(each) for each in DECADE]
    amplitudes = [each.phi[harmonic] for each in seen]
    return float(np.polyfit(np.log([each.rate for each in seen]), np.log(amplitudes), 1)[0])


def _synthesis() -> Terms:
    seen = _loop(FAST)
    phase = np.linspace(0, 2 * math.pi, 65)
    times = phase / seen.rate
    run = simulate(sliding(), times[-1], 0.0, FAST, integrator=DOP853, timestep=times[1], times=times)
    return run.phi - phase, *(-seen.phi[k] * np.sin(k * phase) for k in range(1, 17))


def _furthest(rate: float) -> Terms:
    """The largest |phi| [rad] of a motion of 2 s, from rest at 3.1 rad, or with a multiple of the separatrix's rate."""
    beer = sliding()
    start = 0.0 if rate else 3.1
    top = beer.oscillator.potential(math.pi) - beer.oscillator.potential(0.0)
    spin = rate * math.sqrt(2 * top / beer.oscillator.inertia(0.0))
    run = simulate(beer, 0.55 if rate else 2.0, start, spin, integrator=DOP853)
    return float(np.abs(run.phi).max()), -3.1
