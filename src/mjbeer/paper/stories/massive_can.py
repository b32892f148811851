"""Stories of section 3 and appendix B: cans with mass, segments of beer, and the pendulum."""

import math
import pathlib
from collections.abc import Iterator
from functools import partial

import numpy as np

from mjbeer.drawing.film import Take
from mjbeer.model.setting import DOP853
from mjbeer.output.plots import chart
from mjbeer.paper.equations import segment
from mjbeer.paper.stories.story import Story
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.measure import mean_acceleration
from mjbeer.theory.scene import Scene, frozen, pendulum, sliding

_CANS = {
    "massless can": Can.massless(),
    "aluminium, 0.1 mm": Can.sheet_metal(),
    "hoop of 50 g": Can.hoop(mass=0.05),
}
"""Cans that the plots compare, by the name in their legends."""


def stories() -> Iterator[Story]:
    """Yield the stories of this chapter."""
    yield Story(
        "accelerations",
        "The acceleration of a can whose beer does not swing, from nearly empty to full. It grows from that of the "
        "empty can, half of g sin(alpha) for a hoop, to nearly g sin(alpha). A can of frozen beer is slower: a full "
        "one has two thirds of g sin(alpha).",
        draw=_draw_accelerations,
    )
    yield Story(
        "inertia-axis",
        "The figure of eq. (36): the beer's moment of inertia about the can's axis, I_axis = k m a^2.",
        draw=_draw_axial,
    )
    yield Story(
        "inertia-cm",
        "The figure of eq. (37): the moment of inertia about the beer's own centre of mass, I_cm = k m a^2.",
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
        "A wheel with a pendulum, and its two limits. A light bob swings as if its pivot accelerated at half of "
        "g sin(alpha). Under a heavy bob the wheel swings instead, the faster the heavier the bob.",
        draw=_draw_pendulum,
        film=Take(partial(simulate, pendulum(), 1.5, 1.0, integrator=DOP853), speed=0.25),
    )


def _steady_acceleration(scene: Scene) -> float:
    """Return the acceleration [m/s^2] that MuJoCo computes for a can whose load does not swing."""
    return mean_acceleration(simulate(scene, 0.5, scene.equilibrium(), integrator=DOP853))


def _draw_accelerations(path: pathlib.Path) -> None:
    fills = np.geomspace(1e-4, 1, 60)
    full = sliding().gravity * math.sin(sliding().incline)
    with chart(path, width=9, height=5) as (axes,):
        for name, can in _CANS.items():
            scenes = [sliding(fill=float(fill), can=can) for fill in fills]
            (line,) = axes.semilogx(fills, [scene.acceleration() / full for scene in scenes], label=f"sliding, {name}")
            # A full can's beer has no equilibrium: it is balanced.
            few = [scene for scene in scenes[::6] if scene.load.fill is not None and scene.load.fill < 0.99]
            axes.plot(
                [scene.load.fill for scene in few],
                [_steady_acceleration(scene) / full for scene in few],
                "o",
                color=line.get_color(),
            )
        ice = [frozen(fill=float(fill)) for fill in fills]
        axes.semilogx(
            fills, [scene.acceleration() / full for scene in ice], "--", label="frozen, massless can, as if balanced"
        )
        for level, name in ((1.0, "g sin(alpha)"), (2 / 3, "2/3: solid cylinder"), (0.5, "1/2: hoop")):
            axes.axhline(level, color="grey", linewidth=0.8, zorder=0)
            axes.annotate(name, (1.05e-4, level), (0, 3), textcoords="offset points", color="grey", fontsize=9)
        axes.set(
            xlabel="fill, height of the beer over the can's diameter",
            ylabel="acceleration / g sin(alpha)",
            title="how fast the can runs down (lines: theory, dots: MuJoCo)",
            ylim=(0.45, 1.06),
        )
        axes.legend(loc="center left", bbox_to_anchor=(0.02, 0.69), fontsize=10)


def _draw_inertia(path: pathlib.Path, lines: dict[str, np.ndarray], beta: np.ndarray, title: str, notes: tuple) -> None:
    """Draw k over beta [rad]: lines by name, and `notes` of an angle [degrees], a value and a text each."""
    with chart(path, width=7, height=4.5) as (axes,):
        for (name, values), style in zip(lines.items(), ("-", "--"), strict=False):
            axes.plot(np.degrees(beta), values, style, label=name)
        for degrees, value, text in notes:
            axes.plot(degrees, value, "k.")
            below = text.startswith("least")
            axes.annotate(text, (degrees, value), (6, -14 if below else 6), textcoords="offset points", fontsize=9)
        axes.set(
            xlabel="beta, half the angle that the beer subtends [degrees]",
            ylabel="k",
            title=title,
            xticks=range(0, 181, 30),
            ylim=(0, 1.05) if len(lines) > 1 else (0, 0.55),
        )
        if len(lines) > 1:
            axes.legend()


