"""Plots of loads that are frozen to their cans, appendix A of the paper: rocking, rolling down, and hopping."""

import math
import pathlib
from functools import partial
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from scipy.integrate import solve_ivp

from mjbeer.model.setting import DOP853, FRICTION
from mjbeer.output.plots import (
    COLOURS,
    GREY,
    PRINTED,
    REFERENCE,
    SIMULATED,
    THEORY,
    UNPHYSICAL,
    chart,
    label,
    name_below,
    note,
    ticks,
)
from mjbeer.paper import hopping
from mjbeer.paper.hopping import MU, RATIO
from mjbeer.paper.witness import GRIP, fall_from_top
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.exact import exact
from mjbeer.theory.named import frozen, hoop, in_degrees, in_words, pendulum, sliding
from mjbeer.theory.scene import INCLINE, Scene
from mjbeer.theory.trajectory import Trajectory

_MARGIN = 0.02
"""Relative difference of footnote 7's two friction coefficients from tan(alpha)."""
_MU = 1.0
"""Friction coefficient of the incline from which the can lifts off."""
ROCKING = partial(simulate, frozen(), 2.0, 0.0, integrator=DOP853)
LIFT_OFF = partial(simulate, frozen(), 1.0, math.pi, rolling="contact", timestep=2e-4, friction=_MU)
HOP = partial(simulate, hoop(), 0.5, -3.0, 16.0, rolling="contact", timestep=2e-4)
"""The motions of films: a light hoop is pushed with the weight on top, in contact with level ground."""
_HOOP = f"{in_words(hoop(), {'load'})}; M: mass of the hoop, m: mass of the weight"
_JUMP = 3.0
"""Change of an angle [degrees] from one point to the next, beyond which a line breaks off: elsewhere it is below 1."""
_FROM_TOP = "angle of the weight from the top [°]"


def footnote_8_as_printed(scene: Scene, times: np.ndarray, phi0: float) -> np.ndarray:
    """Return phi [rad] of a half-full massless can by footnote 8's equation as printed, from rest at `phi0` [rad]."""
    a, b, g = scene.can.radius, scene.load.offset, scene.gravity

    def slope(_: float, state: np.ndarray) -> list[float]:
        phi, rate = state
        pull = g * (a * math.sin(scene.incline) - b * math.sin(scene.incline + phi))
        turning = (pull - a * b / 2 * math.sin(phi) * rate**2) / (1.5 * a**2 - 2 * a * b * math.cos(phi))
        return [rate, turning]

    return solve_ivp(slope, (0, times[-1]), [phi0, 0.0], t_eval=times, rtol=1e-10, atol=1e-12).y[0]


def draw_rocking(path: pathlib.Path) -> None:
    """Draw how frozen beer rocks, by MuJoCo and by footnote 8, and how far each is from theory."""
    run = ROCKING()
    scene, times = run.scene, run.time
    title = "A can of frozen beer rocks about its equilibrium and stays"
    subtitle = f"{in_words(scene)}; let go at φ = 0"
    with chart(path, 2, 1, width=9, height=7, title=title, subtitle=subtitle) as (angle, error):
        truth = exact(scene, times, run.phi0).phi
        printed = footnote_8_as_printed(scene, times, run.phi0)
        angle.plot(times, np.degrees(truth), label="exact theory, eq. (52)", **THEORY)
        angle.plot(times, np.degrees(run.phi), label="MuJoCo", **SIMULATED)
        angle.plot(times, np.degrees(printed), label="footnote 8 as printed", **PRINTED)
        angle.axhline(math.degrees(scene.equilibrium()), label="equilibrium, eq. (53)", **REFERENCE)
        error.plot(times, np.degrees(run.phi - truth), **SIMULATED)
        error.plot(times, np.degrees(printed - truth), **PRINTED)
        label(angle, "", "φ, beer's surface to the incline [°]", "The swing")
        label(error, "time t [s]", "φ less that of theory [°]", "How far each is from exact theory")
        name_below([angle], 4)


