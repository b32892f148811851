"""The paper's stories: named scenarios with a plot each, and films of what moves."""

import pathlib

from rich.console import Console

from mjbeer.output import files
from mjbeer.output.terminal import progress_bar
from mjbeer.paper.stories import frozen, hopping, letters, massive_can, sliding
from mjbeer.paper.stories.story import Story

_CHAPTERS = (sliding, massive_can, frozen, hopping)
_SIZE = (640, 360, 20)
"""Width and height [pixels] and frames per second of a film: small, for there are ten of them."""


def stories() -> list[Story]:
    """Return all stories, in the paper's order."""
    return [story for chapter in _CHAPTERS for story in chapter.stories()]


def write(folder: pathlib.Path, films: bool, console: Console) -> list[str]:
    """Write a sketch of the letters, a plot of each story (SVG and PNG), its film if asked for (MP4), and stories.md.

    Return the names of the films that were asked for and are missing because there is no OpenGL.

    Every file appears whole or not at all; stories.md comes last, and that of an earlier run goes first.

    Raises:
      OutputError: if the folder cannot be written to.
      RenderingError: if a film cannot be drawn for another reason, as without ffmpeg.
    """
    from mjbeer.drawing import opengl
    from mjbeer.drawing.video import render

    drawn = stories()
    names = [f"{story.name}.mp4" for story in drawn if films and story.film is not None]
    missing = names if names and opengl.problem() else []
    with files.whole(folder / "stories.md") as summary, progress_bar(console, len(drawn)) as begin:
        (folder / "stories.md").unlink(missing_ok=True)
        letters.draw(folder / "letters")
        for story in drawn:
            begin(story.name)
            story.draw(folder / story.name)
            if films and story.film is not None and not missing:
                file = folder / f"{story.name}.mp4"
                render(story.film.trajectory(), file, *_SIZE, story.film.speed, progress=False)
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
