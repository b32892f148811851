"""Stories of section 2: beer that slides in a massless can."""

import math
import pathlib
from collections.abc import Iterator
from functools import partial

import numpy as np
from scipy.optimize import brentq

from mjbeer.drawing.film import Take
from mjbeer.drawing.overlay.look import Look, Mark
from mjbeer.model.setting import DOP853
from mjbeer.output.plots import (
    COLOURS,
    PRINTED,
    REFERENCE,
    SIMULATED,
    THEORY,
    UNPHYSICAL,
    chart,
    name_below,
    note,
    ticks,
)
from mjbeer.paper.equations import sliding as equations
from mjbeer.paper.letters import Letters
from mjbeer.paper.looping import loop
from mjbeer.paper.scenarios import DECADE
from mjbeer.paper.stories.story import Story
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.exact import exact
from mjbeer.theory.named import in_degrees, in_words, sliding
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

_GHOST: tuple[Mark, ...] = ("phi", "ghost")
_SWING = math.radians(30)
"""Amplitude [rad] of the swing that shows the hesitation: wide enough to be seen in the can's way."""
_LOOPING = 45.0
"""Rate of phi [rad/s] at the bottom of beer that loops: above 39.4 it does, and up to 47.4 its can stays down."""


def stories() -> Iterator[Story]:
    """Yield the stories of this chapter."""
    yield Story(
        "trivial",
        "Beer that starts with its surface parallel to the incline keeps it so, and the can rolls down with exactly "
        "g sin α. Beer let go at 60° swings, and its can hesitates. But its centre of mass moves down just the same.",
        draw=_draw_trivial,
        film=Take(
            partial(_let_go, 0.0),
            speed=0.25,
            look=Look("Let go with its surface along the incline, beer does not swing", ("phi", "u"), ("phi",)),
        ),
    )
    yield Story(
        "hesitation",
        "The can hesitates once in every swing of the beer: its distance less ½ g sin α t² is b sin φ, and swings with "
        "the beer. Eq. (25) as printed has b cos φ instead, a smaller ripple at twice the frequency. It is drawn "
        "without its constant, and from the same start.",
        draw=_draw_hesitation,
        film=Take(_hesitation, 0.25, Look("A can hesitates in every swing of its beer", ("phi", "ahead"), _GHOST)),
    )
    yield Story(
        "release",
        "A can is held until its beer is level and then let go, so that φ starts at −α. The steeper the incline, the "
        "wider the swing, and the slower it is in comparison with small swings.",
        draw=_draw_release,
        film=Take(
            partial(_level_start, 40.0, periods=2.0),
            speed=0.1,
            look=Look("Let go with its surface level, beer swings", ("phi", "ahead"), _GHOST),
        ),
    )
    yield Story(
        "looping",
        "Beer that loops in its can: how far φ is ahead of an even rotation, over one turn. Eq. (26) has only the "
        "ripple at Ω, with the amplitude ε of (28); the one at 2Ω remains however fast the beer spins. A free can "
        "follows only the left motion: if the beer is faster than 47 rad/s at the bottom, it lifts its can off the "
        "incline. At this lower rate, formulas of first order in δ are only near the truth.",
        draw=_draw_looping,
        film=Take(_looping, 0.1, Look("Beer that loops in its can", ("phi", "normal"), ("phi", "forces"))),
    )
    yield Story(
        "ripples",
        "Both ripples over a decade of the mean rate Ω. The one at Ω falls in proportion to 1/Ω² and is 8 % smaller "
        "than by eq. (28); the one at 2Ω does not change. Grey: rates at which the beer would lift a free can.",
        draw=_draw_ripples,
    )


def _let_go(degrees: float) -> Trajectory:
    """Return one second of beer let go at an angle to the incline."""
    return simulate(sliding(), 1.0, math.radians(degrees), integrator=DOP853, timestep=1e-3)


