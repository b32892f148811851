"""Stories of section 3 and appendix B: cans with mass, segments of beer, and the pendulum."""

import math
import pathlib
from collections.abc import Iterator

import numpy as np

from mjbeer.drawing.film import Film
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


def stories() -> Iterator[Story]:
    """Yield the stories of the chapter."""
    yield Story(
        "accelerations",
        "How fast a can runs down if its beer does not swing, from nearly empty to full: from the can's own, half of "
        "g sin(alpha) for a hoop, to nearly g sin(alpha). Frozen beer is slower, two thirds of it when full.",
        _accelerations,
    )  # fmt: skip
    yield Story(
        "inertia-axis", "The figure of eq. (36): inertia of the beer about the can's axis, I_axis = k m a^2.", _axial
    )
    yield Story(
        "inertia-cm", "The figure of eq. (37): inertia about the beer's own centre of mass, I_cm = k m a^2.", _own
    )
    yield Story(
        "tilt",
        "What the paper leaves open about a massive can. The surface of beer that does not swing lies between parallel "
        "to the incline and level, half-way in a nearly empty hoop; little beer swings like a pendulum, where without "
        "the can's mass it would swing ever faster; and the can's mass lets frozen beer hold less of a slope.",
        _tilt,
    )  # fmt: skip
    yield Story(
        "pendulum",
        "A wheel with a pendulum between its limits. A light bob swings as in a frame that accelerates at half of "
        "g sin(alpha); under a heavy one the wheel swings instead, ever faster.",
        _pendulum, Film(0.5, lambda: simulate(pendulum(), 1.5, 1.0, integrator=DOP853)),
    )  # fmt: skip


def _steady(scene: Scene) -> float:
    """Acceleration [m/s^2] that MuJoCo has for a scene at rest in its own frame."""
    return mean_acceleration(simulate(scene, 0.5, scene.equilibrium(), integrator=DOP853))


def _accelerations(path: pathlib.Path) -> None:
    fills = np.geomspace(1e-4, 1, 60)
    full = sliding().gravity * math.sin(sliding().incline)
    with chart(path, width=9, height=5) as (axes,):
        for name, can in _CANS.items():
            scenes = [sliding(fill=float(fill), can=can) for fill in fills]
            (line,) = axes.semilogx(fills, [each.acceleration() / full for each in scenes], label=f"sliding, {name}")
            # A full can's beer has no equilibrium: it is balanced.
            few = [each for each in scenes[::6] if each.load.fill is not None and each.load.fill < 0.99]
            axes.plot(
                [each.load.fill for each in few], [_steady(each) / full for each in few], "o", color=line.get_color()
            )
        ice = [frozen(fill=float(fill)) for fill in fills]
        axes.semilogx(
            fills, [each.acceleration() / full for each in ice], "--", label="frozen, massless can, as if balanced"
        )
        for level, name in ((1.0, "g sin(alpha)"), (2 / 3, "2/3: solid cylinder"), (0.5, "1/2: hoop")):
            axes.axhline(level, color="grey", linewidth=0.8, zorder=0)
            axes.annotate(name, (1.05e-4, level), (0, 3), textcoords="offset points", color="grey", fontsize=9)
        axes.set(
            xlabel="fill, height of the beer over the can's diameter", ylabel="acceleration / g sin(alpha)",
            title="how fast the can runs down (lines: theory, dots: MuJoCo)", ylim=(0.45, 1.06),
        )  # fmt: skip
        axes.legend(loc="center left", bbox_to_anchor=(0.02, 0.69), fontsize=10)


def _k(path: pathlib.Path, lines: dict[str, np.ndarray], beta: np.ndarray, title: str, notes: tuple) -> None:
    with chart(path, width=7, height=4.5) as (axes,):
        for (name, values), style in zip(lines.items(), ("-", "--"), strict=False):
            axes.plot(np.degrees(beta), values, style, label=name)
        for degrees, value, text in notes:
            axes.plot(degrees, value, "k.")
            below = text.startswith("least")
            axes.annotate(text, (degrees, value), (6, -14 if below else 6), textcoords="offset points", fontsize=9)
        axes.set(
            xlabel="beta, half the angle that the beer subtends [degrees]", ylabel="k", title=title,
            xticks=range(0, 181, 30), ylim=(0, 1.05) if len(lines) > 1 else (0, 0.55),
        )  # fmt: skip
        if len(lines) > 1:
            axes.legend()


