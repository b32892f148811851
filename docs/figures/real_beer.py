"""Draws real liquids, which neither slide freely nor are frozen, beside this file: `python docs/figures/real_beer.py`.

This is what footnote 4 of the paper leaves open; `docs/real_beer.md` explains it.
"""

import functools
import math
import pathlib

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import brentq

from mjbeer.drawing.words import in_degrees
from mjbeer.output.plots import COLOURS, GREY, REFERENCE, THEORY, chart, name_below, note
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import THICKNESS, Can, Damping, segment
from mjbeer.theory.liquid import LIQUIDS, NAMES, centrifugal_ratio, liquid_in
from mjbeer.theory.scene import GRAVITY, INCLINE, Scene, frozen, sliding
from mjbeer.theory.trajectory import Trajectory, exact

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
_VOLUMES = np.geomspace(1.0, 350, 61)
_FEW = (1.0, 2.0, 10.0, 50.0, 177.0, 350.0)
"""Volumes of water [mL]: of the lines, and of the points of exact theory."""
_ROSCH = 10.0
"""Volume [mL] near which Rosch (The College of Wooster, 2006) saw a can accelerate less."""
SPREAD = 2.0
"""Factor by which the friction may be wrong in the estimates: it is divided and multiplied by it."""
_SURFACE_TENSION = 0.0728
"""Surface tension of water at 20 degrees Celsius [N/m]; IAPWS."""


def water_in(volume: float, incline: float, friction: float = 1.0, drag: float = 0.0) -> Scene:
    """Return `CAN` with a `volume` [mL] of water in it on an `incline` [rad].

    `friction` is a factor of the water's torque; with 0 there is none.
    """
    area = 1e-6 * volume / (CAN.radius**2 * CAN.length)
    half_angle = float(
        brentq(lambda beta: beta - math.sin(2 * beta) / 2 - area, 0, math.pi, xtol=1e-15)
    )
    fill = math.sin(half_angle / 2) ** 2
    own = liquid_in("water", incline, fill, CAN).damping
    damping = (
        Damping(friction * own.linear, friction * own.quadratic, valid_rates=own.valid_rates)
        if friction
        else 0.0
    )
    return sliding(incline, fill, CAN, LIQUIDS["water"].density, damping=damping, drag=drag)


def capillary_length() -> float:
    """Return the depth [m] below which surface tension shapes a puddle of water more than gravity does."""
    return math.sqrt(_SURFACE_TENSION / (LIQUIDS["water"].density * GRAVITY))


def puddle(depth: float) -> float:
    """Return the volume [mL] of a liquid that lies still in `CAN` with a `depth` [m]."""
    return 1e6 * segment(depth / (2 * CAN.radius)).area * CAN.radius**2 * CAN.length


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


def lump_until(motion: Trajectory) -> float:
    """Return how far a can has come [m] when its wall's centrifugal acceleration first exceeds g cos(alpha).

    From there on the liquid need not stay at the bottom as one lump. It is infinite for a can that stays slower.
    """
    fast = np.flatnonzero(centrifugal_ratio(motion.scene, motion.u_dot) > 1)
    return float(motion.u[fast[0]] - motion.u[0]) if fast.size else math.inf


def times_of(scene: Scene) -> np.ndarray:
    """Return times [s] that last until a can let go has certainly moved by a metre."""
    slowest = _SLOWEST * scene.gravity * math.sin(scene.incline)
    return np.linspace(0, math.sqrt(2 * _WAY / slowest), 401)


def let_go(scene: Scene, times: np.ndarray) -> Trajectory:
    """Return the motion, by MuJoCo, of a can that is let go at rest with a level surface: phi = -alpha."""
    return simulate(scene, times[-1], -scene.incline, tolerance=TOLERANCE, times=times)


