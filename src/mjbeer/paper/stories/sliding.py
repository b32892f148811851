"""Stories of section 2: beer that slides in a massless can."""

import math
import pathlib
from collections.abc import Iterator
from functools import partial

import numpy as np

from mjbeer.drawing.film import Take
from mjbeer.drawing.look import Look
from mjbeer.model.setting import DOP853
from mjbeer.output.plots import chart
from mjbeer.paper.equations import sliding as equations
from mjbeer.paper.letters import Letters
from mjbeer.paper.looping import loop
from mjbeer.paper.scenarios import DECADE
from mjbeer.paper.stories.story import Story
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.scene import Scene, sliding
from mjbeer.theory.trajectory import Trajectory

_SMALL = 0.2
"""Amplitude [rad] of the swing that shows the hesitation."""
_METAL = Can.sheet_metal()
_TRIVIAL = Look("Let go with its surface along the incline, beer does not swing", ("phi", "u"), ("phi",))
_HESITATION = Look("A can hesitates in every swing of its beer", ("phi", "ahead"), ("phi", "ghost"))
_RELEASE = Look("Let go with its surface level, beer swings", ("phi", "ahead"), ("phi", "ghost"))
_LOOPING = Look("Beer that loops in its can", ("phi", "normal"), ("phi", "forces"))


def stories() -> Iterator[Story]:
    """Yield the stories of this chapter."""
    yield Story(
        "trivial",
        "Beer that starts with its surface parallel to the incline keeps it so, and the can rolls down with exactly "
        "g sin(alpha). Beer let go at 60 degrees swings, but its centre of mass moves down the incline just the same.",
        draw=_draw_trivial,
        film=Take(partial(simulate, sliding(), 1.0, 0.0, integrator=DOP853), speed=0.25, look=_TRIVIAL),
    )
    yield Story(
        "hesitation",
        "The can hesitates once in every swing of the beer: its distance minus g sin(alpha) t^2/2 swings with the "
        "beer's frequency and the amplitude b phi_0. Eq. (25) as printed has a far smaller ripple at twice that "
        "frequency.",
        draw=_draw_hesitation,
        film=Take(partial(simulate, sliding(can=_METAL), 1.0, 0.6, integrator=DOP853), speed=0.25, look=_HESITATION),
    )
    yield Story(
        "release",
        "A can is held until its beer is level and then let go, so that phi starts at -alpha. The steeper the incline, "
        "the wider the swing, and the slower it is in comparison with small swings.",
        draw=_draw_release,
        film=Take(partial(_level_start, 40.0, periods=2.0), speed=0.1, look=_RELEASE),
    )
    yield Story(
        "looping",
        "Beer that loops fast in its can: the difference between phi and an even rotation, over one turn. Eq. (26) "
        "has only the ripple at Omega; the one at 2 Omega remains however fast the beer spins. A real can can do "
        "neither of these two motions, since nothing holds it down: if phi_dot at the bottom exceeds 47 rad/s, the "
        "beer lifts it off the incline. In the film it is 45 rad/s.",
        draw=_draw_looping,
        film=Take(partial(simulate, sliding(can=_METAL), 0.5, 0.0, 45.0, integrator=DOP853), speed=0.1, look=_LOOPING),
    )
    yield Story(
        "ripples",
        "Both ripples over a decade of the mean rate Omega. The one at Omega falls in proportion to 1/Omega^2 and is "
        "8 % smaller than by eq. (28); the one at 2 Omega does not change.",
        draw=_draw_ripples,
    )


def _unsteady_distance(run: Trajectory) -> np.ndarray:
    """Return u - g sin(alpha) t^2/2 [m], how far the can is ahead of one that accelerates steadily."""
    return run.u - run.scene.acceleration() * run.time**2 / 2


def _draw_trivial(path: pathlib.Path) -> None:
    scene = sliding()
    times = np.linspace(0, 1, 501)
    runs = {
        f"let go at {degrees:g} degrees": simulate(
            scene, 1.0, math.radians(degrees), integrator=DOP853, timestep=1e-3, times=times
        )
        for degrees in (0, 60)
    }
    with chart(path, 1, 2, width=10, height=4) as (position, angle):
        for name, run in runs.items():
            position.plot(times, run.u - run.u[0], label=name)
            angle.plot(times, np.degrees(run.phi), label=name)
        tenths = times[::50]
        position.plot(tenths, scene.acceleration() * tenths**2 / 2, "k.", label="g sin(alpha) t²/2")
        position.set(xlabel="time [s]", ylabel="distance of the can's axis [m]", title="how far the can is")
        angle.set(xlabel="time [s]", ylabel="surface to incline, phi [degrees]", title="how the beer lies")
        position.legend()


