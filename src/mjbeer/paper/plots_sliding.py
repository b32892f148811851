"""Plots of loads that slide in their cans: sections 2 and 3 of the paper, and appendix B."""

import math
import pathlib
from collections.abc import Sequence
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from scipy.optimize import brentq

from mjbeer.model.setting import DOP853
from mjbeer.output.plots import (
    COLOURS,
    GREY,
    PRINTED,
    REFERENCE,
    SIMULATED,
    THEORY,
    chart,
    label,
    name_below,
    note,
    ticks,
)
from mjbeer.paper import oscillation, segment
from mjbeer.paper.claim import SceneConstants
from mjbeer.paper.oscillation import SLOW
from mjbeer.paper.pendulum import heavy_bob, light_bob
from mjbeer.paper.witness import DECADE, loop
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.exact import exact
from mjbeer.theory.named import frozen, in_degrees, in_words, pendulum, sliding
from mjbeer.theory.scene import INCLINE, Scene
from mjbeer.theory.trajectory import Trajectory, mean_acceleration

_SWING = math.radians(60)
"""Amplitude [rad] of the swing that shows the hesitation: wide enough for the can to be seen to slow down."""
HESITATION = partial(simulate, sliding(), 0.8, _SWING, integrator=DOP853, times=np.linspace(0, 0.8, 401))
LOOPING = partial(simulate, sliding(), 0.5, 0.0, SLOW, integrator=DOP853)
"""The motions of films: beer loops so slowly here that its can stays on the incline."""
_FILL = "fill: height of the beer / can's diameter"
_METAL, _HOOP = Can.sheet_metal(), Can.hoop(mass=0.05)
_CANS = {
    "massless can": Can.massless(),
    f"aluminium can of {1e3 * _METAL.mass:.2g} g": _METAL,
    f"hoop of {1e3 * _HOOP.mass:g} g": _HOOP,
}
"""Cans that the plots compare, by the name in their legends."""


def let_go(degrees: float, duration: float = 1.0) -> Trajectory:
    """Return the motion of beer let go at an angle to the incline, for a `duration` [s]."""
    return simulate(sliding(), duration, math.radians(degrees), integrator=DOP853, timestep=1e-3)


def draw_trivial(path: pathlib.Path) -> None:
    """Draw φ, u and s of beer that is let go along the incline, and at 60 degrees to it."""
    runs = {degrees: let_go(degrees) for degrees in (0.0, 60.0)}
    scene, times = runs[0.0].scene, runs[0.0].time
    title = "However the beer swings, its centre of mass accelerates down the incline evenly"
    with chart(path, 1, 3, width=12, height=4.6, title=title, subtitle=in_words(scene)) as (angle, axis, centre):
        for panel in (axis, centre):
            panel.plot(times, scene.acceleration() * times**2 / 2, label="exact theory: ½ g sin α t²", **THEORY)
        for (degrees, run), line, colour in zip(runs.items(), ("-", "--"), COLOURS[::2], strict=False):
            name = f"MuJoCo, beer let go at φ = {degrees:g}°"
            angle.plot(run.time, np.degrees(run.phi), line, color=colour, label=name)
            axis.plot(run.time, run.u - run.u[0], line, color=colour)
            centre.plot(run.time, run.u - scene.load.offset * np.sin(run.phi), line, color=colour)
        label(angle, "time t [s]", "φ, beer's surface to the incline [°]", "The beer's tilt")
        label(axis, "time t [s]", "u, distance down the incline [m]", "The can's axis")
        label(centre, "time t [s]", "s, distance down the incline [m]", "The beer's centre of mass")
        name_below((angle, axis), 3)


def draw_hesitation(path: pathlib.Path) -> None:
    """Draw how far a can is ahead of one that accelerates evenly, and eq. (25) as printed."""
    run = HESITATION()
    scene, times, b = run.scene, run.time, run.scene.load.offset
    even = scene.acceleration() * times**2 / 2
    # The paper's swing begins at phi = 0, this one at its end: a quarter of a swing later, cos(2 omega t) is -1.
    printed = b * (-(_SWING**2) / 4 - _SWING**2 * np.cos(2 * scene.frequency() * times) / 2)
    title, start = "The can hesitates once in every swing of its beer", f"beer let go at φ₀ = {in_degrees(_SWING)}"
    with chart(path, width=7.5, height=5, title=title, subtitle=f"{in_words(scene)}; {start}") as (axes,):
        axes.plot(times, 1e3 * (exact(scene, times, _SWING).u - even), label="exact theory: b sin φ", **THEORY)
        axes.plot(times, 1e3 * (run.u - even), label="MuJoCo", **SIMULATED)
        axes.plot(times, 1e3 * printed, label="eq. (25) as printed, but for a constant: twice a swing", **PRINTED)
        axes.axhline(0, **REFERENCE)
        label(axes, "time t [s]", "lead of the can, u − ½ g sin α t² [mm]")
        name_below([axes], 3)


