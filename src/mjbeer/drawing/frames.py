"""The pictures of a trajectory at given times, drawn one after the other: title, scene, and charts below."""

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from mjbeer import require
from mjbeer.drawing.overlay import guides
from mjbeer.drawing.overlay.charts import charts
from mjbeer.drawing.overlay.header import Header
from mjbeer.drawing.overlay.look import Look
from mjbeer.drawing.overlay.marks import Marks
from mjbeer.drawing.overlay.sheet import Sheet
from mjbeer.drawing.overlay.strip import Strip
from mjbeer.drawing.painter import Painter
from mjbeer.drawing.size import UNITS, whole
from mjbeer.drawing.world.canvas import Canvas
from mjbeer.drawing.world.display import Display, scale
from mjbeer.drawing.world.positions import coordinates
from mjbeer.drawing.world.shot import Shot
from mjbeer.exceptions import ParameterError
from mjbeer.theory.can import RADIUS
from mjbeer.theory.trajectory import Trajectory

_STRIP = 10
"""Height of the charts below a picture, in units."""
_NARROW = 24
"""Width up to which a picture has no charts below, in units."""
_FINE = 2000
"""Points of a path."""


def draw(
    trajectory: Trajectory, times: np.ndarray, width: int, height: int, look: Look, speed: float = 1.0
) -> Generator[np.ndarray]:
    """Return a generator of the pictures at some times [s], each of shape (height, width, 3), uint8.

    Raises:
      ParameterError: if a parameter is not allowed.
      RenderingError: while the first picture is drawn, if OpenGL does not work.
    """
    require.instance("trajectory", trajectory, Trajectory)
    if (np.diff(trajectory.time) <= 0).any():
        raise ParameterError(
            f"the times of a trajectory must increase for it to be drawn, got {require.shown(trajectory.time)}"
        )
    width, height = whole("width", width), whole("height", height)
    return _draw(trajectory, times, width=width, height=height, look=look, speed=speed)


def _draw(
    trajectory: Trajectory, times: np.ndarray, width: int, height: int, look: Look, speed: float
) -> Generator[np.ndarray]:
    stage = Stage.of(trajectory, width, height, look, speed)
    display = stage.display()
    with Canvas(display.model, width, stage.pixels[1]) as canvas:
        painter = Painter(canvas, display, stage.shot.still)
        for time, now in zip(times, coordinates(trajectory, times), strict=True):
            stage.sheet.boxes.clear()
            painter.paint(stage.sheet, stage.shot.view(time), now[None], stage.top)
            stage.explain(display, time, now)
            yield stage.sheet.picture()


@dataclass(frozen=True, eq=False)
class Stage:
    """Everything in the pictures of a trajectory but what OpenGL draws."""

    sheet: Sheet
    shot: Shot
    marks: Marks
    header: Header
    strip: Strip | None
    top: int
    """Row of the upper edge of the scene [pixels]."""
    pixels: tuple[int, int]
    """Width and height of the scene [pixels]."""
    unit: float
    """Unit of length of the sheet [pixels]."""

    @classmethod
    def of(cls, trajectory: Trajectory, width: int, height: int, look: Look, speed: float) -> "Stage":
        """Return the stage for pictures of a trajectory of a width and a height [pixels]."""
        scene, unit = trajectory.scene, height / UNITS
        header = Header(look, trajectory, speed, unit)
        has_room = len(trajectory.time) > 1 and width > _NARROW * unit
        below = round(_STRIP * unit) if has_room and look.strips else 0
        pixels = (width, height - header.height - below)
        fine = np.linspace(trajectory.time[0], trajectory.time[-1], _FINE)
        positions = coordinates(trajectory, fine)
        plane = -scene.can.length / scene.can.radius * RADIUS / 2
        u, lift = positions[:, 0], positions[:, 3]
        shot = Shot.fit(scene, look.camera, fine, u, lift, plane, pixels, forces="forces" in look.marks)
        marks = Marks(trajectory, look.marks, plane, fine, positions)
        strip = Strip(charts(trajectory, look.strips), width, below) if below else None
        return cls(Sheet(width, height), shot, marks, header, strip, header.height, pixels, unit)

    @property
    def reach(self) -> tuple[float, float]:
        """Return the lowest and the highest u of the motion, as drawn [m]."""
        along = self.marks.positions[:, 0] * scale(self.marks.scene)
        return float(along.min()), float(along.max())

    def display(self) -> Display:
        """Return the model to be drawn."""
        return Display.of([self.marks.scene], *self.reach)

    def explain(self, display: Display, time: float, now: np.ndarray) -> None:
        """Draw title, guides, marks and charts at a `time` [s], with u, phi, roll and lift `now`."""
        view = self.shot.view(time)
        board = guides.Board.of(self.marks.scene, display.model)
        self.marks.draw(self.sheet, view, self.top, time, now)
        guides.draw(self.sheet, board, view, self.top, self.unit)
        self.header.draw(self.sheet, time)
        if self.strip is not None:
            self.strip.draw(self.sheet, time, self.top + self.pixels[1])
