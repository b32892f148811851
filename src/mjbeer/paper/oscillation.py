"""Section 2.3 of the paper, eqs. (25)-(29): a can that hesitates, and beer that loops."""

import math
from functools import cache, partial

import numpy as np

from mjbeer.paper.claim import (
    APPROXIMATION,
    CONSEQUENCE,
    Bound,
    Claim,
    Limit,
    Misprint,
    Observation,
    Witness,
)
from mjbeer.paper.witness import EXACT, REDUCED, TENTH, loop, oscillate, simulated
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.paper_scenes import sliding
from mjbeer.theory.scene import INCLINE

FAST = 350.0
"""phi_dot [rad/s] at phi = 0 of a load that loops fast: nine times the least at which one loops."""
SLOW = 45.0
"""phi_dot [rad/s] at phi = 0 of a load that just loops: 39.4 rad/s is the least, and above 47.4
rad/s the can would leave the incline."""
_DECADE = (50.0, 100.0, 200.0, 400.0)
"""Rates phi_dot [rad/s] at phi = 0 of loads that loop; their mean rates span a decade, 35 to 354
rad/s."""
_HESITATION = 0.01
"""Amplitude [rad] of the swing in which the can's hesitation is measured."""
_PHASE = np.linspace(0, 2 * math.pi, 65)
_TOP = 3.1
"""Angle [rad] near the top, pi, at which a load that does not loop is let go."""

SQUARES_25 = "sin(x)**2/2 - 1/4 + cos(2*x)/{}"
"""The last step of eq. (25): the divisor is 4, and the paper prints 2."""
PRINTED_28 = "m*b*g*cos(alpha)/(Omega**2*(m*b**2/2 + inertia))"
"""Amplitude [rad] of the ripple at Omega by eqs. (27) and (28)."""
CORRECTED_28 = f"{PRINTED_28}*(1 - 3*delta/8)"
"""This amplitude [rad] to first order in delta; the ripple at 2 Omega lowers it."""
_NORMAL = "m*(g*cos(alpha) + across_ddot)"
"""N [N], from MuJoCo's acceleration of the load."""


@cache
def _ripple() -> Observation:
    """Return `ripple`: at index k, the amplitude [m] of cos(k omega t) in u for a small swing.

    The distance due to the steady acceleration is subtracted from u first.
    """
    period = 2 * math.pi / oscillate(sliding(), _HESITATION).omega
    times = period * np.arange(64) / 64
    run = simulate(sliding(), period, _HESITATION, integrator="DOP853", times=times)
    ahead = run.u - run.scene.acceleration() * times**2 / 2
    return Observation.of(
        run.scene, phi_0=_HESITATION, ripple=np.fft.rfft(ahead).real * 2 / len(times)
    )


@cache
def _furthest_from_rest() -> float:
    """Return the largest |phi| [rad] of beer that starts at rest at `_TOP`."""
    run = simulate(sliding(), 2.0, _TOP, integrator="DOP853")
    return float(np.abs(run.phi).max())


@cache
def _furthest_with_push() -> float:
    """Return the largest |phi| [rad] of beer that starts at phi = 0 with a push.

    Its rate is 1.01 times the least that carries it to the top.
    """
    form = sliding().oscillator
    separatrix = math.sqrt(2 * form.drop(0.0, math.pi) / form.inertia(0.0))
    run = simulate(sliding(), 0.55, 0.0, 1.01 * separatrix, integrator="DOP853")
    return float(np.abs(run.phi).max())


@cache
def _slope() -> float:
    """Return the exponent of Omega to which the ripple of phi at Omega is proportional."""
    turns = [loop(sliding(), phi_dot0) for phi_dot0 in _DECADE]
    rates = [turn.Omega for turn in turns]
    amplitudes = [turn.ripple[1] for turn in turns]
    slope, _ = np.polyfit(np.log(rates), np.log(amplitudes), 1)
    return float(slope)


@cache
def _synthesis() -> Observation:
    """Return phi - Omega t [rad] during one turn, in two ways.

    `ahead` is as simulated, and `waves` is the sum of the ripples at Omega to 16 Omega.
    """
    turn = loop(sliding(), FAST)
    times = _PHASE / turn.Omega
    run = simulate(
        sliding(), times[-1], 0.0, FAST, integrator="DOP853", timestep=times[1], times=times
    )
    waves = sum(turn.ripple[k] * np.sin(k * _PHASE) for k in range(1, 17))
    return Observation.of(sliding(), ahead=run.phi - _PHASE, waves=waves)


_HESITATES = Witness(REDUCED, _ripple)
_SLOW_LOOP = simulated(sliding(), 0.0, 6 * math.pi / SLOW, SLOW)
_FAST_LOOP = simulated(sliding(), 0.0, 6 * math.pi / FAST, FAST)
_TURN = Witness(REDUCED, partial(loop, sliding(), FAST))
_NEXT_ORDER = "the next order in delta = 0.22"

