"""The films of the report, in the order in which the page shows them, and how to draw them."""

import math
import pathlib
from collections.abc import Sequence

from rich.console import Console

from mjbeer.drawing.film import Film
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.scene import frozen, hoop, pendulum, sliding

FILMS = {
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
RACE = "race"
"""The film that the page shows first and alone."""
COMMANDS = {
    "sliding": "mjbeer render sliding --can metal --phi0 60 --tolerance 1e-9 --speed 0.5",
    "frozen": "mjbeer render frozen --phi0 180 --duration 0.82 --tolerance 1e-9 --speed 0.25",
    "pendulum": "mjbeer render pendulum --phi0 60 --tolerance 1e-9 --speed 0.5",
    "hoop": "mjbeer render hoop --phi0 -171.8873 --phi-dot0 916.7325 --duration 0.5 --rolling contact --timestep 2e-4 "
    "--speed 0.1",
}
"""The command that draws a film by itself; the others are drawn by `mjbeer report` alone."""


def draw(folder: pathlib.Path, quick: bool, console: Console) -> None:
    """Draw each film and its still picture into a folder, as `name`.mp4 and `name`.png; smaller ones if `quick`.

    Raises:
      OutputError: if the folder cannot be written to.
      RenderingError: if a film cannot be drawn.
    """
    from mjbeer.drawing.video import render, save_frame

    size = (640, 360, 15) if quick else (1280, 720, 30)
    for name, film in FILMS.items():
        trajectory = film.trajectory()
        render(trajectory, folder / f"{name}.mp4", *size, film.speed)
        save_frame(trajectory, film.still, folder / f"{name}.png")
        console.print(f"wrote {folder / name}.mp4", highlight=False, markup=False, soft_wrap=True)


def not_drawn(names: Sequence[str]) -> str:
    """Return the line that says why films are missing and what brings them, or "" where they can be drawn."""
    from mjbeer.drawing import encoder, opengl

    if opengl.problem():
        return opengl.missing(names)
    return encoder.missing(names) if encoder.problem() else ""