def _draw_trivial(path: pathlib.Path) -> None:
    runs = {degrees: _let_go(degrees) for degrees in (0.0, 60.0)}
    scene, times = runs[0.0].scene, runs[0.0].time
    title = "However the beer swings, its centre of mass moves down the incline evenly"
    with chart(path, 1, 3, width=12, height=4.6, title=title, subtitle=in_words(scene)) as (angle, axis, centre):
        for panel in (axis, centre):
            panel.plot(times, scene.acceleration() * times**2 / 2, label="exact theory: ½ g sin α t²", **THEORY)
        for (degrees, run), line, colour in zip(runs.items(), ("-", "--"), COLOURS[::2], strict=False):
            name = f"MuJoCo, beer let go at φ = {degrees:g}°"
            angle.plot(run.time, np.degrees(run.phi), line, color=colour, label=name)
            axis.plot(run.time, run.u - run.u[0], line, color=colour)
            centre.plot(run.time, run.u - scene.load.offset * np.sin(run.phi), line, color=colour)
        angle.set(ylabel="φ, beer's surface to the incline [°]", title="The beer's tilt")
        axis.set(ylabel="u, distance down the incline [m]", title="The can's axis")
        centre.set(ylabel="s, distance down the incline [m]", title="The beer's centre of mass")
        for panel in (angle, axis, centre):
            panel.set_xlabel("time t [s]")
        name_below((angle, axis), 3)


def _hesitation() -> Trajectory:
    """Return one second of beer that swings so far that its can can be seen to hesitate."""
    return simulate(sliding(), 1.0, _SWING, integrator=DOP853, times=np.linspace(0, 1, 501))


def _unsteady_distance(motion: Trajectory) -> np.ndarray:
    """Return u - g sin(alpha) t^2/2 [m], how far the can is ahead of one that accelerates evenly."""
    return motion.u - motion.scene.acceleration() * motion.time**2 / 2


def _draw_hesitation(path: pathlib.Path) -> None:
    run = _hesitation()
    scene, times, b = run.scene, run.time, run.scene.load.offset
    # The paper's swing begins at phi = 0, this one at its end: a quarter of a swing later, cos(2 omega t) is -1.
    printed = b * (-(_SWING**2) / 4 - _SWING**2 * np.cos(2 * scene.frequency() * times) / 2)
    subtitle = f"{in_words(scene)}; beer let go at φ₀ = {in_degrees(_SWING)}"
    with chart(
        path, width=9, height=5, title="The can hesitates once in every swing of its beer", subtitle=subtitle
    ) as (axes,):
        truth = exact(scene, times, _SWING)
        axes.plot(times, 1e3 * _unsteady_distance(truth), label="exact theory: b sin φ", **THEORY)
        axes.plot(times, 1e3 * _unsteady_distance(run), label="MuJoCo", **SIMULATED)
        axes.plot(times, 1e3 * printed, label="eq. (25) as printed, but for a constant: twice a swing", **PRINTED)
        axes.axhline(0, **REFERENCE)
        axes.set(xlabel="time t [s]", ylabel="lead of the can, u − ½ g sin α t² [mm]")
        name_below([axes], 3)


def _level_start(degrees: float, periods: float = 3.0) -> Trajectory:
    """Return the swing of beer that starts level, over a number of periods of a small oscillation."""
    scene = sliding(math.radians(degrees))
    return simulate(scene, periods * 2 * math.pi / scene.frequency(), -scene.incline, integrator=DOP853)


def _draw_release(path: pathlib.Path) -> None:
    runs = [_level_start(degrees) for degrees in (5.0, 20.0, 40.0, 70.0)]
    subtitle = f"{in_words(runs[0].scene, {'incline'})}; beer let go with a level surface, φ = −α"
    title = "The steeper the incline, the slower the beer swings for its can"
    with chart(path, width=9, height=5, title=title, subtitle=subtitle) as (axes,):
        small = np.linspace(0, 3, 601)
        axes.plot(small, -np.cos(2 * math.pi * small), label="theory of small swings, eq. (24)", **THEORY)
        for run in runs:
            swings = run.time * run.scene.frequency() / (2 * math.pi)
            axes.plot(swings, run.phi / run.scene.incline, label=f"MuJoCo, α = {in_degrees(run.scene.incline)}")
        axes.set(xlabel="time / period of small swings", ylabel="beer's tilt / incline, φ / α", xlim=(0, 3))
        name_below([axes], 3)


def _looping() -> Trajectory:
    """Return half a second of beer that loops so slowly that its can stays on the incline."""
    return simulate(sliding(), 0.5, 0.0, _LOOPING, integrator=DOP853)


def _least_push(rate: float) -> float:
    """Return the least normal force of a turn that begins at the bottom at a `rate` [rad/s], over the weight."""
    scene = sliding()
    turn = exact(scene, np.linspace(0, 4 * math.pi / _LOOPING, 2001), 0.0, rate)
    return float(turn.forces.normal.min()) / (scene.mass * scene.gravity)