CLAIMS = (
    Claim(
        "(25)",
        "u - s = b sin(phi), eq. (12); printed b cos(phi)",
        TENTH,
        Bound(1e-12, "rounding"),
        residual="-b*sin(phi) + (u - s)",
        misprint=Misprint(
            1.10,
            wrong="-b*cos(phi) + (u - s)",
            about="How far the axis is ahead of the centre of mass",
            latex=r"u-s=b\,<\cos|\sin>\,\varphi",
        ),
        quote="u = s + b cos φ",
    ),
    Claim(
        "(25)",
        "amplitude of the ripple of u at omega: b phi_0; printed none",
        _HESITATES,
        Bound(2e-5, "the amplitude: phi_0^2/8 = 1.2e-5, and phi is not quite a cosine"),
        residual="ripple[1] - b*phi_0",
        misprint=Misprint(
            1.0,
            wrong="ripple[1]",
            about="Amplitude of the can's hesitation at the frequency ω of the swing",
            latex=r"<0|b\,\varphi_0>",
            kind=CONSEQUENCE,
            of="(25)",
        ),
    ),
    Claim(
        "(25)",
        "amplitude of the ripple of u at 2 omega, divided by that at omega: none; printed phi_0/2",
        _HESITATES,
        Bound(1e-9, "rounding: sin(phi) swings alike to both sides"),
        residual="ripple[2]",
        misprint=Misprint(
            _HESITATION / 2,
            wrong="abs(ripple[2]) + b*phi_0**2/2",
            about="Amplitude of the can's hesitation at 2ω",
            latex=r"<b\,\varphi_0\cdot\frac{\varphi_0}{2}|0>",
            kind=CONSEQUENCE,
            of="(25)",
        ),
        scale="ripple[1]",
        quote="a small modulation at angular frequency 2ω, which would appear as a small, periodic "
        "“hesitation”",
    ),
    Claim(
        "(25)",
        "last step, sin^2 = 1/2 - cos(2wt)/2: the coefficient of phi_0^2 cos(2wt) is 1/4, printed "
        "1/2",
        Witness("algebra", lambda: Observation.of(sliding(), x=_PHASE)),
        Bound(1e-15, "rounding"),
        residual=SQUARES_25.format(4),
        misprint=Misprint(
            0.5,
            wrong=SQUARES_25.format(2),
            about="The last step, from the sine's square to the double angle",
            latex=r"-\frac{\varphi_0^2\sin^2\!\omega "
            r"t}{2}=-\frac{\varphi_0^2}{4}+\frac{\varphi_0^2\cos "
            r"2\omega t}{<2|4>}",
        ),
    ),
    Claim(
        "sec. 2.3.1",
        "beer let go at rest with a level surface (theta = 0) swings with the amplitude phi_0 = "
        "alpha",
        simulated(sliding(), -INCLINE),
        EXACT,
        residual="array([theta[0], max(abs(phi))]) - array([0, alpha])",
        quote="If the half cylinder started from rest with its surface horizontal, then φ₀ = α",
    ),
    Claim(
        "sec. 2.3.2",
        "no loop from rest: phi stays within its start; it loops from 1.01 times the separatrix's "
        "rate",
        Witness(REDUCED, _furthest_from_rest),
        Bound(1e-9, "DOP853"),
        residual=f"observed - {_TOP}",
        limit=Limit(0.67, _furthest_with_push),
        quote="This motion is not possible starting from rest",
    ),
    Claim(
        "sec. 2.3.2",
        "the can stays on the incline (N > 0) while its beer loops: beyond, at 350 rad/s; within, "
        "at 45",
        _SLOW_LOOP,
        Bound(0.0, "the sign of N"),
        residual=f"abs({_NORMAL}) - {_NORMAL}",
        limit=Limit(1.95, _FAST_LOOP.observe),
        quote="rolls down the incline essentially as a rigid body",
    ),
    Claim(
        "(26)",
        "ripple of phi at 2 Omega: delta/4, whatever Omega; printed none",
        _TURN,
        Bound(8e-3, _NEXT_ORDER),
        residual="ripple[2] - delta/4",
        misprint=Misprint(
            1.0,
            wrong="ripple[2]",
            about="Fast loops: the ripples of φ",
            latex=r"\varphi=\Omega t+\varepsilon\sin\Omega t<|{}+\frac{\delta}{4}\sin2\Omega t,\\ "
            r"\delta=\frac{mb^2/2}{mb^2/2+I_{\text{cm}}}>",
            kind=APPROXIMATION,
        ),
        quote="we consider that case that angle φ varies with time as φ = Ωt + ε sin ωt",
    ),
    Claim(
        "(27), (28)",
        "epsilon, the ripple at Omega: 1 - 3 delta/8 of the printed one",
        _TURN,
        Bound(8e-3, _NEXT_ORDER),
        residual=f"ripple[1] - {CORRECTED_28}",
        misprint=Misprint(
            0.076,
            wrong=f"ripple[1] - {PRINTED_28}",
            about="Fast loops: amplitude of the ripple at Ω",
            latex=r"\varepsilon=<|\Bigl(1-\frac{3}{8}\delta\Bigr)>"
            r"\frac{mbg\cos\alpha}{\Omega^2(mb^2/2+I_{\text{cm}})}",
            kind=APPROXIMATION,
        ),
        quote="the equation of motion (16) averages to the form",
    ),
    Claim(
        "(28)",
        "epsilon falls as Omega^-2 over a decade of Omega",
        Witness(REDUCED, _slope),
        Bound(6e-3, "the slowest, at 35 rad/s, is near the separatrix"),
        residual="observed + 2",
    ),
    Claim(
        "(28)",
        "epsilon has the frequency Omega: with those at Omega to 16 Omega, phi is as simulated",
        Witness(REDUCED, _synthesis),
        Bound(1e-5, "ripples beyond"),
        residual="ahead - waves",
    ),
    Claim(
        "(29)",
        "amplitude of the ripple of u at Omega: b (1 + delta/8); printed b",
        _TURN,
        Bound(1e-3, _NEXT_ORDER),
        residual="sway[1] - b*(1 + delta/8)",
        misprint=Misprint(
            0.026,
            wrong="sway[1] - b",
            about="Fast loops: the ripple of u at Ω",
            latex=r"b<|\Bigl(1+\frac{\delta}{8}\Bigr)>\sin\Omega t",
            kind=APPROXIMATION,
        ),
    ),
)
