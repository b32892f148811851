"""Draws the sketches of `docs/how-it-works.md`, `real_beer.md` and `physics.md`.

Run it as `python docs/figures/sketches.py`.
"""

import math
import pathlib

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from mjbeer import Can, Scene, frozen
from mjbeer.output.plots import COLOURS, GREY, chart
from mjbeer.theory.liquid_properties import LIQUIDS

HERE = pathlib.Path(__file__).parent
BEER = "#E8A33D"
SURFACE = "#A05A00"
LETTER = COLOURS[0]
FORCE = COLOURS[1]
ARC = COLOURS[0]
OTHER_ARC = COLOURS[2]
TURNS = COLOURS[1]


def on_circle(angle: float | np.ndarray, radius: float = 1.0) -> np.ndarray:
    """Return points at angles [rad] from straight down, counterclockwise."""
    return radius * np.transpose([np.sin(angle), -np.cos(angle)])


def arrow(
    axes: Axes,
    start: np.ndarray,
    end: np.ndarray,
    colour: str,
    style: str = "-|>",
    **more: str | float,
) -> None:
    """Draw an arrow."""
    look = {
        "arrowstyle": style,
        "color": colour,
        "shrinkA": 0,
        "shrinkB": 0,
        "linewidth": 1.4,
    } | more
    axes.annotate("", tuple(end), tuple(start), arrowprops=look)


def can(axes: Axes, half_angle: float, turned: float) -> None:
    """Draw a can of radius 1 and its load, a segment.

    The middle of the segment is `turned` from the bottom by an angle [rad].
    """
    axes.set_axis_off()
    axes.set_aspect("equal")
    axes.plot(*on_circle(np.linspace(0, 2 * math.pi, 361)).T, color="black", linewidth=1.5)
    wet = on_circle(turned + np.linspace(-half_angle, half_angle, 181))
    axes.fill(*wet.T, color=BEER, alpha=0.5, linewidth=0)
    axes.plot(*wet[[0, -1]].T, color=SURFACE, linewidth=1.5)
    axes.plot(0, 0, "o", color="black", markersize=4)


def write(
    axes: Axes, text: str, place: tuple[float, float], colour: str = "black", **style: str
) -> None:
    """Write a text at a place."""
    axes.text(*place, text, color=colour, **({"ha": "center", "va": "center"} | style))


def point_at(axes: Axes, target: np.ndarray, place: tuple[float, float], text: str) -> None:
    """Write a text at a place, with a line to what it speaks of."""
    line = {"arrowstyle": "-", "color": GREY}
    axes.annotate(text, tuple(target), place, ha="center", va="center", arrowprops=line)


def draw_rolling() -> None:
    """Draw the three ways in which a model can be made to roll."""
    title = "A model rolls by its coordinates, by an equation, or by friction"
    subtitle = "Only with contact, the third way, can the can slip and leave the incline."
    with chart(HERE / "rolling", 1, 3, 9, 4.6, title, subtitle) as (reduced, equality, contact):
        for axes, name in ((reduced, "reduced"), (equality, "equality"), (contact, "contact")):
            can(axes, math.pi / 2, math.radians(-50))
            axes.plot(
                [-1.45, 1.45],
                [-1, -1],
                color="black" if axes is contact else "#C4C4C4",
                linewidth=2,
            )
            axes.set(xlim=(-1.5, 1.5), ylim=(-2.65, 1.5))
            axes.set_title(name, loc="center", fontweight="bold")
        fixed = np.array([0, 0.75])
        site = on_circle(math.radians(-50), 0.75)
        reduced.plot(*np.transpose([fixed, site]), color=FORCE, linewidth=2.5)
        reduced.plot(*np.transpose([fixed, [0, 0], site]), "--", color=LETTER, linewidth=1)
        reduced.plot(*np.transpose([fixed, site]), "o", color=FORCE, markersize=6)
        write(reduced, "r", (0.13, 0.4), LETTER)
        write(reduced, "r", (-0.22, -0.4), LETTER)
        write(reduced, "tendon", (-0.3, 0.28), FORCE, ha="right", fontsize="9.5")
        point_at(reduced, fixed, (0.75, 1.2), "a fixed point")
        point_at(reduced, site, (-0.5, -1.25), "a point of the can")
        write(
            reduced,
            "There is no constraint. The\ntendon is a line between two\n"
            "points. Its armature, an inertia\nagainst change of its length,\nis that of rolling.",
            (0, -2.05),
        )
        arrow(equality, np.array([0, 0]), np.array([1.4, 0]), LETTER)
        write(equality, "u", (1.3, 0.2), LETTER)
        arrow(
            equality,
            np.array([-0.42, 1.1]),
            np.array([0.55, 1.05]),
            LETTER,
            connectionstyle="arc3,rad=-0.3",
        )
        write(equality, "roll", (0.1, 1.4), LETTER)
        write(equality, "Two joints are tied\nby an equality constraint,\nroll = u/a.", (0, -1.85))
        arrow(contact, np.array([0, -1.55]), np.array([0, -1.02]), FORCE)
        write(contact, "N", (0.2, -1.35), FORCE)
        arrow(contact, np.array([0, -1.07]), np.array([-0.7, -1.07]), FORCE)
        write(contact, "F", (-0.85, -1.2), FORCE)
        write(
            contact,
            "A cylinder lies on a plane:\nfriction makes it roll\nas long as F ≤ μN.",
            (0, -1.85),
        )