def level_start(degrees: float, periods: float = 3.0) -> Trajectory:
    """Return the swing of beer that starts level, over a number of periods of a small oscillation."""
    scene = sliding(math.radians(degrees))
    return simulate(scene, periods * 2 * math.pi / scene.frequency(), -scene.incline, integrator=DOP853)


def draw_release(path: pathlib.Path) -> None:
    """Draw the swings of beer that is let go level, on four inclines."""
    runs = [level_start(degrees) for degrees in (5.0, 20.0, 40.0, 70.0)]
    subtitle = f"{in_words(runs[0].scene, {'incline'})}; beer let go with a level surface, φ = −α"
    title = "The steeper the incline, the slower the beer swings for its can"
    with chart(path, width=7.5, height=5, title=title, subtitle=subtitle) as (axes,):
        small = np.linspace(0, 3, 601)
        axes.plot(small, -np.cos(2 * math.pi * small), label="theory of small swings, eq. (24)", **THEORY)
        for run in runs:
            swings = run.time * run.scene.frequency() / (2 * math.pi)
            axes.plot(swings, run.phi / run.scene.incline, label=f"MuJoCo, α = {in_degrees(run.scene.incline)}")
        label(axes, "time / period of small swings", "beer's tilt / incline, φ / α", xlim=(0, 3))
        name_below([axes], 3)


def least_push(rate: float) -> float:
    """Return the least normal force of a turn that begins at the bottom at a `rate` [rad/s], over the weight."""
    scene = sliding()
    turn = exact(scene, np.linspace(0, 4 * math.pi / SLOW, 2001), 0.0, rate)
    return float(turn.forces.normal.min()) / (scene.mass * scene.gravity)


def draw_looping(path: pathlib.Path) -> None:
    """Draw how unevenly beer loops, slowly and fast, beside eqs. (26) and (28)."""
    scene = sliding()
    c = SceneConstants.of(scene)
    phase = np.linspace(0, 2 * math.pi, 201)
    x = np.degrees(phase)
    title = "Beer that loops in its can does not turn evenly"
    with chart(path, 1, 2, width=11, height=5.2, title=title, subtitle=in_words(scene)) as both:
        for axes, start, about in zip(both, (SLOW, 400.0), ("Slowly", "Fast, in a can held down"), strict=True):
            turn = loop(scene, start)
            phi = sum(turn.phi[k] * np.sin(k * phase) for k in range(1, 40))
            once = oscillation.corrected_28(c, turn.rate) * np.sin(phase)
            corrected = np.degrees(once + c.spread / 4 * np.sin(2 * phase))
            printed = np.degrees(oscillation.epsilon_28(c, turn.rate) * np.sin(phase))
            axes.plot(x, printed, label="one ripple in a turn: eqs. (26) and (28) as printed", **PRINTED)
            axes.plot(x[::5], corrected[::5], "k.", label="with a second ripple, twice in a turn: corrected")
            axes.plot(x, np.degrees(phi), label="MuJoCo", **SIMULATED)
            ylabel = "beer ahead of even turning, φ − Ωt [°]"
            rate = f"{about}: Ω = {turn.rate:.0f} rad/s in the mean"
            label(axes, "even turning, Ωt [°]", ylabel, rate, xticks=range(0, 361, 90))
        name_below(both, 3)


def draw_ripples(path: pathlib.Path) -> None:
    """Draw both ripples of looping beer over the mean rate."""
    scene = sliding()
    c = SceneConstants.of(scene)
    turns = [loop(scene, start) for start in np.geomspace(SLOW, DECADE[-1], 10)]
    rates = np.array([turn.rate for turn in turns])
    line = np.geomspace(rates[0], rates[-1], 50)
    lifts = loop(scene, float(brentq(least_push, SLOW, 2 * SLOW, xtol=1e-3))).rate
    title = "One ripple of looping beer dies out with its rate, and one stays"
    with chart(path, width=7.5, height=5.6, title=title, subtitle=in_words(scene)) as (axes,):
        axes.axvspan(lifts, 1.1 * rates[-1], color="#EFEFEF", zorder=0)
        axes.plot(
            line, np.degrees(oscillation.epsilon_28(c, line)), label="once in a turn: eq. (28), printed", **PRINTED
        )
        corrected = np.degrees(oscillation.corrected_28(c, line))
        axes.plot(line, corrected, label="once in a turn: corrected", color=COLOURS[0])
        stays = np.full_like(line, math.degrees(c.spread / 4))
        axes.plot(line, stays, label="twice in a turn: not in the paper", color=COLOURS[2])
        for harmonic, name, marker, colour in ((1, "once", "o", COLOURS[0]), (2, "twice", "s", COLOURS[2])):
            amplitudes = [math.degrees(turn.phi[harmonic]) for turn in turns]
            axes.plot(rates, amplitudes, marker, label=f"MuJoCo, {name} in a turn", color=colour)
        held = f"from {lifts:.0f} rad/s on only in a can that is held down:\na free one would lift off the incline"
        note(axes, held, (lifts, 0.17), (8, 0))
        axes.set(xscale="log", yscale="log")
        limits = (rates[0] / 1.1, 1.1 * rates[-1])
        label(axes, "mean rate Ω of the beer [rad/s]", "amplitude of the ripple of φ [°]", xlim=limits)
        ticks(axes.xaxis, (30, 50, 100, 200, 300))
        ticks(axes.yaxis, (0.1, 0.3, 1, 3, 10, 30))
        name_below([axes], 2)


