"""Real liquids, which neither slide freely nor are frozen: what footnote 4 of the paper leaves open."""

import functools
import math
import pathlib

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import brentq

from mjbeer.output.plots import COLOURS, GREY, REFERENCE, THEORY, chart, label, name_below, note, ticks
from mjbeer.paper.segment import area_33
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import THICKNESS, Can
from mjbeer.theory.exact import exact
from mjbeer.theory.liquid import FILM_LOAD, LIQUIDS, NAMES, liquid_in
from mjbeer.theory.named import frozen, in_degrees, in_words, sliding
from mjbeer.theory.scene import INCLINE, Scene
from mjbeer.theory.trajectory import Trajectory

CAN = Can.sheet_metal(thickness=THICKNESS * 0.013 / Can.sheet_metal().mass)
"""A 12-oz can of 13 g, as they are sold: one of a sheet of 0.1 mm would have 8.6 g, but real ends are thicker."""
DRAG = 1.1 * 1.2 * 2 * CAN.radius * CAN.length / 2
"""Drag of the air [kg/m], C_d rho A/2, with the handbooks' C_d = 1.1 of a cylinder across the stream, 1.2 kg/m^3, and
the can seen from the front. Neither the nearby incline nor the can's rotation are in it."""
TOLERANCE = 1e-6
"""Tolerance [rad] of the simulations. It moves no mean acceleration by 1e-6 of itself."""
_WAY = 1.0
"""Length of Jackson's and of our incline [m]."""
_SLOWEST = 0.25
"""An acceleration over g sin(alpha) below all that occur: how long a run must at least take."""
_INCLINES = (2.0, 5.0, 10.0)
_VOLUMES = np.geomspace(0.3, 350, 61)
_FEW = (0.3, 2.0, 10.0, 50.0, 177.0, 350.0)
"""Volumes of water [mL]: of the lines, and of the points of exact theory."""
_ROSCH = 10.0
"""Volume [mL] near which Rosch (The College of Wooster, 2006) saw a can accelerate less."""


def water_in(volume: float, incline: float, friction: bool = True, drag: float = 0.0) -> Scene:
    """Return `CAN` with a `volume` [mL] of water in it on an `incline` [rad], with or without the water's friction."""
    area = 1e-6 * volume / (CAN.radius**2 * CAN.length)
    half_angle = float(brentq(lambda beta: area_33(beta) - area, 0, math.pi, xtol=1e-15))
    fill = math.sin(half_angle / 2) ** 2
    damping = liquid_in("water", incline, fill, CAN).damping if friction else 0.0
    return sliding(incline, fill, CAN, LIQUIDS["water"].density, damping=damping, drag=drag)


def over_first_metre(motion: Trajectory) -> float:
    """Return the mean acceleration 2 (1 m)/t^2 over the first metre from rest, over g sin(alpha).

    t is the time after which the axis has moved by a metre; between the samples it is found on the cubic through both
    positions and speeds.
    """
    way = motion.u - motion.u[0]
    after = int(np.argmax(way > _WAY))
    cubic = CubicHermiteSpline(motion.time, way - _WAY, motion.u_dot)
    time = float(brentq(cubic, motion.time[after - 1], motion.time[after], xtol=1e-14))
    return 2 * _WAY / time**2 / (motion.scene.gravity * math.sin(motion.scene.incline))


def times_of(scene: Scene) -> np.ndarray:
    """Return times [s] that last until a can let go has certainly moved by a metre."""
    slowest = _SLOWEST * scene.gravity * math.sin(scene.incline)
    return np.linspace(0, math.sqrt(2 * _WAY / slowest), 401)


def let_go(scene: Scene, times: np.ndarray) -> Trajectory:
    """Return the motion, by MuJoCo, of a can that is let go at rest with a level surface: phi = -alpha."""
    return simulate(scene, times[-1], -scene.incline, tolerance=TOLERANCE, times=times)


@functools.cache
def _simulated(incline: float, friction: bool = True, drag: float = 0.0) -> list[float]:
    """Return the mean accelerations over the first metre of all volumes, by MuJoCo. Both panels have one of these."""
    scenes = [water_in(float(volume), incline, friction, drag) for volume in _VOLUMES]
    return [over_first_metre(let_go(scene, times_of(scene))) for scene in scenes]


def film_holds(incline: float) -> float:
    """Return the volume [mL] of water that a film on the wall can hold at the end of the first metre.

    There the can has the speed that it would have with half of g sin(alpha), sqrt(g sin(alpha) 1 m).
    """
    water, gravity = LIQUIDS["water"], sliding().gravity
    speed = math.sqrt(gravity * math.sin(incline) * _WAY)
    return 1e6 * FILM_LOAD * math.sqrt(water.viscosity * speed / gravity) * CAN.radius * CAN.length


