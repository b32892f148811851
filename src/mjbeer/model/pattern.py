"""Compiled models into which scenes are written in place, a hundred times faster than a scene is compiled.

What does not depend on a scene's numbers is compiled once a process for each kind of model. A scene's numbers are
then written into a copy, and MuJoCo derives its constants from them anew (`mj_setConst`), as its compiler does.
"""

import copy
import threading
from collections.abc import Hashable
from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer.model import constrained, statistics, templates
from mjbeer.model.build import compile_model, compose, finish, fit, mechanics_of
from mjbeer.model.engine import copy_model, quiet
from mjbeer.model.mechanics import Mechanics
from mjbeer.model.setting import Setting
from mjbeer.theory.scene import Scene

_MOST = 64
"""Largest number of kinds that are kept: each template has a few, and an edited template is another one."""
_patterns: "dict[Hashable, _Pattern]" = {}
_adding = threading.Lock()


class _Pattern:
    """The compiled model of the first scene of a kind."""

    def __init__(self, scene: Scene, setting: Setting) -> None:
        spec = compose(scene, setting)
        self.model = finish(spec, setting)
        self.complete = bool(np.isfinite(spec.stat.extent) and np.isfinite(spec.stat.center).all())
        """Whether the template says where and how large everything is; otherwise the compiler computes it."""


@dataclass(frozen=True)
class Plan:
    """A scene in a setting, with what is to be written into a model."""

    scene: Scene
    setting: Setting
    moving: Mechanics
    kind: Hashable
    """All that decides which elements a model has, and those of its numbers that no scene changes."""

    @classmethod
    def of(cls, scene: Scene, setting: Setting) -> "Plan":
        """Return the plan for a scene in a setting.

        Raises:
          UnsupportedError: if MuJoCo cannot move one of its bodies.
          TemplateError: if there are no templates.
        """
        moving = mechanics_of(scene, setting)
        elements = moving.joints, moving.force != 0, moving.chord > 0, moving.damps, moving.drag > 0
        kind = templates.contents(templates.name(scene)), setting.rolling, setting.softness, elements
        return cls(scene, setting, moving, kind)


class Editable:
    """A model and its data, for one thread at a time, into which scenes of one kind are written in place.

    Raises:
      UnsupportedError: if MuJoCo cannot have such a model.
      TemplateError: if the template of the scene is missing or not as it should be.
    """

    def __init__(self, plan: Plan) -> None:
        self._pattern = _pattern(plan)
        self.model = copy.copy(self._pattern.model)
        self.data = mujoco.MjData(self.model)
        self.write(plan)

    def write(self, plan: Plan) -> None:
        """Write a plan of the same kind into the model, and reset the data.

        Every number of the model is then, to the bit, that of a model compiled for the scene.

        Raises:
          UnsupportedError: if MuJoCo cannot have such a model.
        """
        model, data, setting = self.model, self.data, plan.setting
        fit(model, plan.scene, setting, plan.moving)
        with quiet():
            mujoco.mj_setConst(model, data)
        statistics.derive(model, data)
        if constrained.is_rigid(setting):
            constrained.make_rigid(model)
        least = min(min(body.mass, body.inertia) for body in plan.moving.bodies.values())
        singular = data.warning[mujoco.mjtWarning.mjWARN_INERTIA].number > 0
        if singular or not (least >= mujoco.mjMINVAL and self._pattern.complete):
            copy_model(model, compile_model(plan.scene, setting))  # the compiler says why, where it refuses the scene
        mujoco.mj_resetData(model, data)


def _pattern(plan: Plan) -> _Pattern:
    with _adding:
        if (pattern := _patterns.get(plan.kind)) is None:
            if len(_patterns) >= _MOST:
                _patterns.clear()
            pattern = _patterns[plan.kind] = _Pattern(plan.scene, plan.setting)
    return pattern