def _draw_axial(path: pathlib.Path) -> None:
    beta = np.linspace(0.02, math.pi, 181)
    lines = {
        "eq. (36), first and last form": np.array([segment.eq_36(angle) for angle in beta]),
        "third line as printed, …/8": np.array([segment.middle_36(angle, 8) for angle in beta]),
    }
    right = lines["eq. (36), first and last form"]
    least = int(right.argmin())
    notes = (
        (90, 0.5, "half full: 1/2"),
        (math.degrees(beta[least]), float(right[least]), f"least: {right[least]:.3f}"),
    )
    _draw_inertia(path, lines, beta, "I_axis = k m a², eq. (36)", notes)


def _draw_own(path: pathlib.Path) -> None:
    beta = np.linspace(0.02, math.pi, 181)
    lines = {"eq. (37)": np.array([segment.eq_37(angle) for angle in beta])}
    _draw_inertia(path, lines, beta, "I_cm = k m a², eq. (37)", ((90, segment.eq_37(math.pi / 2), "half full: 0.32"),))


def _draw_tilt(path: pathlib.Path) -> None:
    fills = np.geomspace(1e-3, 0.99, 60)
    with chart(path, 1, 3, width=13, height=4.2) as (angle, rate, limit):
        for name, can in list(_CANS.items())[1:]:
            scenes = [sliding(fill=float(fill), can=can) for fill in fills]
            angle.semilogx(fills, [math.degrees(scene.equilibrium()) for scene in scenes], label=name)
            rate.semilogx(fills, [scene.frequency() for scene in scenes], label=name)
            ice = [frozen(fill=float(fill), can=can) for fill in fills]
            limit.semilogx(fills, [math.degrees(scene.largest_incline()) for scene in ice], label=name)
        light = [sliding(fill=float(fill)) for fill in fills]
        rate.semilogx(fills, [scene.frequency() for scene in light], "k:", label="massless can")
        ice = [frozen(fill=float(fill)) for fill in fills]
        limit.semilogx(fills, [math.degrees(scene.largest_incline()) for scene in ice], "k:", label="massless can")
        for axes, label, title in (
            (angle, "phi* [degrees]", "sliding: tilt of beer that rests"),
            (rate, "ω [rad/s]", "sliding: small swings about it"),
            (limit, "alpha [degrees]", "frozen: steepest incline it stays on"),
        ):
            axes.set(xlabel="fill", ylabel=label, title=title)
        rate.set(ylim=(0, 80))
        limit.legend()


def _small_swing_frequency(scene: Scene) -> float:
    """Return omega [rad/s], measured over some six swings of 0.001 rad."""
    omega = scene.frequency()
    start = scene.equilibrium() + 1e-3
    return simulate(scene, 40 / omega, start, integrator=DOP853, timestep=0.02 / omega).frequency()


def _draw_pendulum(path: pathlib.Path) -> None:
    ratios = np.geomspace(1e-3, 1e3, 61)
    scenes = [pendulum(load_mass=0.2 * float(ratio)) for ratio in ratios]
    first = scenes[0]
    light = math.sqrt(
        first.gravity * math.hypot(math.cos(first.incline), math.sin(first.incline) / 2) / first.load.offset
    )
    heavy = np.sqrt(first.gravity * math.cos(first.incline) * ratios / (2 * first.load.offset))
    few = scenes[::6]
    measured = [_small_swing_frequency(scene) for scene in few]
    with chart(path, width=8, height=5) as (axes,):
        axes.loglog(ratios, [scene.frequency() for scene in scenes], label="exact theory")
        axes.loglog([scene.load.mass / 0.2 for scene in few], measured, "o", label="MuJoCo, swings of 0.001 rad")
        axes.axhline(light, color="grey", linestyle="--", label="light bob: g √(cos²(alpha) + sin²(alpha)/4) = ω² b")
        high = heavy > light / 2
        axes.loglog(ratios[high], heavy[high], ":", color="grey", label="heavy bob: ω² = g cos(alpha) m / 2Mb")
        axes.set(xlabel="bob over wheel, m/M", ylabel="ω of small swings [rad/s]", title="a wheel with a pendulum")
        axes.legend()
