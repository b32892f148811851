"""The paper's stories: its scenarios with a plot each, films of what moves, and a sketch of the letters."""

import math
import pathlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc
from rich.console import Console

from mjbeer.drawing import opengl, studio
from mjbeer.drawing.film import Take
from mjbeer.drawing.overlay import Look, Mark
from mjbeer.drawing.studio import Order
from mjbeer.model.setting import FRICTION
from mjbeer.output import files
from mjbeer.output.plots import COLOURS, chart
from mjbeer.output.terminal import progress_bar
from mjbeer.paper import plots_frozen, plots_sliding, real_beer
from mjbeer.paper.hopping import MU
from mjbeer.theory.load import segment

_WIDTH, _HEIGHT, _FPS = 960, 540, 30
"""Width and height [pixels] and pictures per second of a film: small, for there are ten of them."""
_GHOST: tuple[Mark, ...] = ("phi", "ghost")
_EVERYTHING: tuple[Mark, ...] = ("phi", "paths", "forces")
_HOOP: tuple[Mark, ...] = ("paths", "forces")


@dataclass(frozen=True)
class Story:
    """A scenario of the paper."""

    name: str
    """Name of its files, without an ending."""
    caption: str
    """What the plot and the film show."""
    draw: Callable[[pathlib.Path], None]
    """Writes the plot to a path, once with .svg and once with .png appended."""
    film: Take | None = None


