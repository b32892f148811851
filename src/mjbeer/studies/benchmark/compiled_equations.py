"""The equations of `other_tools.right_hand_side`, compiled by numba for one scene.

They are called in two ways: as a Python function of an array, which SciPy takes, and as a C
function in place of MuJoCo's, so that mjbeer's DOP853 steps them without Python and without MuJoCo.
The numbers of the scene are compiled in, which takes a few tenths of a second for each scene.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numba import carray, cfunc, njit, types

from mjbeer.integrators.dynamics import Dynamics
from mjbeer.model.setting import Setting
from mjbeer.simulation.methods import model_numbers
from mjbeer.simulation.stepped_model import SteppedModel
from mjbeer.studies.benchmark.other_tools import right_hand_side
from mjbeer.studies.benchmark.points import Case

_ARRAY_FUNCTION = "float64[::1](float64, float64[::1])"
_C_FUNCTION = types.void(types.intp, types.CPointer(types.float64))
"""A function of two addresses, as MuJoCo's functions take those of an mjModel and an mjData."""


def array_function(case: Case) -> Callable[[float, np.ndarray], np.ndarray]:
    """Return the compiled equations as a function of the time [s] and the array of a state."""
    rates = njit(right_hand_side(case.scene))
    if case.scene.attachment == "frozen":

        def frozen(time, state):
            return np.array(rates(time, (state[0], state[1])))

        return njit(_ARRAY_FUNCTION)(frozen)

    def sliding(time, state):
        return np.array(rates(time, (state[0], state[1], state[2], state[3])))

    return njit(_ARRAY_FUNCTION)(sliding)


class CompiledEquations(Dynamics):
    """The accelerations of a scene by its equations, in place of MuJoCo's for mjbeer's methods.

    Positions, rates and accelerations stand one after the other in an array. MuJoCo's model only
    says how many there are.
    """

    def __init__(self, case: Case) -> None:
        super().__init__(SteppedModel(model_numbers(case.scene, Setting())).model)
        self._rates = njit(right_hand_side(case.scene))
        # The compiled code exists as long as this attribute.
        self._accelerate = _c_function(self._rates, case.scene.attachment)
        self._numbers = np.zeros(3 * self.model.nv)
        qpos, qvel, qacc = np.split(self._numbers, 3)
        self.kernel_view = self.kernel_view._replace(
            functions=np.array([self._accelerate.address]),
            data=self._numbers.ctypes.data,
            qpos=qpos,
            qvel=qvel,
            qacc=qacc,
        )

    def derivative(self, state: np.ndarray) -> np.ndarray:
        """Return the time derivative of a state."""
        self.evaluations += 1
        return np.array(self._rates(0.0, tuple(state)))


def _c_function(rates: Any, attachment: str) -> Any:
    """Return a C function that reads positions and rates, and writes accelerations behind them."""
    if attachment == "frozen":

        def frozen(_, address):
            numbers = carray(address, 3)
            _phi_dot, numbers[2] = rates(0.0, (numbers[0], numbers[1]))

        return cfunc(_C_FUNCTION)(frozen)

    def sliding(_, address):
        numbers = carray(address, 6)
        state = (numbers[0], numbers[1], numbers[2], numbers[3])
        _u_dot, _phi_dot, numbers[4], numbers[5] = rates(0.0, state)

    return cfunc(_C_FUNCTION)(sliding)