def _beer(fills: Sequence[float] | np.ndarray, can: Can) -> list[Scene]:
    return [sliding(fill=float(fill), can=can) for fill in fills]


def draw_accelerations(path: pathlib.Path) -> None:
    """Draw the acceleration of cans whose beer does not swing over their fill."""
    # Near 0 and near 1 the curves are steep, so that the points are denser there.
    fills = (1 - np.cos(np.linspace(0.02, math.pi, 121))) / 2
    few = (0.001, 0.05, *np.arange(0.1, 0.95, 0.1))
    full = sliding().gravity * math.sin(sliding().incline)
    title = "The fuller the can, the faster it runs down, unless its beer is frozen"
    subtitle = "beer that does not swing; the same on every incline"
    with chart(path, width=7.5, height=5.4, title=title, subtitle=subtitle) as (axes,):
        levels = ((1.0, "mass that slides", 7), (2 / 3, "solid cylinder: 2/3", -8), (0.5, "hoop: 1/2", 7))
        for level, name, offset in levels:
            axes.axhline(level, **REFERENCE)
            note(axes, name, (1.0, level), (0, offset), ha="right")
        for name, can in _CANS.items():
            theory = [scene.acceleration() / full for scene in _beer(fills, can)]
            (line,) = axes.plot(fills, theory, label=f"sliding, {name}")
            runs = [simulate(scene, 0.5, scene.equilibrium(), integrator=DOP853) for scene in _beer(few, can)]
            axes.plot(few, [mean_acceleration(run) / full for run in runs], "o", color=line.get_color())
        ice = [frozen(fill=float(fill)).acceleration() / full for fill in fills]
        axes.plot([], [], "o", color=GREY, label="MuJoCo (lines: exact theory)")
        axes.plot(fills, ice, "--", label="frozen, massless can, as if it were balanced")
        label(axes, _FILL, "acceleration / g sin α", ylim=(0.45, 1.08))
        name_below([axes], 2)


def draw_inertia(path: pathlib.Path) -> None:
    """Draw the figures of eqs. (36) and (37)."""
    half_angles = np.linspace(0.02, math.pi, 181)
    degrees, axial = np.degrees(half_angles), segment.eq_36(half_angles)
    least = int(axial.argmin())
    title, subtitle = "Moments of inertia of the beer", "beer of mass m in a can of radius a"
    with chart(path, width=7.5, height=5.6, title=title, subtitle=subtitle) as (axes,):
        axes.plot(degrees, axial, label="about the can's axis, eq. (36)")
        printed = segment.middle_36(half_angles, 8)
        axes.plot(degrees, printed, label="the same, third line of (36) as printed, …/8", **PRINTED)
        axes.plot(degrees, segment.eq_37(half_angles), label="about its own centre of mass, eq. (37)", color=COLOURS[2])
        for angle, value, text, offset in (
            (90, 0.5, "half full: 1/2", (6, 10)),
            (90, segment.eq_37(math.pi / 2), "half full: 0.32", (10, -8)),
            (degrees[least], axial[least], f"least: {axial[least]:.3f}", (16, 19)),
        ):
            axes.plot(angle, value, "k.")
            note(axes, text, (angle, value), offset, color="black")
        xlabel = "β, half the angle under which the beer is seen from the axis [°]"
        label(axes, xlabel, "moment of inertia / m a²", xticks=range(0, 181, 30), ylim=(0, 1.05))
        above = axes.secondary_xaxis("top")
        above.set_xticks([0, 60, 90, 120, 180], ["0", "¼", "½", "¾", "1"])
        above.set_xlabel(_FILL)
        name_below([axes], 2)


_FILLS = (1 - np.cos(np.linspace(0.03, 0.98 * math.pi, 181))) / 2
"""Fills of curves that are steep near 0 and near 1, where they are denser."""


