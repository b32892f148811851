"""Stories of section 3 and appendix B: cans with mass, segments of beer, and the pendulum."""

import math
import pathlib
from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes

from mjbeer.drawing.film import Take
from mjbeer.drawing.overlay.look import Look
from mjbeer.model.setting import DOP853
from mjbeer.output.plots import COLOURS, GREY, REFERENCE, SIMULATED, THEORY, chart, name_below, note, ticks
from mjbeer.paper.equations import segment
from mjbeer.paper.stories.story import Story
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.exact import exact
from mjbeer.theory.named import frozen, in_degrees, in_words, pendulum, sliding
from mjbeer.theory.scene import INCLINE, Scene
from mjbeer.theory.trajectory import Trajectory, mean_acceleration

_METAL, _HOOP = Can.sheet_metal(), Can.hoop(mass=0.05)
_CANS = {
    "massless can": Can.massless(),
    f"aluminium can of {1e3 * _METAL.mass:.2g} g": _METAL,
    f"hoop of {1e3 * _HOOP.mass:g} g": _HOOP,
}
"""Cans that the plots compare, by the name in their legends."""
_FILL = "fill: height of the beer / can's diameter"


def stories() -> Iterator[Story]:
    """Yield the stories of this chapter."""
    yield Story(
        "accelerations",
        "The acceleration of a can whose beer does not swing, from nearly empty to full. It grows from that of the "
        "empty can, half of g sin α for a hoop, to nearly g sin α. A can of frozen beer is slower: a full one has two "
        "thirds of g sin α. The dashed line is without the swings of frozen beer, as if it were balanced.",
        draw=_draw_accelerations,
    )
    yield Story(
        "inertia-axis",
        "The figure of eq. (36): the beer's moment of inertia about the can's axis.",
        draw=_draw_axial,
    )
    yield Story(
        "inertia-cm",
        "The figure of eq. (37): the moment of inertia about the beer's own centre of mass.",
        draw=_draw_own,
    )
    yield Story(
        "tilt",
        "What the paper leaves open about a massive can. Left: the surface of beer that does not swing is between "
        "level and parallel to the incline, half-way in a nearly empty hoop. Middle: a little beer swings like a "
        "pendulum; in a massless can it would swing the faster the less there is. Right: a can with mass and frozen "
        "beer stays only on gentler slopes than a massless one.",
        draw=_draw_tilt,
    )
    yield Story(
        "pendulum",
        "A wheel with a pendulum. Left: a wide swing. Right: small swings, and their two limits. A light bob swings "
        "as if its pivot accelerated at half of g sin α. Under a heavy bob the wheel swings instead, the faster the "
        "heavier the bob.",
        draw=_draw_pendulum,
        film=Take(
            _pendulum,
            0.25,
            Look("A wheel hesitates in every swing of its pendulum", ("phi", "ahead"), ("phi", "ghost")),
        ),
    )


def _steady_acceleration(scene: Scene) -> float:
    """Return the acceleration [m/s^2] that MuJoCo computes for a can whose load does not swing."""
    return mean_acceleration(simulate(scene, 0.5, scene.equilibrium(), integrator=DOP853))


def _draw_accelerations(path: pathlib.Path) -> None:
    # Near 0 and near 1 the curves are steep, so that the points are denser there.
    fills = (1 - np.cos(np.linspace(0.02, math.pi, 121))) / 2
    full = sliding().gravity * math.sin(sliding().incline)
    title = "The fuller the can, the faster it runs down, unless its beer is frozen"
    subtitle = "beer that does not swing; the same on every incline"
    with chart(path, width=9, height=5.4, title=title, subtitle=subtitle) as (axes,):
        for level, name, offset in (
            (1.0, "mass that slides", 7),
            (2 / 3, "solid cylinder: 2/3", -8),
            (0.5, "hoop: 1/2", 7),
        ):
            axes.axhline(level, **REFERENCE)
            note(axes, name, (1.0, level), (0, offset), ha="right")
        for name, can in _CANS.items():
            scenes = [sliding(fill=float(fill), can=can) for fill in fills]
            (line,) = axes.plot(
                fills, [scene.acceleration() / full for scene in scenes], label=f"beer sliding, {name}: exact theory"
            )
            few = [sliding(fill=float(fill), can=can) for fill in (0.001, 0.05, *np.arange(0.1, 0.95, 0.1))]
            axes.plot(
                [scene.load.fill for scene in few],
                [_steady_acceleration(scene) / full for scene in few],
                "o",
                color=line.get_color(),
            )
        ice = [frozen(fill=float(fill)).acceleration() / full for fill in fills]
        axes.plot([], [], "o", color=GREY, label="MuJoCo")
        axes.plot(fills, ice, "--", label="beer frozen, massless can: theory as if it were balanced")
        axes.set(xlabel=_FILL, ylabel="acceleration / g sin α", ylim=(0.45, 1.08))
        name_below([axes], 2)


_BETA = np.linspace(0.02, math.pi, 181)


def _draw_inertia(path: pathlib.Path, title: str, lines: dict[str, np.ndarray], notes: tuple) -> None:
    """Draw inertia over half angles: the right line and misprints, by name.

    `notes` have an angle [degrees], a value, a text and its offset [points] each.
    """
    with chart(path, width=8, height=5, title=title, subtitle="beer of mass m in a can of radius a") as (axes,):
        for (name, values), line, colour in zip(lines.items(), ("-", "--"), COLOURS, strict=False):
            axes.plot(np.degrees(_BETA), values, line, color=colour, label=name)
        for angle, value, text, offset in notes:
            axes.plot(angle, value, "k.")
            note(axes, text, (angle, value), offset, color="black")
        axes.set(
            xlabel="β, half the angle under which the beer is seen from the axis [°]",
            ylabel="moment of inertia / m a²",
            xticks=range(0, 181, 30),
            ylim=(0, 1.05 * max(values.max() for values in lines.values())),
        )
        above = axes.secondary_xaxis("top")
        above.set_xticks([0, 60, 90, 120, 180], ["0", "¼", "½", "¾", "1"])
        above.set_xlabel(_FILL)
        name_below([axes], 2)


