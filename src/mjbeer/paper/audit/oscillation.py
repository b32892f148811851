"""Claims of section 2 about small oscillations and loops, equations (6), (10) and (24)-(29)."""

import math
from collections.abc import Callable, Iterator
from functools import cache

import numpy as np

from mjbeer.model.setting import DOP853
from mjbeer.paper.audit.claim import Claim, confirmed, corrected, limit
from mjbeer.paper.audit.motions import LARGE, MODERATE, REDUCED, SMALL, long_swing, swing
from mjbeer.paper.audit.witness import watch
from mjbeer.paper.equations import sliding as equations
from mjbeer.paper.letters import Letters, Terms
from mjbeer.paper.looping import Looping, cosines, loop
from mjbeer.paper.scenarios import DECADE
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.named import sliding
from mjbeer.theory.scene import Scene

FAST = 350.0
"""phi_dot [rad/s] at phi = 0 of a load that loops fast: nine times the least that makes it loop."""
SLOW = 45.0
"""The same of a load that just loops. It takes 39.4 rad/s to loop; above 47.4 rad/s the can would leave the incline."""
_HESITATION = 0.01
"""Amplitude [rad] of the swing in which the can's hesitation is measured."""


def claims() -> Iterator[Claim]:
    """Yield the claims of this chapter."""
    yield from _frequency()
    yield from _hesitation()
    yield from _looping()


def _frequency() -> Iterator[Claim]:
    beer = sliding()
    c = Letters.of(beer)
    yield limit(
        "(6), (24)",
        "omega of small oscillations: beyond, a swing of 1 rad; within, of 1e-3 rad",
        witness=REDUCED,
        beyond=lambda: (math.sqrt(equations.eq_6(c)), -long_swing(beer, MODERATE).frequency()),
        within=lambda: (math.sqrt(equations.eq_24(c)), -long_swing(beer, SMALL).frequency()),
        misses_by=0.15,
        bound=3e-7,
        reason="the amplitude: 2e-7",
    )
    yield corrected(
        "(10)",
        "omega^2, middle form: it lacks 1/a (in SI units)",
        witness=REDUCED,
        printed=lambda: (equations.printed_10(c, math.pi), -(long_swing(beer, SMALL).frequency() ** 2)),
        right=lambda: (equations.eq_10(c, math.pi), -(long_swing(beer, SMALL).frequency() ** 2)),
        misses_by=0.967,
        bound=6e-7,
        reason="the amplitude: 4e-7",
    )
    yield confirmed(
        "(10)",
        "omega^2 = 1.33 g cos(alpha)/a",
        witness=REDUCED,
        terms=lambda: (1.33 * c.g * c.cos_alpha / c.a, -(long_swing(beer, SMALL).frequency() ** 2)),
        bound=3.8e-3,
        reason="half a unit of the last digit",
    )


def _hesitation() -> Iterator[Claim]:
    phi0 = _HESITATION
    yield corrected(
        "(25)",
        "u - s = b sin(phi), eq. (12); printed b cos(phi)",
        witness=REDUCED,
        printed=lambda: equations.printed_25(swing(0.1).quantities),
        right=lambda: equations.ripple_25(swing(0.1).quantities),
        misses_by=1.10,
        bound=1e-12,
        reason="rounding",
    )
    yield corrected(
        "(25)",
        "amplitude of the ripple of u at omega: b phi_0; printed none",
        witness=REDUCED,
        printed=lambda: (_ripple(sliding())[1], 0.0),
        right=lambda: (_ripple(sliding())[1], -sliding().load.offset * phi0),
        misses_by=1.0,
        bound=2e-5,
        reason="the amplitude: phi_0^2/8 = 1.2e-5, and phi is not quite a cosine",
    )
    yield corrected(
        "(25)",
        "amplitude of the ripple of u at 2 omega over that at omega: none; printed phi_0/2",
        witness=REDUCED,
        printed=lambda: _ripple_at_twice(phi0**2 / 2),
        right=lambda: _ripple_at_twice(0.0),
        misses_by=phi0 / 2,
        bound=1e-9,
        reason="rounding: sin(phi) swings alike to both sides",
    )
    phase = np.linspace(0, 2 * math.pi, 65)
    yield corrected(
        "(25)",
        "last step, sin^2 = 1/2 - cos(2wt)/2: the coefficient of phi_0^2 cos(2wt) is 1/4, printed 1/2",
        witness="algebra",
        printed=lambda: equations.printed_squares_25(np.sin(phase), np.cos(2 * phase)),
        right=lambda: equations.squares_25(np.sin(phase), np.cos(2 * phase)),
        misses_by=0.5,
        bound=1e-15,
        reason="rounding",
    )
    yield corrected(
        "sec. 2.3.1",
        "phi at which the surface is horizontal: -alpha; printed phi_0 = alpha",
        witness=REDUCED,
        printed=lambda: (_level_phi(), -sliding().incline),
        right=lambda: (_level_phi(), sliding().incline),
        misses_by=2.0,
        bound=1e-12,
        reason="rounding",
    )