def draw_roll_down(path: pathlib.Path) -> None:
    """Draw the roll-down of frozen beer: how far it turns, what rolling needs, and how high the can hops."""
    contact = LIFT_OFF()
    scene, times = contact.scene, np.linspace(0, 1, 1001)
    run = simulate(scene, times[-1], math.pi, integrator=DOP853, times=times)
    parts = exact(scene, times, math.pi).rolls_until()
    rolls, pulled = times <= parts, times >= parts
    title = "Frozen beer let go on top: it rolls down in jerks, until its can leaves the incline"
    subtitle = f"{in_words(scene)}; let go at φ = 180°"
    with chart(path, 4, 1, width=9, height=11, title=title, subtitle=subtitle) as panels:
        angle, normal, friction, lift = panels
        even = scene.acceleration() / scene.can.radius * times**2 / 2
        angle.plot(times, np.degrees(even), "--", label="solid cylinder: g sin α t² / 3a", color=GREY, linewidth=1.2)
        printed = footnote_8_as_printed(scene, times, math.pi) - math.pi
        angle.plot(times[rolls], np.degrees(printed[rolls]), label="footnote 8 as printed", **PRINTED)
        needed = np.where((run.forces.needed < 2) & (run.forces.normal > 0), run.forces.needed, np.nan)
        push = run.forces.normal / (scene.mass * scene.gravity)
        for axes, values in ((angle, np.degrees(run.phi - math.pi)), (normal, push), (friction, needed)):
            axes.plot(times[rolls], values[rolls], label="MuJoCo, can that rolls", **SIMULATED)
            axes.plot(times[pulled], values[pulled], label="the same, if the incline could pull the can", **UNPHYSICAL)
        name = f"MuJoCo, can on an incline with μ = {_MU:g}: slips and hops"
        hops: dict[str, Any] = {"color": COLOURS[2], "label": name}
        angle.plot(contact.time, np.degrees(contact.phi - math.pi), **hops)
        lift.plot(contact.time, 1e3 * contact.lift, **hops)
        normal.axhline(0, **REFERENCE)
        friction.axhline(_MU, **REFERENCE)
        note(friction, f"μ = {_MU:g}", (0, _MU), (0, 7))
        label(angle, "", "φ − 180° [°]", "How far the can has turned")
        label(normal, "", "normal force / weight", "What rolling needs: the incline's push, or pull below 0")
        label(friction, "", "friction |F| / N", "What rolling needs: friction", ylim=(0, 2))
        label(lift, "time t [s]", "height [mm]", "How high a can that is free to leave it is above the incline")
        for axes in panels:
            axes.set_xlim(0, times[-1])
            axes.axvline(parts, **REFERENCE)
        note(lift, f"N = 0 at {parts:.3f} s", (parts, 1e3 * contact.lift.max() * 0.8), (-6, 0), ha="right")
        name_below(panels, 2)


def contact_at_equilibrium(part: float) -> Trajectory:
    """Return one second in contact from the equilibrium, at a friction coefficient of `part` times tan(alpha)."""
    scene = frozen()
    return simulate(scene, 1.0, scene.equilibrium(), rolling="contact", friction=part * math.tan(scene.incline))


def draw_friction(path: pathlib.Path) -> None:
    """Draw how far a can slides at its equilibrium, with friction coefficients about tan(alpha)."""
    runs = {part: contact_at_equilibrium(part) for part in (1 + _MARGIN, 1 - _MARGIN, 0.7)}
    scene = runs[0.7].scene
    title = "At rest on its equilibrium, the can stays if μ > tan α, and slides off if not"
    subtitle = f"{in_words(scene)}, tan α = {math.tan(scene.incline):.3f}"
    with chart(path, 1, 2, width=11, height=4.8, title=title, subtitle=subtitle) as panels:
        for axes, parts in zip(panels, ((1 + _MARGIN, 1 - _MARGIN), (1 + _MARGIN, 0.7)), strict=True):
            for part in parts:
                run, colour = runs[part], COLOURS[list(runs).index(part)]
                axes.plot(run.time, 1e3 * np.abs(run.u - run.u[0]), color=colour, label=f"MuJoCo, μ = {part:g} tan α")
            about = f"{100 * (1 - min(parts)):.0f} % less friction than it takes"
            label(axes, "time t [s]", "distance slid [mm]", about)
        name_below(panels, 3)


