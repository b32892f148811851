"""The report: the tables, a video of each scene and the paper's stories, in a folder with a page that shows it all."""

import pathlib
from dataclasses import dataclass

from rich.console import Console

from mjbeer.drawing import studio
from mjbeer.output import files
from mjbeer.paper import stories
from mjbeer.report import films, page
from mjbeer.studies.validation.validate import Validation, validate


@dataclass(frozen=True)
class _Checks:
    """The checks, to be made; their results go into a file."""

    path: pathlib.Path

    def write(self) -> Validation:
        validation = validate(None)
        files.write(self.path, validation.json())
        return validation


def write(folder: pathlib.Path, quick: bool, console: Console) -> tuple[Validation, str]:
    """Write validation.json, a video and a picture of each scene, stories, plots and index.html into a folder.

    Quickly, the videos are smaller and the stories have plots and no films. Where there is no OpenGL or no ffmpeg, all
    is written but videos, pictures and films. What comes back is the validation, and the line that says which are
    missing for that reason, or "".

    Every file appears whole or not at all; the page comes last, and that of an earlier report goes first.

    Raises:
      OutputError: if the folder cannot be written to.
      RenderingError: if a video cannot be drawn for another reason.
    """
    drawn, papers, plots = films.orders(folder, quick), folder / "paper", folder / "plots"
    for each in (folder, plots):
        files.make_folder(each)
    with files.whole(folder / "index.html") as index, stories.told(papers, films=False):
        (folder / "index.html").unlink(missing_ok=True)
        if not_drawn := films.not_drawn([str(order.path.relative_to(folder)) for order in drawn]):
            for order in drawn:  # those of an earlier report are not of this one
                order.path.unlink(missing_ok=True)
            drawn = []
        # The checks take longest, and compile what the films run; plots of what is known need not. The last are quick.
        orders = [_Checks(folder / "validation.json"), *page.plots(plots), *drawn]
        validation, *_ = studio.produce([*orders, *reversed(stories.plots(papers))], console)
        index.write_text(page.html(folder, validation, quick, not_drawn), encoding="utf-8")
    return validation, not_drawn