def _draw_axial(path: pathlib.Path) -> None:
    right = np.array([segment.eq_36(angle) for angle in _BETA])
    printed = np.array([segment.middle_36(angle, 8) for angle in _BETA])
    least = int(right.argmin())
    notes = (
        (90, 0.5, "half full: 1/2", (6, 10)),
        (math.degrees(_BETA[least]), float(right[least]), f"least: {right[least]:.3f}", (4, -12)),
    )
    lines = {"eq. (36), first and last line": right, "eq. (36), third line as printed, …/8": printed}
    _draw_inertia(path, "Moment of inertia of the beer about the can's axis", lines, notes)


def _draw_own(path: pathlib.Path) -> None:
    lines = {"eq. (37)": np.array([segment.eq_37(angle) for angle in _BETA])}
    notes = ((90, segment.eq_37(math.pi / 2), "half full: 0.32", (10, -8)),)
    _draw_inertia(path, "Moment of inertia of the beer about its own centre of mass", lines, notes)


def _draw_tilt(path: pathlib.Path) -> None:
    fills = (1 - np.cos(np.linspace(0.03, 0.98 * math.pi, 181))) / 2
    title = "What the mass of the can does to its beer"
    subtitle = f"beer sliding on an incline of {in_degrees(INCLINE)} (left and middle), beer frozen (right)"
    with chart(path, 1, 3, width=13, height=4.8, title=title, subtitle=subtitle) as (angle, rate, limit):
        for name, can in _CANS.items():
            beer = [sliding(fill=float(fill), can=can) for fill in fills]
            ice = [frozen(fill=float(fill), can=can) for fill in fills]
            angle.plot(fills, [math.degrees(scene.equilibrium()) for scene in beer], label=name)
            rate.plot(fills, [scene.frequency() for scene in beer])
            limit.plot(fills, [math.degrees(scene.largest_incline()) for scene in ice])
        for axes, label, title in (
            (angle, "φ at rest, beer's surface to the incline [°]", "Tilt of beer that does not swing"),
            (rate, "ω [rad/s]", "Frequency of its small swings"),
            (limit, "α [°]", "Steepest incline on which it stays"),
        ):
            axes.set(xlabel=_FILL, ylabel=label, title=title)
        rate.set(ylim=(0, 80))
        name_below([angle], 3)


def _small_swing_frequency(scene: Scene) -> float:
    """Return omega [rad/s], measured over some six swings of 0.001 rad."""
    omega = scene.frequency()
    start = scene.equilibrium() + 1e-3
    return simulate(scene, 40 / omega, start, integrator=DOP853, timestep=0.02 / omega).frequency()


def _pendulum() -> Trajectory:
    """Return a wide swing of a pendulum in its wheel."""
    return simulate(pendulum(), 1.5, 1.0, integrator=DOP853)


def _draw_pendulum(path: pathlib.Path) -> None:
    run = _pendulum()
    scene, start = run.scene, in_degrees(run.phi0)
    title = "A wheel with a pendulum: a wide swing, and how the bob's mass changes small ones"
    with chart(path, 1, 2, width=12, height=5.4, title=title, subtitle=in_words(scene, {"load"})) as (swing, rate):
        truth = exact(scene, run.time, run.phi0)
        swing.plot(run.time, np.degrees(truth.phi), label="exact theory", **THEORY)
        swing.plot(run.time, np.degrees(run.phi), label="MuJoCo", **SIMULATED)
        ratio = scene.load.mass / scene.can.mass
        swing.set(
            xlabel="time t [s]",
            ylabel="φ, pendulum to the incline's normal [°]",
            title=f"Let go at φ = {start}, bob of {ratio:g} wheel masses",
        )
        _draw_frequencies(rate, scene)
        name_below([swing, rate], 3)


def _draw_frequencies(axes: Axes, scene: Scene) -> None:
    """Draw the frequency of small swings over the mass of the bob in masses of the wheel, and its two limits."""
    wheel, b, g = scene.can.mass, scene.load.offset, scene.gravity
    ratios = np.geomspace(1e-3, 1e3, 61)
    scenes = [pendulum(scene.incline, wheel, wheel * float(ratio), b) for ratio in ratios]
    light = math.sqrt(g * math.hypot(math.cos(scene.incline), math.sin(scene.incline) / 2) / b)
    heavy = np.sqrt(g * math.cos(scene.incline) * ratios / (2 * b))
    high = heavy > light / 2
    axes.plot(ratios, [each.frequency() for each in scenes], **THEORY)
    axes.plot(
        ratios[::6],
        [_small_swing_frequency(each) for each in scenes[::6]],
        "o",
        label="MuJoCo, swings of 0.06°",
        **SIMULATED,
    )
    axes.axhline(light, color="black", linewidth=1, linestyle="--", label="light bob: ω² = g √(cos² α + ¼ sin² α) / b")
    axes.plot(ratios[high], heavy[high], ":", color="black", label="heavy bob: ω² = ½ (m/M) g cos α / b")
    axes.set(
        xscale="log",
        yscale="log",
        xlabel="mass of the bob / mass of the wheel, m / M",
        ylabel="ω of small swings [rad/s]",
        title="Small swings",
    )
    ticks(axes.xaxis, (0.001, 0.01, 0.1, 1, 10, 100, 1000))
    ticks(axes.yaxis, (10, 20, 50, 100, 200, 400))
