"""Stories of appendix A: beer frozen to its can, with the paper's numbers a = 3 cm, b = 1 cm, alpha = 10 degrees."""

import math
import pathlib
from collections.abc import Iterator
from functools import partial

import numpy as np
from scipy.integrate import solve_ivp

from mjbeer.drawing.film import Take
from mjbeer.drawing.look import Look
from mjbeer.model.setting import DOP853
from mjbeer.output.plots import chart
from mjbeer.paper.scenarios import footnote_scene
from mjbeer.paper.stories.story import Story
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.exact import exact
from mjbeer.theory.scene import frozen, pendulum, sliding
from mjbeer.theory.trajectory import Trajectory

_MARGIN = 0.02
"""Relative difference of footnote 7's two friction coefficients from tan(alpha)."""
_ROCKING = Look("Frozen beer, let go below: it rocks", ("phi", "u"), ("phi", "paths"))
_ROLL_DOWN = Look(
    "Frozen beer, let go on top: it rolls, slips and hops", ("normal", "lift"), ("phi", "paths", "forces")
)
_FRICTION = Look("Too little friction: a can at its equilibrium slides off", ("phi", "slip"), ("phi", "forces"))


def stories() -> Iterator[Story]:
    """Yield the stories of this chapter."""
    yield Story(
        "rocking",
        "A can with frozen beer, let go at phi = 0, rocks about its equilibrium and does not roll off. Footnote 8's "
        "equation as printed gives another swing. The film shows a half-full can.",
        draw=_draw_rocking,
        film=Take(partial(simulate, frozen(), 2.0, 0.0, integrator=DOP853), speed=0.5, look=_ROCKING),
    )
    yield Story(
        "roll-down",
        "The figure of A.3: the same can, let go with the beer on top. It rolls down like a solid cylinder, but in "
        "jerks. Rolling needs more and more friction, and from 0.848 s on the incline would have to pull the can. The "
        "film shows a half-full can, which slips and hops.",
        draw=_draw_roll_down,
        film=Take(partial(_lift_off, 1.0), speed=0.25, look=_ROLL_DOWN),
    )
    yield Story(
        "friction",
        "Footnote 7: at the equilibrium the can stays if the friction coefficient is more than tan(alpha), and slides "
        "off if it is less. The two lines are simulations in contact, 2 % above and 2 % below.",
        draw=_draw_friction,
        film=Take(partial(_contact_at_equilibrium, 1 - 0.3), speed=0.5, look=_FRICTION),
    )
    yield Story(
        "period",
        "What the paper leaves open: the period grows with the amplitude and is infinite at the separatrix, the end of "
        "the largest swing. On an incline the frozen can swings differently to either side, and rolls off downhill.",
        draw=_draw_period,
    )


def _footnote_8_as_printed(times: np.ndarray, phi0: float) -> np.ndarray:
    """Return phi [rad] by footnote 8's equation as printed, integrated by SciPy from rest at `phi0` [rad]."""
    scene = footnote_scene()
    a, b, g = 100 * scene.can.radius, 100 * scene.load.offset, 100 * scene.gravity

    def slope(_: float, state: np.ndarray) -> list[float]:
        phi, rate = state
        pull = g * (a * math.sin(scene.incline) - b * math.sin(scene.incline + phi))
        turning = (pull - a * b / 2 * math.sin(phi) * rate**2) / (1.5 * a**2 - 2 * a * b * math.cos(phi))
        return [rate, turning]

    return solve_ivp(slope, (0, times[-1]), [phi0, 0.0], t_eval=times, rtol=1e-10, atol=1e-12).y[0]


def _draw_rocking(path: pathlib.Path) -> None:
    scene = footnote_scene()
    times = np.linspace(0, 3, 601)
    run = simulate(scene, 3, 0.0, integrator=DOP853, times=times)
    with chart(path, width=9, height=4.5) as (axes,):
        axes.plot(times, np.degrees(run.phi), label="MuJoCo")
        axes.plot(times[::12], np.degrees(exact(scene, times[::12], 0.0).phi), "k.", label="exact theory, eq. (52)")
        axes.plot(times, np.degrees(_footnote_8_as_printed(times, 0.0)), "--", label="footnote 8 as printed")
        axes.axhline(math.degrees(scene.equilibrium()), color="grey", linewidth=0.8, label="equilibrium, (53)")
        axes.set(xlabel="time [s]", ylabel="phi [degrees]", title="frozen beer, let go at phi = 0", ylim=(-2, 58))
        axes.legend(loc="upper right", ncols=4, fontsize=9)


