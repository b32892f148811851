"""A scene set up to be stepped, a simulated motion with the record of all its steps, and its error by a second run."""

import math
import threading
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from mjbeer import require
from mjbeer.exceptions import DivergenceError
from mjbeer.model.build import compiled_model, write_numbers
from mjbeer.model.joints import initial_state, joint_addresses, to_coordinates
from mjbeer.model.mechanics import Mechanics, Structure
from mjbeer.model.mjcf_file import compiled_views
from mjbeer.model.setting import OWN, Setting
from mjbeer.simulation.fixed_step import Recorder, Solution, states_after
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.record import ERROR, Record, failed_checks, rolling_failures
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory, distance

if TYPE_CHECKING:
    from mjbeer.integrators.dynamics import Dynamics

_GOLDEN_SECTION = (math.sqrt(5) - 1) / 2
"""The greater part of a timestep in an uneven run. None of its multiples is near a whole number, so that no rate of
rotation has the same phase at the ends of both parts."""
_kept = threading.local()
"""The simulators of a thread by the structure of their models: to make one takes longer than most runs."""
_OVER_DISTANCE = 3.2
"""Error estimate over the distance to an uneven run. A contact is 0.62 times as soft in that run, so that its distance
is 1/2.6 of the error; 3.2 allows for an order that has not settled."""
_START_OFFSET = 4e-14
"""Distance between the starts of a run and of the uneven one [rad]: a hundred times their rounding, which shows how
much that matters beside a separatrix. A larger one could move the motion against an error, and hide it."""
_DEPTH = 0.5
"""Depth at which a can in contact starts in the uneven run, over that in the run. The error of softness falls to 0.62
or to 0.38 of itself; that of the depth falls to half, between them, as the two may be of opposite sign."""
_COMPARED, _PARTS = 4096, 32
"""Number of timesteps, evenly spread over a run, at which the uneven run is compared with it besides the samples; and
of the parts of a run to a tolerance, in each of which its runs are compared at least once."""
_MAX_TURN_PER_STEP = 2.0
"""Largest angle that the load may turn in a timestep [rad], unless its motion hardly depends on the angle: J looks the
same at every step of pi, but not to the stages of DOP853."""


class Simulator:
    """A scene set up to be stepped in a setting, by one thread at a time; the benchmark times nothing but `solve`.

    If `uneven`, each timestep is taken as two parts of unequal length, or as one and a bit with mjbeer's own
    integrators, so that an even and an uneven run have no timestep by which both could be wrong alike.

    Raises:
      UnsupportedError: if MuJoCo cannot have such a model.
    """

    def __init__(self, scene: Scene, setting: Setting, uneven: bool = False) -> None:
        mechanics = _mechanics(scene, setting, uneven)
        self.model, self._uneven = compiled_model(mechanics), uneven
        self.data = mujoco.MjData(self.model)
        self._views = compiled_views(self.model, mechanics.parameters)
        self._written: Mechanics | None = None
        self._dynamics: Dynamics | None = None  # of a model that one of mjbeer's own integrators has stepped
        self._write(mechanics)

    @classmethod
    def kept(cls, scene: Scene, setting: Setting) -> "Simulator":
        """Return this thread's simulator of such models, in which its last scene leaves no trace."""
        mechanics = _mechanics(scene, setting)
        simulators: dict[Structure, Simulator] = vars(_kept).setdefault("simulators", {})
        if (simulator := simulators.get(mechanics.structure)) is None:
            simulator = simulators[mechanics.structure] = cls(scene, setting)
        simulator._write(mechanics)
        return simulator

    def _write(self, mechanics: Mechanics) -> None:
        """Write the numbers of a scene into the model, if they are new, and reset the data."""
        self.scene, self.setting = mechanics.scene, mechanics.setting
        if mechanics == self._written:
            mujoco.mj_resetData(self.model, self.data)
        else:
            self._written = None  # until all of it is written
            write_numbers(self.model, self.data, mechanics, self._views)
            self._written = mechanics
        if self._dynamics is not None:
            self._dynamics.begin()

    def initial_state(self, phi0: float, phi_dot0: float) -> np.ndarray:
        """Return the state of a start at `phi0` [rad] with `phi_dot0` [rad/s], shape (nq + nv,)."""
        return initial_state(self.model, self.scene, phi0, phi_dot0)

    def solve(self, start: np.ndarray, times: np.ndarray, friction: float | None = None) -> Solution:
        """Return the states at `times` [s] of the motion from `start`; MuJoCo's integrators use the nearest timesteps.

        If a coefficient of `friction` is given, the solution has the record of all steps, too.

        Raises:
          DivergenceError: if the motion stops being finite.
          ToleranceError: if the tolerance is not reached.
        """
        scene, model, integrator = self.scene, self.model, self.setting.integrator
        timestep, tolerance = self.setting.timestep, self.setting.tolerance
        recorder: Recorder | None = None
        if tolerance is None and friction is not None:
            recorder = Recorder(model, scene, friction, within=integrator in OWN)
        if tolerance is None and integrator not in OWN:
            parts = (_GOLDEN_SECTION * timestep, (1 - _GOLDEN_SECTION) * timestep) if self._uneven else (timestep,)
            steps = np.rint(times / timestep).astype(np.int64)
            states = states_after(model, self.data, start, steps, parts, recorder)
            return Solution(states, recorder.record if recorder else None, None, integrator)
        # Imported only here: numba, which compiles them, takes longer to import than all else together.
        from mjbeer.integrators.dop853 import DOP853
        from mjbeer.integrators.dynamics import Dynamics
        from mjbeer.integrators.gauss_jackson import GaussJackson
        from mjbeer.simulation.tolerance import ToleranceLoop, even_at_most

        dynamics = self._dynamics = self._dynamics or Dynamics(model, self.data)
        if tolerance is not None:
            loop = ToleranceLoop(model, scene, dynamics)
            return loop.run(start, times, tolerance, math.inf if friction is None else friction)
        if self._uneven:
            timestep *= _GOLDEN_SECTION
        if integrator == "DOP853":
            states = DOP853(model, dynamics).run(start, times, timestep, observer=recorder)
        else:
            states = GaussJackson(model, dynamics).run(start, times, timestep, even_at_most(scene), recorder)
        return Solution(states, recorder.record if recorder else None, None, integrator)


