"""Plots of loads that are frozen to their cans, appendix A of the paper: rocking, rolling down, and hopping."""

import math
from collections.abc import Sequence
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from scipy.integrate import solve_ivp

from mjbeer.drawing.words import in_degrees
from mjbeer.model.setting import DOP853
from mjbeer.output.plots import (
    COLOURS,
    GREY,
    PRINTED,
    REFERENCE,
    SIMULATED,
    THEORY,
    UNPHYSICAL,
    label,
    name_below,
    note,
    ticks,
)
from mjbeer.paper import hopping
from mjbeer.paper.hopping import MU
from mjbeer.paper.witness import GRIP, fall_from_top
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.exact import exact
from mjbeer.theory.scene import INCLINE, Scene
from mjbeer.theory.scenes import frozen, hoop, pendulum, sliding
from mjbeer.theory.trajectory import Trajectory

FRICTION = 1.0
"""Friction coefficient of the incline from which the can lifts off."""
ROCKING = partial(simulate, frozen(), 2.0, 0.0, integrator=DOP853)
LIFT_OFF = partial(simulate, frozen(), 1.0, math.pi, rolling="contact", timestep=2e-4, friction=FRICTION)
PARTING = partial(LIFT_OFF, times=np.linspace(0.68, 1.0, 1601))
"""The motions of films."""
_JUMP = 3.0
"""Change of an angle [degrees] from one point to the next, beyond which a line breaks off: elsewhere it is below 1."""


def footnote_8_as_printed(scene: Scene, times: np.ndarray, phi0: float) -> np.ndarray:
    """Return phi [rad] of a half-full massless can by footnote 8's equation as printed, from rest at `phi0` [rad]."""
    a, b, g = scene.can.radius, scene.load.offset, scene.gravity

    def slope(_: float, state: np.ndarray) -> list[float]:
        phi, rate = state
        pull = g * (a * math.sin(scene.incline) - b * math.sin(scene.incline + phi))
        turning = (pull - a * b / 2 * math.sin(phi) * rate**2) / (1.5 * a**2 - 2 * a * b * math.cos(phi))
        return [rate, turning]

    return solve_ivp(slope, (0, times[-1]), [phi0, 0.0], t_eval=times, rtol=1e-10, atol=1e-12).y[0]


def draw_rocking(panels: Sequence[Axes]) -> None:
    """Draw how frozen beer rocks, by MuJoCo and by footnote 8, and how far each is from theory."""
    run = ROCKING()
    scene, times = run.scene, run.time
    angle, error = panels
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


def draw_roll_down(panels: Sequence[Axes]) -> None:
    """Draw the roll-down of frozen beer: how far it turns, and how hard the incline would have to push."""
    times = np.linspace(0, 1, 1001)
    run = simulate(frozen(), times[-1], math.pi, integrator=DOP853, times=times)
    scene, parts = run.scene, exact(run.scene, times, math.pi).rolls_until()
    rolls, pulled = times <= parts, times >= parts
    angle, normal = panels
    even = scene.acceleration() / scene.can.radius * times**2 / 2
    angle.plot(times, np.degrees(even), "--", label="solid cylinder: g sin α t² / 3a", color=GREY, linewidth=1.2)
    printed = footnote_8_as_printed(scene, times, math.pi) - math.pi
    angle.plot(times[rolls], np.degrees(printed[rolls]), label="footnote 8 as printed", **PRINTED)
    for axes, values in ((angle, np.degrees(run.phi - math.pi)), (normal, _in_weights(run))):
        axes.plot(times[rolls], values[rolls], label="MuJoCo, can that rolls", **SIMULATED)
        axes.plot(times[pulled], values[pulled], label="the same, if the incline could pull the can", **UNPHYSICAL)
        axes.axvline(parts, **REFERENCE)
        axes.set_xlim(0, times[-1])
    normal.axhline(0, **REFERENCE)
    note(normal, f"no push at {parts:.3f} s", (parts, 7), (-6, 0), ha="right")
    label(angle, "", "φ − 180° [°]", "How far the can has turned")
    label(normal, "time t [s]", "normal force / weight", "How hard the incline pushes; below 0 it would have to pull")
    name_below(panels, 2)


def _in_weights(run: Trajectory) -> np.ndarray:
    """Return the normal force that rolling needs, over the weight of can and load."""
    return run.forces.normal / (run.scene.mass * run.scene.gravity)