def draw_layer() -> None:
    """Draw the layer of liquid that the wall of a rolling can drags along."""
    half = math.radians(62)
    radius = Can().radius
    speed = 0.5
    wetted = 2 * half * radius
    thickness = math.sqrt(LIQUIDS["water"].viscosity * wetted / speed)
    drawn = 0.255
    title = f"The wall drags along a layer of water that is {1e3 * thickness:.1f} mm thick"
    subtitle = (
        f"12-oz can whose wall passes the water at {speed:g} m/s; the layer is drawn "
        f"{drawn * radius / thickness:.0f} times as thick"
    )
    with chart(HERE / "layer", 1, 1, 8, 5, title, subtitle) as (axes,):
        can(axes, half, math.radians(-14))
        angles = math.radians(-14) + np.linspace(half, -half, 181)
        # It grows with the root of the distance.
        thick = drawn * np.sqrt(np.linspace(0, 1, 181))
        inner = (1 - thick[:, np.newaxis]) * on_circle(angles)
        layer = np.concatenate([on_circle(angles), inner[::-1]])
        (shown,) = axes.fill(*layer.T, color=COLOURS[5], alpha=0.8, linewidth=0)
        shown.set_clip_path(Polygon(on_circle(angles), transform=axes.transData))
        path = on_circle(angles, 1.1)
        axes.plot(*path.T, color=LETTER, linewidth=1)
        arrow(axes, path[-3], path[-1], LETTER)
        write(axes, "wetted arc X", (-0.5, -1.22), LETTER)
        arrow(
            axes,
            on_circle(math.radians(120), 0.88),
            on_circle(math.radians(75), 0.88),
            FORCE,
            connectionstyle="arc3,rad=-0.2",
        )
        write(axes, "w", (0.68, 0.18), FORCE)
        write(
            axes,
            "The can turns past the liquid\nat w [rad/s]: its wall, at the\n"
            "radius a, has the speed U = aw.",
            (-0.05, 0.5),
            FORCE,
        )
        begins = on_circle(math.radians(40), 0.98)
        thickest = on_circle(math.radians(-64), 0.9)
        still = on_circle(math.radians(10), 0.62)
        point_at(axes, begins, (1.75, -0.8), "The layer begins\nwhere the wall enters\nthe liquid.")
        point_at(
            axes,
            thickest,
            (-1.8, -0.55),
            "It is thickest\nwhere the wall leaves:\n√(νX/U), ν: viscosity.",
        )
        point_at(axes, still, (1.75, -0.02), "The liquid above\nthe layer lies still.")
        axes.set(xlim=(-2.4, 2.4), ylim=(-1.35, 1.1))


def height(scene: Scene, phi: float | np.ndarray) -> np.ndarray:
    """Return V(phi) - V(0), divided by its amplitude."""
    oscillator = scene.oscillator
    return -oscillator.drop(phi, 0.0) / oscillator.depth


def landscape(axes: Axes, scene: Scene, low: float, high: float, energy: float) -> None:
    """Draw V between two angles, and E, both divided by the amplitude of V."""
    phi = np.linspace(low, high, 401)
    axes.plot(phi, height(scene, phi), color="black", linewidth=1.5)
    axes.axhline(energy, color=GREY, linestyle="--", linewidth=1)
    quarter = math.pi / 2 if high - low < math.tau else math.tau
    marks = quarter * np.arange(math.ceil(low / quarter), math.floor(high / quarter) + 1)
    axes.set_xticks(marks, [f"{math.degrees(mark):.0f}°".replace("-", "−") for mark in marks])
    axes.set_xlabel("φ, angle of the load")
    axes.margins(y=0.15)
    axes.grid(visible=False)


