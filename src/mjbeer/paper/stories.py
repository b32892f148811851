"""The paper's stories: its scenarios as data, each with a plot, a caption and perhaps a film."""

import pathlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from matplotlib.axes import Axes
from rich.console import Console

from mjbeer.drawing import opengl
from mjbeer.drawing.film import Film, MotionFilm
from mjbeer.drawing.race import Race, Runner
from mjbeer.drawing.style import FilmStyle
from mjbeer.drawing.video import FilmJob, PlotJob
from mjbeer.drawing.words import in_degrees, in_words
from mjbeer.output import files, jobs
from mjbeer.output.jobs import Job
from mjbeer.output.plots import chart
from mjbeer.paper import story_plots
from mjbeer.paper.story_plots import SWING
from mjbeer.theory.paper_scenes import frozen, sliding

SIZE = (768, 432, 25)
"""Width and height [pixels] and pictures per second of a film; a page shows it at most 768 pixels
wide."""


class PlotSize(NamedTuple):
    """The rows and columns of a plot's panels, and the size of the whole."""

    rows: int
    columns: int
    width: float
    """[inches]."""
    height: float
    """[inches]."""


@dataclass(frozen=True)
class Story:
    """A scenario of the paper."""

    name: str
    """The name of its files, without an ending."""
    title: str
    subtitle: str
    """The scene of the plot, in words."""
    caption: str
    """What the plot and the film show."""
    size: PlotSize
    draw: Callable[[Sequence[Axes]], None]
    """Draws the curves into the panels."""
    film: Film | None = None

    def plot(self, path: pathlib.Path) -> None:
        """Write the plot to a path, with .svg appended.

        Raises:
          OutputError: if the file cannot be written.
        """
        with chart(path, *self.size, self.title, self.subtitle) as panels:
            self.draw(panels)


def _let_go() -> Sequence[Runner]:
    """Return two cans: in one the beer does not swing, in the other it does."""
    still = story_plots.let_go(0.0, 0.65)
    swinging = story_plots.let_go(60.0, 0.65)
    return [
        Runner("let go at φ = 60°", swinging, (0.75, 0.2, 0.1), note="swings"),
        Runner("let go at φ = 0°", still, (0.1, 0.35, 0.6), note="does not swing"),
    ]


