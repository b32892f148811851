"""Draws how real liquids swing, and how they roll, beside this file.

They swing faster than the paper says, and neither slide freely nor are frozen, which footnote 4 of
the paper leaves open. `docs/real_beer.md` and `docs/rolling-liquids.md` explain it. Run it as
`python docs/figures/real_beer.py`.
"""

import functools
import math
import pathlib
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import brentq

from mjbeer.drawing.words import in_degrees
from mjbeer.output.plots import COLOURS, GREY, REFERENCE, THEORY, chart, name_below, note
from mjbeer.simulation.simulate import simulate
from mjbeer.theory import slosh
from mjbeer.theory.can import THICKNESS, Can
from mjbeer.theory.equations import slip_rate_of
from mjbeer.theory.liquid import centrifugal_ratio, film_share, liquid, liquid_in
from mjbeer.theory.liquid_damping import COATING_SHARE
from mjbeer.theory.liquid_properties import LIQUIDS, NAMES
from mjbeer.theory.paper_scenes import frozen, sliding
from mjbeer.theory.scene import GRAVITY, Scene
from mjbeer.theory.segment import segment
from mjbeer.theory.trajectory import Trajectory, exact

CAN = Can.sheet_metal(thickness=THICKNESS * 0.013 / Can.sheet_metal().mass)
"""A 12-oz can of 13 g, as they are sold.

One of a sheet of 0.1 mm would have 8.6 g, but real ends are thicker.
"""
DRAG = 1.1 * 1.2 * 2 * CAN.radius * CAN.length / 2
"""Drag of the air [kg/m], C_d rho A/2.

C_d = 1.1 is the handbooks' of a cylinder across the stream, rho is 1.2 kg/m^3, and A is that of the
can seen from the front. Neither the nearby incline nor the can's rotation are in it.
"""
TOLERANCE = 1e-6
"""Tolerance [rad] of the simulations. It moves no mean acceleration by 1e-6 of itself."""
_WAY = 1.0
"""Length of Jackson's and of our incline [m]."""
_SLOWEST = 0.25
"""An acceleration, divided by g sin(alpha), below all that occur: it tells how long to run."""
_INCLINES = (2.0, 5.0, 10.0)
"""[degrees]"""
_VOLUMES = np.geomspace(1.0, 350, 61)
"""Volumes of water [mL] of the lines."""
_FEW = (1.0, 2.0, 10.0, 50.0, 177.0, 350.0)
"""Volumes of water [mL] of the points of exact theory."""
_ROSCH = 10.0
"""Volume [mL] near which Rosch (The College of Wooster, 2006) saw a can accelerate less."""
_INSIDE = 20.0
"""Volume of water [mL] of the title.

On the gentlest incline this much stays inside the model for the whole metre.
"""
SPREAD = 2.0
"""Factor by which the friction may be wrong: the estimates divide and multiply it by this."""
SWING = 0.15
"""Tilt [rad] with which the beer of the swing is let go: linear theory holds up to 0.2."""
_SURFACE_TENSION = 0.0728
"""Surface tension of water at 20 degrees Celsius [N/m]; IAPWS."""
_FAST = 1.8
"""The largest speed [m/s] in the plot of all liquids."""
_SLOW = 0.1
"""The largest speed [m/s] in the plot of the slow ones."""
_SEEN_CLOSER = 2.0
"""How long the slow ones are shown [s]."""
_BEYOND = {"color": COLOURS[0], "linestyle": ":", "linewidth": 1.3}
"""Look of motions in which the liquid need not stay below as one lump."""
_NO_LUMP = "beyond the model: the liquid need not stay below"
"""Their name."""
_POINTS = {"color": "black", "linestyle": "", "marker": ".", "markersize": 4}
"""Look of points of exact theory."""
_PAINTS = (GREY, COLOURS[0], COLOURS[4], COLOURS[2], COLOURS[1], COLOURS[3], COLOURS[5])
"""Colours of no friction, of the liquids from thin to thick, and of ice."""


