"""Stories of appendix A: beer frozen to its half-full can."""

import math
import pathlib
from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from scipy.integrate import solve_ivp

from mjbeer.drawing.film import Take
from mjbeer.drawing.overlay.look import Look, Mark
from mjbeer.model.setting import DOP853
from mjbeer.output.plots import (
    COLOURS,
    GREY,
    PRINTED,
    REFERENCE,
    SIMULATED,
    THEORY,
    UNPHYSICAL,
    chart,
    name_below,
    note,
)
from mjbeer.paper.stories.story import Story
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.exact import exact
from mjbeer.theory.named import frozen, in_degrees, in_words, pendulum, sliding
from mjbeer.theory.scene import INCLINE, Scene
from mjbeer.theory.trajectory import Trajectory

_MARGIN = 0.02
"""Relative difference of footnote 7's two friction coefficients from tan(alpha)."""
_EVERYTHING: tuple[Mark, ...] = ("phi", "paths", "forces")
_GRIP = 1.0
"""Friction coefficient of the incline from which the can lifts off."""


def stories() -> Iterator[Story]:
    """Yield the stories of this chapter."""
    yield Story(
        "rocking",
        "A can with frozen beer, let go at φ = 0, rocks about its equilibrium and does not roll off. Footnote 8's "
        "equation as printed, with ½ a b in place of a b, gives another swing.",
        draw=_draw_rocking,
        film=Take(_rocking, 0.5, Look("Frozen beer, let go below: it rocks", ("phi", "u"), ("phi", "paths"))),
    )
    yield Story(
        "roll-down",
        "The figure of A.3: the same can, let go with the beer on top. It rolls down like a solid cylinder, but in "
        "jerks. Rolling needs more and more friction, and from 0.834 s on the incline would have to pull the can: what "
        "comes after that is dotted. A can on an incline with μ = 1 slips and hops instead.",
        draw=_draw_roll_down,
        film=Take(
            partial(_lift_off, _GRIP),
            speed=0.25,
            look=Look("Frozen beer, let go on top: it rolls, slips and hops", ("normal", "lift"), _EVERYTHING),
        ),
    )
    yield Story(
        "friction",
        "Footnote 7: at the equilibrium the can stays if the friction coefficient is more than tan α, and slides off "
        "if it is less. The lines are simulations in contact, 2 % above, 2 % below, and 30 % below.",
        draw=_draw_friction,
        film=Take(
            partial(_contact_at_equilibrium, 1 - 0.3),
            speed=0.5,
            look=Look("Too little friction: a can at its equilibrium slides off", ("phi", "slip"), ("phi", "forces")),
        ),
    )
    yield Story(
        "period",
        "What the paper leaves open: the period grows with the amplitude and is infinite at the separatrix, the end of "
        "the largest swing. On an incline the frozen can swings differently to either side, and rolls off downhill.",
        draw=_draw_period,
    )


def _rocking() -> Trajectory:
    """Return the rocking of frozen beer that is let go with its surface along the incline."""
    return simulate(frozen(), 2.0, 0.0, integrator=DOP853)


def _footnote_8_as_printed(scene: Scene, times: np.ndarray, phi0: float) -> np.ndarray:
    """Return phi [rad] of a half-full massless can by footnote 8's equation as printed, from rest at `phi0` [rad]."""
    a, b, g = scene.can.radius, scene.load.offset, scene.gravity

    def slope(_: float, state: np.ndarray) -> list[float]:
        phi, rate = state
        pull = g * (a * math.sin(scene.incline) - b * math.sin(scene.incline + phi))
        turning = (pull - a * b / 2 * math.sin(phi) * rate**2) / (1.5 * a**2 - 2 * a * b * math.cos(phi))
        return [rate, turning]

    return solve_ivp(slope, (0, times[-1]), [phi0, 0.0], t_eval=times, rtol=1e-10, atol=1e-12).y[0]


