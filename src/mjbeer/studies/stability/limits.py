"""The largest timesteps at which small swings of every scene are stable, and those at which they are accurate.

Each limit is the first that is reached from small timesteps: they rise by a fifth until one fails, and bisection
follows. Larger timesteps might be stable again; they are not tried. Constraints are tuned to every timestep, as `build`
does.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.model import state
from mjbeer.model.build import build
from mjbeer.model.setting import DOP853, INTEGRATORS, ROLLINGS, Integrator, Rolling, Setting, supported
from mjbeer.output.terminal import Table
from mjbeer.predictions import linear_stability
from mjbeer.predictions.linear_stability import ACCURACY, ACCURATE_PERIODS, GROWTH, PERIODS, RUNGE_KUTTA
from mjbeer.simulation.run import Prepared
from mjbeer.studies.cases import CASES
from mjbeer.studies.rows import PASSED, Result, Row
from mjbeer.studies.stability.stiff_runs import settle
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.exact import exact
from mjbeer.theory.oscillator import Oscillator
from mjbeer.theory.scene import Scene

GROUP = "limits"
"""The group of the study that the limits are in."""
AGREEMENT = 0.05
"""Largest relative difference at which a measured limit agrees with the predicted one."""
_SAMPLE = (("sliding", "reduced"), ("frozen", "reduced"), ("pendulum", "equality"), ("frozen", "contact"))
"""Scenes and ways of rolling in a quick study."""
_RESOLUTION = 1.004
"""Bisection ends when the two timesteps that enclose the limit have this ratio."""
_RISE = 1.2
"""Ratio of successive timesteps in the search for the first that fails."""
_FROM, _TO = 0.2, 12.0
"""Smallest and largest omega h in the search for a limit of stability."""
_ACCURATE_FROM = {True: 0.1, False: 0.01}
"""Smallest omega h in the search for a limit of accuracy, by whether the method is a Runge-Kutta method."""
_STABLE_AMPLITUDE = 1e-4
"""Amplitude of the swing that has to stay bounded [rad]: even a hundredfold, it changes the frequency by 1e-5 only."""
_ACCURATE_AMPLITUDE = 1e-3
"""Amplitude of the swing that has to stay accurate [rad]: the exact motion has the same nonlinearity."""
_FREE_FALL = 1e-2
"""Relative tolerance for saying that the last RK4 stage was in free fall. Without contact it adds -g h cos(alpha)/6 to
lift_dot; with contact, a thousandth of that."""


def rows(quick: bool = False) -> list[Row]:
    """Return a row a scene, way of rolling and integrator; a `quick` study has a sample of them."""
    methods: list[tuple[Integrator, bool]] = [*((name, True) for name in (*INTEGRATORS, DOP853)), ("RK4", False)]
    tried = [
        (case, rolling, integrator, settled)
        for case in CASES
        for rolling in ROLLINGS
        for integrator, settled in methods
        if supported(CASES[case].scene, rolling) and (settled or rolling == "contact")
    ]
    if quick:
        tried = [of for of in tried if of[:2] in _SAMPLE and of[2] in ("Euler", "RK4", DOP853) and of[3]]
    reason = "bisection to 0.4 %, and an instability has to grow before it is seen"
    row = partial(Row, GROUP, bound=AGREEMENT, unit="relative", reason=reason)
    names = (", ".join(way) + ("" if settled else ", not settled") for *way, settled in tried)
    return [row(name, partial(measure, *of)) for name, of in zip(names, tried, strict=True)]


def measure(case: str, rolling: Rolling, integrator: Integrator, settled: bool = True) -> dict[str, Any]:
    """Return the two limits of one way to simulate one scene, measured and predicted, all as omega h.

    "error" is the larger relative difference of the two. A can in contact that is not `settled` starts where `simulate`
    starts it, 1e-9 radii deep, and only its stability is measured. For it, "lost_a_stage" is whether one of RK4's
    stages in the first step has no contact at the limit; linear theory does not cover that.
    """
    swings = Swings(CASES[case].scene, rolling, integrator, settled)
    stable, unstable = _limit(swings.bounded, _FROM, _TO)
    predicted = linear_stability.stable_limit(integrator)
    error = abs(stable / predicted - 1)
    about = {"case": case, "rolling": rolling, "integrator": integrator, "settled": settled}
    result = about | {"stable": stable, "stable_predicted": predicted}
    if not settled:
        lost = error > AGREEMENT and swings.loses_a_stage(unstable)
        return result | {"lost_a_stage": lost, "error": 0.0 if lost else error}
    accurate, _ = _limit(swings.accurate, _ACCURATE_FROM[integrator in RUNGE_KUTTA], stable)
    expected = swings.accurate_limit()
    error = max(error, abs(accurate / expected - 1))
    return result | {"accurate": accurate, "accurate_predicted": expected, "error": error}


@dataclass(frozen=True)
class Swings:
    """Small swings of a scene about its equilibrium with one integrator. `swing` is the timestep as omega h."""

    scene: Scene
    rolling: Rolling
    integrator: Integrator
    settled: bool = True
    """Whether a can in contact starts at the depth at which it is carried, or 1e-9 radii deep as in `simulate`."""

    def bounded(self, swing: float) -> bool:
        """Return whether the energy stays below `GROWTH` squared times its initial value, over `PERIODS` periods."""
        form, rest = self.scene.oscillator, self.scene.equilibrium()
        try:
            motion = self._simulate(swing, _STABLE_AMPLITUDE, math.floor(PERIODS * 2 * math.pi / swing))
        except DivergenceError:
            return False
        above = form.inertia(motion.phi) * motion.phi_dot**2 / 2 - form.drop(motion.phi, rest)
        return bool((above < GROWTH**2 * above[0]).all())

    def accurate(self, swing: float) -> bool:
        """Return whether the error stays below `ACCURACY` over `ACCURATE_PERIODS` periods."""
        steps, omega = math.floor(ACCURATE_PERIODS * 2 * math.pi / swing), self.scene.frequency()
        try:
            motion = self._simulate(swing, _ACCURATE_AMPLITUDE, steps)
        except DivergenceError:
            return False
        start = self.scene.equilibrium() + _ACCURATE_AMPLITUDE
        truth = exact(self.scene, np.arange(steps + 1) * swing / omega, start)
        off = np.hypot(motion.phi - truth.phi, (motion.phi_dot - truth.phi_dot) / omega)
        return bool(off.max() < ACCURACY * _ACCURATE_AMPLITUDE)

    def accurate_limit(self) -> float:
        """Return the largest omega h of an accurate swing by theory.

        A contact is the softer the longer the timestep to which it is tuned. The can sinks in by delta, in proportion
        to h^2, and rolls like one of radius a - delta/2, whose equilibrium and frequency are slightly different. delta
        is read from the model at rest.
        """
        scene = self.scene
        if self.rolling != "contact":
            return linear_stability.accurate_limit(self.integrator)
        omega, rest = scene.frequency(), scene.equilibrium()
        model = build(scene, self.rolling, integrator=self.integrator, timestep=1 / omega)
        settled = settle(model, state.start(model, scene, rest, 0.0))
        depth = -float(state.read(model, scene, settled[None], times=np.zeros(1)).lift[0])
        reduce = Oscillator.sliding if scene.attachment == "sliding" else Oscillator.frozen

        def excess(swing: float) -> float:
            can = replace(scene.can, radius=scene.can.radius - depth * swing**2 / 2)
            form = reduce(can, scene.load, scene.incline, scene.gravity)
            drift = (form.equilibrium() - rest) / _ACCURATE_AMPLITUDE
            return linear_stability.error(self.integrator, swing, drift, form.frequency() / omega) - ACCURACY

        return linear_stability.first(excess, 5e-3, linear_stability.stable_limit(self.integrator))

    def loses_a_stage(self, swing: float) -> bool:
        """Return whether the last of RK4's stages in the first step has no contact and falls freely.

        That stage has a weight of a sixth, so that it then adds -g h cos(alpha)/6 to lift_dot.
        """
        motion = self._simulate(swing, _STABLE_AMPLITUDE, 1)
        falls = -self.scene.gravity * math.cos(self.scene.incline) * swing / self.scene.frequency() / 6
        return bool(abs(motion.lift_dot[1] / falls - 1) < _FREE_FALL)

    def _simulate(self, swing: float, amplitude: float, steps: int) -> Coordinates:
        """Return a number of steps of a swing of an amplitude [rad]."""
        scene, timestep = self.scene, swing / self.scene.frequency()
        prepared = Prepared(scene, Setting(self.rolling, self.integrator, timestep))
        start = prepared.start(scene.equilibrium() + amplitude, 0.0)
        start = settle(prepared.model, start) if self.settled else start
        times = timestep * np.arange(steps + 1)
        return prepared.coordinates(prepared.solve(start, times).states, times)


def bisected(holds: Callable[[float], bool], low: float, high: float, ratio: float) -> tuple[float, float]:
    """Return two positive numbers of at most this ratio, where a condition that `holds` at `low` ends before `high`."""
    while high / low > ratio:
        middle = math.sqrt(low * high)
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low, high


def _limit(holds: Callable[[float], bool], low: float, high: float) -> tuple[float, float]:
    """Return two neighbouring values, of which a condition holds at the first and not at the second.

    The first is 0 if it does not hold at `low`, the second is infinite if it holds up to `high`.
    """
    if not holds(low):
        return 0.0, low
    while holds(low * _RISE):
        low *= _RISE
        if low > high:
            return low, math.inf
    return bisected(holds, low, low * _RISE, _RESOLUTION)


def table(results: Sequence[Result]) -> Table:
    """Return the limits as a table, each with measured over predicted in brackets."""
    lines = []
    for result in results:
        of, accurate = result.values, "-"
        if "accurate" in of:
            accurate = f"{of['accurate']:.3g} ({of['accurate'] / of['accurate_predicted']:.3f})"
        stable = f"{of['stable']:.3f} ({of['stable'] / of['stable_predicted']:.3f})"
        lost = "a stage of RK4 loses the contact"
        lines.append((result.name, stable, accurate, lost if of.get("lost_a_stage") else PASSED[result.passed]))
    columns = ("swing", "stable to ωh (over theory)", "accurate to ωh (over theory)", "verdict")
    return Table("Largest timesteps of a small swing", columns, lines)