# fmt: off
_STORIES = (
    Story("trivial",
        "Beer that starts with its surface parallel to the incline keeps it so, and the can rolls down with exactly "
        "g sin α. Beer let go at 60° swings, and its can hesitates. But its centre of mass moves down just the same.",
        plots_sliding.draw_trivial,
        Take(partial(plots_sliding.let_go, 0.0), 0.25,
            look=Look("Let go with its surface along the incline, beer does not swing", ("phi", "u"), ("phi",)))),
    Story("hesitation",
        "The can hesitates once in every swing of the beer: its distance less ½ g sin α t² is b sin φ, and swings with "
        "the beer. Eq. (25) as printed has b cos φ instead, a smaller ripple at twice the frequency. It is drawn "
        "without its constant, and from the same start.",
        plots_sliding.draw_hesitation,
        Take(plots_sliding.HESITATION, 0.25,
            look=Look("A can hesitates in every swing of its beer", ("phi", "ahead"), _GHOST))),
    Story("release",
        "A can is held until its beer is level and then let go, so that φ starts at −α. The steeper the incline, the "
        "wider the swing, and the slower it is in comparison with small swings.",
        plots_sliding.draw_release,
        Take(partial(plots_sliding.level_start, 40.0, periods=2.0), 0.1,
            look=Look("Let go with its surface level, beer swings", ("phi", "ahead"), _GHOST))),
    Story("looping",
        "Beer that loops in its can: how far φ is ahead of an even rotation, over one turn. Eq. (26) has only the "
        "ripple at Ω, with the amplitude ε of (28); the one at 2Ω remains however fast the beer spins. A free can "
        "follows only the left motion: if the beer is faster than 47 rad/s at the bottom, it lifts its can off the "
        "incline. At this lower rate, formulas of first order in δ are only near the truth.",
        plots_sliding.draw_looping,
        Take(plots_sliding.LOOPING, 0.1,
            look=Look("Beer that loops in its can", ("phi", "normal"), ("phi", "forces")))),
    Story("ripples",
        "Both ripples over a decade of the mean rate Ω. The one at Ω falls in proportion to 1/Ω² and is 8 % smaller "
        "than by eq. (28); the one at 2Ω does not change. Grey: rates at which the beer would lift a free can.",
        plots_sliding.draw_ripples),
    Story("accelerations",
        "The acceleration of a can whose beer does not swing, from nearly empty to full. It grows from that of the "
        "empty can, half of g sin α for a hoop, to nearly g sin α. A can of frozen beer is slower: a full one has two "
        "thirds of g sin α. The dashed line is without the swings of frozen beer, as if it were balanced.",
        plots_sliding.draw_accelerations),
    Story("inertia-axis", "The figure of eq. (36): the beer's moment of inertia about the can's axis.",
        plots_sliding.draw_axial),
    Story("inertia-cm", "The figure of eq. (37): the moment of inertia about the beer's own centre of mass.",
        plots_sliding.draw_own),
    Story("tilt",
        "What the paper leaves open about a massive can. Left: the surface of beer that does not swing is between "
        "level and parallel to the incline, half-way in a nearly empty hoop. Middle: a little beer swings like a "
        "pendulum; in a massless can it would swing the faster the less there is. Right: a can with mass and frozen "
        "beer stays only on gentler slopes than a massless one.",
        plots_sliding.draw_tilt),
    Story("pendulum",
        "A wheel with a pendulum. Left: a wide swing. Right: small swings, and their two limits. A light bob swings "
        "as if its pivot accelerated at half of g sin α. Under a heavy bob the wheel swings instead, the faster the "
        "heavier the bob.",
        plots_sliding.draw_pendulum,
        Take(plots_sliding.WIDE_PENDULUM, 0.25,
            look=Look("A wheel hesitates in every swing of its pendulum", ("phi", "ahead"), _GHOST))),
    Story("rocking",
        "A can with frozen beer, let go at φ = 0, rocks about its equilibrium and does not roll off. Footnote 8's "
        "equation as printed, with ½ a b in place of a b, gives another swing.",
        plots_frozen.draw_rocking,
        Take(plots_frozen.ROCKING, 0.5,
            look=Look("Frozen beer, let go below: it rocks", ("phi", "u"), ("phi", "paths")))),
    Story("roll-down",
        "The figure of A.3: the same can, let go with the beer on top. It rolls down like a solid cylinder, but in "
        "jerks. Rolling needs more and more friction, and from 0.834 s on the incline would have to pull the can: what "
        "comes after that is dotted. A can on an incline with μ = 1 slips and hops instead.",
        plots_frozen.draw_roll_down,
        Take(plots_frozen.LIFT_OFF, 0.25,
            look=Look("Frozen beer, let go on top: it rolls, slips and hops", ("normal", "lift"), _EVERYTHING))),
    Story("friction",
        "Footnote 7: at the equilibrium the can stays if the friction coefficient is more than tan α, and slides off "
        "if it is less. The lines are simulations in contact, 2 % above, 2 % below, and 30 % below.",
        plots_frozen.draw_friction,
        Take(partial(plots_frozen.contact_at_equilibrium, 0.7), 0.5,
            look=Look("Too little friction: a can at its equilibrium slides off", ("phi", "slip"), ("phi", "forces")))),
    Story("period",
        "What the paper leaves open: the period grows with the amplitude and is infinite at the separatrix, the end of "
        "the largest swing. On an incline the frozen can swings differently to either side, and rolls off downhill.",
        plots_frozen.draw_period),
    Story("hopping",
        "A hoop with a weight on its rim. Left: it starts with the weight on top and rolls without slipping. Where the "
        "ground would have to pull, the lines are dotted; there the hoop hops, which needs M/m < 1/13. Right: a fast "
        "hoop of M/m = 1/20, in contact with the ground, with a friction coefficient of 1.",
        plots_frozen.draw_normal,
        Take(partial(plots_frozen.HOP, friction=FRICTION), 0.1,
            look=Look("A weight on the rim makes a light hoop hop", ("normal", "lift"), _HOOP))),
    Story("lift-off",
        "Left: the angles at which a hoop that starts from rest lifts off and at which it skids, over its mass. "
        "Littlewood's 90° hold for a massless hoop; with any finite friction coefficient the hoop skids first. A hoop "
        "just too heavy to skid at 80° grips until after 90°: hence the jump. Right: a fast hoop skids, then hops.",
        plots_frozen.draw_lift_off,
        Take(partial(plots_frozen.HOP, friction=MU), 0.1,
            look=Look("With less friction the hoop skids before it hops", ("normal", "slip"), _HOOP))),
    Story("real-beer",
        "What footnote 4 leaves open, as an estimate. Without friction a nearly empty can has a little more than half "
        "of g sin α (wide line), but in Jackson's experiment it was slower. The friction of water on the wall makes it "
        "slower, and no measurement is fitted. Grey lines: the can is so fast that its water need not stay at the "
        "bottom. Grey area: surface tension shapes the puddle. Rosch saw the least acceleration near 10 mL of water; "
        "here it is near 1 mL.",
        real_beer.draw_first_metre),
    Story("liquids",
        "From frictionless to frozen. A half-full can without friction goes ever faster. A lump of liquid brings it "
        "to a terminal speed (dashed), the lower the thicker the liquid. Grey: the can is so fast that the liquid need "
        "not stay at the bottom. With ice it rocks about its equilibrium and does not go anywhere. Glycerol and honey "
        "coat the can, so that their speeds are no better than an order of magnitude.",
        real_beer.draw_liquids),
)
# fmt: on


