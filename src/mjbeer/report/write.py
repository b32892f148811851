"""The report: one page with the checks, a film of each scene and the paper's stories; more maps lie beside it."""

import pathlib
import tempfile
from functools import partial
from types import SimpleNamespace

from rich.console import Console

from mjbeer.drawing import jobs, opengl
from mjbeer.output import files
from mjbeer.report import films, page
from mjbeer.studies.validation.validate import Validation, validate


def write(folder: pathlib.Path, quick: bool, console: Console) -> tuple[Validation, str]:
    """Write index.html into a folder, whole or not at all; that of an earlier report goes first.

    Quickly, the films are smaller and the stories have plots and no films. Where there is no OpenGL, there are no
    films. What comes back is the validation, and the line that says which films are missing, or "".

    Raises:
      OutputError: if the folder cannot be written to.
      RenderingError: if a film cannot be drawn for another reason.
    """
    files.make_folder(folder)
    with files.atomic_write(folder / "index.html") as index, tempfile.TemporaryDirectory() as work:
        (folder / "index.html").unlink(missing_ok=True)
        filmed = films.film_jobs(pathlib.Path(work), quick)
        not_drawn = opengl.missing([each.path.stem for each in filmed]) if opengl.problem() else ""
        filmed = [] if not_drawn else filmed
        # The checks take longest, and compile what the films run; plots are quick.
        checks = SimpleNamespace(path=folder / "checks", write=partial(validate, None))
        drawn = [checks, *filmed, *page.plot_jobs(folder)]
        validation, *made = jobs.produce(drawn, console)
        stills, plots = made[: len(filmed)], made[len(filmed) :]
        shown = {each.path.stem: (each.path.read_bytes(), still) for each, still in zip(filmed, stills, strict=True)}
        pictures = {plot.name: plot for plot in plots if plot}
        index.write_text(page.html(validation, shown, pictures, quick, not_drawn), encoding="utf-8")
    return validation, not_drawn