def _draw_roll_down(path: pathlib.Path) -> None:
    scene = footnote_scene()
    times = np.linspace(0, 1.2, 1201)
    run = simulate(scene, 1.2, math.pi, integrator=DOP853, times=times)
    parts = exact(scene, times, math.pi).rolls_until()
    even = scene.acceleration() / scene.can.radius * times**2 / 2
    with chart(path, 3, 1, width=9, height=9) as (angle, normal, friction):
        angle.plot(times, np.degrees(run.phi - math.pi), label="MuJoCo, rolling without slipping")
        angle.plot(times, np.degrees(even), "k:", label="solid cylinder, g sin(alpha) t²/3a")
        angle.plot(
            times, np.degrees(_footnote_8_as_printed(times, math.pi) - math.pi), "--", label="footnote 8 as printed"
        )
        angle.set(ylabel="phi - 180 [degrees]", title="beer frozen to its can, let go with the beer on top")
        angle.legend()
        normal.plot(times, run.forces.normal / (scene.mass * scene.gravity))
        normal.axhline(0, color="k", linewidth=0.8)
        normal.set(ylabel="N / weight", title="what the incline must push with, or pull")
        needed = np.where(run.forces.needed < 3, run.forces.needed, np.nan)
        friction.plot(times, needed)
        friction.set(
            xlabel="time [s]",
            ylabel="|F| / N",
            title="friction coefficient that rolling takes",
            ylim=(0, 3),
            xlim=normal.get_xlim(),
        )
        for axes in (angle, normal, friction):
            axes.axvline(parts, color="grey", linewidth=0.8)
        angle.annotate(
            f"the can parts at {parts:.3f} s", (parts, 60), (6, 0), textcoords="offset points", color="grey", fontsize=9
        )


def _lift_off(friction: float) -> Trajectory:
    """Return a roll-down from the top in contact, which ends after the can has left the incline."""
    return simulate(frozen(), 1.0, math.pi, rolling="contact", timestep=2e-4, friction=friction)


def _contact_at_equilibrium(part: float) -> Trajectory:
    """Return one second in contact from the equilibrium, at a friction coefficient of `part` times tan(alpha)."""
    scene = frozen()
    mu = part * math.tan(scene.incline)
    return simulate(scene, 1.0, scene.equilibrium(), rolling="contact", friction=mu)


def _draw_friction(path: pathlib.Path) -> None:
    with chart(path, width=8, height=4.5) as (axes,):
        for part in (1 - _MARGIN, 1 + _MARGIN):
            run = _contact_at_equilibrium(part)
            axes.plot(run.time, 1e3 * np.abs(run.u - run.u[0]), label=f"μ = {part:g} tan(alpha)")
        axes.set(
            xlabel="time [s]",
            ylabel="how far the can has moved [mm]",
            title="frozen beer at its equilibrium, on a 10 degree incline",
        )
        axes.legend()


def _draw_period(path: pathlib.Path) -> None:
    with chart(path, 1, 2, width=11, height=4.5) as (period, swing):
        for name, scene in (
            ("sliding beer", sliding()),
            ("pendulum in a wheel", pendulum()),
            ("frozen beer", frozen()),
        ):
            rest, (_, high) = scene.equilibrium(), scene.separatrix()
            amplitudes = (high - rest) * (1 - np.geomspace(1, 1e-4, 80))[1:]
            small = 2 * math.pi / scene.frequency()
            (line,) = period.plot(
                np.degrees(amplitudes), [scene.period(amplitude) / small for amplitude in amplitudes], label=name
            )
            few = (high - rest) * np.array([0.2, 0.4, 0.6, 0.8, 0.9])
            measured = [simulate(scene, 8, rest + amplitude, integrator=DOP853).frequency() for amplitude in few]
            period.plot(np.degrees(few), 2 * math.pi / np.array(measured) / small, "o", color=line.get_color())
            period.axvline(math.degrees(high - rest), color=line.get_color(), linewidth=0.8, linestyle=":")
        period.set(
            xlabel="amplitude downhill from the equilibrium [degrees]",
            ylabel="period / that of small swings",
            ylim=(0.9, 2.6),
            xlim=(0, 185),
            title="lines: exact theory, dots: MuJoCo",
        )
        period.legend()
        inclines = np.linspace(0.2, 25, 60)
        cans = [frozen(math.radians(incline)) for incline in inclines]
        for index, name in ((1, "rolls off downhill from here on"), (0, "swings that far uphill, at most")):
            swing.plot(inclines, [math.degrees(can.separatrix()[index]) for can in cans], label=name)
        swing.plot(inclines, [math.degrees(can.equilibrium()) for can in cans], "k--", label="equilibrium, eq. (53)")
        swing.set(
            xlabel="incline [degrees]", ylabel="phi [degrees]", title="frozen beer: where it swings", ylim=(-190, 190)
        )
        swing.legend(loc="lower right")
