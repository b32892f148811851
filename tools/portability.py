"""Other tools that load MJCF, each in a virtual environment of its own.

`python -m tools.portability` measures all. The environments are in build/others, which git ignores,
and stay there: the first run downloads about 1.5 GB.
"""

import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
from dataclasses import dataclass

from mjbeer import Scene, exact
from mjbeer.model.export import export
from mjbeer.model.setting import ROLLINGS, Rolling, supported
from tests.support.scenes import SCENES
from tools.environments import CHECKOUT, AbsentError, python_with

ENVIRONMENTS = CHECKOUT / "build" / "others"
START = 1.0, 0.5
"""phi [rad] and its rate [rad/s] at the start: more than half a swing follows in a second."""
FRICTION = 10.0
"""With less, the hoop would slip."""
_TIMESTEP = 1e-3
"""The timestep [s] by default."""
_HOOP_TIMESTEP = 2.5e-4
"""The timestep [s] of the hoop's template, as the hoop passes its bottom at 47 rad/s."""
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
        return python_with(folder, self.name, self.requirements)


OLDEST = "3.3.4"
"""The oldest MuJoCo that loads portable exports.

Those before do not know the camera that a viewer begins with.
"""
# MJX 3.3 calls a function of JAX's with an argument that JAX has not had since, so that it needs
# the JAX of its time.
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
    """Return the names in the environment's MJBEER_OTHERS.

    They are separated by commas there; "all" is all of them.

    Raises:
      ValueError: if a name is unknown.
    """
    text = os.environ.get("MJBEER_OTHERS", "")
    if text == "all":
        return list(BY_NAME)
    names = [name.strip() for name in text.split(",") if name.strip()]
    if unknown := [name for name in names if name not in BY_NAME]:
        raise ValueError(
            f"MJBEER_OTHERS names {unknown[0]!r}; allowed are all, or some of {', '.join(BY_NAME)}"
        )
    return names


def timestep(name: str) -> float:
    """Return the timestep [s] for a scene by its name."""
    return _HOOP_TIMESTEP if name == "hoop" else _TIMESTEP


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
            path = pathlib.Path(folder) / f"{number}.xml"
            export(
                SCENES[name],
                path,
                *START,
                rolling,
                timestep=timestep(name),
                friction=FRICTION,
                portable=portable,
            )
            paths[name, rolling] = path
        ran = subprocess.run(
            [python, _CONSUMERS, other.word, *paths.values()],
            capture_output=True,
            text=True,
            check=False,
            env={**os.environ, "JAX_PLATFORMS": "cpu", "MUJOCO_GL": "disable"},
            cwd=folder,
        )
    if ran.returncode:  # some tools end the process instead of raising an error
        last = ran.stderr.strip().splitlines()[-1]
        return dict.fromkeys(paths, f"it ends with {last[-120:]}")
    told = json.loads(ran.stdout.splitlines()[-1])
    found: dict[tuple[str, str], float | str] = {}
    for (name, rolling), path in paths.items():
        value = told[str(path)]
        if isinstance(value, str):
            found[name, rolling] = value
        else:
            found[name, rolling] = abs(value - final_phi(SCENES[name]))
    return found


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
    """Print a table of portable exports and one of ordinary ones.

    Each has a row for every tool, or for those in MJBEER_OTHERS.
    """
    columns = [f"{kind}, {rolling}" for kind in ("sliding", "frozen") for rolling in ROLLINGS]
    for portable in (True, False):
        exports = "portable" if portable else "ordinary"
        print(f"\n{exports} exports: largest error of phi after 1 s [rad]")
        print(f"| tool | {' | '.join(columns)}")
        for name in wanted() or BY_NAME:
            print(row(BY_NAME[name], portable), flush=True)


if __name__ == "__main__":
    main()
