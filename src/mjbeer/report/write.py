"""The report: one page with the checks, films and the paper's stories; maps and a race to play lie beside it."""

import pathlib
import tempfile
from functools import partial
from types import SimpleNamespace

from rich.console import Console

from mjbeer.drawing import opengl, video
from mjbeer.output import files
from mjbeer.report import films, page
from mjbeer.studies.validation.validate import Validation, validate

_HERE = pathlib.Path(__file__).parent
_LIVE = _HERE / "web" / "live.html", _HERE.parents[2] / "docs" / "live.html"  # in a wheel, and in a checkout


def write(folder: pathlib.Path, quick: bool, console: Console) -> tuple[Validation, str]:
    """Write index.html and live.html into a folder, each whole or not at all; that of an earlier report goes first.

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
        validation, *made = video.produce(drawn, console)
        stills, plots = made[: len(filmed)], made[len(filmed) :]
        shown = {each.path.stem: (each.path.read_bytes(), still) for each, still in zip(filmed, stills, strict=True)}
        pictures = {plot.name: plot for plot in plots if plot}
        files.write(folder / "live.html", next(filter(pathlib.Path.is_file, _LIVE)).read_text(encoding="utf-8"))
        index.write_text(page.html(validation, shown, pictures, quick, not_drawn), encoding="utf-8")
    return validation, not_drawn