def _draw_looping(path: pathlib.Path) -> None:
    scene = _looping().scene
    c = Letters.of(scene)
    title = "Beer that loops in its can does not turn evenly"
    subtitle = f"{in_words(scene)};  ε of eq. (28), δ = ½ m b² / (½ m b² + I) = {c.spread:.2f}"
    with chart(path, 1, 2, width=11, height=5.2, title=title, subtitle=subtitle) as both:
        for axes, start in zip(both, (_LOOPING, 400.0), strict=True):
            turn, possible = loop(scene, start), _least_push(start) > 0
            phase = np.linspace(0, 2 * math.pi, 201)
            phi = sum(turn.phi[k] * np.sin(k * phase) for k in range(1, 40))
            printed = equations.epsilon_28(c, turn.rate) * np.sin(phase)
            right = equations.corrected_28(c, turn.rate) * np.sin(phase) + equations.ripple_26(c) * np.sin(2 * phase)
            x = np.degrees(phase)
            axes.plot(
                x[::5],
                np.degrees(right[::5]),
                "k.",
                label="(1 − ⅜ δ) ε sin Ωt + ¼ δ sin 2Ωt: right to first order in δ",
            )
            axes.plot(x, np.degrees(printed), label="ε sin Ωt, eqs. (26) and (28)", **PRINTED)
            if possible:
                axes.plot(x, np.degrees(phi), label="MuJoCo, a free can", **SIMULATED)
            else:
                axes.plot(
                    x, np.degrees(phi), label="MuJoCo, a can that is held down: a free one would lift off", **UNPHYSICAL
                )
            axes.set(
                xlabel="even turning, Ωt [°]",
                ylabel="beer ahead of even turning, φ − Ωt [°]",
                title=f"{start:g} rad/s at the bottom, Ω = {turn.rate:.0f} rad/s in the mean",
                xticks=range(0, 361, 90),
            )
        name_below(both, 2)


def _draw_ripples(path: pathlib.Path) -> None:
    scene: Scene = sliding()
    c = Letters.of(scene)
    turns = [loop(scene, start) for start in np.geomspace(_LOOPING, DECADE[-1], 10)]
    rates = np.array([turn.rate for turn in turns])
    line = np.geomspace(rates[0], rates[-1], 50)
    lifts = loop(scene, float(brentq(_least_push, _LOOPING, 2 * _LOOPING, xtol=1e-3))).rate
    title = "Looping beer turns unevenly: a ripple that dies with Ω, and one that stays"
    with chart(path, width=9.5, height=5.6, title=title, subtitle=in_words(scene)) as (axes,):
        axes.axvspan(lifts, 1.1 * rates[-1], color="#EFEFEF", zorder=0)
        axes.plot(line, np.degrees(equations.epsilon_28(c, line)), label="ε, eq. (28)", **PRINTED)
        axes.plot(line, np.degrees(equations.corrected_28(c, line)), label="(1 − ⅜ δ) ε", color=COLOURS[0])
        axes.plot(
            line,
            np.degrees(np.full_like(line, equations.ripple_26(c))),
            label="¼ δ, not in the paper",
            color=COLOURS[2],
        )
        axes.plot(rates, [math.degrees(turn.phi[1]) for turn in turns], "o", label="MuJoCo, at Ω", color=COLOURS[0])
        axes.plot(rates, [math.degrees(turn.phi[2]) for turn in turns], "s", label="MuJoCo, at 2Ω", color=COLOURS[2])
        letters = f"ε = m g b cos α / (Ω² (½ m b² + I))\nδ = ½ m b² / (½ m b² + I) = {c.spread:.2f}"
        note(axes, letters, (110, 12), (0, 0), color="black")
        held = f"from Ω = {lifts:.0f} rad/s on only in a can that is held down:\na free one would lift off the incline"
        note(axes, held, (lifts, 0.17), (8, 0))
        axes.set(
            xscale="log",
            yscale="log",
            xlabel="mean rate Ω [rad/s]",
            ylabel="amplitude of the ripple of φ [°]",
            xlim=(rates[0] / 1.1, 1.1 * rates[-1]),
        )
        ticks(axes.xaxis, (30, 50, 100, 200, 300))
        ticks(axes.yaxis, (0.1, 0.3, 1, 3, 10, 30))
        name_below([axes], 3)