def _looping() -> Iterator[Claim]:
    c = Letters.of(sliding())
    yield limit(
        "sec. 2.3.2",
        "no loop from rest: phi stays within its start; it loops from 1.01 times the separatrix's rate",
        witness=REDUCED,
        beyond=lambda: _furthest_over_start(1.01),
        within=lambda: _furthest_over_start(0.0),
        misses_by=0.67,
        bound=1e-9,
        reason="DOP853",
    )
    yield limit(
        "sec. 2.3.2",
        "the can stays on the incline (N > 0) while its beer loops: beyond, at 350 rad/s; within, at 45",
        witness=REDUCED,
        beyond=lambda: _normal_force(FAST),
        within=lambda: _normal_force(SLOW),
        misses_by=1.95,
        bound=0.0,
        reason="the sign of N",
    )
    yield corrected(
        "(26)",
        "ripple of phi at 2 Omega: delta/4, whatever Omega; printed none",
        witness=REDUCED,
        printed=lambda: (_loop(FAST).phi[2], 0.0),
        right=lambda: (_loop(FAST).phi[2], -equations.ripple_26(c)),
        misses_by=1.0,
        bound=8e-3,
        reason="the next order in delta = 0.22",
    )
    yield corrected(
        "(27), (28)",
        "epsilon, the ripple at Omega: 1 - 3 delta/8 of the printed one",
        witness=REDUCED,
        printed=lambda: _epsilon(equations.epsilon_28),
        right=lambda: _epsilon(equations.corrected_28),
        misses_by=0.076,
        bound=8e-3,
        reason="the next order in delta = 0.22",
    )
    yield confirmed(
        "(28)",
        "epsilon falls as Omega^-2 over a decade of Omega",
        witness=REDUCED,
        terms=lambda: (_slope(1), 2.0),
        bound=6e-3,
        reason="the slowest, at 35 rad/s, is near the separatrix",
    )
    yield confirmed(
        "(28)",
        "epsilon has the frequency Omega: with those at Omega to 16 Omega, phi is as simulated",
        witness=REDUCED,
        terms=_synthesis,
        bound=1e-5,
        reason="ripples beyond",
    )
    yield corrected(
        "(29)",
        "amplitude of the ripple of u at Omega: b (1 + delta/8); printed b",
        witness=REDUCED,
        printed=lambda: (_loop(FAST).sway[1], -c.b),
        right=lambda: (_loop(FAST).sway[1], -equations.sway_29(c)),
        misses_by=0.026,
        bound=1e-3,
        reason="the next order in delta = 0.22",
    )


def _normal_force(phi_dot0: float) -> Terms:
    """Return the terms of |N| = N [N] over three turns, with N from MuJoCo's acceleration of the load."""
    motion = watch(sliding(), "reduced", 3 * 2 * math.pi / phi_dot0, 0.0, phi_dot0)
    q = motion.quantities
    normal = q.m * (q.g * q.cos_alpha + motion.across[2])
    return np.abs(normal), -normal


@cache
def _ripple(scene: Scene) -> np.ndarray:
    """Return the amplitudes [m] of cos(k omega t) in u, without its steady acceleration, over one measured period."""
    period = 2 * math.pi / long_swing(scene, _HESITATION).frequency()
    times = period * np.arange(64) / 64
    run = simulate(scene, period, _HESITATION, integrator=DOP853, times=times)
    return cosines(run.u - scene.acceleration() * times**2 / 2)


def _ripple_at_twice(expected: float) -> Terms:
    """Return the terms [m] of: the ripple of u at 2 omega is `expected` b; the one at omega sets the error's scale."""
    ripple = _ripple(sliding())
    return ripple[1], abs(ripple[2]) + sliding().load.offset * expected, -ripple[1]


def _level_phi() -> float:
    """Return phi [rad] of a level surface: phi minus the angle from gravity to the line to the centre of mass."""
    motion = swing(LARGE)
    return float(motion.quantities.phi[0] - motion.theta[0])


@cache
def _loop(phi_dot0: float) -> Looping:
    """Return a turn of a load that loops, from `phi_dot0` [rad/s] at phi = 0."""
    return loop(sliding(), phi_dot0)


def _epsilon(formula: Callable[[Letters, float], float]) -> Terms:
    """Return the terms [rad] of: the measured ripple of phi at Omega is that of a formula."""
    turn = _loop(FAST)
    return turn.phi[1], -formula(Letters.of(sliding()), turn.rate)


def _slope(harmonic: int) -> float:
    """Return the slope of log(amplitude of a ripple of phi) over log(Omega), over a decade of Omega."""
    turns = [_loop(phi_dot0) for phi_dot0 in DECADE]
    amplitudes = [turn.phi[harmonic] for turn in turns]
    return float(np.polyfit(np.log([turn.rate for turn in turns]), np.log(amplitudes), 1)[0])


def _synthesis() -> Terms:
    """Return the terms [rad] of: phi over one turn is Omega t and its ripples at Omega to 16 Omega."""
    turn = _loop(FAST)
    phase = np.linspace(0, 2 * math.pi, 65)
    times = phase / turn.rate
    run = simulate(sliding(), times[-1], 0.0, FAST, integrator=DOP853, timestep=times[1], times=times)
    return run.phi - phase, *(-turn.phi[k] * np.sin(k * phase) for k in range(1, 17))


def _furthest_over_start(rate: float) -> Terms:
    """Return the terms [rad] of: the largest |phi| of a motion is 3.1, the angle from which it starts at rest.

    If `rate` is not 0 it starts at phi = 0 instead, at that multiple of the rate that just carries it to the top.
    """
    beer = sliding()
    start = 0.0 if rate else 3.1
    top = beer.oscillator.drop(0.0, math.pi)
    spin = rate * math.sqrt(2 * top / beer.oscillator.inertia(0.0))
    run = simulate(beer, 0.55 if rate else 2.0, start, spin, integrator=DOP853)
    return float(np.abs(run.phi).max()), -3.1