def draw_first_metre(path: pathlib.Path) -> None:
    """Draw the mean acceleration over the first metre over the water in the can, on three inclines and with air."""
    title = "The friction of a little water makes a can slower than an empty one"
    subtitle = f"12-oz can of {1e3 * CAN.mass:.3g} g with water, let go with a level surface; nothing is fitted"
    with chart(path, 1, 2, width=13, height=6, title=title, subtitle=subtitle) as (inclines, air):
        steepest = math.radians(_INCLINES[-1])
        free = [water_in(float(volume), steepest, friction=False) for volume in _VOLUMES]
        footnote = [scene.acceleration() / (scene.gravity * math.sin(steepest)) for scene in free]
        for axes in (inclines, air):
            axes.axvspan(_VOLUMES[0], film_holds(steepest), color="#EFEFEF", zorder=0)
            axes.axhline(0.5, **REFERENCE)
            axes.axhline(1.0, **REFERENCE)
            axes.plot(_VOLUMES, footnote, label="without friction, beer that does not swing: footnote 4", **THEORY)
            axes.set(xscale="log", xlim=(_VOLUMES[0], 400), ylim=(0.31, 1.08))
            ticks(axes.xaxis, (0.3, 1, 3, 10, 30, 100, 350))
        for degrees, colour in zip(_INCLINES, (COLOURS[0], COLOURS[2], COLOURS[1]), strict=True):
            incline, name = math.radians(degrees), f"MuJoCo: friction of water, {degrees:g}°"
            inclines.plot(_VOLUMES, _simulated(incline, True, 0.0), color=colour, label=name)
            theory = [water_in(volume, incline) for volume in _FEW]
            exactly = [over_first_metre(exact(scene, times_of(scene), -incline)) for scene in theory]
            inclines.plot(_FEW, exactly, ".", color="black", label="exact theory of the same")
        for name, friction, drag, line, colour in (
            ("MuJoCo: air alone, 10°", False, DRAG, ":", COLOURS[3]),
            ("MuJoCo: friction of water, 10°", True, 0.0, "-", COLOURS[1]),
            ("MuJoCo: friction of water, and air, 10°", True, DRAG, "--", COLOURS[6]),
        ):
            air.plot(_VOLUMES, _simulated(steepest, friction, drag), line, color=colour, label=name)
        ylabel = "mean acceleration over the first metre / g sin α"
        label(inclines, "water in the can [mL]", ylabel, "On three inclines, without air")
        label(air, "water in the can [mL]", ylabel, f"What the air adds, at {in_degrees(steepest)}")
        inclines.axvline(_ROSCH, ymax=0.6, linestyle="--", **REFERENCE)
        note(inclines, "Rosch: slower near 10 mL", (_ROSCH, 0.42), (6, 0))
        note(inclines, "Jackson et al.: a nearly full can comes near g sin α", (400, 1.035), (0, 0), ha="right")
        note(inclines, "Jackson et al.: a nearly empty can\nis slower than ½ g sin α", (0.33, 0.35), (0, 0))
        note(inclines, "hoop: ½", (400, 0.5), (0, 7), ha="right")
        film = "the wall could carry all of\nthe water round as a film:\nan estimate only"
        note(inclines, film, (0.33, 0.72), (0, 0))
        name_below([inclines, air], 3)


def draw_liquids(path: pathlib.Path) -> None:
    """Draw the speed of half-full cans with real liquids over time, with their terminal speeds."""
    times = np.linspace(0, 6, 601)
    scenes = {"no friction": sliding()} | {
        name: sliding(density=LIQUIDS[name].density, damping=liquid_in(name).damping) for name in NAMES
    }
    title = "From frictionless to frozen: each real liquid has a terminal speed"
    subtitle = f"{in_words(sliding(), {'load'})}; let go with a level surface; lines by MuJoCo"
    with chart(path, 1, 2, width=13, height=5.6, title=title, subtitle=subtitle) as (fast, slow):
        for (name, scene), colour in zip((scenes | {"ice": frozen()}).items(), _PAINTS, strict=True):
            run = let_go(scene, times)
            truth = exact(scene, times[::50], -INCLINE)
            for axes in (fast, slow):
                axes.plot(times, run.u_dot, color=colour, label=name)
                axes.plot(truth.time, truth.u_dot, ".", color="black", markersize=4, label="exact theory")
                if scene.dissipates:
                    axes.axhline(scene.terminal_speed(), color=colour, linestyle="--", linewidth=1)
        fast.plot([], [], "--", color=GREY, linewidth=1, label="terminal speed")
        ylabel, closer = "speed of the can down the incline [m/s]", "Glycerol, honey and ice, seen closer"
        label(fast, "time t [s]", ylabel, "All of them", xlim=(0, 6), ylim=(-0.3, 5))
        label(slow, "time t [s]", ylabel, closer, xlim=(0, 2), ylim=(-0.2, 0.6))
        name_below([fast, slow], 5)


_PAINTS = (GREY, COLOURS[0], COLOURS[4], COLOURS[2], COLOURS[1], COLOURS[3], COLOURS[5])
"""Colours of no friction, of the liquids from thin to thick, and of ice."""
