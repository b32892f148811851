"""The report: one page with the checks, a film of each scene and the paper's stories."""

import pathlib
import tempfile
from dataclasses import replace
from functools import partial
from types import SimpleNamespace

from rich.console import Console

from mjbeer.drawing import jobs, opengl
from mjbeer.output import files
from mjbeer.paper import stories
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
        path = pathlib.Path(work)
        drawn = films.orders(path, quick)
        told = [] if quick else stories.films(path)
        not_drawn = opengl.missing([each.path.stem for each in drawn + told]) if opengl.problem() else ""
        drawn, told = ([], []) if not_drawn else (drawn, told)
        plots = [*page.plots(path), *(replace(plot, in_memory=True) for plot in stories.plots(path))]
        # The checks take longest, and compile what the films run; plots are quick.
        checks = SimpleNamespace(path=path / "checks", write=partial(validate, None))
        orders = [checks, *drawn, *told, *plots]
        validation, *made = jobs.produce(orders, console)
        still = {order.path: poster for order, poster in zip(drawn + told, made, strict=False)}
        scenes, filmed = (
            {each.path.stem: (each.path.read_bytes(), still[each.path]) for each in of} for of in (drawn, told)
        )
        pictures = {plot.name: plot for plot in made[len(drawn + told) :]}
        index.write_text(page.html(validation, scenes, pictures, filmed, quick, not_drawn), encoding="utf-8")
    return validation, not_drawn