def _draw_rocking(path: pathlib.Path) -> None:
    run = _rocking()
    scene, times = run.scene, run.time
    rest = math.degrees(scene.equilibrium())
    subtitle = f"{in_words(scene)}; let go at φ = 0"
    title = "A can of frozen beer rocks about its equilibrium and stays"
    with chart(path, 2, 1, width=9, height=7, title=title, subtitle=subtitle) as (angle, error):
        truth = exact(scene, times, run.phi0).phi
        printed = _footnote_8_as_printed(scene, times, run.phi0)
        angle.plot(times, np.degrees(truth), label="exact theory, eq. (52)", **THEORY)
        angle.plot(times, np.degrees(run.phi), label="MuJoCo", **SIMULATED)
        angle.plot(times, np.degrees(printed), label="footnote 8 as printed", **PRINTED)
        angle.axhline(rest, label="equilibrium, eq. (53)", **REFERENCE)
        error.plot(times, np.degrees(run.phi - truth), **SIMULATED)
        error.plot(times, np.degrees(printed - truth), **PRINTED)
        angle.set(ylabel="φ, beer's surface to the incline [°]", title="The swing")
        error.set(xlabel="time t [s]", ylabel="φ less that of theory [°]", title="How far each is from exact theory")
        name_below([angle], 4)


def _lift_off(friction: float) -> Trajectory:
    """Return a roll-down from the top in contact, which ends after the can has left the incline."""
    return simulate(frozen(), 1.0, math.pi, rolling="contact", timestep=2e-4, friction=friction)


def _draw_roll_down(path: pathlib.Path) -> None:
    contact = _lift_off(_GRIP)
    scene, times = contact.scene, np.linspace(0, 1, 1001)
    run = simulate(scene, times[-1], math.pi, integrator=DOP853, times=times)
    parts = exact(scene, times, math.pi).rolls_until()
    rolls, pulled = times <= parts, times >= parts
    subtitle = f"{in_words(scene)}; let go at φ = 180°"
    title = "Frozen beer let go on top: it rolls down in jerks, until its can leaves the incline"
    with chart(path, 4, 1, width=9, height=11, title=title, subtitle=subtitle) as panels:
        angle, normal, friction, lift = panels
        even = scene.acceleration() / scene.can.radius * times**2 / 2
        angle.plot(times, np.degrees(even), "--", label="solid cylinder: g sin α t² / 3a", color=GREY, linewidth=1.2)
        printed = _footnote_8_as_printed(scene, times, math.pi) - math.pi
        angle.plot(times[rolls], np.degrees(printed[rolls]), label="footnote 8 as printed", **PRINTED)
        needed = np.where((run.forces.needed < 2) & (run.forces.normal > 0), run.forces.needed, np.nan)
        weight = scene.mass * scene.gravity
        for axes, values in (
            (angle, np.degrees(run.phi - math.pi)),
            (normal, run.forces.normal / weight),
            (friction, needed),
        ):
            axes.plot(times[rolls], values[rolls], label="MuJoCo, can that rolls", **SIMULATED)
            axes.plot(times[pulled], values[pulled], label="the same, if the incline could pull the can", **UNPHYSICAL)
        hops: dict[str, Any] = {
            "color": COLOURS[2],
            "label": f"MuJoCo, can on an incline with μ = {_GRIP:g}: slips and hops",
        }
        angle.plot(contact.time, np.degrees(contact.phi - math.pi), **hops)
        lift.plot(contact.time, 1e3 * contact.lift, **hops)
        normal.axhline(0, **REFERENCE)
        friction.axhline(_GRIP, **REFERENCE)
        note(friction, f"μ = {_GRIP:g}", (0, _GRIP), (0, 7))
        angle.set(ylabel="φ − 180° [°]", title="How far the can has turned")
        normal.set(ylabel="normal force / weight", title="What rolling needs: the incline's push, or pull below 0")
        friction.set(ylabel="friction |F| / N", title="What rolling needs: friction", ylim=(0, 2))
        lift.set(
            ylabel="height [mm]",
            title="How high a can that is free to leave it is above the incline",
            xlabel="time t [s]",
        )
        for axes in panels:
            axes.set_xlim(0, times[-1])
            axes.axvline(parts, **REFERENCE)
        note(lift, f"N = 0 at {parts:.3f} s", (parts, 1e3 * contact.lift.max() * 0.8), (-6, 0), ha="right")
        name_below(panels, 2)


def _contact_at_equilibrium(part: float) -> Trajectory:
    """Return one second in contact from the equilibrium, at a friction coefficient of `part` times tan(alpha)."""
    scene = frozen()
    mu = part * math.tan(scene.incline)
    return simulate(scene, 1.0, scene.equilibrium(), rolling="contact", friction=mu)