STORIES = (
    Story(
        "trivial",
        "However the beer swings, its centre of mass accelerates down the incline evenly",
        in_words(sliding()),
        "Beer that starts with its surface parallel to the incline keeps it so, and the can rolls "
        "down with exactly g sin α. Beer that is let go at 60° swings, and its can hesitates. The "
        "centre of mass of the beer moves down in the same way in both.",
        PlotSize(2, 1, 6, 5.6),
        story_plots.draw_trivial,
        Race(
            "One beer swings: the centres of mass stay abreast",
            _let_go,
            length=0.40,
            duration=0.65,
            speed=0.1,
            hold=1.0,
            still=0.2,
            centres=True,
        ),
    ),
    Story(
        "hesitation",
        "The can hesitates once in every swing of its beer",
        f"{in_words(sliding())}; beer let go at φ₀ = {in_degrees(SWING)}",
        "The can hesitates once in every swing of the beer. Its distance less ½ g sin α t² is b "
        "sin φ, and swings with the beer. Eq. (25) as printed has b cos φ instead, which is a "
        "smaller ripple at twice the frequency. It is drawn without its constant, and from the "
        "same start. The film sliding shows such a can.",
        PlotSize(1, 1, 6, 4.0),
        story_plots.draw_hesitation,
    ),
    Story(
        "looping",
        "Beer loops unevenly in its can, slow or fast",
        f"{in_words(sliding())}; the fast can would lift off, and is kept on it",
        "The beer loops in its can. The plots show how far it is ahead of an even rotation, over "
        "one turn. By eqs. (26) and (28) it is ahead in one half of the turn and behind in the "
        "other. In truth there is a second ripple, twice in a turn, which remains however fast the "
        "beer spins. Fast beer lifts its can off the incline: a free can stays on it up to 47 "
        "rad/s at the bottom. The corrected formula is of first order, and only near the truth "
        "when the beer is slow. In the film the beer was set spinning at 45 rad/s, seven turns a "
        "second, before it starts. Going through below, it presses the can down with nearly four "
        "weights; on top it takes all but a third of the weight off the incline.",
        PlotSize(2, 1, 6, 5.6),
        story_plots.draw_looping,
        MotionFilm(
            story_plots.LOOPING,
            speed=0.1,
            style=FilmStyle(
                "Beer that loops in its can all but lifts it",
                ("normal", "turns"),
                ("normal",),
                "pan",
                notes=("light", "heavy"),
                facts="beer set spinning at 45 rad/s",
            ),
        ),
    ),
    Story(
        "rocking",
        "Frozen beer rocks about its equilibrium and does not roll off",
        f"{in_words(frozen())}; let go at φ = 0",
        "A can with frozen beer is let go at φ = 0. It rocks about its equilibrium and does not "
        "roll off. Nothing takes energy from it here, and so it rocks for ever; a real can comes "
        "to rest in the equilibrium. Footnote 8's equation as printed has ½ a b in place of a b, "
        "and gives another swing.",
        PlotSize(2, 1, 6, 5.6),
        story_plots.draw_rocking,
        MotionFilm(
            story_plots.ROCKING,
            speed=0.5,
            style=FilmStyle(
                "Frozen beer, let go below, rocks and does not roll off",
                ("phi", "u"),
                ("phi", "equilibrium"),
                facts="without losses it rocks for ever",
            ),
        ),
    ),
    Story(
        "roll-down",
        "Frozen beer let go on top rolls down in jerks",
        f"{in_words(frozen())}; let go at φ = 180°",
        "A half-full can is let go with its frozen beer on top, as in the figure of A.3 (where "
        "b = a/3; here b = 0.42 a). It rolls down in jerks, a little faster than a solid cylinder. "
        "From 0.834 s on the incline would have to pull the can for it to keep rolling. What comes "
        "after that is dotted.",
        PlotSize(2, 1, 6, 5.6),
        story_plots.draw_roll_down,
    ),
    Story(
        "slip-and-hop",
        "With μ = 1 the can slips a little before it hops",
        f"{in_words(frozen())}; let go at φ = 180°",
        "A half-full can is let go with its frozen beer on top, on an incline with μ = 1. Rolling "
        "needs more and more friction. At 0.72 s it needs more than there is, and the can slips by "
        "less than a millimetre, which no film can show. At 0.83 s the can begins to slip far, and "
        "then it hops, 7 mm high. The film begins 0.45 s after the can was let go: each time the "
        "beer goes through below it presses the can down harder, until, going up, it takes the "
        "can along. The landing is a blow of more than eight weights (mean of 11 ms).",
        PlotSize(2, 1, 6, 5.6),
        story_plots.draw_slip_and_hop,
        MotionFilm(
            story_plots.PARTING,
            speed=0.06,
            hold=1.0,
            still=0.9,
            style=FilmStyle(
                "Frozen beer rolls faster and faster, until its can hops",
                ("normal", "lift"),
                ("paths", "normal"),
                "pan",
                ("flies", "heavy", "slips", "light"),
                facts="let go on top at t = 0, μ = 1",
            ),
        ),
    ),
    Story(
        "lift-off",
        "Before a hoop lifts off, it skids",
        "hoop of mass M with a weight m on its rim, level ground; rolling from rest",
        "The angles at which a hoop that starts from rest lifts off and at which it skids, over "
        "its mass. Littlewood's 90° are right for a massless hoop. With any finite friction the "
        "hoop skids first. A hoop just too heavy to skid at 80° grips until after 90°: this is why "
        "one line has a gap.",
        PlotSize(1, 1, 6, 4.4),
        story_plots.draw_lift_off,
    ),
)
"""All stories, in the paper's order."""


def letters() -> str:
    """Return the drawing of a can with the letters of the formulas, as SVG."""
    return pathlib.Path(__file__).with_name("letters.svg").read_text(encoding="utf-8")


def films(folder: pathlib.Path) -> list[FilmJob]:
    """Return the films of the stories, to be drawn into a folder."""
    return [
        FilmJob(story.film, folder / f"{story.name}.mp4", *SIZE)
        for story in STORIES
        if story.film is not None
    ]


def write(folder: pathlib.Path, filmed: bool, console: Console) -> str:
    """Write a plot of each story (SVG), its film if asked for (MP4), and stories.md into a folder.

    Return the line that says which films were asked for and are missing because there is no OpenGL,
    or "".

    Raises:
      OutputError: if the folder cannot be written to.
      RenderingError: if a film cannot be drawn for another reason, as without ffmpeg.
    """
    film_jobs = films(folder) if filmed else []
    missing = ""
    if film_jobs and opengl.problem():
        missing = opengl.missing_films_message([film.path.name for film in film_jobs])
        film_jobs = []
    files.write(folder / "letters.svg", letters())
    plots = [PlotJob(story.plot, folder / story.name) for story in STORIES]
    drawings = [*film_jobs, *plots]
    jobs.run_jobs([Job(drawing.path.name, drawing.write) for drawing in drawings], console)
    lines = ["# The paper's stories", "", "![The letters of the formulas](letters.svg)", ""]
    if missing:
        lines += [f"Films: {missing}", ""]
    for story in STORIES:
        name = story.name
        lines += [f"## {name}", "", f"![{name}]({name}.svg)", "", story.caption, ""]
        if filmed and not missing and story.film is not None:
            lines += [f"[Film]({name}.mp4)", ""]
    files.write(folder / "stories.md", "\n".join(lines))
    return missing
