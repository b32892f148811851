"""A compiled model with the numbers of a scene, ready to be stepped; each thread keeps its own for the next scene."""

import threading
from functools import cached_property
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from mjbeer.model.build import compiled_model, write_numbers
from mjbeer.model.check import check_run, is_edited
from mjbeer.model.joints import initial_state
from mjbeer.model.mechanics import Mechanics, Structure
from mjbeer.model.mjcf_file import compiled_views
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.scene import Scene

if TYPE_CHECKING:
    from mjbeer.integrators.dynamics import Dynamics


class SteppedModel:
    """A MuJoCo model of a scene and its data, stepped by one thread at a time.

    Raises:
      UnsupportedError: if MuJoCo cannot have such a model.
    """

    def __init__(self, mechanics: Mechanics) -> None:
        self.model = compiled_model(mechanics)
        self.data = mujoco.MjData(self.model)
        self._views = compiled_views(self.model, mechanics.parameters)
        self._written: Mechanics | None = None
        self._edited = is_edited(mechanics)
        self.write(mechanics)

    @property
    def scene(self) -> Scene:
        """Return the scene whose numbers the model has."""
        assert self._written is not None
        return self._written.scene

    def write(self, mechanics: Mechanics) -> None:
        """Write the numbers of a scene into the model, if they are new, and reset the data."""
        if mechanics == self._written:
            mujoco.mj_resetData(self.model, self.data)
        else:
            self._written = None  # until all of it is written
            write_numbers(self.model, self.data, mechanics, self._views)
            self._written = mechanics
        if "dynamics" in vars(self):
            self.dynamics.model_has_changed()

    @cached_property
    def dynamics(self) -> "Dynamics":
        """Return the model's accelerations for mjbeer's own integrators."""
        # Imported only here: numba, which compiles them, takes longer to import than everything else together.
        from mjbeer.integrators.dynamics import Dynamics

        return Dynamics(self.model, self.data)

    def initial_state(self, phi0: float, phi_dot0: float) -> np.ndarray:
        """Return the state of a start at `phi0` [rad] with `phi_dot0` [rad/s], shape (nq + nv,)."""
        return initial_state(self.model, self.scene, phi0, phi_dot0)

    def check(self, motion: Coordinates) -> None:
        """Compare the MJCF with theory at the states of a run of this scene, unless it is mjbeer's own.

        Raises:
          TemplateError: if it does not move as theory says there.
        """
        if self._edited and self._written is not None:
            check_run(self._written, motion)


class _Kept(threading.local):
    """The models of a thread by their structure: to make one takes longer than most runs."""

    def __init__(self) -> None:
        self.models: dict[Structure, SteppedModel] = {}


_kept = _Kept()


def kept_model(mechanics: Mechanics) -> SteppedModel:
    """Return this thread's model of such a structure, in which its last scene leaves no trace."""
    kept = _kept.models.get(mechanics.structure)
    if kept is None:
        kept = _kept.models[mechanics.structure] = SteppedModel(mechanics)
    else:
        kept.write(mechanics)
    return kept