def _draw_hesitation(path: pathlib.Path) -> None:
    scene = sliding()
    b, omega = scene.load.offset, scene.frequency()
    times = np.linspace(0, 1, 501)
    run = simulate(scene, 1.0, _SMALL, integrator=DOP853, times=times)
    printed = b * (1 - _SMALL**2 / 4 + _SMALL**2 * np.cos(2 * omega * times) / 2)
    with chart(path, width=9, height=4.5) as (axes,):
        axes.plot(times, 1e3 * _unsteady_distance(run), label="MuJoCo")
        axes.plot(
            times[::10],
            1e3 * b * _SMALL * np.cos(omega * times[::10]),
            "k.",
            label="b phi₀ cos(ωt), eq. (25) corrected",
        )
        axes.plot(times, 1e3 * (printed - b), "--", label="eq. (25) as printed, less b: at 2ω")
        axes.set(
            xlabel="time [s]",
            ylabel="u - g sin(alpha) t²/2 [mm]",
            title=f"the can's hesitation, beer let go at {math.degrees(_SMALL):.0f} degrees",
        )
        axes.set_ylim(-3.2, 4.2)
        axes.legend(loc="upper center", ncols=3, fontsize=9)


def _level_start(degrees: float, periods: float = 3.0) -> Trajectory:
    """Return the swing of beer that starts level, over a number of periods of a small oscillation."""
    scene = sliding(math.radians(degrees))
    return simulate(scene, periods * 2 * math.pi / scene.frequency(), -scene.incline, integrator=DOP853)


def _draw_release(path: pathlib.Path) -> None:
    with chart(path, width=9, height=4.5) as (axes,):
        for degrees in (5.0, 20.0, 40.0, 70.0):
            run = _level_start(degrees, periods=3)
            swings = run.time * run.scene.frequency() / (2 * math.pi)
            axes.plot(swings, run.phi / run.scene.incline, label=f"incline {degrees:g} degrees")
        small = np.linspace(0, 3, 61)
        axes.plot(small, -np.cos(2 * math.pi * small), "k.", label="small oscillations, eq. (24)")
        axes.set(
            xlabel="time in periods of a small oscillation",
            ylabel="phi / alpha",
            xlim=(0, 3),
            ylim=(-1.1, 1.7),
            title="beer let go with a level surface",
        )
        axes.legend(loc="upper center", ncols=3, fontsize=9)


def _draw_looping(path: pathlib.Path) -> None:
    scene = sliding()
    c = Letters.of(scene)
    with chart(path, 1, 2, width=11, height=4.5) as both:
        for axes, start in zip(both, (60.0, 400.0), strict=True):
            turn = loop(scene, start)
            phase = np.linspace(0, 2 * math.pi, 201)
            phi = sum(turn.phi[k] * np.sin(k * phase) for k in range(1, 40))
            printed = equations.epsilon_28(c, turn.rate) * np.sin(phase)
            right = equations.corrected_28(c, turn.rate) * np.sin(phase) + equations.ripple_26(c) * np.sin(2 * phase)
            x = np.degrees(phase)
            axes.plot(x, np.degrees(phi), label="MuJoCo")
            axes.plot(x[::8], np.degrees(right[::8]), "k.", label="with the ripple at 2Ω, to first order")
            axes.plot(x, np.degrees(printed), "--", label="eq. (26) with (28)")
            axes.set(
                xlabel="Ωt [degrees]",
                ylabel="phi - Ωt [degrees]",
                title=f"Ω = {turn.rate:.0f} rad/s",
                xticks=range(0, 361, 90),
            )
        both[0].set_ylim(-10, 16)
        both[0].legend(loc="upper right")


def _draw_ripples(path: pathlib.Path) -> None:
    scene: Scene = sliding()
    c = Letters.of(scene)
    turns = [loop(scene, start) for start in np.geomspace(DECADE[0], DECADE[-1], 9)]
    rates = np.array([turn.rate for turn in turns])
    line = np.geomspace(rates[0], rates[-1], 50)
    with chart(path, width=8, height=5) as (axes,):
        axes.loglog(rates, [math.degrees(turn.phi[1]) for turn in turns], "o", label="at Ω, MuJoCo")
        axes.loglog(rates, [math.degrees(turn.phi[2]) for turn in turns], "s", label="at 2Ω, MuJoCo")
        axes.loglog(line, np.degrees(equations.epsilon_28(c, line)), "--", label="ε, eq. (28)")
        axes.loglog(line, np.degrees(equations.corrected_28(c, line)), label="ε (1 - 3δ/8)")
        axes.loglog(line, np.degrees(np.full_like(line, equations.ripple_26(c))), label="δ/4, not in the paper")
        axes.set(xlabel="mean rate Ω [rad/s]", ylabel="amplitude in phi [degrees]", title="ripples of looping beer")
        axes.legend()