@functools.cache
def _simulated(
    incline: float, friction: float = 1.0, drag: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Return the mean accelerations over the first metre of all volumes, by MuJoCo, and whether each can stays slow
    enough for its liquid to be one lump."""
    scenes = [water_in(float(volume), incline, friction, drag) for volume in _VOLUMES]
    runs = [let_go(scene, times_of(scene)) for scene in scenes]
    return np.array([over_first_metre(run) for run in runs]), np.array(
        [lump_until(run) > _WAY for run in runs]
    )


def draw_first_metre(path: pathlib.Path) -> None:
    """Draw the mean acceleration over the first metre over the water in the can, on three inclines, and its spread."""
    title = "An estimate: the friction of a little water makes a can slower than an empty one"
    subtitle = f"12-oz can of {1e3 * CAN.mass:.3g} g with water, let go with a level surface; no measurement is fitted"
    with chart(path, 1, 2, width=10, height=6.6, title=title, subtitle=subtitle) as (
        inclines,
        spread,
    ):
        gentle = math.radians(_INCLINES[0])
        free = [water_in(float(volume), gentle, friction=0.0) for volume in _VOLUMES]
        footnote = [scene.acceleration() / (scene.gravity * math.sin(gentle)) for scene in free]
        for axes in (inclines, spread):
            axes.axvspan(_VOLUMES[0], puddle(capillary_length()), color="#EFEFEF", zorder=0)
            axes.axhline(0.5, **REFERENCE)
            axes.axhline(1.0, **REFERENCE)
            axes.plot(
                _VOLUMES,
                footnote,
                label="without friction, beer that does not swing: footnote 4",
                **THEORY,
            )
            axes.set(xscale="log", xlim=(_VOLUMES[0], 400), ylim=(0.27, 1.08))
            marks = (1, 3, 10, 30, 100, 350)
            axes.set_xticks(marks, map(str, marks))
            axes.tick_params(which="minor", labelbottom=False)
        for degrees in _INCLINES:
            incline = math.radians(degrees)
            mean, lump = _simulated(incline)
            inclines.plot(_VOLUMES, mean, **_BEYOND)
            if lump.any():
                named = f"MuJoCo: friction of water, {degrees:g}°"
                inclines.plot(_VOLUMES, np.where(lump, mean, np.nan), color=COLOURS[0], label=named)
            theory = [water_in(volume, incline) for volume in _FEW]
            exactly = [
                over_first_metre(exact(scene, times_of(scene), -incline)) for scene in theory
            ]
            inclines.plot(
                _FEW, exactly, ".", color="black", markersize=4, label="exact theory of the same"
            )
        mean, lump = _simulated(gentle)
        most, least = _simulated(gentle, 1 / SPREAD)[0], _simulated(gentle, SPREAD)[0]
        band = f"the friction divided or multiplied by {SPREAD:g}"
        spread.fill_between(
            _VOLUMES, least, most, color=COLOURS[5], alpha=0.3, linewidth=0, label=band
        )
        spread.plot(_VOLUMES, mean, **_BEYOND)
        spread.plot(_VOLUMES, np.where(lump, mean, np.nan), color=COLOURS[0])
        with_air = _simulated(gentle, 1.0, DRAG)[0]
        spread.plot(
            _VOLUMES,
            with_air,
            "--",
            color=COLOURS[1],
            linewidth=1.2,
            label="MuJoCo: with the air as well, 2°",
        )
        ylabel = "mean acceleration over the first metre / g sin α"
        inclines.set(
            xlabel="water in the can [mL]", ylabel=ylabel, title="On three inclines, without air"
        )
        spread.set(
            xlabel="water in the can [mL]",
            ylabel=ylabel,
            title=f"How sure it is, at {in_degrees(gentle)}",
        )
        for axes in (inclines, spread):
            axes.plot([], [], label=_TOO_FAST, **_BEYOND)
        inclines.axvline(_ROSCH, ymax=0.6, linestyle="--", **REFERENCE)
        note(inclines, "Rosch: slower near 10 mL", (_ROSCH, 0.38), (6, 0))
        note(
            inclines,
            "Jackson et al.: a nearly full can comes near g sin α",
            (400, 1.035),
            (0, 0),
            ha="right",
        )
        note(
            inclines,
            "Jackson et al.: a nearly empty can\nis slower than ½ g sin α",
            (0.33, 0.33),
            (0, 0),
        )
        steepest_first = ", ".join(f"{each:g}°" for each in _INCLINES[::-1])
        note(inclines, f"from above: {steepest_first}", (400, 0.57), (0, 0), ha="right")
        note(inclines, "hoop: ½", (400, 0.5), (0, 7), ha="right")
        depth = f"a puddle less than {1e3 * capillary_length():.1f} mm deep,\nwhich surface tension shapes"
        note(inclines, depth, (0.33, 0.74), (0, 0))
        name_below([inclines, spread], 2)


def draw_liquids(path: pathlib.Path) -> None:
    """Draw the speed of half-full cans with real liquids over time, with their terminal speeds in this model."""
    times = np.linspace(0, 6, 601)
    scenes = {"no friction": sliding()} | {
        name: sliding(density=LIQUIDS[name].density, damping=liquid_in(name).damping)
        for name in NAMES
    }
    title = "From frictionless to frozen: a lump of liquid comes to a terminal speed"
    subtitle = f"half-full massless can, incline {in_degrees(INCLINE)}; let go with a level surface; lines by MuJoCo"
    with chart(path, 1, 2, width=10, height=5.6, title=title, subtitle=subtitle) as (fast, slow):
        for (name, scene), colour in zip(
            (scenes | {"ice": frozen()}).items(), _PAINTS, strict=True
        ):
            run = let_go(scene, times)
            truth = exact(scene, times[::50], -INCLINE)
            real = name in NAMES
            whole = math.inf if not real else lump_until(run)
            lump = run.u - run.u[0] < whole
            for axes in (fast, slow):
                if not lump.all():
                    axes.plot(times, run.u_dot, **(_BEYOND | {"color": colour}))
                axes.plot(times, np.where(lump, run.u_dot, np.nan), color=colour, label=name)
                axes.plot(
                    truth.time, truth.u_dot, ".", color="black", markersize=4, label="exact theory"
                )
                if real and lump.all():
                    axes.axhline(scene.terminal_speed(), color=colour, linestyle="--", linewidth=1)
            if not lump.all():
                note(fast, name, (times[-1], run.u_dot[-1]), (-4, 8), ha="right")
        fast.plot([], [], "--", color=GREY, linewidth=1, label="terminal speed")
        fast.plot([], [], label=_TOO_FAST, **(_BEYOND | {"color": GREY}))
        ylabel, closer = "speed of the can down the incline [m/s]", "The slow ones, seen closer"
        fast.set(
            xlabel="time t [s]", ylabel=ylabel, title="All of them", xlim=(0, 6), ylim=(-0.3, 5)
        )
        slow.set(xlabel="time t [s]", ylabel=ylabel, title=closer, xlim=(0, 2), ylim=(-0.2, 0.6))
        name_below([fast, slow], 5)


_BEYOND = {"color": COLOURS[0], "linestyle": ":", "linewidth": 1.3}
_TOO_FAST = "beyond the model: too fast for the liquid to stay below"
"""Look and name of motions in which the wall's centrifugal acceleration exceeds gravity's part across the incline."""
_PAINTS = (GREY, COLOURS[0], COLOURS[4], COLOURS[2], COLOURS[1], COLOURS[3], COLOURS[5])
"""Colours of no friction, of the liquids from thin to thick, and of ice."""

if __name__ == "__main__":
    draw_first_metre(pathlib.Path(__file__).with_name("real-beer"))
    draw_liquids(pathlib.Path(__file__).with_name("liquids"))