def water_in(volume: float, incline: float, friction: float = 1.0, drag: float = 0.0) -> Scene:
    """Return `CAN` with a `volume` [mL] of water in it on an `incline` [rad].

    `friction` is a factor of the water's torque; with 0 there is none.
    """
    area = 1e-6 * volume / (CAN.radius**2 * CAN.length)

    def excess(beta: float) -> float:
        return beta - math.sin(2 * beta) / 2 - area

    half_angle = float(brentq(excess, 0, math.pi, xtol=1e-15))
    fill = math.sin(half_angle / 2) ** 2
    density = LIQUIDS["water"].density
    if not friction:
        return sliding(incline, fill, CAN, density, drag=drag)
    used = liquid_in("water", incline, fill, CAN)
    own = used.damping
    linear = friction * own.linear
    quadratic = friction * own.quadratic
    damping = replace(own, linear=linear, quadratic=quadratic)
    return Scene(CAN, used.swing.load, incline, damping=damping, drag=drag)


def capillary_length() -> float:
    """Return the depth [m] below which surface tension shapes a puddle more than gravity does."""
    return math.sqrt(_SURFACE_TENSION / (LIQUIDS["water"].density * GRAVITY))


def puddle(depth: float) -> float:
    """Return the volume [mL] of a liquid that lies still in `CAN` with a `depth` [m]."""
    return 1e6 * segment(depth / (2 * CAN.radius)).area * CAN.radius**2 * CAN.length


def over_first_metre(motion: Trajectory) -> float:
    """Return the mean acceleration 2 (1 m)/t^2 over the first metre, divided by g sin(alpha).

    t is the time after which the axis has moved by a metre from rest. Between the samples it is
    found on the cubic through both positions and speeds.
    """
    way = motion.u - motion.u[0]
    after = int(np.argmax(way > _WAY))
    cubic = CubicHermiteSpline(motion.time, way - _WAY, motion.u_dot)
    time = float(brentq(cubic, motion.time[after - 1], motion.time[after], xtol=1e-14))
    return 2 * _WAY / time**2 / (motion.scene.gravity * math.sin(motion.scene.incline))


def lump_until(motion: Trajectory) -> float:
    """Return how far a can has come [m] when its liquid need no longer stay below as one lump.

    From there on `liquid_warnings` say so: the wall's centrifugal acceleration exceeds
    g cos(alpha), or a film on the wall can hold a third of the liquid. It is infinite for a liquid
    that stays one lump. Between the samples it is found on a straight line.
    """
    scene = motion.scene
    way = motion.u - motion.u[0]
    rates = np.abs(slip_rate_of(scene, motion.phi_dot, motion.u_dot))
    turns = np.abs(way) / (math.tau * scene.can.radius)
    pairs = zip(np.maximum.accumulate(rates), np.maximum.accumulate(turns), strict=True)
    films = np.array([film_share(scene, rate, turn) for rate, turn in pairs])
    # 1 is a limit of the model.
    used = np.maximum(centrifugal_ratio(scene, motion.u_dot), films / COATING_SHARE)
    if used.max() <= 1:
        return math.inf
    after = int(np.argmax(used > 1))
    around = slice(after - 1, after + 1)
    return float(np.interp(1.0, used[around], way[around]))


def times_of(scene: Scene) -> np.ndarray:
    """Return times [s] that last until a can let go has certainly moved by a metre."""
    slowest = _SLOWEST * scene.gravity * math.sin(scene.incline)
    return np.linspace(0, math.sqrt(2 * _WAY / slowest), 401)


def let_go(scene: Scene, times: np.ndarray) -> Trajectory:
    """Return the motion, by MuJoCo, of a can that is let go at rest with a level surface.

    It begins with phi = -alpha.
    """
    return simulate(scene, times[-1], -scene.incline, tolerance=TOLERANCE, times=times)