def draw_tilt(path: pathlib.Path) -> None:
    """Draw the tilt of beer at rest in its can, and the frequency of its small swings, over the fill."""
    title, subtitle = (
        "What the mass of a can does to beer that slides in it",
        f"beer sliding on an incline of {in_degrees(INCLINE)}",
    )
    with chart(path, 1, 2, width=11, height=5, title=title, subtitle=subtitle) as (angle, rate):
        for name, can in _CANS.items():
            scenes = _beer(_FILLS, can)
            angle.plot(_FILLS, [math.degrees(scene.equilibrium()) for scene in scenes], label=name)
            rate.plot(_FILLS, [scene.frequency() for scene in scenes])
        note(angle, "level", (1, -math.degrees(INCLINE)), (0, 8), ha="right")
        note(angle, "parallel to the incline", (1, 0), (0, 8), ha="right")
        angle.axhline(-math.degrees(INCLINE), **REFERENCE)
        tilt = "φ, beer's surface to the incline [°]"
        label(angle, _FILL, tilt, "Tilt of beer that does not swing", ylim=(-10.8, 0.9))
        label(rate, _FILL, "ω [rad/s]", "Frequency of its small swings", ylim=(0, 80))
        name_below([angle], 3)


def draw_steepest(path: pathlib.Path) -> None:
    """Draw the steepest incline on which a can with frozen beer stays, over the fill."""
    title, subtitle = "A can with mass and frozen beer stays only on gentler slopes", "beer frozen, at its equilibrium"
    with chart(path, width=7.5, height=5, title=title, subtitle=subtitle) as (axes,):
        for name, can in _CANS.items():
            scenes = [frozen(fill=float(fill), can=can) for fill in _FILLS]
            axes.plot(_FILLS, [math.degrees(scene.largest_incline()) for scene in scenes], label=name)
        label(axes, _FILL, "steepest incline on which it stays, α [°]", ylim=(0, 90))
        name_below([axes], 3)


def draw_pendulum(path: pathlib.Path) -> None:
    """Draw a wide swing of the pendulum, and the frequency of small ones over the mass of its bob."""
    run = simulate(pendulum(), 1.5, 1.0, integrator=DOP853)
    scene, ratio = run.scene, run.scene.load.mass / run.scene.can.mass
    title = "A wheel with a pendulum: a wide swing, and how the bob's mass changes small ones"
    with chart(path, 1, 2, width=12, height=5.4, title=title, subtitle=in_words(scene, {"load"})) as (swing, rate):
        truth = exact(scene, run.time, run.phi0)
        swing.plot(run.time, np.degrees(truth.phi), label="exact theory", **THEORY)
        swing.plot(run.time, np.degrees(run.phi), label="MuJoCo", **SIMULATED)
        about = f"Let go at φ = {in_degrees(run.phi0)}, bob of {ratio:g} wheel masses"
        label(swing, "time t [s]", "φ, pendulum to the incline's normal [°]", about)
        _draw_frequencies(rate, scene)
        name_below([swing, rate], 3)


def _small_swing_frequency(scene: Scene) -> float:
    """Return omega [rad/s], measured over some six swings of 0.001 rad."""
    omega, start = scene.frequency(), scene.equilibrium() + 1e-3
    return simulate(scene, 40 / omega, start, integrator=DOP853, timestep=0.02 / omega).frequency()


def _draw_frequencies(axes: Axes, scene: Scene) -> None:
    """Draw the frequency of small swings over the mass of the bob in masses of the wheel, and its two limits."""
    ratios, wheel = np.geomspace(1e-3, 1e3, 61), scene.can.mass
    scenes = [pendulum(scene.incline, wheel, wheel * float(ratio), scene.load.offset) for ratio in ratios]
    light, heavy = light_bob(scene), np.array([heavy_bob(each) for each in scenes])
    high = heavy > light / 2
    axes.plot(ratios, [each.frequency() for each in scenes], **THEORY)
    measured = [_small_swing_frequency(each) for each in scenes[::6]]
    axes.plot(ratios[::6], measured, "o", label="MuJoCo, swings of 0.06°", **SIMULATED)
    axes.axhline(light, color="black", linewidth=1, linestyle="--", label="light bob: ω² = g √(cos² α + ¼ sin² α) / b")
    axes.plot(ratios[high], heavy[high], ":", color="black", label="heavy bob: ω² = ½ (m/M) g cos α / b")
    axes.set(xscale="log", yscale="log")
    label(axes, "mass of the bob / mass of the wheel, m / M", "ω of small swings [rad/s]", "Small swings")
    ticks(axes.xaxis, (0.001, 0.01, 0.1, 1, 10, 100, 1000))
    ticks(axes.yaxis, (10, 20, 50, 100, 200, 400))