def _axial(path: pathlib.Path) -> None:
    beta = np.linspace(0.02, math.pi, 181)
    lines = {
        "eq. (36), first and last form": np.array([segment.eq_36(each) for each in beta]),
        "third line as printed, …/8": np.array([segment.middle_36(each, 8) for each in beta]),
    }
    right = lines["eq. (36), first and last form"]
    least = int(right.argmin())
    notes = (
        (90, 0.5, "half full: 1/2"),
        (math.degrees(beta[least]), float(right[least]), f"least: {right[least]:.3f}"),
    )
    _k(path, lines, beta, "I_axis = k m a², eq. (36)", notes)


def _own(path: pathlib.Path) -> None:
    beta = np.linspace(0.02, math.pi, 181)
    lines = {"eq. (37)": np.array([segment.eq_37(each) for each in beta])}
    _k(path, lines, beta, "I_cm = k m a², eq. (37)", ((90, segment.eq_37(math.pi / 2), "half full: 0.32"),))


def _tilt(path: pathlib.Path) -> None:
    fills = np.geomspace(1e-3, 0.99, 60)
    with chart(path, 1, 3, width=13, height=4.2) as (angle, rate, limit):
        for name, can in list(_CANS.items())[1:]:
            scenes = [sliding(fill=float(fill), can=can) for fill in fills]
            angle.semilogx(fills, [math.degrees(each.equilibrium()) for each in scenes], label=name)
            rate.semilogx(fills, [each.frequency() for each in scenes], label=name)
            ice = [frozen(fill=float(fill), can=can) for fill in fills]
            limit.semilogx(fills, [math.degrees(each.largest_incline()) for each in ice], label=name)
        light = [sliding(fill=float(fill)) for fill in fills]
        rate.semilogx(fills, [each.frequency() for each in light], "k:", label="massless can")
        ice = [frozen(fill=float(fill)) for fill in fills]
        limit.semilogx(fills, [math.degrees(each.largest_incline()) for each in ice], "k:", label="massless can")
        for axes, label, title in (
            (angle, "phi* [degrees]", "sliding: tilt of beer that rests"),
            (rate, "ω [rad/s]", "sliding: small swings about it"),
            (limit, "alpha [degrees]", "frozen: steepest incline it stays on"),
        ):
            axes.set(xlabel="fill", ylabel=label, title=title)
        rate.set(ylim=(0, 80))
        limit.legend()


def _pendulum(path: pathlib.Path) -> None:
    ratios = np.geomspace(1e-3, 1e3, 61)
    scenes = [pendulum(load_mass=0.2 * float(ratio)) for ratio in ratios]
    first = scenes[0]
    light = math.sqrt(
        first.gravity * math.hypot(math.cos(first.incline), math.sin(first.incline) / 2) / first.load.offset
    )
    heavy = np.sqrt(first.gravity * math.cos(first.incline) * ratios / (2 * first.load.offset))
    few = scenes[::6]
    seen = [simulate(each, 40 / each.frequency(), each.equilibrium() + 1e-3, integrator=DOP853,
                     timestep=0.02 / each.frequency()).frequency() for each in few]  # fmt: skip
    with chart(path, width=8, height=5) as (axes,):
        axes.loglog(ratios, [each.frequency() for each in scenes], label="exact theory")
        axes.loglog([each.load.mass / 0.2 for each in few], seen, "o", label="MuJoCo, swings of 0.001 rad")
        axes.axhline(light, color="grey", linestyle="--", label="light bob: g √(cos²(alpha) + sin²(alpha)/4) = ω² b")
        high = heavy > light / 2
        axes.loglog(ratios[high], heavy[high], ":", color="grey", label="heavy bob: ω² = g cos(alpha) m / 2Mb")
        axes.set(xlabel="bob over wheel, m/M", ylabel="ω of small swings [rad/s]", title="a wheel with a pendulum")
        axes.legend()
