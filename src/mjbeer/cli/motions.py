"""The commands about one motion: simulate, render and export."""

import math
import pathlib
from contextlib import nullcontext
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np

from mjbeer.cli.arguments import Motion, Start, if_given
from mjbeer.drawing.camera import Camera
from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import MujocoIntegrator, Rolling
from mjbeer.output import files, terminal
from mjbeer.output.terminal import say

if TYPE_CHECKING:
    from mjbeer.cli.figures import Figures
    from mjbeer.theory.trajectory import Trajectory

_FPS = 30
"""Pictures per second of a video."""
_TURN = 1.0
"""Largest turn from picture to picture [rad] that the eye can follow well: a sixth of a circle."""


@dataclass(frozen=True)
class Simulate(Motion):
    """Simulate a scene and print its key figures, with an estimate of the error."""

    output: Annotated[pathlib.Path | None, if_given(pathlib.Path, "no CSV")] = None
    """CSV file to write; "-" is standard output."""
    json: bool = False
    """Print the key figures and the warnings as JSON."""

    def run(self) -> int:
        """Run the command and return its exit status, 0."""
        from mjbeer.cli.figures import Figures
        from mjbeer.theory.trajectory import csv

        to_output = str(self.output) == "-"
        if to_output and self.json:
            raise ParameterError("standard output takes one of them: the JSON, or the CSV of --output -")
        with files.whole(self.output) if self.output and not to_output else nullcontext() as temporary:
            figures = Figures(self.simulate(), self.friction)
            if temporary:
                temporary.write_text(csv(figures.trajectory), encoding="utf-8")
        if temporary:
            say(f"wrote {self.output}")
        if to_output:
            terminal.write(csv(figures.trajectory))
            say(figures.text().rstrip())
        else:
            terminal.write(figures.json() if self.json else figures.text())
        _warn(figures)
        return 0


@dataclass(frozen=True)
class Render(Motion):
    """Simulate a scene and draw it as a video (MP4)."""

    output: pathlib.Path = pathlib.Path("mjbeer.mp4")
    """MP4 file to write."""
    speed: float = 1.0
    """Playback speed: 1 is real time, 0.25 is four times slower."""
    camera: Camera = "auto"
    """Camera: fixed (it stands still and shows the whole motion), pan (it moves along with a constant acceleration),
    close (it goes along with the can), or auto: fixed, unless the can would be too small."""
    width: int = 1280
    """Width of the video [pixels]."""
    height: int = 720
    """Height of the video [pixels]."""

    def run(self) -> int:
        """Run the command and return its exit status, 0."""
        from mjbeer.cli.figures import Figures
        from mjbeer.drawing.video import render

        trajectory = self.simulate()
        _warn(Figures(trajectory, self.friction))
        _warn_of_turns(trajectory, self.speed)
        render(
            trajectory,
            self.output,
            width=self.width,
            height=self.height,
            fps=_FPS,
            speed=self.speed,
            camera=self.camera,
        )
        say(f"wrote {self.output}")
        return 0


@dataclass(frozen=True)
class Export(Start):
    """Write a scene with its start as one MJCF file that MuJoCo 4 loads without mjbeer."""

    output: pathlib.Path
    """MJCF file to write, whose name ends in .xml; its keyframe "start" is the initial state."""
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
    """Write MJCF that MuJoCo 3.3.1, MJX, mujoco_warp and dm_control load too. In double precision the paper's scenes
    are within 1e-7 rad of exact theory after a second, as without it; with a contact within 2e-6 rad, not 3e-7.
    docs/portability.md has each tool's error. The integrator must be Euler, implicitfast or RK4."""

    def run(self) -> int:
        """Run the command and return its exit status, 0."""
        from mjbeer.model.export import export

        export(
            self.scene.told_scene(),
            self.output,
            **self.state,
            rolling=self.rolling,
            integrator=self.integrator,
            timestep=self.timestep,
            friction=self.friction,
            portable=self.portable,
        )
        start = 'its start is a keyframe: mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)'
        say(f"wrote {self.output}; {start}")
        return 0


def _warn_of_turns(trajectory: "Trajectory", speed: float) -> None:
    """Say how slowly a motion must be shown in which can or load turn too far from picture to picture."""
    fastest = max(float(np.abs(rate).max()) for rate in (trajectory.roll_dot, trajectory.phi_dot))
    turn = fastest * speed / _FPS
    if turn > _TURN:
        slower = speed * _TURN / turn
        digit = 10.0 ** math.floor(math.log10(slower))
        advice = math.floor(slower / digit) * digit  # never rounded up to the speed itself
        say(
            f"note: can or load turn by up to {math.degrees(turn):.0f} degrees from picture to picture, which deceives "
            f"the eye; --speed {advice:.1g} shows it better",
            "yellow",
        )


def _warn(figures: "Figures") -> None:
    for warning in figures.trajectory.warnings:
        say(f"not to be trusted: {warning}", "yellow")
    for note in figures.notes:
        say(f"note: {note}", "yellow")
