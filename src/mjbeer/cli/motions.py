"""Commands about one motion: simulate, render, export."""

import pathlib
from dataclasses import dataclass

from mjbeer.cli.arguments import AnyScene, Motion, radians
from mjbeer.model.setting import MujocoIntegrator, Rolling
from mjbeer.output import files, terminal
from mjbeer.output.terminal import STDERR, say, show


@dataclass(frozen=True)
class Simulate(Motion):
    """Simulate a scene; show what the run says about itself, and write the motion as CSV."""

    output: pathlib.Path | None = None
    """CSV file to write; "-" for standard output."""

    def run(self) -> int:
        """Run the command and return its exit status, 0."""
        from mjbeer.cli.trajectory import csv, summary

        if self.output is None:
            trajectory = self.simulate()
            show(summary(trajectory))
        elif str(self.output) == "-":
            trajectory = self.simulate()
            terminal.write(csv(trajectory))
            STDERR.print(summary(trajectory))
        else:
            with files.whole(self.output) as temporary:
                trajectory = self.simulate()
                temporary.write_text(csv(trajectory), encoding="utf-8")
            say(f"wrote {self.output}")
            show(summary(trajectory))
        _warn(trajectory.warnings)
        return 0


@dataclass(frozen=True)
class Render(Motion):
    """Simulate a scene and draw it as a video (MP4)."""

    output: pathlib.Path = pathlib.Path("mjbeer.mp4")
    """Video to write."""
    speed: float = 1.0
    """Playback speed: 1 is real time, 0.25 four times slower."""
    camera: str = "side"
    """Camera: side, quarter or overview."""
    width: int = 1280
    """Width [pixels]."""
    height: int = 720
    """Height [pixels]."""

    def run(self) -> int:
        """Run the command and return its exit status, 0."""
        from mjbeer.drawing.video import render

        trajectory = self.simulate()
        _warn(trajectory.warnings)
        render(trajectory, self.output, self.width, self.height, speed=self.speed, camera=self.camera)
        say(f"wrote {self.output}")
        return 0


@dataclass(frozen=True)
class Export:
    """Write a scene as one MJCF file that any MuJoCo loads, with its start as a keyframe."""

    scene: AnyScene
    output: pathlib.Path
    """MJCF file to write."""
    phi0: float = 60.0
    """Start angle of the load to the incline, the paper's phi [degrees]."""
    phi_dot0: float = 0.0
    """Start rate of phi [degrees/s]."""
    rolling: Rolling = "reduced"
    """What makes the can roll; the reduced model of a frozen load turns on the spot."""
    integrator: MujocoIntegrator = "RK4"
    """Integrator."""
    timestep: float = 1e-3
    """Timestep [s]."""
    friction: float = 1.0
    """Friction coefficient of a contact."""

    def run(self) -> int:
        """Run the command and return its exit status, 0."""
        from mjbeer.model.export import export

        start = radians("phi0", self.phi0), radians("phi_dot0", self.phi_dot0, "degrees/s")
        settings = self.rolling, self.integrator, self.timestep, self.friction
        export(self.scene.scene(), self.output, *start, *settings)
        say(f"wrote {self.output}")
        return 0


def _warn(warnings: tuple[str, ...]) -> None:
    for each in warnings:
        say(f"not to be trusted: {each}", "yellow")
