"""The style of a film: its title and charts, its marks and notes, and its camera."""

from dataclasses import dataclass
from typing import Literal, NamedTuple, Self

import numpy as np

from mjbeer.drawing.camera import Camera
from mjbeer.model import looks
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

Mark = Literal["ghost", "paths", "normal", "friction", "phi", "equilibrium", "measured"]
"""What can be drawn to explain a motion.

ghost: a can that accelerates evenly. paths: those of a point on the rim and of the load's centre of
mass. normal: the normal force N. friction: the friction F. phi: the angle of the load.
equilibrium: that angle in the equilibrium. measured: where a filmed axis has been so far.
"""


class SceneNames(NamedTuple):
    """What a scene and its parts are called in a film."""

    title: str
    """The title of a film for which no other is given."""
    body: str
    """What rolls."""
    load: str
    """What is in it."""


_NAMES = {
    "sliding": SceneNames("Beer that slides in its can without friction", "can", "beer"),
    "frozen": SceneNames("Beer frozen to its can", "can", "beer"),
    "pendulum": SceneNames("A pendulum in a rolling wheel", "wheel", "bob"),
    "hoop": SceneNames("A weight on the rim of a hoop", "hoop", "bar"),
}
"""What scenes and their parts are called, by how the scenes look."""


def scene_names(scene: Scene) -> SceneNames:
    """Return what a scene and its parts are called in a film."""
    return _NAMES[looks.name(scene)]


@dataclass(frozen=True)
class FilmStyle:
    """What is drawn into the pictures of a motion besides the can, and below them."""

    title: str
    """What is seen, in a few words."""
    strips: tuple[str, ...] = ("phi", "u")
    """Names of the quantities in the charts below the picture."""
    marks: tuple[Mark, ...] = ("phi", "paths")
    """What is drawn to explain the motion."""
    camera: Camera = "auto"
    """How the camera moves."""
    notes: tuple[str, ...] = ()
    """What is said while it happens; the charts show when each of them holds."""
    facts: str = ""
    """What else to know of the motion, such as how it is started; it stands at the right."""
    notes_aside: bool = False
    """Whether what moves passes beside the notes, which then need no room above it."""
    answer: str = ""
    """What is said at the end of the motion, in place of a note."""
    measured: np.ndarray | None = None
    """Times [s] and places u [m] of a filmed axis, shape (points, 2)."""

    @classmethod
    def usual(cls, trajectory: Trajectory, camera: Camera = "auto") -> Self:
        """Return the style of a motion for which no other is given."""
        scene = trajectory.scene
        title = scene_names(scene).title
        if scene.dissipates:
            title = "A can that its load or the air brakes"
        if trajectory.rolling == "contact":
            return cls(
                title,
                strips=("phi", "normal"),
                marks=("phi", "paths", "normal", "friction"),
                camera=camera,
            )
        if scene.dissipates:
            return cls(title, strips=("phi", "u_dot"), camera=camera)
        if scene.attachment == "sliding":
            return cls(title, strips=("phi", "ahead"), marks=("phi", "ghost"), camera=camera)
        return cls(title, camera=camera)