def _mechanics(scene: Scene, setting: Setting, uneven: bool = False) -> Mechanics:
    """Return what is to be written into the model of a scene.

    A rigid equality that is integrated to a tolerance only has to correct the slip that rounding causes. It is tuned to
    sqrt(a/g)/2, a twelfth of the period of a pendulum of length a, which is too slow to limit the steps.
    """
    timestep = setting.timestep * (_GOLDEN_SECTION if uneven else 1)
    if setting.tolerance is not None and setting.rolling == "equality" and scene.gravity > 0:
        timestep = math.sqrt(scene.can.radius / scene.gravity) / 2
    return Mechanics(scene, setting, timestep=timestep)


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Run(Trajectory):
    """A simulated motion and its setting.

    What it says about itself rests on all of its steps, and does not depend on the samples that were asked for.
    """

    setting: Setting
    """How the can was made to roll and how it was stepped."""
    record: Record
    """The extremes of the motion over all its steps, on which its warnings rest."""
    chosen: str
    """The name of the integrator; with a tolerance it is "GaussJackson" or "DOP853"."""
    error: float | None
    """The error that was estimated on the way to a tolerance [rad]; None without one."""
    checkpoints: Coordinates
    """The motion at its samples and at times that are spread over the whole run, where a second run is compared."""

    def __post_init__(self) -> None:
        """Check nothing: the start is checked before a run, and its samples are finite after it."""

    @property
    def rolling(self) -> str:
        """Return "reduced", "equality" or "contact"."""
        return self.setting.rolling

    @property
    def integrator(self) -> str:
        """Return the name of the integrator."""
        return self.chosen

    @property
    def timestep(self) -> float | None:
        """Return the fixed timestep of the integrator [s]; None with a tolerance."""
        return self.setting.timestep if self.setting.tolerance is None else None

    def rolls_until(self, friction: float = np.inf) -> float:
        """Return the time [s] until which rolling without slipping was possible with a coefficient of `friction`.

        It is infinite if rolling was possible to the end. With infinite friction only N > 0 has to hold; any other
        takes a run as long as this one.
        """
        friction = require.non_negative("friction", friction, finite=False)
        if friction == self.record.friction:
            return self.record.rolling_ends_at
        simulator = Simulator(self.scene, self.setting)
        start = simulator.initial_state(self.phi0, self.phi_dot0)
        record = simulator.solve(start, self.checkpoints.time, friction).record
        assert record is not None
        return record.rolling_ends_at

    @cached_property
    def error_estimate(self) -> float:
        """Return the estimated global error of phi and u/a [rad], relative to the angle where that exceeds 1 rad.

        It rests on the largest distance from a second run. Without a tolerance the first access makes that, in twice
        the time of this one; the error is infinite if it diverges.
        """
        return compare_uneven(self) if self.error is None else self.error

    @cached_property
    def failed_checks(self) -> tuple[str, ...]:
        """Return those reasons to doubt that the equations were solved that take no second run."""
        found = failed_checks(self.record, self.rolling)
        turn = self.record.largest_rate * (timestep := self.timestep or 0.0)
        if turn > _MAX_TURN_PER_STEP and self.integrator != "DOP853":
            # Damping slows the load, and the slower it is, the less even it turns: down to the rate that is no trouble.
            rate = min(abs(self.phi_dot0), _MAX_TURN_PER_STEP / timestep) if self.scene.dissipates else self.phi_dot0
            if self.scene.oscillator.unevenness(self.phi0, rate) > ERROR:
                found.append(
                    f"the load turns by {turn:.3g} rad in a timestep (trusted up to {_MAX_TURN_PER_STEP:g}), in which "
                    "its weight and inertia change unseen"
                )
        return tuple(found)

    @cached_property
    def rolling_warnings(self) -> tuple[str, ...]:
        """Return where the can did not, or could not, roll without slipping, one sentence for each."""
        return tuple(rolling_failures(self.record, self.rolling, self.setting.friction))

    @cached_property
    def solver_warnings(self) -> tuple[str, ...]:
        """Return the reasons to doubt that the equations of the model were solved, one sentence for each."""
        if (error := self.error_estimate) <= ERROR:
            return self.failed_checks
        finer = "other timesteps" if self.timestep is not None else "a tighter tolerance"
        if math.isfinite(error):
            found = f"phi and u/a are off by {error:.3g} rad (trusted up to {ERROR:g}), as a run at {finer} shows"
        else:
            found = f"a run at {finer} diverges: take a much smaller timestep or a better integrator"
        return (*self.failed_checks, found)