def stories() -> list[Story]:
    """Return all stories, in the paper's order."""
    return list(_STORIES)


def orders(folder: pathlib.Path) -> list[Order]:
    """Return the films of the stories, to be drawn into a folder."""
    filmed = [(story.film, folder / f"{story.name}.mp4") for story in stories() if story.film is not None]
    return [Order(film, path, _WIDTH, _HEIGHT, _FPS) for film, path in filmed]


def write(folder: pathlib.Path, films: bool, console: Console) -> list[str]:
    """Write a sketch of the letters, a plot of each story (SVG and PNG), its film if asked for (MP4), and stories.md.

    Return the names of the films that were asked for and are missing because there is no OpenGL.

    Every file appears whole or not at all; stories.md comes last, and that of an earlier run goes first.

    Raises:
      OutputError: if the folder cannot be written to.
      RenderingError: if a film cannot be drawn for another reason, as without ffmpeg.
    """
    drawn, filmed = stories(), orders(folder) if films else []
    missing = [order.path.name for order in filmed] if filmed and opengl.problem() else []
    with files.whole(folder / "stories.md") as summary:
        (folder / "stories.md").unlink(missing_ok=True)
        with progress_bar(console, len(drawn)) as begin:
            draw_letters(folder / "letters")
            for story in drawn:
                begin(story.name)
                story.draw(folder / story.name)
        if filmed and not missing:
            studio.produce(filmed, console)
        lines = ["# The paper's stories", "", "![The letters of the formulas](letters.svg)", ""]
        lines += [f"Films: {opengl.missing(missing)}", ""] if missing else []
        for story in drawn:
            lines += [f"## {story.name}", "", f"![{story.name}]({story.name}.svg)", "", story.caption, ""]
            lines += [f"[Film]({story.name}.mp4)", ""] if films and story.film is not None and not missing else []
        summary.write_text("\n".join(lines), encoding="utf-8")
    return missing


_INCLINE, _PHI = math.radians(18), math.radians(35)
"""Angles of the sketch [rad]: steep enough to be seen."""
_DOWNHILL, _AWAY = np.array([[math.cos(_INCLINE), -math.sin(_INCLINE)], [math.sin(_INCLINE), math.cos(_INCLINE)]])
_LENGTH, _WAY = 5.4, 3.2
"""Length of the incline, and how far the can has rolled down it, in radii of the can."""
_AXIS = _WAY * _DOWNHILL + _AWAY
_FORCE, _LETTER = COLOURS[1], COLOURS[0]


def draw_letters(path: pathlib.Path) -> None:
    """Draw a sketch of a can on its incline with the letters of the formulas, as `path` with .svg and with .png.

    Raises:
      OutputError: if a file cannot be written.
    """
    with chart(path, width=6.4, height=3.9) as (axes,):
        axes.set_axis_off()
        axes.set_aspect("equal")
        _draw_can(axes)
        _draw_arrows(axes)


