"""The paper's stories: its scenarios, each with a plot and a caption, and films of what moves."""

import math
import pathlib
import re
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial

from rich.console import Console

from mjbeer.drawing import opengl, studio
from mjbeer.drawing.film import Film, Take
from mjbeer.drawing.overlay import Look
from mjbeer.drawing.race import Race, Runner
from mjbeer.drawing.studio import Filmed, Plotted
from mjbeer.output import files
from mjbeer.paper import plots_frozen, plots_sliding, real_beer
from mjbeer.paper.hopping import MU
from mjbeer.theory.scene import INCLINE

SIZE = 960, 540, 25
"""Width and height [pixels] and pictures per second of a film: a page shows it 768 pixels wide, or less."""
_BLUE, _RED = (0.1, 0.35, 0.6), (0.75, 0.2, 0.1)


@dataclass(frozen=True)
class Story:
    """A scenario of the paper."""

    name: str
    """Name of its files, without an ending."""
    caption: str
    """What the plot and the film show."""
    draw: Callable[[pathlib.Path], None]
    """Writes the plot to a path, with .svg appended."""
    film: Film | None = None


def _let_go() -> Sequence[Runner]:
    """Return two cans: in one the beer does not swing, in the other it does."""
    still, swinging = (plots_sliding.let_go(degrees, 0.65) for degrees in (0.0, 60.0))
    return [
        Runner("let go at φ = 60°", swinging, _RED, note="swings"),
        Runner("let go at φ = 0°", still, _BLUE, note="does not swing"),
    ]


def _with_friction() -> Sequence[Runner]:
    """Return two cans at their equilibrium: on one incline the friction is just enough, on the other it is not."""
    enough, little = (plots_frozen.contact_at_equilibrium(part) for part in (1.02, 0.7))
    return [
        Runner(f"μ = {0.7 * math.tan(INCLINE):.2f}", little, _RED, note="30 % less than tan α"),
        Runner(f"μ = {1.02 * math.tan(INCLINE):.2f}", enough, _BLUE, note="2 % more than tan α"),
    ]


_PLOTS: dict[str, Callable[[pathlib.Path], None]] = {
    "trivial": plots_sliding.draw_trivial,
    "hesitation": plots_sliding.draw_hesitation,
    "release": plots_sliding.draw_release,
    "looping": plots_sliding.draw_looping,
    "ripples": plots_sliding.draw_ripples,
    "accelerations": plots_sliding.draw_accelerations,
    "inertia": plots_sliding.draw_inertia,
    "tilt": plots_sliding.draw_tilt,
    "pendulum": plots_sliding.draw_pendulum,
    "rocking": plots_frozen.draw_rocking,
    "roll-down": plots_frozen.draw_roll_down,
    "slip-and-hop": plots_frozen.draw_slip_and_hop,
    "friction": plots_frozen.draw_friction,
    "steepest-incline": plots_sliding.draw_steepest,
    "period": plots_frozen.draw_period,
    "hopping": plots_frozen.draw_normal,
    "lift-off": plots_frozen.draw_lift_off,
    "skid": plots_frozen.draw_skid,
    "real-beer": real_beer.draw_first_metre,
    "liquids": real_beer.draw_liquids,
}
"""What draws the plot of each story, in the paper's order. Their captions are in captions.md."""
_FILMS: dict[str, Film] = {
    "trivial": Race(
        "Whether its beer swings or not, a can gets equally far",
        _let_go,
        length=0.36,
        speed=0.1,
        told=str,  # the story has a caption
        still=0.2,
        strips=("phi", "u"),
    ),
    "hesitation": Take(
        plots_sliding.HESITATION,
        speed=0.1,
        look=Look("A can hesitates in every swing of its beer", ("u_dot", "ahead"), ("phi", "ghost")),
    ),
    "release": Take(
        partial(plots_sliding.level_start, 40.0, periods=2.0),
        speed=0.1,
        look=Look("Let go with its surface level, beer swings", ("phi", "ahead"), ("phi", "ghost")),
    ),
    "looping": Take(
        plots_sliding.LOOPING,
        speed=0.1,
        look=Look("Beer that loops in its can", ("phi", "normal"), ("phi", "forces")),
    ),
    "rocking": Take(
        plots_frozen.ROCKING,
        speed=0.5,
        look=Look("Frozen beer, let go below: it rocks", ("phi", "u"), ("phi", "paths")),
    ),
    "slip-and-hop": Take(
        plots_frozen.PARTING,
        speed=0.04,
        still=0.9,
        look=Look("Frozen beer rolls down, slips and hops", ("slip", "lift"), ("forces", "skid"), "close", "μ = 1"),
    ),
    "friction": Race(
        "With too little friction a can slides off its equilibrium",
        _with_friction,
        length=0.3,
        speed=0.2,
        told=str,
        still=0.7,
        facts=f"tan α = {math.tan(INCLINE):.2f}",
        strips=("slip",),
    ),
    "skid": Take(
        plots_frozen.SKID,
        speed=0.08,
        still=0.24,
        look=Look(
            "A pushed hoop skids before it hops",
            ("slip", "lift"),
            ("forces", "skid"),
            facts=f"μ = {MU:g}",
        ),
    ),
}
"""The films of the stories that have one."""


