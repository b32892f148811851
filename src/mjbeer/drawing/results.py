"""The table of a race: each can from its end, and when it has finished, by MuJoCo and by theory."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mjbeer.drawing.overlay.sheet import Sheet
from mjbeer.drawing.runner import Runner
from mjbeer.drawing.world.view import circle
from mjbeer.theory.segment import segment


@dataclass(frozen=True, eq=False)
class Results:
    """The table of the race: each can from its end, and when it has finished, by MuJoCo and by theory."""

    runners: Sequence[Runner]
    finish: Sequence[float]
    theory: Sequence[float]

    @classmethod
    def of(cls, length: float, runners: Sequence[Runner]) -> "Results":
        return cls(
            runners,
            [runner.finish(length) for runner in runners],
            [runner.finish_of_theory(length) for runner in runners],
        )

    def draw(self, sheet: Sheet, time: float, positions: np.ndarray, corner: tuple[int, int], unit: float) -> None:
        """Draw the table as it is at a `time` [s]; `corner` is its upper left corner."""
        sheet.blank(*corner, sheet.width, sheet.height)
        left, top = corner
        columns = left + unit * np.array([1.6, 3.6, 19.5, 25.0])
        for column, words in zip(columns[2:], ("MuJoCo", "theory"), strict=True):
            sheet.text((column, top + 1.2 * unit), words, 0.95 * unit, "#52606d", anchor=(0.5, 0.5))
        order = sorted(self.finish)
        for row, (runner, finish, theory, position) in enumerate(
            zip(self.runners, self.finish, self.theory, positions, strict=True)
        ):
            middle = top + (2.9 + 2.25 * row) * unit
            _section(sheet, np.array([columns[0], middle]), 0.95 * unit, runner, position)
            sheet.text((columns[1], middle), runner.name, 1.05 * unit, bold=time >= finish == order[0])
            if time >= finish:
                place = f"{order.index(finish) + 1}."
                sheet.text((columns[2] - 3.6 * unit, middle), place, 1.05 * unit, runner.colour, (1, 0.5), bold=True)
                sheet.text((columns[2], middle), f"{finish:.4f} s", 1.05 * unit, anchor=(0.5, 0.5))
                sheet.text((columns[3], middle), f"{theory:.4f} s", 1.05 * unit, anchor=(0.5, 0.5))


def _section(sheet: Sheet, centre: np.ndarray, radius: float, runner: Runner, position: np.ndarray) -> None:
    """Draw a can as seen along its axis, with its beer: a close-up of what is small in the picture."""
    scene, (_, phi, roll, _) = runner.trajectory.scene, position
    fill, tilt = scene.load.fill or 0.0, phi + scene.incline
    if fill > 1e-3:
        half = segment(fill).half_angle
        angles = tilt + np.linspace(-half, half, 40)
        arc = centre + radius * np.stack([-np.sin(angles), np.cos(angles)], axis=1)
        sheet.area(arc, (0.92, 0.58, 0.06) if scene.attachment == "sliding" else (0.62, 0.78, 0.90))
    sheet.line(centre + circle(radius), 0.14 * radius, runner.colour)
    turned = np.array([math.sin(roll + scene.incline), -math.cos(roll + scene.incline)])
    sheet.line(centre + radius * np.array([[0.72], [1.0]]) * turned, 0.2 * radius, "#c0272d")