def _draw_can(axes: Axes) -> None:
    """Draw the incline with α, the can with the half that beer fills and φ, the radius a, and the distance b."""
    foot, slope = _LENGTH * _DOWNHILL, math.degrees(_INCLINE)
    axes.plot(*np.transpose([-0.5 * _DOWNHILL, foot]), color="black", linewidth=2)
    axes.plot([foot[0] - 1.9, foot[0]], [foot[1], foot[1]], color="black", linewidth=1)
    axes.add_patch(Arc(tuple(foot), 3, 3, theta1=180 - slope, theta2=180, color=_LETTER))
    _letter(axes, "α", foot + np.array([-1.72, 0.2]))
    tilt = -_INCLINE - _PHI  # of the surface to the horizontal: positive φ is clockwise, as the can rolls
    rim, filled = (
        _AXIS + np.transpose([np.cos(angles), np.sin(angles)])
        for angles in (np.linspace(0, 2 * math.pi, 361), tilt - np.linspace(0, math.pi, 181))
    )
    axes.plot(*rim.T, color="black", linewidth=1.5)
    axes.fill(*filled.T, color="#E8A33D", alpha=0.6, linewidth=0)
    axes.plot(*filled[[-1, 0]].T, color="#A05A00", linewidth=1.5)
    axes.plot(*np.transpose([_AXIS - 1.3 * _DOWNHILL, _AXIS + 1.5 * _DOWNHILL]), "--", color="grey", linewidth=0.8)
    axes.add_patch(Arc(tuple(_AXIS), 1.5, 1.5, theta1=math.degrees(tilt), theta2=-slope, color=_LETTER))
    _letter(axes, "φ", _AXIS + 0.9 * _towards((tilt - _INCLINE) / 2))
    centre, top = _AXIS + segment(0.5).offset * _towards(tilt - math.pi / 2), _AXIS + _towards(0.5)
    axes.plot(*_AXIS, "o", color="black", markersize=3)
    axes.plot(*centre, "o", color="black", markersize=6)
    for letter, end, offset in (("b", centre, [-0.16, 0.06]), ("a", top, [-0.08, 0.14])):
        axes.plot(*np.transpose([_AXIS, end]), color=_LETTER)
        _letter(axes, letter, (_AXIS + end) / 2 + offset)


def _draw_arrows(axes: Axes) -> None:
    """Draw the way u of the axis, the forces N and F of the incline on the can, and the direction of gravity."""
    above, touch = 2.15 * _AWAY, _AXIS - _AWAY
    for end in (np.zeros(2), _WAY * _DOWNHILL):
        axes.plot(*np.transpose([end + 0.1 * _AWAY, end + above + 0.08 * _AWAY]), ":", color="grey", linewidth=0.8)
    under, corner = touch - 0.07 * _AWAY, np.array([_LENGTH * _DOWNHILL[0] - 0.2, 0.9])
    for letter, start, end, place, colour in (
        ("u", above, _WAY * _DOWNHILL + above, _WAY / 2 * _DOWNHILL + 2.35 * _AWAY, _LETTER),
        ("N", touch - 0.9 * _AWAY, touch, touch - 0.6 * _AWAY + [-0.2, 0], _FORCE),
        ("F", under, under - 0.9 * _DOWNHILL, touch - 0.75 * _DOWNHILL - 0.27 * _AWAY, _FORCE),
        ("g", corner, corner - [0, 0.9], corner + np.array([0.2, -0.5]), _FORCE),
    ):
        style = {"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0, "linewidth": 1.4}
        axes.annotate("", tuple(end), tuple(start), arrowprops=style)
        _letter(axes, letter, place, colour)


def _towards(angle: float) -> np.ndarray:
    return np.array([math.cos(angle), math.sin(angle)])


def _letter(axes: Axes, letter: str, place: np.ndarray, colour: str = _LETTER) -> None:
    axes.text(place[0], place[1], letter, color=colour, fontsize=15, style="italic", ha="center", va="center")