def compare_uneven(run: Run) -> float:
    """Return the error of phi and u/a [rad] that an uneven run shows, relative beyond 1 rad; infinite if that diverges.

    Constraints that are tuned to the timestep are harder in it, so that its distance from the first run includes the
    effect of their softness. It begins a little aside, which adds that of rounding, and of a contact's depth.
    """
    scene, setting, motion = run.scene, run.setting, run.checkpoints
    simulator = Simulator(scene, setting, uneven=True)
    start = simulator.initial_state(run.phi0 + _START_OFFSET, run.phi_dot0)
    if setting.rolling == "contact":
        start[joint_addresses(simulator.model)["lift"]] *= _DEPTH
    try:
        states = simulator.solve(start, motion.time).states
    except DivergenceError:
        return math.inf
    begin = run.phi0, scene.start(run.phi0, run.phi_dot0)[0]
    uneven = to_coordinates(simulator.model, scene, states, motion.time)
    return _OVER_DISTANCE * distance(motion, uneven, scene.can.radius, begin)


def integrate(scene: Scene, phi0: float, phi_dot0: float, setting: Setting, times: np.ndarray) -> Run:
    """Return the motion of a scene in a setting at increasing `times` [s], with the same errors as `simulate`."""
    along, samples, checkpoints = times, slice(None), None
    if setting.tolerance is None:
        last = max(1, int(times[-1] / setting.timestep))
        checkpoints = setting.timestep * np.linspace(0, last, min(last, _COMPARED) + 1).astype(np.int64)
    elif (times[1:] - times[:-1]).max(initial=times[0]) > times[-1] / _PARTS:
        checkpoints = times[-1] * np.linspace(0, 1, _PARTS + 1)
    if checkpoints is not None:
        along = np.sort(np.concatenate([times, checkpoints[checkpoints <= times[-1]]]))
        along = along[np.diff(along, prepend=-1.0) > 0]  # unlike union1d it does not import masked arrays
        samples = np.searchsorted(along, times)
    simulator = Simulator.kept(scene, setting)
    solution = simulator.solve(simulator.initial_state(phi0, phi_dot0), along, friction=math.inf)
    motion = to_coordinates(simulator.model, scene, solution.states, along)
    assert solution.record is not None
    return Run(
        **{name: array[samples] for name, array in vars(motion).items()},
        scene=scene,
        phi0=phi0,
        phi_dot0=phi_dot0,
        setting=setting,
        record=solution.record,
        chosen=solution.integrator,
        error=solution.error,
        checkpoints=motion,
    )
