"""The film of a race: cans let go together on one incline, and the order in which they reach its end."""

import math
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass

import numpy as np

from mjbeer.drawing.course import Course, draw, last
from mjbeer.drawing.film import Reel
from mjbeer.drawing.runner import Runner
from mjbeer.drawing.size import whole
from mjbeer.exceptions import ParameterError


@dataclass(frozen=True)
class Race:
    """A film of several cans of one size, let go together on one incline."""

    title: str
    runners: Callable[[], Sequence[Runner]]
    """A function that computes the motions, and that can be pickled."""
    length: float
    """Distance from start to finish [m]."""
    speed: float
    """Playback speed: 1 is real time, 0.5 is half as fast."""
    told: Callable[[], str]
    """A function that says what is seen, in whole sentences, for the text beside the film."""
    still: float
    """Time of the motion that the still picture of the film shows [s]."""
    after: float = 0.0
    """How long the film goes on after the last can has finished, in seconds of the motion [s]."""

    @property
    def caption(self) -> str:
        """Return what is seen."""
        return self.told()

    def reel(self) -> Reel:
        """Compute the motions, and return what is needed to draw them.

        A can that does not finish is followed until the others have.

        Raises:
          ParameterError: if no can finishes, or the motion of one that does not ends before that of the film.
        """
        runners = self.runners()
        end = last(runners, self.length) + self.after
        for runner in runners:
            if runner.finish(self.length) == math.inf and not runner.trajectory.time[-1] >= end:
                raise ParameterError(
                    f"{runner.name} rolls {runner.distance[-1]:.3g} m to t = {runner.trajectory.time[-1]:.3g} s, and "
                    f"the race is over {self.length:g} m and lasts {end:.3g} s"
                )

        def pictures(times: np.ndarray, width: int, height: int) -> Generator[np.ndarray]:
            return draw(self.course(runners, width, height), times)

        return Reel(0.0, end, self.speed, pictures)

    def course(self, runners: Sequence[Runner], width: int, height: int) -> Course:
        """Return what is drawn of the race, in pictures of a width and a height [pixels]."""
        width, height = whole("width", width), whole("height", height)
        return Course.of(self.title, self.length, self.speed, runners, width, height)
