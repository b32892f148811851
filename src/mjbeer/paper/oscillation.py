"""Section 2.3 of the paper, equations (25)-(29): how a can hesitates while its beer swings, and beer that loops."""

import math
from functools import cache, partial
from typing import Any

import numpy as np

from mjbeer.model.setting import DOP853
from mjbeer.paper import witness
from mjbeer.paper.claim import APPROXIMATION, CONSEQUENCE, Bound, Claim, Limit, Misprint, SceneConstants, Terms, Witness
from mjbeer.paper.witness import DECADE, EXACT, REDUCED, Looping, cosines, frequency, simulate_motion, swing
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.scene import INCLINE
from mjbeer.theory.scenes import sliding

FAST = 350.0  # phi_dot [rad/s] at phi = 0 of a load that loops fast: nine times the least that makes it loop
SLOW = 45.0
"""The same of a load that just loops. It takes 39.4 rad/s to loop; above 47.4 rad/s the can would leave the incline."""
_HESITATION = 0.01  # amplitude [rad] of the swing in which the can's hesitation is measured
_PHASE = np.linspace(0, 2 * math.pi, 65)
_TOP = 3.1  # angle [rad] beside the top from which a load is let go that does not loop


def squares_25(waves: tuple[Any, Any], part: int) -> Terms:
    """Return the terms of sin^2(x)/2 = 1/4 - cos(2x)/`part` from sin(x) and cos(2x); 4 is right, the paper has 2."""
    sine, cosine_twice = waves
    return sine**2 / 2, -0.25, cosine_twice / part


def epsilon_28(c: SceneConstants, rate: Any) -> Any:
    """Return the amplitude [rad] of the ripple at Omega by eqs. (27) and (28); `rate` is the mean Omega [rad/s]."""
    return c.m * c.b * c.g * c.cos_alpha / (rate**2 * (c.m * c.b**2 / 2 + c.inertia))


def corrected_28(c: SceneConstants, rate: Any) -> Any:
    """Return the same amplitude [rad] times 1 - 3 delta/8, to first order in delta; the ripple at 2 Omega lowers it."""
    return epsilon_28(c, rate) * (1 - 3 * c.spread / 8)


@cache
def _beer() -> SceneConstants:
    return SceneConstants.of(sliding())


@cache
def _ripple() -> np.ndarray:
    """Return the amplitudes [m] of cos(k omega t) in u, without its steady acceleration, over one measured period."""
    period = 2 * math.pi / frequency(sliding(), _HESITATION)
    times = period * np.arange(64) / 64
    run = simulate(sliding(), period, _HESITATION, integrator=DOP853, times=times)
    return cosines(run.u - run.scene.acceleration() * times**2 / 2)


def _ripple_at_twice(ripple: np.ndarray, expected: float) -> Terms:
    """Return the terms [m] of: the ripple of u at 2 omega is `expected` b; the one at omega sets the error's scale."""
    return ripple[1], abs(ripple[2]) + _beer().b * expected, -ripple[1]


def _normal_force(phi_dot0: float) -> np.ndarray:
    """Return N [N] over three turns, from MuJoCo's acceleration of the load."""
    q = simulate_motion(sliding(), "reduced", 3 * 2 * math.pi / phi_dot0, 0.0, phi_dot0)
    return q.m * (q.g * q.cos_alpha + q.across_ddot)


@cache
def _furthest(rate: float) -> float:
    """Return the largest |phi| [rad] of beer that starts at rest at `_TOP`.

    If `rate` is not 0 it starts at phi = 0 instead, at that multiple of the rate that just carries it to the top.
    """
    form = sliding().oscillator
    spin = rate * math.sqrt(2 * form.drop(0.0, math.pi) / form.inertia(0.0))
    run = simulate(sliding(), 0.55 if rate else 2.0, 0.0 if rate else _TOP, spin, integrator=DOP853)
    return float(np.abs(run.phi).max())


@cache
def _loop(phi_dot0: float = FAST) -> Looping:
    """Return a turn of a load that loops, from `phi_dot0` [rad/s] at phi = 0."""
    return witness.loop(sliding(), phi_dot0)


def _slope() -> float:
    """Return the slope of log(amplitude of the ripple of phi at Omega) over log(Omega), over a decade of Omega."""
    turns = [_loop(phi_dot0) for phi_dot0 in DECADE]
    amplitudes = [turn.phi[1] for turn in turns]
    return float(np.polyfit(np.log([turn.rate for turn in turns]), np.log(amplitudes), 1)[0])


def _synthesis(turn: Looping) -> Terms:
    """Return the terms [rad] of: phi over one turn is Omega t and its ripples at Omega to 16 Omega."""
    times = _PHASE / turn.rate
    run = simulate(sliding(), times[-1], 0.0, FAST, integrator=DOP853, timestep=times[1], times=times)
    return run.phi - _PHASE, *(-turn.phi[k] * np.sin(k * _PHASE) for k in range(1, 17))


_HESITATES = Witness(REDUCED, _ripple)
_FAST_LOOP = Witness(REDUCED, _loop)
_NEXT_ORDER = "the next order in delta = 0.22"

