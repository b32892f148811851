"""A compiled model with the numbers of a scene, ready to be stepped.

Each thread keeps its own for the next scene.
"""

import threading
from functools import cached_property
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from mjbeer.model.check import check_run, is_edited
from mjbeer.model.compiled import compiled_model, parameter_views, write_numbers
from mjbeer.model.joints import initial_state
from mjbeer.model.model_numbers import ModelNumbers, Structure
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.scene import Scene

if TYPE_CHECKING:
    from mjbeer.integrators.dynamics import Dynamics


class SteppedModel:
    """A MuJoCo model of a scene and its data, stepped by one thread at a time.

    Raises:
      UnsupportedError: if MuJoCo cannot represent such a model.
    """

    def __init__(self, numbers: ModelNumbers) -> None:
        self.model = compiled_model(numbers)
        self.data = mujoco.MjData(self.model)
        self._views = parameter_views(self.model, numbers.parameters)
        self._written: ModelNumbers | None = None
        self._edited = is_edited(numbers)
        self.write(numbers)

    @property
    def scene(self) -> Scene:
        """Return the scene whose numbers the model has."""
        assert self._written is not None
        return self._written.scene

    def write(self, numbers: ModelNumbers) -> None:
        """Write the numbers of a scene into the model, if they are new, and reset the data."""
        if numbers == self._written:
            mujoco.mj_resetData(self.model, self.data)
        else:
            self._written = None  # until all of it is written
            write_numbers(self.model, self.data, numbers, self._views)
            self._written = numbers
        if "dynamics" in vars(self):
            self.dynamics.model_has_changed()

    @cached_property
    def dynamics(self) -> "Dynamics":
        """Return the model's accelerations for mjbeer's own integrators."""
        from mjbeer.integrators.dynamics import Dynamics  # numba is slow to import

        return Dynamics(self.model, self.data)

    def initial_state(self, phi0: float, phi_dot0: float) -> np.ndarray:
        """Return the state of a start at `phi0` [rad] with `phi_dot0` [rad/s], shape (nq + nv,)."""
        return initial_state(self.model, self.scene, phi0, phi_dot0)

    def check(self, motion: Coordinates) -> None:
        """Compare the MJCF with theory at the states of a run, unless it is mjbeer's own.

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


def kept_model(numbers: ModelNumbers) -> SteppedModel:
    """Return this thread's model of that structure, with these numbers and its data reset."""
    kept = _kept.models.get(numbers.structure)
    if kept is None:
        kept = _kept.models[numbers.structure] = SteppedModel(numbers)
    else:
        kept.write(numbers)
    return kept
