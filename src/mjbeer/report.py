"""The report: the tables, a video of each scene and the paper's stories, in a folder with a summary."""

import pathlib

from rich.console import Console

from mjbeer.drawing import studio
from mjbeer.drawing.studio import Order
from mjbeer.output import files
from mjbeer.paper.stories import report
from mjbeer.report_films import FILMS
from mjbeer.studies.validation import tables
from mjbeer.studies.validation.run import Validation, validate


def write(folder: pathlib.Path, quick: bool, console: Console) -> tuple[Validation, list[str]]:
    """Write validation.json, a video and a picture of each scene, the paper's stories and summary.md into a folder.

    Quickly, the videos are smaller and the stories have plots and no films. Where there is no OpenGL, all is written
    but videos, pictures and films. What comes back is the validation, and the names of the videos and films that are
    missing for that reason.

    Every file appears whole or not at all; the summary comes last, and that of an earlier report goes first.

    Raises:
      OutputError: if the folder cannot be written to.
      RenderingError: if a video cannot be drawn for another reason, as without ffmpeg.
    """
    from mjbeer.drawing import opengl

    size = (640, 360, 15) if quick else (1280, 720, 30)
    with files.whole(folder / "summary.md") as summary:  # a folder that cannot be written to fails here
        validation = validate(console)
        (folder / "summary.md").unlink(missing_ok=True)
        files.write(folder / "validation.json", tables.to_json(validation))
        orders = [Order(film, folder / f"{name}.mp4", *size) for name, film in FILMS.items()]
        orders += [] if quick else report.orders(folder / "paper")
        missing = [str(order.path.relative_to(folder)) for order in orders] if opengl.problem() else []
        report.write(folder / "paper", False, console)
        if not missing:
            studio.produce(orders, console)
        console.print(f"wrote {folder / 'paper'}", highlight=False, markup=False, soft_wrap=True)
        summary.write_text(_summary(validation, missing), encoding="utf-8")
    return validation, missing


def _summary(validation: Validation, missing: list[str]) -> str:
    from mjbeer.drawing import opengl

    results, findings = validation.results, validation.findings
    lines = ["# mjbeer: report", ""]
    lines += [f"{tables.sentence(validation)}.", ""]
    lines += [f"Films: {opengl.missing(missing)}", ""] if missing else []
    for name, film in FILMS.items():
        if f"{name}.mp4" in missing:
            continue
        lines += [f"## {name}", "", f"[![{name}]({name}.png)]({name}.mp4)", "", film.caption, ""]
    lines += ["## The paper's stories", "", "A plot each: [paper/stories.md](paper/stories.md).", ""]
    lines += ["## Validation against exact theory", "", tables.validation(results, document=True).markdown(title=False)]
    lines += ["## The paper, equation by equation", "", tables.audit(findings, document=True).markdown(title=False)]
    return "\n".join(lines)