# fmt: off
CLAIMS = (
    Claim("(25)", "u - s = b sin(phi), eq. (12); printed b cos(phi)",
        Witness(REDUCED, partial(swing, 0.1)), Bound(1e-12, "rounding"),
        lambda q: (q.u - q.s, -q.b * q.sin_phi),
        Misprint(1.10, lambda q: (q.u - q.s, -q.b * q.cos_phi), "How far the axis is ahead of the centre of mass",
            r"u-s=b\,<\cos|\sin>\,\varphi"),
        quote="u = s + b cos φ"),
    Claim("(25)", "amplitude of the ripple of u at omega: b phi_0; printed none",
        _HESITATES, Bound(2e-5, "the amplitude: phi_0^2/8 = 1.2e-5, and phi is not quite a cosine"),
        lambda ripple: (ripple[1], -_beer().b * _HESITATION),
        Misprint(1.0, lambda ripple: (ripple[1], 0.0),
            "Amplitude of the can's hesitation at the frequency ω of the swing", r"<0|b\,\varphi_0>",
            CONSEQUENCE, "(25)")),
    Claim("(25)", "amplitude of the ripple of u at 2 omega over that at omega: none; printed phi_0/2",
        _HESITATES, Bound(1e-9, "rounding: sin(phi) swings alike to both sides"),
        lambda ripple: _ripple_at_twice(ripple, 0.0),
        Misprint(_HESITATION / 2, lambda ripple: _ripple_at_twice(ripple, _HESITATION**2 / 2),
            "Amplitude of the can's hesitation at 2ω", r"<b\,\varphi_0\cdot\frac{\varphi_0}{2}|0>",
            CONSEQUENCE, "(25)"),
        quote="a small modulation at angular frequency 2ω, which would appear as a small, periodic “hesitation”"),
    Claim("(25)", "last step, sin^2 = 1/2 - cos(2wt)/2: the coefficient of phi_0^2 cos(2wt) is 1/4, printed 1/2",
        Witness("algebra", lambda: (np.sin(_PHASE), np.cos(2 * _PHASE))), Bound(1e-15, "rounding"),
        lambda waves: squares_25(waves, 4),
        Misprint(0.5, lambda waves: squares_25(waves, 2), "The last step, from the sine's square to the double angle",
            r"-\frac{\varphi_0^2\sin^2\!\omega t}{2}=-\frac{\varphi_0^2}{4}+\frac{\varphi_0^2\cos 2\omega t}{<2|4>}")),
    Claim("sec. 2.3.1", "beer let go at rest with a level surface (theta = 0) swings with the amplitude phi_0 = alpha",
        Witness(REDUCED, partial(swing, -INCLINE)), EXACT,
        lambda q: (np.array([q.theta[0], np.abs(q.phi).max()]), -np.array([0.0, q.alpha])),
        quote="If the half cylinder started from rest with its surface horizontal, then φ₀ = α"),
    Claim("sec. 2.3.2", "no loop from rest: phi stays within its start; it loops from 1.01 times the separatrix's rate",
        Witness(REDUCED, partial(_furthest, 0.0)), Bound(1e-9, "DOP853"),
        lambda furthest: (furthest, -_TOP), limit=Limit(0.67, partial(_furthest, 1.01)),
        quote="This motion is not possible starting from rest"),
    Claim("sec. 2.3.2",
        "the can stays on the incline (N > 0) while its beer loops: beyond, at 350 rad/s; within, at 45",
        Witness(REDUCED, partial(_normal_force, SLOW)), Bound(0.0, "the sign of N"),
        lambda normal: (np.abs(normal), -normal), limit=Limit(1.95, partial(_normal_force, FAST)),
        quote="rolls down the incline essentially as a rigid body"),
    Claim("(26)", "ripple of phi at 2 Omega: delta/4, whatever Omega; printed none",
        _FAST_LOOP, Bound(8e-3, _NEXT_ORDER),
        lambda turn: (turn.phi[2], -_beer().spread / 4),
        Misprint(1.0, lambda turn: (turn.phi[2], 0.0), "Fast loops: the ripples of φ",
            r"\varphi=\Omega t+\varepsilon\sin\Omega t<|{}+\frac{\delta}{4}\sin2\Omega t,\\ "
            r"\delta=\frac{mb^2/2}{mb^2/2+I_{\text{cm}}}>", APPROXIMATION),
        quote="we consider that case that angle φ varies with time as φ = Ωt + ε sin ωt"),
    Claim("(27), (28)", "epsilon, the ripple at Omega: 1 - 3 delta/8 of the printed one",
        _FAST_LOOP, Bound(8e-3, _NEXT_ORDER),
        lambda turn: (turn.phi[1], -corrected_28(_beer(), turn.rate)),
        Misprint(0.076, lambda turn: (turn.phi[1], -epsilon_28(_beer(), turn.rate)),
            "Fast loops: amplitude of the ripple at Ω",
            r"\varepsilon=<|\Bigl(1-\frac{3}{8}\delta\Bigr)>"
            r"\frac{mbg\cos\alpha}{\Omega^2(mb^2/2+I_{\text{cm}})}", APPROXIMATION),
        quote="the equation of motion (16) averages to the form"),
    Claim("(28)", "epsilon falls as Omega^-2 over a decade of Omega",
        Witness(REDUCED, _slope), Bound(6e-3, "the slowest, at 35 rad/s, is near the separatrix"),
        lambda slope: (slope, 2.0)),
    Claim("(28)", "epsilon has the frequency Omega: with those at Omega to 16 Omega, phi is as simulated",
        _FAST_LOOP, Bound(1e-5, "ripples beyond"), _synthesis),
    Claim("(29)", "amplitude of the ripple of u at Omega: b (1 + delta/8); printed b",
        _FAST_LOOP, Bound(1e-3, _NEXT_ORDER),
        lambda turn: (turn.sway[1], -_beer().b * (1 + _beer().spread / 8)),
        Misprint(0.026, lambda turn: (turn.sway[1], -_beer().b), "Fast loops: the ripple of u at Ω",
            r"b<|\Bigl(1+\frac{\delta}{8}\Bigr)>\sin\Omega t", APPROXIMATION)),
)
# fmt: on
