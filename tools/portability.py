"""Other tools that load MJCF, each in a virtual environment of its own: `python -m tools.portability` measures all.

The environments are in build/others, which git ignores, and stay there: the first run downloads about 1.5 GB.
"""

import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass

from filelock import FileLock

from mjbeer import Scene, exact
from mjbeer.model.export import export
from mjbeer.model.setting import ROLLINGS, Rolling, supported
from tests.support.scenes import SCENES

CHECKOUT = pathlib.Path(__file__).parents[1]
ENVIRONMENTS = CHECKOUT / "build" / "others"
START = 1.0, 0.5
"""phi [rad] and its rate [rad/s] at the start, on the way through more than half a swing in a second."""
FRICTION = 10.0
"""With less, the hoop would slip."""
_TIMESTEP, _HOOP = 1e-3, 2.5e-4
"""Timesteps [s]: the default, and for the hoop, which passes its bottom at 47 rad/s, that of its template."""
_CONSUMERS = pathlib.Path(__file__).parent / "consumers.py"


@dataclass(frozen=True)
class Other:
    """A tool that loads MJCF."""

    name: str
    requirements: tuple[str, ...]
    """What pip installs; none for the Python that runs the tests."""
    word: str
    """Its word in `consumers.TOOLS`."""
    precise: bool = True
    """Whether it computes in double precision."""

    def python(self) -> str:
        """Return the Python that has the tool, after installing it if need be.

        Raises:
          AbsentError: if pip cannot install it; the message has the reason.
        """
        if not self.requirements:
            return sys.executable
        folder = ENVIRONMENTS / self.name.replace(" ", "-")
        program, stamp = folder / "bin" / "python", folder / "installed.txt"
        ENVIRONMENTS.mkdir(parents=True, exist_ok=True)
        with FileLock(f"{folder}.lock"):  # several processes may run the tests
            if not stamp.exists() or stamp.read_text() != "\n".join(self.requirements):
                subprocess.run([sys.executable, "-m", "venv", "--clear", folder], check=True)
                pip = [
                    program,
                    "-m",
                    "pip",
                    "install",
                    "--quiet",
                    "--disable-pip-version-check",
                    "--only-binary=:all:",
                ]
                ran = subprocess.run(
                    [*pip, *self.requirements], capture_output=True, text=True, check=False
                )
                if ran.returncode:
                    shutil.rmtree(folder)
                    raise AbsentError(
                        f"pip cannot install {self.name}: {ran.stderr.strip().splitlines()[-1]}"
                    )
                stamp.write_text("\n".join(self.requirements))
        return str(program)


class AbsentError(Exception):
    """A tool cannot be had here."""


OLDEST = "3.3.4"
"""The oldest MuJoCo that loads portable exports: those before do not know the camera that a viewer begins with."""
# MJX 3.3 calls a function of JAX's with an argument that JAX has not had since; MJX's JAX is that of its time.
_MJX = "mujoco==3.3.*", "mujoco-mjx==3.3.*", "jax==0.8.0", "jaxlib==0.8.0"
OTHERS = (
    Other("MuJoCo 4", (), "mujoco"),
    Other(f"MuJoCo {OLDEST}", (f"mujoco=={OLDEST}",), "mujoco"),
    Other("MJX 3.3", _MJX, "mjx"),
    Other("MJX 3.3 single", _MJX, "mjx-single", precise=False),
    Other("mujoco_warp 4", ("mujoco==4.0.*", "mujoco-warp==4.0.*"), "warp", precise=False),
    Other("dm_control 1.0.50", ("dm_control==1.0.50", "mujoco==3.17.*"), "dm_control"),
)
BY_NAME = {other.name: other for other in OTHERS}


def wanted() -> list[str]:
    """Return the names in the environment's MJBEER_OTHERS, which are separated by commas; "all" is all of them.

    Raises:
      ValueError: if a name is unknown.
    """
    text = os.environ.get("MJBEER_OTHERS", "")
    names = (
        list(BY_NAME)
        if text == "all"
        else [name.strip() for name in text.split(",") if name.strip()]
    )
    if unknown := [name for name in names if name not in BY_NAME]:
        raise ValueError(
            f"MJBEER_OTHERS names {unknown[0]!r}; allowed are all, or some of {', '.join(BY_NAME)}"
        )
    return names


def timestep(name: str) -> float:
    """Return the timestep [s] for a scene by its name."""
    return _HOOP if name == "hoop" else _TIMESTEP


def cases() -> list[tuple[str, Rolling]]:
    """Return all scenes by name, each with every way of rolling that MuJoCo has for it."""
    return [
        (name, rolling)
        for name, scene in SCENES.items()
        for rolling in ROLLINGS
        if supported(scene, rolling)
    ]


def final_phi(scene: Scene) -> float:
    """Return phi [rad] after a second, by exact theory."""
    return float(exact(scene, [0.0, 1.0], *START).phi[-1])


def errors(other: Other, portable: bool = True) -> dict[tuple[str, str], float | str]:
    """Return the error of phi after a second [rad] in each case, or the reason why there is none.

    Raises:
      AbsentError: if the tool cannot be had.
    """
    python = other.python()
    with tempfile.TemporaryDirectory() as folder:
        paths = {}
        for number, (name, rolling) in enumerate(cases()):
            path = paths[name, rolling] = pathlib.Path(folder) / f"{number}.xml"
            scene, step = SCENES[name], timestep(name)
            export(
                scene, path, *START, rolling, timestep=step, friction=FRICTION, portable=portable
            )
        words = [python, _CONSUMERS, other.word, *paths.values()]
        env = {**os.environ, "JAX_PLATFORMS": "cpu", "MUJOCO_GL": "disable"}
        ran = subprocess.run(
            words, capture_output=True, text=True, check=False, env=env, cwd=folder
        )
    if ran.returncode:  # some tools end the process instead of raising an error
        last = ran.stderr.strip().splitlines()[-1]
        return dict.fromkeys(paths, f"it ends with {last[-120:]}")
    found = json.loads(ran.stdout.splitlines()[-1])
    return {
        (name, rolling): value
        if isinstance(value := found[str(path)], str)
        else abs(value - final_phi(SCENES[name]))
        for (name, rolling), path in paths.items()
    }


def row(other: Other, portable: bool) -> str:
    """Return the row of a tool in the table of docs/portability.md."""
    try:
        found = errors(other, portable)
    except AbsentError as error:
        return f"| {other.name} | {error} |"
    cells = []
    for kind in ("sliding", "frozen"):
        for rolling in ROLLINGS:
            values = [
                value
                for (name, how), value in found.items()
                if how == rolling and SCENES[name].attachment == kind
            ]
            reasons = [value for value in values if isinstance(value, str)]
            numbers = [
                math.inf if math.isnan(value) else value
                for value in values
                if isinstance(value, float)
            ]
            cells.append(reasons[0] if reasons else f"{max(numbers):.1e}")
    return f"| {other.name} | {' | '.join(cells)} |"


def main() -> None:
    """Print a table of all tools, or of those in MJBEER_OTHERS, with portable exports and with ordinary ones."""
    for portable in (True, False):
        print(
            f"\n{'portable' if portable else 'ordinary'} exports: largest error of phi after 1 s [rad]"
        )
        print(
            "| tool | "
            + " | ".join(
                f"{kind}, {rolling}" for kind in ("sliding", "frozen") for rolling in ROLLINGS
            )
        )
        for name in wanted() or BY_NAME:
            print(row(BY_NAME[name], portable), flush=True)


if __name__ == "__main__":
    main()
