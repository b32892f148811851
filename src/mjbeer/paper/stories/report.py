"""The paper's stories: named scenarios with a plot each, and films of what moves."""

import pathlib

from rich.console import Console

from mjbeer.drawing import studio
from mjbeer.drawing.studio import Order
from mjbeer.output import files
from mjbeer.output.terminal import progress_bar
from mjbeer.paper.stories import frozen, hopping, letters, massive_can, real_beer, sliding
from mjbeer.paper.stories.story import Story

_CHAPTERS = (sliding, massive_can, frozen, hopping, real_beer)
_WIDTH, _HEIGHT, _FPS = 960, 540, 30
"""Width and height [pixels] and pictures per second of a film: small, for there are ten of them."""


def stories() -> list[Story]:
    """Return all stories, in the paper's order."""
    return [story for chapter in _CHAPTERS for story in chapter.stories()]


def orders(folder: pathlib.Path) -> list[Order]:
    """Return the films of the stories, to be drawn into a folder."""
    return [
        Order(story.film, folder / f"{story.name}.mp4", _WIDTH, _HEIGHT, _FPS)
        for story in stories()
        if story.film is not None
    ]


def write(folder: pathlib.Path, films: bool, console: Console) -> list[str]:
    """Write a sketch of the letters, a plot of each story (SVG and PNG), its film if asked for (MP4), and stories.md.

    Return the names of the films that were asked for and are missing because there is no OpenGL.

    Every file appears whole or not at all; stories.md comes last, and that of an earlier run goes first.

    Raises:
      OutputError: if the folder cannot be written to.
      RenderingError: if a film cannot be drawn for another reason, as without ffmpeg.
    """
    from mjbeer.drawing import opengl

    drawn, filmed = stories(), orders(folder) if films else []
    missing = [order.path.name for order in filmed] if filmed and opengl.problem() else []
    with files.whole(folder / "stories.md") as summary:
        (folder / "stories.md").unlink(missing_ok=True)
        with progress_bar(console, len(drawn)) as begin:
            letters.draw(folder / "letters")
            for story in drawn:
                begin(story.name)
                story.draw(folder / story.name)
        if filmed and not missing:
            studio.produce(filmed, console)
        summary.write_text(_summary(drawn, films, missing), encoding="utf-8")
    return missing


def _summary(drawn: list[Story], films: bool, missing: list[str]) -> str:
    from mjbeer.drawing import opengl

    lines = ["# The paper's stories", "", "![The letters of the formulas](letters.svg)", ""]
    lines += [f"Films: {opengl.missing(missing)}", ""] if missing else []
    for story in drawn:
        picture = f"![{story.name}]({story.name}.svg)"
        filmed = films and story.film is not None and not missing
        lines += [f"## {story.name}", "", picture, "", story.caption, ""]
        lines += [f"[Film]({story.name}.mp4)", ""] if filmed else []
    return "\n".join(lines)
