"""The commands about one motion: simulate, render and export."""

import pathlib
from dataclasses import dataclass

from mjbeer.cli.arguments import AnyScene, Motion, radians
from mjbeer.model.setting import MujocoIntegrator, Rolling
from mjbeer.output import files, terminal
from mjbeer.output.terminal import STDERR, say, show


@dataclass(frozen=True)
class Simulate(Motion):
    """Simulate a scene, print its key figures with an estimate of the error, and write the motion as CSV."""

    output: pathlib.Path | None = None
    """CSV file to write; "-" is standard output. If not given, no CSV is written."""

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
    """MP4 file to write."""
    speed: float = 1.0
    """Playback speed: 1 is real time, 0.25 is four times slower."""
    camera: str = "side"
    """Camera: side (the can's open end), quarter (from above and downhill) or overview (the whole motion)."""
    width: int = 1280
    """Width of the video [pixels]."""
    height: int = 720
    """Height of the video [pixels]."""

    def run(self) -> int:
        """Run the command and return its exit status, 0."""
        from mjbeer.drawing.video import render

        trajectory = self.simulate()
        _warn(trajectory.warnings)
        render(
            trajectory,
            self.output,
            width=self.width,
            height=self.height,
            speed=self.speed,
            camera=self.camera,
        )
        say(f"wrote {self.output}")
        return 0


@dataclass(frozen=True)
class Export:
    """Write a scene as one MJCF file that MuJoCo 4 loads without mjbeer, with the initial state as a keyframe."""

    scene: AnyScene
    output: pathlib.Path
    """MJCF file to write."""
    phi0: float = 60.0
    """Initial phi: the angle of the beer's surface to the incline, as in the paper's Fig. 3 [degrees]."""
    phi_dot0: float = 0.0
    """Initial rate of change of phi [degrees/s]."""
    rolling: Rolling = "reduced"
    """What makes the can roll: reduced coordinates, a joint equality, or contact with friction. The reduced model of a
    frozen load has phi as its only coordinate, so MuJoCo shows it turning in place."""
    integrator: MujocoIntegrator = "RK4"
    """Integrator: one of MuJoCo's, by its name in MJCF."""
    timestep: float = 1e-3
    """Timestep [s]."""
    friction: float = 1.0
    """Coefficient of friction, used only with rolling by contact."""
    portable: bool = False
    """Write MJCF that MuJoCo 3.3.1, MJX, mujoco_warp and dm_control load too. In double precision, the paper's scenes are
    then within 1e-7 rad of exact theory after a second, as without it; with a contact within 2e-6 rad, not 3e-7.
    docs/portability.md has each tool's error. The integrator must be Euler, implicitfast or RK4."""

    def run(self) -> int:
        """Run the command and return its exit status, 0."""
        from mjbeer.model.export import export

        export(
            self.scene.scene(),
            self.output,
            phi0=radians("phi0", self.phi0),
            phi_dot0=radians("phi_dot0", self.phi_dot0, "degrees/s"),
            rolling=self.rolling,
            integrator=self.integrator,
            timestep=self.timestep,
            friction=self.friction,
            portable=self.portable,
        )
        say(f"wrote {self.output}")
        return 0


def _warn(warnings: tuple[str, ...]) -> None:
    for warning in warnings:
        say(f"not to be trusted: {warning}", "yellow")
