"""Plots of loads that slide in their cans: sections 2 and 3 of the paper, and appendix B."""

import math
from collections.abc import Sequence
from functools import partial

import numpy as np
from matplotlib.axes import Axes

from mjbeer.drawing.words import in_degrees
from mjbeer.model.setting import DOP853
from mjbeer.output.plots import COLOURS, GREY, PRINTED, REFERENCE, SIMULATED, THEORY, label, name_below, note, ticks
from mjbeer.paper import oscillation
from mjbeer.paper.claim import SceneConstants
from mjbeer.paper.oscillation import SLOW
from mjbeer.paper.pendulum import heavy_bob, light_bob
from mjbeer.paper.witness import loop
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.exact import exact
from mjbeer.theory.scene import Scene
from mjbeer.theory.scenes import frozen, pendulum, sliding
from mjbeer.theory.trajectory import Trajectory, mean_acceleration

SWING = math.radians(60)
"""Amplitude [rad] of the swing that shows the hesitation: wide enough for the can to be seen to slow down."""
HESITATION = partial(simulate, sliding(), 0.8, SWING, integrator=DOP853, times=np.linspace(0, 0.8, 401))
LOOPING = partial(simulate, sliding(), 0.5, 0.0, SLOW, integrator=DOP853)
"""The motions of films: beer loops so slowly here that its can stays on the incline."""
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


def draw_trivial(panels: Sequence[Axes]) -> None:
    """Draw φ, u and s of beer that is let go along the incline, and at 60 degrees to it."""
    runs = {degrees: let_go(degrees) for degrees in (0.0, 60.0)}
    scene, times = runs[0.0].scene, runs[0.0].time
    angle, axis, centre = panels
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


def draw_hesitation(panels: Sequence[Axes]) -> None:
    """Draw how far a can is ahead of one that accelerates evenly, and eq. (25) as printed."""
    run = HESITATION()
    scene, times, b = run.scene, run.time, run.scene.load.offset
    even = scene.acceleration() * times**2 / 2
    # The paper's swing begins at phi = 0, this one at its end: a quarter of a swing later, cos(2 omega t) is -1.
    printed = b * (-(SWING**2) / 4 - SWING**2 * np.cos(2 * scene.frequency() * times) / 2)
    (axes,) = panels
    axes.plot(times, 1e3 * (exact(scene, times, SWING).u - even), label="exact theory: b sin φ", **THEORY)
    axes.plot(times, 1e3 * (run.u - even), label="MuJoCo", **SIMULATED)
    axes.plot(times, 1e3 * printed, label="eq. (25) as printed, but for a constant: twice a swing", **PRINTED)
    axes.axhline(0, **REFERENCE)
    label(axes, "time t [s]", "lead of the can, u − ½ g sin α t² [mm]")
    name_below([axes], 3)


def draw_looping(panels: Sequence[Axes]) -> None:
    """Draw how unevenly beer loops, slowly and fast, beside eqs. (26) and (28)."""
    scene = sliding()
    c = SceneConstants.of(scene)
    phase = np.linspace(0, 2 * math.pi, 201)
    x = np.degrees(phase)
    both = panels
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


def draw_accelerations(panels: Sequence[Axes]) -> None:
    """Draw the acceleration of cans whose beer does not swing over their fill."""
    # Near 0 and near 1 the curves are steep, so that the points are denser there.
    fills = (1 - np.cos(np.linspace(0.02, math.pi, 121))) / 2
    few = (0.001, 0.05, *np.arange(0.1, 0.95, 0.1))
    full = sliding().gravity * math.sin(sliding().incline)
    (axes,) = panels
    levels = ((1.0, "mass that slides", 7), (2 / 3, "solid cylinder: 2/3", -8), (0.5, "hoop: 1/2", 7))
    for level, name, offset in levels:
        axes.axhline(level, **REFERENCE)
        note(axes, name, (1.0, level), (0, offset), ha="right")
    for name, can in _CANS.items():
        theory = [scene.acceleration() / full for scene in (sliding(fill=float(fill), can=can) for fill in fills)]
        (line,) = axes.plot(fills, theory, label=f"sliding, {name}")
        runs = [
            simulate(scene, 0.5, scene.equilibrium(), integrator=DOP853)
            for scene in (sliding(fill=float(fill), can=can) for fill in few)
        ]
        axes.plot(few, [mean_acceleration(run) / full for run in runs], "o", color=line.get_color())
    ice = [frozen(fill=float(fill)).acceleration() / full for fill in fills]
    axes.plot([], [], "o", color=GREY, label="MuJoCo (lines: exact theory)")
    axes.plot(fills, ice, "--", label="frozen, massless can, as if it were balanced")
    label(axes, "fill: height of the beer / can's diameter", "acceleration / g sin α", ylim=(0.45, 1.08))
    name_below([axes], 2)


def draw_pendulum(panels: Sequence[Axes]) -> None:
    """Draw a wide swing of the pendulum, and the frequency of small ones over the mass of its bob."""
    run = simulate(pendulum(), 1.5, 1.0, integrator=DOP853)
    scene, ratio = run.scene, run.scene.load.mass / run.scene.can.mass
    swing, rate = panels
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