@functools.cache
def _simulated(
    incline: float, friction: float = 1.0, drag: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Return the mean accelerations over the first metre of all volumes, by MuJoCo.

    Then whether the liquid of each stays one lump.
    """
    scenes = [water_in(float(volume), incline, friction, drag) for volume in _VOLUMES]
    runs = [let_go(scene, times_of(scene)) for scene in scenes]
    mean = np.array([over_first_metre(run) for run in runs])
    lump = np.array([lump_until(run) > _WAY for run in runs])
    return mean, lump


def draw_swing(path: pathlib.Path) -> None:
    """Draw a swing of beer in a half-full can, with its can, as the paper and as a liquid has it.

    A grey line has all modes of the liquid without viscosity.
    """
    times = np.linspace(0, 0.6, 301)
    density = LIQUIDS["beer"].density
    scenes = {
        "the paper's beer, a solid that slides": sliding(0.0, 0.5, CAN, density),
        "liquid beer: the slowest mode": liquid("beer", 0.0, 0.5, CAN),
    }
    paper, beer = scenes.values()
    ratio = beer.frequency() / paper.frequency()
    title = f"Liquid beer swings {ratio:.2f} times as fast as the paper's solid beer"
    subtitle = (
        f"half-full 12-oz can of {1e3 * CAN.mass:.3g} g on level ground; let go at {SWING:g} rad; "
        "lines: MuJoCo; points: exact theory"
    )
    with chart(path, 2, 1, width=8, height=6.6, title=title, subtitle=subtitle) as (tilts, places):
        for (name, scene), colour in zip(scenes.items(), (COLOURS[0], COLOURS[1]), strict=True):
            run = simulate(scene, times[-1], SWING, tolerance=TOLERANCE, times=times)
            truth = exact(scene, times[::10], SWING)
            named = f"{name}, {scene.frequency() / math.tau:.1f} Hz"
            tilts.plot(times, run.phi, color=colour, label=named)
            places.plot(times, 1e3 * run.distance, color=colour)
            tilts.plot(truth.time, truth.phi, **_POINTS)
            places.plot(truth.time, 1e3 * truth.distance, **_POINTS)
            _draw_all_modes(scene, times, tilts, places)
        tilts.set(title="The surface of the beer", ylabel="tilt φ [rad]")
        places.set(title="The can", ylabel="u from the start [mm]", xlabel="time t [s]")
        tilts.tick_params(labelbottom=False)
        for axes in (tilts, places):
            axes.set_xlim(0, times[-1])
        name_below([tilts, places], 1)


def _draw_all_modes(scene: Scene, times: np.ndarray, tilts: Axes, places: Axes) -> None:
    """Draw the mean tilt of a liquid whose flat surface is let go, and the place of its can."""
    if scene.load.sloshes_in is None:
        return
    modes = slosh.rolling(0.5, scene.effective_mass / scene.load.mass)
    rates = modes.frequencies(scene.can.radius, scene.gravity)
    tilt = SWING * np.cos(np.outer(times, rates)) @ modes.energy_shares
    look = THEORY | {"linewidth": 4}
    tilts.plot(
        times, tilt, label="liquid beer: all modes, by linear theory without viscosity", **look
    )
    places.plot(times, 1e3 * modes.arm * scene.can.radius * (tilt - SWING), **look)


def draw_first_metre(path: pathlib.Path) -> None:
    """Draw the mean acceleration over the first metre against the water in the can.

    The left panel has three inclines, the right one the spread on the gentlest.
    """
    gentle = math.radians(_INCLINES[0])
    accelerations = []
    for friction in (SPREAD, 1.0, 1 / SPREAD):
        scene = water_in(_INSIDE, gentle, friction)
        accelerations.append(over_first_metre(let_go(scene, times_of(scene))))
    least, mean, most = accelerations
    title = (
        f"An estimate: {_INSIDE:g} mL of water slow a can to {mean:.2f} g sin α "
        f"({least:.2f} to {most:.2f})"
    )
    subtitle = (
        f"12-oz can of {1e3 * CAN.mass:.3g} g with water, let go on {in_degrees(gentle)} with a "
        "level surface; in brackets: friction doubled to halved. Points are exact theory. What "
        "Jackson (1996) and Rosch (2006) measured is not fitted."
    )
    with chart(path, 1, 2, width=9, height=6.2, title=title, subtitle=subtitle) as panels:
        inclines, spread = panels
        for axes in panels:
            _prepare_first_metre(axes)
        _draw_inclines(inclines)
        _draw_spread(spread)
        spread.plot(_INSIDE, mean, "o", color=COLOURS[0])
        _note_facts(inclines)
        (lump,) = inclines.plot([], [], color=COLOURS[0], label="MuJoCo: friction of water")
        (fast,) = inclines.plot([], [], label=_NO_LUMP, **_BEYOND)
        name_below([inclines], 2, [lump, fast])


def _prepare_first_metre(axes: Axes) -> None:
    """Set the axes of a panel of the first metre, and draw what footnote 4 of the paper says."""
    gentle = math.radians(_INCLINES[0])
    free = [water_in(float(volume), gentle, friction=0.0) for volume in _VOLUMES]
    footnote = [scene.acceleration() / (scene.gravity * math.sin(gentle)) for scene in free]
    axes.axvspan(_VOLUMES[0], puddle(capillary_length()), color="#EFEFEF", zorder=0)
    axes.axhline(0.5, **REFERENCE)
    axes.axhline(1.0, **REFERENCE)
    axes.plot(_VOLUMES, footnote, **THEORY)
    axes.set(xscale="log", xlim=(_VOLUMES[0], 400), ylim=(0.25, 1.1))
    marks = (1, 3, 10, 30, 100, 350)
    axes.set_xticks(marks, map(str, marks))
    axes.tick_params(which="minor", labelbottom=False)
    axes.set_xlabel("water in the can [mL]")


def _draw_inclines(axes: Axes) -> None:
    """Draw the mean accelerations on three inclines, by MuJoCo and by exact theory."""
    for degrees in _INCLINES:
        incline = math.radians(degrees)
        mean, lump = _simulated(incline)
        axes.plot(_VOLUMES, mean, **_BEYOND)
        if lump.any():
            axes.plot(_VOLUMES, np.where(lump, mean, np.nan), color=COLOURS[0])
        theory = [water_in(volume, incline) for volume in _FEW]
        motions = [exact(scene, times_of(scene), -incline) for scene in theory]
        axes.plot(_FEW, [over_first_metre(motion) for motion in motions], **_POINTS)
    axes.set_title("On three inclines, without air")
    axes.set_ylabel("mean acceleration over the first metre / g sin α")


def _draw_spread(axes: Axes) -> None:
    """Draw the mean acceleration on the gentle incline with other friction, and with air."""
    gentle = math.radians(_INCLINES[0])
    mean, lump = _simulated(gentle)
    most, _ = _simulated(gentle, 1 / SPREAD)
    least, _ = _simulated(gentle, SPREAD)
    with_air, _ = _simulated(gentle, 1.0, DRAG)
    axes.fill_between(_VOLUMES, least, most, color=COLOURS[5], alpha=0.3, linewidth=0)
    axes.plot(_VOLUMES, mean, **_BEYOND)
    axes.plot(_VOLUMES, np.where(lump, mean, np.nan), color=COLOURS[0])
    axes.plot(_VOLUMES, with_air, "--", color=COLOURS[1], linewidth=1.2)
    axes.set_title(f"How sure it is, on {in_degrees(gentle)}")
    axes.tick_params(labelleft=False)
    note(axes, "with air as well", (1.15, 0.35), (0, 0), color=COLOURS[1])
    note(axes, "friction doubled\nto halved (band)", (40, 0.44), (4, 0), color=COLOURS[0])


def _note_facts(axes: Axes) -> None:
    """Write what others measured into a panel, and what its lines are."""
    thin = f"a puddle\nunder {1e3 * capillary_length():.1f} mm:\nsurface tension\nshapes it"
    steepest_first = ", ".join(f"{degrees:g}°" for degrees in _INCLINES[::-1])
    axes.axvline(_ROSCH, ymax=0.6, linestyle="--", **REFERENCE)
    note(axes, "Jackson measured: nearly\nfull cans come near g sin α", (1.1, 1.05), (0, 0))
    note(axes, thin, (1.1, 0.85), (0, 0))
    note(axes, "Rosch measured:\nslower near 10 mL", (_ROSCH, 0.36), (6, 0))
    note(axes, "Jackson measured:\nnearly empty cans\nare below ½", (1.1, 0.32), (0, 0))
    note(axes, "hoop: ½", (400, 0.5), (0, 7), ha="right")
    note(axes, f"{steepest_first}\nfrom above", (45, 0.63), (10, 0), color=COLOURS[0])
    note(axes, "no friction (grey,\nas in the paper)", (1.1, 0.65), (0, 0))


def draw_liquids(path: pathlib.Path) -> None:
    """Draw the speed of half-full cans with real liquids against time.

    Their terminal speeds in this model are drawn as well.
    """
    gentle = math.radians(_INCLINES[0])
    times = np.linspace(0, 12, 1201)
    scenes = {"no friction": sliding(gentle)}
    for name in NAMES:
        used = liquid_in(name, gentle)
        scenes[name] = Scene(Can(), used.swing.load, gentle, damping=used.damping)
    scenes["ice"] = frozen(gentle)
    # On this incline these two, and glycerol, stay inside the model.
    of_oil = 100 * scenes["olive oil"].terminal_speed()
    of_honey = 100 * scenes["honey"].terminal_speed()
    title = (
        f"Cans reach a terminal speed: {of_oil:.0f} cm/s with olive oil, "
        f"{of_honey:.1f} cm/s with honey"
    )
    subtitle = (
        f"half-full massless can, incline {in_degrees(gentle)}; let go with a level surface; "
        "lines by MuJoCo, points are exact theory"
    )
    with chart(path, 1, 2, width=9, height=5.6, title=title, subtitle=subtitle) as (fast, slow):
        for (name, scene), colour in zip(scenes.items(), _PAINTS, strict=True):
            run = let_go(scene, times)
            truth = exact(scene, times[::50], -gentle)
            is_real = name in NAMES
            whole = lump_until(run) if is_real else math.inf
            lump = run.u - run.u[0] < whole
            for axes, last in ((fast, times[-1]), (slow, _SEEN_CLOSER)):
                shown = times <= last
                speed = np.where(lump, run.u_dot, np.nan)
                if not lump.all():
                    axes.plot(times[shown], run.u_dot[shown], **(_BEYOND | {"color": colour}))
                axes.plot(times[shown], speed[shown], color=colour)
                axes.plot(truth.time[shown[::50]], truth.u_dot[shown[::50]], **_POINTS)
                if is_real and lump.all():
                    terminal = [scene.terminal_speed()] * 2
                    axes.plot([0, last], terminal, color=colour, linestyle="--", linewidth=1)
            end = float(np.interp(_SEEN_CLOSER, times, run.u_dot))
            if end < _SLOW:
                if is_real:
                    note(slow, name, (_SEEN_CLOSER, end), (6, 0), color=colour)
                else:
                    words = f"{name}: no\nterminal speed"
                    note(slow, words, (_SEEN_CLOSER, end), (6, 18), color=colour)
            elif is_real:
                note(fast, name, (times[-1], run.u_dot[-1]), (-4, 8), color=colour, ha="right")
            else:
                high = 0.95 * _FAST
                steepest = int(np.argmax(run.u_dot > high))
                note(
                    fast,
                    f"{name}: no terminal speed",
                    (times[steepest], high),
                    (6, 0),
                    color=colour,
                )
        note(fast, "glycerol, honey, ice", (times[-1], 0.05), (-4, 7), ha="right")
        (terminal,) = fast.plot([], [], "--", color=GREY, linewidth=1, label="terminal speed")
        (beyond,) = fast.plot([], [], label=_NO_LUMP, **(_BEYOND | {"color": GREY}))
        for axes in (fast, slow):
            axes.set_xlabel("time t [s]")
        slow.set_ylabel("speed [m/s]")
        fast.set_ylabel("speed of the can down the incline [m/s]")
        fast.set(title="All of them", xlim=(0, times[-1]), ylim=(-0.1, _FAST))
        slow.set(title="The slow ones, seen closer", xlim=(0, 1.36 * _SEEN_CLOSER))
        slow.set(ylim=(-0.045, _SLOW), xticks=np.linspace(0, _SEEN_CLOSER, 5))
        name_below([fast], 2, [terminal, beyond])


if __name__ == "__main__":
    draw_swing(pathlib.Path(__file__).with_name("swing"))
    draw_first_metre(pathlib.Path(__file__).with_name("real-beer"))
    draw_liquids(pathlib.Path(__file__).with_name("liquids"))