def draw_period(path: pathlib.Path) -> None:
    """Draw periods over amplitudes, and between which angles frozen beer swings."""
    scenes = {"beer sliding": sliding(), "pendulum in a wheel": pendulum(), "beer frozen": frozen()}
    title = "The wider a swing, the slower, and how wide it can be"
    subtitle = f"half-full massless can with sliding and with frozen beer, {in_words(pendulum())}"
    with chart(path, 1, 2, width=12, height=5.2, title=title, subtitle=subtitle) as (period, swing):
        for name, scene in scenes.items():
            rest, (_, high) = scene.equilibrium(), scene.separatrix()
            amplitudes = (high - rest) * (1 - np.geomspace(0.999, 1e-4, 100))
            small = 2 * math.pi / scene.frequency()
            theory = [scene.period(amplitude) / small for amplitude in amplitudes]
            (line,) = period.plot(np.degrees(amplitudes), theory, label=name)
            few = (high - rest) * np.array([0.2, 0.4, 0.6, 0.8, 0.9])
            measured = [simulate(scene, 8, rest + amplitude, integrator=DOP853).frequency() for amplitude in few]
            period.plot(np.degrees(few), 2 * math.pi / np.array(measured) / small, "o", color=line.get_color())
            period.axvline(math.degrees(high - rest), color=line.get_color(), linewidth=1, linestyle=":")
        period.plot([], [], "o", color=GREY, label="MuJoCo (lines: exact theory)")
        period.plot([], [], ":", color=GREY, linewidth=1, label="widest swing: its period is infinite")
        xlabel, ylabel = "amplitude, downhill from the equilibrium [°]", "period / period of small swings"
        label(period, xlabel, ylabel, f"Periods on an incline of {in_degrees(INCLINE)}", ylim=(0.9, 2.6), xlim=(0, 185))
        _draw_range(swing)
        name_below([period, swing], 3)


def _draw_range(axes: Axes) -> None:
    """Draw between which angles a frozen load swings, over the incline."""
    # At both ends of the inclines the limits are steep, so that the points are denser there.
    inclines = frozen().largest_incline() * (1 - np.cos(np.linspace(0.02, math.pi - 0.005, 100))) / 2
    cans, x = [frozen(incline) for incline in inclines], np.degrees(inclines)
    low, high = np.degrees([can.separatrix() for can in cans]).T
    axes.fill_between(x, low, high, color=COLOURS[5], alpha=0.25, linewidth=0)
    axes.plot(x, high, color=COLOURS[5])
    axes.plot(x, low, color=COLOURS[5])
    axes.plot(x, np.degrees([can.equilibrium() for can in cans]), "k--", label="equilibrium of frozen beer, eq. (53)")
    note(axes, "let go here, it swings", (4, 70), (0, 0), color="black")
    for place in ((20.5, 150), (20.5, -120)):
        note(axes, "let go here,\nit rolls off", place, (0, 0), color="black")
    about, ylabel = "Frozen beer: where it swings, and where it does not", "φ, beer's surface to the incline [°]"
    label(axes, "incline α [°]", ylabel, about, ylim=(-190, 190), yticks=range(-180, 181, 60))


def _draw_hop(axes: Axes, friction: float, slips: bool) -> None:
    """Draw the height of a pushed hoop, how far it has slid if asked for, and what theory foresees."""
    run = HOP(friction=friction)
    rolling = exact(run.scene, np.linspace(0, 0.06, 6001), run.phi0, run.phi_dot0)
    if slips:
        axes.plot(run.time, 1e3 * run.slip, color=COLOURS[2], label="slip: distance less the arc turned, MuJoCo")
    axes.plot(run.time, 1e3 * run.lift, color="black", label="height above the ground, MuJoCo")
    skids, parts = rolling.rolls_until(friction), rolling.rolls_until()
    style: dict[str, Any] = {"color": GREY, "linewidth": 1.2}
    axes.axvline(skids, label="theory: it skids from here on", linestyle="--", **style)
    axes.axvline(parts, label="theory: here N = 0 if it still rolled", linestyle=":", **style)
    about = f"Pushed: φ = {in_degrees(run.phi0)}, {run.phi_dot0:g} rad/s, M/m = 1/20, μ = {friction:g}"
    label(axes, "time t [s]", "distance [mm]" if slips else "height [mm]", about)


