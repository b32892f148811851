"""The command `mjbeer view`: a scene in MuJoCo's viewer."""

from dataclasses import dataclass

from mjbeer.cli.arguments import Start
from mjbeer.model.setting import MujocoIntegrator, Rolling


@dataclass(frozen=True)
class View(Start):
    """Open a scene in MuJoCo's viewer, paused at its start.

    The space bar runs and pauses it, backspace goes back to the start, and F4 plots u, phi and the other sensors.
    """

    rolling: Rolling | None = None
    """What makes the can roll: reduced coordinates, a joint equality, or contact with friction. If not given, it is a
    joint equality, or reduced coordinates for a massless can with a sliding load. The reduced model of a frozen load
    has phi as its only coordinate, so it turns in place."""
    integrator: MujocoIntegrator = "RK4"
    """Integrator: one of MuJoCo's, by its name in MJCF."""
    timestep: float = 1e-3
    """Timestep [s]."""
    friction: float = 1.0
    """Coefficient of friction, used only with rolling by contact."""
    speed: float = 1.0
    """Playback speed: 1 is real time, 0.25 is four times slower."""

    def run(self) -> int:
        """Run the command and return its exit status, 0."""
        from mjbeer.drawing.viewer import view

        view(
            self.scene.told_scene(),
            **self.state,
            rolling=self.rolling,
            integrator=self.integrator,
            timestep=self.timestep,
            friction=self.friction,
            speed=self.speed,
        )
        return 0