def draw_slip_and_hop(panels: Sequence[Axes]) -> None:
    """Draw the friction that frozen beer's rolling down needs, and how a can with less of it slips and hops."""
    contact = LIFT_OFF()
    times = np.linspace(0, 1, 1001)
    rolling = exact(contact.scene, times, math.pi)
    parts = rolling.rolls_until()
    friction, moved = panels
    needed = np.where((rolling.forces.needed_friction < 2.5) & (times < parts), rolling.forces.needed_friction, np.nan)
    friction.plot(times, needed, label="needed to roll, exact theory", color="black")
    friction.axhline(FRICTION, **REFERENCE)
    note(friction, f"all that there is: μ = {FRICTION:g}", (0, FRICTION), (6, 8))
    moved.plot(contact.time, 1e3 * contact.slip, color=COLOURS[1], label="slid instead of rolled, MuJoCo")
    moved.plot(contact.time, 1e3 * contact.lift, color=COLOURS[0], label="height above the incline, MuJoCo")
    for axes in panels:
        axes.axvline(parts, **REFERENCE)
        axes.set_xlim(0, times[-1])
    note(moved, "from here on rolling\nwould need a pull", (parts, 5), (-6, 0), ha="right")
    label(friction, "", "friction / normal force", "Friction that rolling needs", ylim=(0, 2.2))
    label(moved, "time t [s]", "distance [mm]", "What the can does")
    name_below(panels, 2)


def draw_period(panels: Sequence[Axes]) -> None:
    """Draw periods over amplitudes, and between which angles frozen beer swings."""
    scenes = {"beer sliding": sliding(), "pendulum in a wheel": pendulum(), "beer frozen": frozen()}
    period, swing = panels
    for name, scene in scenes.items():
        rest, (_, high) = scene.equilibrium(), scene.separatrix()
        amplitudes = (high - rest) * (1 - np.geomspace(0.999, 1e-4, 60))
        small = 2 * math.pi / scene.frequency()
        theory = [scene.period(amplitude) / small for amplitude in amplitudes]
        (line,) = period.plot(np.degrees(amplitudes), theory, label=name)
        few = (high - rest) * np.array([0.2, 0.4, 0.6, 0.8, 0.9])
        measured = [simulate(scene, 4, rest + amplitude, integrator=DOP853).frequency() for amplitude in few]
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


def skids(ratios: np.ndarray, mu: float) -> np.ndarray:
    """Return the angles from the top [degrees] at which hoops of ratios M/m skid, with a gap (NaN) at a jump."""
    angles = np.degrees([hopping.slip(float(ratio), mu) for ratio in ratios])
    angles[1:][np.abs(np.diff(angles)) > _JUMP] = math.nan
    return angles


def draw_lift_off(panels: Sequence[Axes]) -> None:
    """Draw where a hoop lifts off and where it skids, over its mass."""
    # The angle of lift-off rises like a square root just below 1/13, so that the points are denser there.
    ratios = np.unique(np.append(np.geomspace(1e-3, 0.07, 300), 1 / 13 * (1 - np.geomspace(0.1, 1e-6, 20))))
    few = np.array([2e-3, 8e-3, 0.03, 0.06])
    found = [fall_from_top(hoop(hoop_mass=0.2 * float(ratio)), 5e-5, GRIP).takeoff() for ratio in few]
    measured = [math.nan if angle is None else math.degrees(angle) for angle in found]
    lifts = [math.degrees(hopping.lift_off(float(ratio))) for ratio in ratios]
    (axes,) = panels
    axes.plot(ratios, lifts, color=COLOURS[0], label="lifts off if it cannot skid, theory")
    axes.plot(few, measured, "o", color=COLOURS[0], label="lifts off, MuJoCo, μ = 1 000 000")
    for mu, colour in ((2.0, COLOURS[3]), (MU, COLOURS[1]), (0.5, COLOURS[4])):
        axes.plot(ratios, skids(ratios, mu), "--", color=colour, label=f"skids if μ = {mu:g}, theory")
    axes.axhline(90, **REFERENCE)
    axes.axvline(1 / 13, **REFERENCE)
    note(axes, "Littlewood: 90°", (0.01, 90), (4, -8))
    note(axes, "heavier hoops never lift off: M/m = 1/13", (1 / 13, 70), (-4, 0), ha="right")
    axes.set_xscale("log")
    label(axes, "mass of the hoop / weight on its rim, M / m", "angle of the weight from the top [°]")
    ticks(axes.xaxis, (0.001, 0.002, 0.005, 0.01, 0.02, 0.05))
    name_below([axes], 2)