def draw_normal(path: pathlib.Path) -> None:
    """Draw the normal force that rolling hoops need, and a hoop that hops."""
    angles = np.linspace(1, 179, 400)
    ratios = ((1e-3, "1/1000"), (RATIO, "1/20"), (1 / 13, "1/13"), (0.2, "1/5"))
    title = "Why a hoop hops: the ground would have to pull"
    with chart(path, 1, 2, width=12, height=5.4, title=title, subtitle=_HOOP) as (push, hops):
        for (ratio, name), colour in zip(ratios, COLOURS, strict=False):
            values = np.array([hopping.normal(ratio, math.pi - math.radians(angle)) for angle in angles])
            negative = np.flatnonzero(values < 0)
            end = negative[0] if len(negative) else len(angles)
            push.plot(angles[:end], values[:end], color=colour, label=f"M/m = {name}")
            push.plot(angles[end:], values[end:], ":", color=colour)
        push.plot([], [], label="after it would have hopped", **UNPHYSICAL)
        push.axhline(0, **REFERENCE)
        push.axvline(90, **REFERENCE)
        note(push, "weight level\nwith the axis", (90, 2.6), (-6, 0), ha="right")
        ylabel, spread = "normal force / weight on the rim, N / m g", range(0, 181, 30)
        label(push, _FROM_TOP, ylabel, "Rolling from rest, theory", ylim=(-1.5, 4), xticks=spread)
        _draw_hop(hops, FRICTION, slips=False)
        name_below([push, hops], 3)


def skids(ratios: np.ndarray, mu: float) -> tuple[np.ndarray, np.ndarray]:
    """Return ratios M/m and the angles from the top at which a hoop skids [degrees], with a gap (NaN) at a jump."""
    angles = np.degrees([hopping.slip(float(ratio), mu) for ratio in ratios])
    jumps = np.flatnonzero(np.abs(np.diff(angles)) > _JUMP)
    for place in jumps[::-1]:
        low, high = ratios[place], ratios[place + 1]
        while high - low > 1e-3 * low:
            middle = (low + high) / 2
            before = abs(math.degrees(hopping.slip(float(middle), mu)) - angles[place]) < _JUMP
            low, high = (middle, high) if before else (low, middle)
        ends = np.degrees([hopping.slip(float(low), mu), math.nan, hopping.slip(float(high), mu)])
        ratios, angles = np.insert(ratios, place + 1, [low, low, high]), np.insert(angles, place + 1, ends)
    return ratios, angles


def draw_lift_off(path: pathlib.Path) -> None:
    """Draw where a hoop lifts off and where it skids over its mass, and one that skids and hops."""
    # The angle of lift-off rises like a square root just below 1/13, so that the points are denser there.
    ratios = np.unique(np.append(np.geomspace(1e-3, 0.07, 60), 1 / 13 * (1 - np.geomspace(0.1, 1e-6, 20))))
    few = np.array([2e-3, 8e-3, 0.03, 0.06])
    found = [fall_from_top(hoop(hoop_mass=0.2 * float(ratio)), 5e-5, GRIP).takeoff() for ratio in few]
    measured = [math.nan if angle is None else math.degrees(angle) for angle in found]
    lifts = [math.degrees(hopping.lift_off(float(ratio))) for ratio in ratios]
    with chart(path, 1, 2, width=12, height=5.6, title="Before a hoop lifts off, it skids", subtitle=_HOOP) as panels:
        where, hops = panels
        where.plot(ratios, lifts, color=COLOURS[0], label="lifts off, theory")
        where.plot(few, measured, "o", color=COLOURS[0], label="lifts off, MuJoCo, μ = 1 000 000")
        for mu, colour in ((0.5, COLOURS[4]), (MU, COLOURS[1]), (2.0, COLOURS[3])):
            where.plot(*skids(ratios, mu), "--", color=colour, label=f"skids, theory, μ = {mu:g}")
        where.axhline(90, **REFERENCE)
        where.axvline(1 / 13, **REFERENCE)
        note(where, "Littlewood: 90°", (0.01, 90), (4, -8))
        note(where, "M/m = 1/13", (1 / 13, 75), (-4, 0), ha="right")
        where.set_xscale("log")
        label(where, "mass of the hoop / weight on its rim, M / m", _FROM_TOP, "Rolling from rest")
        ticks(where.xaxis, (0.001, 0.002, 0.005, 0.01, 0.02, 0.05))
        _draw_hop(hops, MU, slips=True)
        name_below(panels, 3)