def leg(axes: Axes, begin: float, end: float, level: float, colour: str, style: str) -> None:
    """Draw a leg of a motion between two angles, at the height `level`."""
    arrow(axes, np.array([begin, level]), np.array([end, level]), colour, style, linewidth=2)


def draw_swing(axes: Axes) -> None:
    """Draw the legs of a swing, two arcs that meet at the rest."""
    scene = frozen(math.radians(8))
    rest = scene.equilibrium()
    low, crest = scene.separatrix()
    turn = rest + 1.9
    energy = float(height(scene, turn))
    behind = np.linspace(low, rest, 10_001)
    other_turn = float(behind[height(scene, behind) < energy][0])
    landscape(axes, scene, low - 0.6, crest + 0.9, energy)
    marked = np.array([crest, rest])
    axes.plot(marked, height(scene, marked), "o", color="black", markersize=4)
    write(axes, "crest", (crest, float(height(scene, crest)) + 0.2))
    write(axes, "rest", (rest, float(height(scene, rest)) - 0.2))
    leg(axes, rest, turn, energy, ARC, "<|-|>")
    leg(axes, rest, other_turn, energy, OTHER_ARC, "<|-|>")
    for place, colour in ((turn, ARC), (other_turn, OTHER_ARC)):
        axes.plot(place, energy, "o", color=colour, markersize=5)
    write(axes, "arc", ((rest + turn) / 2, energy + 0.17), ARC)
    write(axes, "arc", ((rest + other_turn) / 2, energy + 0.17), OTHER_ARC)
    write(axes, "turning points: E = V", (rest, energy + 0.55), GREY)
    for place in (turn, other_turn):
        axes.annotate(
            "",
            (place, energy + 0.08),
            (rest + 0.35 * (place - rest), energy + 0.48),
            arrowprops={"arrowstyle": "-", "color": GREY, "linewidth": 0.8},
        )
    write(axes, "E", (low - 0.45, energy + 0.14), GREY)
    write(axes, "V", (low - 0.2, float(height(scene, low - 0.45))))
    axes.set_title("A swing: two arcs")


def draw_slope(axes: Axes) -> None:
    """Draw the legs of a load that climbs a slope and rolls down again."""
    scene = frozen(math.radians(8))
    crest = scene.separatrix()[1]
    first = crest - math.pi  # the edge between two turns
    turn = first - 1.6
    energy = float(height(scene, turn))
    landscape(axes, scene, turn - 0.6, first + 4 * math.pi + 0.5, energy)
    leg(axes, first, turn, energy + 0.3, ARC, "-")
    leg(axes, turn, first, energy - 0.3, ARC, "-|>")
    axes.plot([turn, turn], [energy - 0.3, energy + 0.3], color=ARC, linewidth=2)
    axes.plot(turn, energy, "o", color=ARC, markersize=5)
    write(axes, "arc", ((turn + first) / 2, energy + 0.7), ARC)
    for place in range(2):
        edge = first + math.tau * place
        leg(axes, edge + math.tau, edge, energy + 0.3, TURNS, "-|>")
        leg(axes, edge, edge + math.tau, energy - 0.3, TURNS, "-|>")
        middle = crest + math.tau * place
        axes.plot(middle, height(scene, middle), "o", color="black", markersize=4)
        axes.plot([middle, middle], [height(scene, middle), energy], ":", color=GREY)
        axes.plot([edge, edge], [energy - 0.5, energy + 0.5], color=GREY, linewidth=0.8)
    write(axes, "turn", (crest, energy + 0.7), TURNS)
    write(axes, "turn", (crest + math.tau, energy + 0.7), TURNS)
    write(axes, "uphill", (first + math.tau, energy + 1.15), TURNS)
    write(axes, "downhill", (first + math.tau, energy - 0.8), TURNS)
    beside = (crest + math.tau + 0.3, energy - 1.6)
    write(axes, "energy\nat the crest", beside, GREY, ha="left")
    axes.set_title("Up a slope and down again: turns and an arc")


def draw_legs() -> None:
    """Draw the legs into which exact theory cuts a motion."""
    title = "A motion is cut into arcs, which turn back, and turns, which do not"
    subtitle = (
        "frozen beer on 8°: potential V (solid) and energy E of a motion (dashed). An arc leads "
        "to a turning point, where E = V, and back; a turn passes a crest. Exact theory integrates "
        "the time of each."
    )
    with chart(HERE / "legs", 1, 2, 9, 4.8, title, subtitle) as (swing, slope):
        swing.set_ylabel("energy above V(0) / amplitude of V")
        draw_swing(swing)
        draw_slope(slope)


if __name__ == "__main__":
    draw_rolling()
    draw_layer()
    draw_legs()