def _draw_friction(path: pathlib.Path) -> None:
    runs = {part: _contact_at_equilibrium(part) for part in (1 + _MARGIN, 1 - _MARGIN, 0.7)}
    scene = runs[0.7].scene
    title = "At rest on its equilibrium, the can stays if μ > tan α, and slides off if not"
    subtitle = f"{in_words(scene)}, tan α = {math.tan(scene.incline):.3f}"
    with chart(path, 1, 2, width=11, height=4.8, title=title, subtitle=subtitle) as panels:
        for axes, parts in zip(panels, ((1 + _MARGIN, 1 - _MARGIN), (1 + _MARGIN, 0.7)), strict=True):
            for part in parts:
                run, colour = runs[part], COLOURS[list(runs).index(part)]
                axes.plot(run.time, 1e3 * np.abs(run.u - run.u[0]), color=colour, label=f"MuJoCo, μ = {part:g} tan α")
            least = 1 - min(parts)
            axes.set(
                xlabel="time t [s]",
                ylabel="distance slid [mm]",
                title=f"{100 * least:.0f} % less friction than it takes",
            )
        name_below(panels, 3)


def _draw_period(path: pathlib.Path) -> None:
    scenes = {"beer sliding": sliding(), "pendulum in a wheel": pendulum(), "beer frozen": frozen()}
    title = "The wider a swing, the slower, and how wide it can be"
    subtitle = f"half-full massless can with sliding and with frozen beer, {in_words(pendulum())}"
    with chart(path, 1, 2, width=12, height=5.2, title=title, subtitle=subtitle) as (period, swing):
        for name, scene in scenes.items():
            rest, (_, high) = scene.equilibrium(), scene.separatrix()
            amplitudes = (high - rest) * (1 - np.geomspace(0.999, 1e-4, 400))
            small = 2 * math.pi / scene.frequency()
            (line,) = period.plot(
                np.degrees(amplitudes), [scene.period(amplitude) / small for amplitude in amplitudes], label=name
            )
            few = (high - rest) * np.array([0.2, 0.4, 0.6, 0.8, 0.9])
            measured = [simulate(scene, 8, rest + amplitude, integrator=DOP853).frequency() for amplitude in few]
            period.plot(np.degrees(few), 2 * math.pi / np.array(measured) / small, "o", color=line.get_color())
            period.axvline(math.degrees(high - rest), color=line.get_color(), linewidth=1, linestyle=":")
        period.plot([], [], "o", color=GREY, label="MuJoCo (lines: exact theory)")
        period.plot([], [], ":", color=GREY, linewidth=1, label="widest swing: its period is infinite")
        period.set(
            xlabel="amplitude, downhill from the equilibrium [°]",
            ylabel="period / period of small swings",
            ylim=(0.9, 2.6),
            xlim=(0, 185),
            title=f"Periods on an incline of {in_degrees(INCLINE)}",
        )
        _draw_range(swing)
        name_below([period, swing], 3)


def _draw_range(axes: Axes) -> None:
    """Draw between which angles a frozen load swings, over the incline."""
    # At both ends of the inclines the limits are steep, so that the points are denser there.
    limit = frozen().largest_incline()
    inclines = limit * (1 - np.cos(np.linspace(0.02, math.pi - 0.005, 200))) / 2
    cans = [frozen(incline) for incline in inclines]
    low, high = np.degrees([can.separatrix() for can in cans]).T
    x = np.degrees(inclines)
    axes.fill_between(x, low, high, color=COLOURS[5], alpha=0.25, linewidth=0)
    axes.plot(x, high, color=COLOURS[5])
    axes.plot(x, low, color=COLOURS[5])
    axes.plot(x, np.degrees([can.equilibrium() for can in cans]), "k--", label="equilibrium of frozen beer, eq. (53)")
    for text, place in (
        ("let go here, it swings", (4, 70)),
        ("let go here,\nit rolls off", (20.5, 150)),
        ("let go here,\nit rolls off", (20.5, -120)),
    ):
        note(axes, text, place, (0, 0), color="black")
    axes.set(
        xlabel="incline α [°]",
        ylabel="φ, beer's surface to the incline [°]",
        title="Frozen beer: where it swings, and where it does not",
        ylim=(-190, 190),
        yticks=range(-180, 181, 60),
    )
