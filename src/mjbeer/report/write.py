"""The report: the tables, a video of each scene and the paper's stories, in a folder with a page that shows it all."""

import pathlib

from rich.console import Console

from mjbeer.drawing import studio
from mjbeer.output import files
from mjbeer.paper import stories
from mjbeer.report import films, page
from mjbeer.studies.validation.run import Validation, validate


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
    orders = films.orders(folder, quick)
    with files.whole(folder / "index.html") as index:  # a folder that cannot be written to fails here
        (folder / "index.html").unlink(missing_ok=True)
        validation = validate(console)
        files.write(folder / "validation.json", validation.json())
        not_drawn = films.not_drawn([str(order.path.relative_to(folder)) for order in orders])
        stories.write(folder / "paper", False, console)
        console.print(f"wrote {folder / 'paper'}", highlight=False, markup=False, soft_wrap=True)
        page.draw_plots(folder / "plots")
        if not_drawn:
            for order in orders:  # those of an earlier report are not of this one
                order.path.unlink(missing_ok=True)
        else:
            studio.produce(orders, console)
        index.write_text(page.html(folder, validation, quick, not_drawn), encoding="utf-8")
    return validation, not_drawn
