"""How a motion is shown: what is drawn into its pictures besides the can, and below them."""

from dataclasses import dataclass
from typing import Literal, Self

from mjbeer.drawing.world.cameras import Camera
from mjbeer.model import looks
from mjbeer.theory.trajectory import Trajectory

Mark = Literal["phi", "paths", "forces", "ghost"]
"""phi: the angle of the load. paths: of a point on the rim and of the load's centre of mass. forces: N and F. ghost: a
can that accelerates evenly."""
_TITLES = {
    "sliding": "Beer that slides in its can without friction",
    "frozen": "Beer frozen to its can",
    "pendulum": "A pendulum in a rolling wheel",
    "hoop": "A weight on the rim of a hoop",
}
_DAMPED = "A can that its load or the air brakes"


@dataclass(frozen=True)
class Look:
    """What is drawn into the pictures of a motion besides the can, and below them."""

    title: str
    """What is seen, in a few words."""
    strips: tuple[str, ...] = ("phi", "u")
    """Names of the quantities in the charts below the picture."""
    marks: tuple[Mark, ...] = ("phi", "paths")
    """What is drawn to explain the motion."""
    camera: Camera = "auto"
    """How the camera moves."""

    @classmethod
    def usual(cls, trajectory: Trajectory, camera: Camera = "auto") -> Self:
        """Return the look of a motion of which nothing else is known."""
        title = _DAMPED if trajectory.scene.dissipates else _TITLES[looks.name(trajectory.scene)]
        if trajectory.rolling == "contact":
            return cls(title, strips=("phi", "normal"), marks=("phi", "paths", "forces"), camera=camera)
        if trajectory.scene.dissipates:
            return cls(title, strips=("phi", "u_dot"), camera=camera)
        if trajectory.scene.attachment == "sliding":
            return cls(title, strips=("phi", "ahead"), marks=("phi", "ghost"), camera=camera)
        return cls(title, camera=camera)
