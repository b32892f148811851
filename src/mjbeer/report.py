"""The report: the tables, a video of each scene and the paper's stories, in a folder with a summary."""

import math
import pathlib

from rich.console import Console

from mjbeer.drawing.film import Film
from mjbeer.output import files
from mjbeer.paper.stories import report
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.validation import tables
from mjbeer.studies.validation.run import Validation, validate
from mjbeer.theory.can import Can
from mjbeer.theory.scene import frozen, hoop, pendulum, sliding

_FILMS = {
    "sliding": Film(
        speed=0.5,
        trajectory=lambda: simulate(sliding(can=Can.sheet_metal()), 2.0, math.radians(60), tolerance=1e-9),
        caption="Half a can of beer, let go at 60 degrees. The beer slides in its can without friction and swings; the "
        "can rolls away under it, hesitating with every swing. Half of real time.",
        still=0.6,
    ),
    "frozen": Film(
        speed=0.25,
        trajectory=lambda: simulate(frozen(), 0.82, math.pi, tolerance=1e-9),
        caption="The beer is frozen to the can, let go with the beer on top: it rolls down ever faster, in jerks. It "
        "ends just before the can would leave the incline. A quarter of real time.",
        still=0.25,
    ),
    "pendulum": Film(
        speed=0.5,
        trajectory=lambda: simulate(pendulum(), 2.0, math.radians(60), tolerance=1e-9),
        caption="A hoop wheel with a pendulum on its axle, let go at 60 degrees. Half of real time.",
        still=0.6,
    ),
    "hoop": Film(
        speed=0.1,
        trajectory=lambda: simulate(hoop(), 0.5, -3.0, 16.0, rolling="contact", timestep=2e-4),
        caption="A light hoop with a heavy bar on its rim, pushed with the bar on top, on level ground. It rolls over "
        "once, and hops a radius high when the bar comes up: nothing holds it down but its weight. A tenth of real "
        "time.",
        still=0.24,
    ),
}


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
    from mjbeer.drawing.video import render, save_frame

    size = (640, 360, 15) if quick else (1280, 720, 30)
    with files.whole(folder / "summary.md") as summary:  # a folder that cannot be written to fails here
        validation = validate(console)
        (folder / "summary.md").unlink(missing_ok=True)
        files.write(folder / "validation.json", tables.to_json(validation))
        drawn = {} if opengl.problem() else _FILMS
        for name, film in drawn.items():
            trajectory = film.trajectory()
            render(trajectory, folder / f"{name}.mp4", *size, film.speed)
            save_frame(trajectory, film.still, folder / f"{name}.png")
            console.print(f"wrote {folder / name}.mp4", highlight=False, markup=False, soft_wrap=True)
        missing = [f"{name}.mp4" for name in _FILMS if name not in drawn]
        missing += [f"paper/{name}" for name in report.write(folder / "paper", not quick, console)]
        console.print(f"wrote {folder / 'paper'}", highlight=False, markup=False, soft_wrap=True)
        summary.write_text(_summary(validation, missing), encoding="utf-8")
    return validation, missing


def _summary(validation: Validation, missing: list[str]) -> str:
    from mjbeer.drawing import opengl

    results, findings = validation.results, validation.findings
    lines = ["# mjbeer: report", ""]
    lines += [f"{tables.sentence(validation)}.", ""]
    lines += [f"Films: {opengl.missing(missing)}", ""] if missing else []
    for name, film in _FILMS.items():
        if f"{name}.mp4" in missing:
            continue
        lines += [f"## {name}", "", f"[![{name}]({name}.png)]({name}.mp4)", "", film.caption, ""]
    lines += ["## The paper's stories", "", "A plot each: [paper/stories.md](paper/stories.md).", ""]
    lines += ["## Validation against exact theory", "", tables.validation(results, document=True).markdown(title=False)]
    lines += ["## The paper, equation by equation", "", tables.audit(findings, document=True).markdown(title=False)]
    return "\n".join(lines)
