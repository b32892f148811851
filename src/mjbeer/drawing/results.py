"""The table of a race: each can from its end, and when it has finished, by MuJoCo and by theory."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mjbeer.drawing.overlay.sheet import Sheet
from mjbeer.drawing.runner import Runner
from mjbeer.drawing.world.view import circle
from mjbeer.theory.load import segment


@dataclass(frozen=True, eq=False)
class Results:
    """The table of the race: each can from its end, and when it has finished, by MuJoCo and by theory.

    Of a can that does not finish it has how far it has come when the last of the others does.
    """

    runners: Sequence[Runner]
    finish: Sequence[float]
    words: Sequence[tuple[str, str]]
    """What is written of each can once it has finished, or all have: by MuJoCo, and by theory."""
    end: float
    """When the last can finishes that does [s]."""

    @classmethod
    def of(cls, length: float, runners: Sequence[Runner], end: float) -> "Results":
        finish = [runner.finish(length) for runner in runners]
        words = []
        for runner, time in zip(runners, finish, strict=True):
            if time < math.inf:
                words.append((f"{time:.4f} s", f"{runner.finish_of_theory(length):.4f} s"))
            else:
                way = float(runner.positions(np.array([end]))[0, 0])
                words.append((f"{way:.4f} m", f"{runner.way_of_theory(end):.4f} m"))
        return cls(runners, finish, words, end)

    def draw(self, sheet: Sheet, time: float, positions: np.ndarray, corner: tuple[int, int], unit: float) -> None:
        """Draw the table as it is at a `time` [s]; `corner` is its upper left corner."""
        sheet.blank(*corner, sheet.width, sheet.height)
        left, top = corner
        columns = left + unit * np.array([1.6, 3.6, 19.5, 25.0])
        for column, by in zip(columns[2:], ("MuJoCo", "theory"), strict=True):
            sheet.text((column, top + 1.2 * unit), by, 0.95 * unit, "#52606d", anchor=(0.5, 0.5))
        order = sorted(self.finish)
        for row, (runner, finish, words, position) in enumerate(
            zip(self.runners, self.finish, self.words, positions, strict=True)
        ):
            middle = top + (2.9 + 2.25 * row) * unit
            _section(sheet, np.array([columns[0], middle]), 0.95 * unit, runner, position)
            sheet.text((columns[1], middle), runner.name, 1.05 * unit, bold=time >= finish == order[0])
            if time >= finish:
                place = f"{order.index(finish) + 1}."
                sheet.text((columns[2] - 3.6 * unit, middle), place, 1.05 * unit, runner.colour, (1, 0.5), bold=True)
            if time >= min(finish, self.end):
                for column, number in zip(columns[2:], words, strict=True):
                    sheet.text((column, middle), number, 1.05 * unit, anchor=(0.5, 0.5))


def _section(sheet: Sheet, centre: np.ndarray, radius: float, runner: Runner, position: np.ndarray) -> None:
    """Draw a can as seen along its axis, with its beer: a close-up of what is small in the picture."""
    scene, (_, phi, roll, _) = runner.trajectory.scene, position
    fill, tilt = scene.load.fill or 0.0, phi + scene.incline
    if fill > 1e-3:
        half = segment(fill).half_angle
        angles = tilt + np.linspace(-half, half, 40)
        arc = centre + radius * np.stack([-np.sin(angles), np.cos(angles)], axis=1)
        usual = (0.92, 0.58, 0.06) if scene.attachment == "sliding" else (0.62, 0.78, 0.90)
        sheet.area(arc, runner.load or usual)
    sheet.line(centre + circle(radius), 0.14 * radius, runner.colour)
    turned = np.array([math.sin(roll + scene.incline), -math.cos(roll + scene.incline)])
    sheet.line(centre + radius * np.array([[0.72], [1.0]]) * turned, 0.2 * radius, "#c0272d")
