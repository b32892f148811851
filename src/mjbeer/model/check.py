"""Checks whether files of MJCF, which anybody may edit, still move as theory says.

A mechanics file is checked when it is read, by `check_file`. A model that is drawn has looks as
well, and is checked by `check_drawn`. An edited file is also checked in the states of every run, by
`check_run`. All three compare accelerations, by `model_fault`.
"""

import functools
import hashlib
import pathlib
import xml.etree.ElementTree as ET

import mujoco
import numpy as np

from mjbeer.exceptions import TemplateError
from mjbeer.model import looks, mjcf_file
from mjbeer.model.compare import model_fault
from mjbeer.model.model_numbers import ModelNumbers
from mjbeer.model.setting import Rolling, Setting
from mjbeer.theory.can import Can, Damping, Load
from mjbeer.theory.equations import Coordinates, select_samples
from mjbeer.theory.scene import Attachment, Scene

SHIPPED = pathlib.Path(__file__).with_name("shipped.sha256")
"""The SHA-256 of mjbeer's own mechanics files, which `make templates` writes. Their motions are
compared with theory in tests and searches, so that their runs need not be checked. Any other
file, even one with only another comment, is checked in every run, which takes longer."""
_STATES = 1000
"""Largest number of a run's states, evenly spread, in which an edited file is checked. That takes
some 10 ms, or 20 in contact. What stops a can, or pushes it back, acts for longer than a thousandth
of most runs."""


def check_file(folder: pathlib.Path, attachment: Attachment, rolling: Rolling) -> str | None:
    """Return what is wrong with a mechanics file, None if nothing is.

    First, the file must have the numbers of the paper's can, into which mjbeer writes those of a
    scene. Second, once the numbers of a scene that needs all of its elements are written into it,
    it must have theory's accelerations.
    """
    massless = attachment == "frozen" or rolling == "reduced"
    can = Can.massless() if massless else Can.sheet_metal()
    scene = Scene(can, Load.segment(), attachment=attachment)
    paper = ModelNumbers(scene, Setting(rolling, mjcf=folder), visuals=True)
    return _file_fault(paper, paper.structure.content)


@functools.lru_cache(maxsize=64)
def _file_fault(paper: ModelNumbers, content: tuple[bytes, ...]) -> str | None:
    """Return what is wrong with the file of the paper's can.

    `content` is not read here: it makes the cache notice an edited file.
    """
    attachment = paper.scene.attachment
    damping = Damping(1e-3, 1e-4, 1e-5) if attachment == "sliding" else 0.0
    drag = 0.5 if attachment == "sliding" else 0.0
    can = Can(radius=0.05, length=0.1, mass=4.0, inertia=6e-3)
    load = Load(mass=0.3, offset=0.02, inertia=1e-4)
    other = Scene(can, load, 0.3, attachment, 5.0, damping, drag)
    root = mjcf_file.read(paper.path)
    edited = mjcf_file.differences(root, paper.parameters)
    mjcf_file.write(root, ModelNumbers(other, paper.setting, visuals=True).parameters, paper.path)
    fault = model_fault(_compile(root, paper.path), other, paper.setting)
    if fault is not None:
        return f"{paper.path} {fault}"
    if edited:
        names = ", ".join(edited)
        return (
            f"{paper.path} has other numbers than the paper; "
            f"mjbeer writes a scene's own numbers into {names}"
        )
    return None


def check_drawn(model: mujoco.MjModel, scene: Scene, setting: Setting) -> str | None:
    """Return what is wrong with a model that has looks, None if nothing is.

    The mechanics file has passed `check_file`, so it must be the looks that add a mass or a joint.
    """
    fault = model_fault(model, scene, setting)
    if fault is not None:
        return f"{setting.folder / 'looks'}, in {looks.name(scene)}, {fault}"
    return None


def is_edited(numbers: ModelNumbers) -> bool:
    """Return whether the mechanics file of a scene differs from mjbeer's own, wherever it lies.

    Raises:
      TemplateError: if the file is missing or not readable.
    """
    return digest(numbers.structure.content) != _shipped_digests()[numbers.path.name]


def digest(content: tuple[bytes, ...]) -> str:
    """Return the SHA-256 of the content of a mechanics file and of what it includes."""
    return hashlib.sha256(b"".join(content)).hexdigest()


@functools.cache
def _shipped_digests() -> dict[str, str]:
    """Return the SHA-256 of mjbeer's own mechanics files, by their names."""
    rows = [line.split() for line in SHIPPED.read_text().splitlines()]
    return {name: value for value, name in rows}


def check_run(numbers: ModelNumbers, motion: Coordinates) -> None:
    """Compare a file that `is_edited` with theory in the states of a run.

    A limit or a wall may act only there. The `motion` must be in the order of time. The states that
    are compared include the last one, and those with the largest and the smallest positions and
    rates. The model has the whole file, including what a model to be stepped leaves out.

    Raises:
      TemplateError: if the accelerations differ; the message names the file and the difference.
    """
    last = len(motion.time) - 1
    chosen = set(np.linspace(0, last, min(last + 1, _STATES)).astype(int).tolist())
    for values in (motion.u, motion.phi, motion.u_dot, motion.phi_dot):
        chosen |= {int(values.argmin()), int(values.argmax())}
    root = mjcf_file.read(numbers.path)
    mjcf_file.write(root, numbers.parameters, numbers.path)
    mjcf_file.remove(root, "keyframe")  # It is that of the file's own scene.
    model = _compile(root, numbers.path)
    states = select_samples(motion, sorted(chosen))
    fault = model_fault(model, numbers.scene, numbers.setting, states)
    if fault is not None:
        raise TemplateError(f"{numbers.path} {fault}, in a state of this run")


def _compile(root: ET.Element, path: pathlib.Path) -> mujoco.MjModel:
    """Return the model in the tree of the file at a path."""
    try:
        return mjcf_file.parse_spec(root, path).compile()
    except ValueError as error:
        raise TemplateError(f"{path} is refused by MuJoCo: {mjcf_file.one_line(error)}") from error