def stories() -> list[Story]:
    """Return all stories, in the paper's order."""
    told = re.findall(r"## (.+)\n\n((?:.+\n)+)", _read("captions.md"))
    captions = {name: " ".join(words.split()) for name, words in told}
    return [Story(name, captions[name], draw, _FILMS.get(name)) for name, draw in _PLOTS.items()]


def _read(name: str) -> str:
    return pathlib.Path(__file__).with_name(name).read_text(encoding="utf-8")


def plots(folder: pathlib.Path) -> list[Plotted]:
    """Return the plots of the stories, to be drawn into a folder."""
    return [Plotted(story.draw, folder / story.name) for story in stories()]


def films(folder: pathlib.Path) -> list[Filmed]:
    """Return the films of the stories, to be drawn into a folder."""
    filmed = [(story.film, folder / f"{story.name}.mp4") for story in stories() if story.film is not None]
    return [Filmed(film, path, *SIZE) for film, path in filmed]


@contextmanager
def told(folder: pathlib.Path, films: bool, note: str = "") -> Generator[None]:
    """Write letters.svg and, when the block has written plots and perhaps films, stories.md, with a note.

    stories.md of an earlier run goes first.

    Raises:
      OutputError: if the folder cannot be written to.
    """
    files.make_folder(folder)
    with files.whole(folder / "stories.md") as summary:
        (folder / "stories.md").unlink(missing_ok=True)
        files.write(folder / "letters.svg", _read("letters.svg"))
        yield
        lines = ["# The paper's stories", "", "![The letters of the formulas](letters.svg)", ""]
        lines += [f"Films: {note}", ""] if note else []
        for story in stories():
            lines += [f"## {story.name}", "", f"![{story.name}]({story.name}.svg)", "", story.caption, ""]
            lines += [f"[Film]({story.name}.mp4)", ""] if films and story.film is not None else []
        summary.write_text("\n".join(lines), encoding="utf-8")


def write(folder: pathlib.Path, filmed: bool, console: Console) -> str:
    """Write a plot of each story (SVG), its film if asked for (MP4), and stories.md, each whole or not at all.

    Return the line that says which films were asked for and are missing because there is no OpenGL, or "".

    Raises:
      OutputError: if the folder cannot be written to.
      RenderingError: if a film cannot be drawn for another reason, as without ffmpeg.
    """
    orders = films(folder) if filmed else []
    note = opengl.missing([order.path.name for order in orders]) if orders and opengl.problem() else ""
    with told(folder, filmed and not note, note):
        studio.produce([*([] if note else orders), *plots(folder)], console)
    return note
