"""The largest timestep that stays stable, and the largest that stays accurate, of small swings of every scene.

Both are found from the small side: timesteps rise by a fifth until one fails, and bisection follows. What may be stable
again beyond is not looked for. Constraints are tuned to every timestep, as `build` does; a can in contact starts at
the depth at which it is carried.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from mjbeer import dop853, linear_stability, state, stepping
from mjbeer.cases import CASES
from mjbeer.exact import exact
from mjbeer.exceptions import DivergenceError
from mjbeer.grid import Grid
from mjbeer.linear_stability import ACCURACY, ACCURATE_PERIODS, GROWTH, PERIODS, RUNGE_KUTTA
from mjbeer.model import DOP853, INTEGRATORS, ROLLINGS, build
from mjbeer.oscillator import Oscillator
from mjbeer.scene import Scene
from mjbeer.settled import settle
from mjbeer.state import Motion
from mjbeer.task import Task

AGREEMENT = 0.05
"""How far a measured limit may be from the predicted one, as a share of it."""
STABLE_AMPLITUDE = 1e-4
"""Of the swing that has to stay bounded [rad]: grown a hundredfold, its frequency is off by 1e-5 or less."""
ACCURATE_AMPLITUDE = 1e-3
"""Of the swing that has to stay accurate [rad]: what is nonlinear is in the exact motion as well."""
_RESOLUTION = 1.004
"""Ratio of the two timesteps at which bisection ends."""
_RISE = 1.2
"""Ratio of two timesteps on the way up to the first that fails."""
_FROM, _TO = 0.2, 12.0
"""Least and largest omega h of the search for a limit of stability."""
_ACCURATE_FROM = {True: 0.1, False: 0.01}
"""Least omega h of that for a limit of accuracy; lower where the method is not of Runge and Kutta."""


def measure(case: str, rolling: str, integrator: str, settled: bool = True) -> dict[str, Any]:
    """The two limits of one way to simulate one scene, measured and predicted, all as omega h.

    "agrees" says whether a limit is within `AGREEMENT` of what is predicted. A can that is not `settled` starts where
    `simulate` starts it, 1e-9 radii deep; of that, "lost_a_stage" says whether the first step that fails is one of
    which a Runge-Kutta stage was without contact.
    """
    scene = CASES[case].scene
    omega = scene.frequency()

    def run(swing: float, amplitude: float, periods: int) -> Motion:
        steps = math.floor(periods * 2 * math.pi / swing)
        return _run(scene, rolling, integrator, swing / omega, amplitude, steps, settled)

    def bounded(swing: float) -> bool:
        try:
            return _energy(scene, run(swing, STABLE_AMPLITUDE, PERIODS)) < GROWTH**2
        except DivergenceError:
            return False

    def accurate(swing: float) -> bool:
        try:
            return _error(scene, run(swing, ACCURATE_AMPLITUDE, ACCURATE_PERIODS), swing / omega) < ACCURACY
        except DivergenceError:
            return False

    stable, unstable = _limit(bounded, _FROM, _TO)
    predicted = linear_stability.stable_limit(integrator)
    found = {
        "kind": "limit",
        "case": case,
        "rolling": rolling,
        "integrator": integrator,
        "settled": settled,
        "frequency": omega,
        "stable": stable,
        "stable_predicted": predicted,
        "stable_ratio": stable / predicted,
    }
    if not settled:
        lost = bool(_lost_a_stage(scene, integrator, unstable / omega))
        return found | {"lost_a_stage": lost, "agrees": _close(stable, predicted) or lost}
    accurate_to, _ = _limit(accurate, _ACCURATE_FROM[integrator in RUNGE_KUTTA], stable)
    expected = _predict_accurate(scene, rolling, integrator)
    return found | {
        "accurate": accurate_to,
        "accurate_predicted": expected,
        "accurate_ratio": accurate_to / expected,
        "agrees": _close(stable, predicted) and _close(accurate_to, expected),
    }


def tasks(quick: bool = False) -> list[Task]:
    """One a scene, way of rolling and integrator; a `quick` study has a sample of them."""
    found = []
    for case, rolling, integrator, settled in _combinations():
        if quick and not (integrator in ("Euler", "RK4", DOP853) and (case, rolling) in _SAMPLE and settled):
            continue

        def take(case=case, rolling=rolling, integrator=integrator, settled=settled) -> dict[str, Any]:
            return measure(case, rolling, integrator, settled)

        name = f"{case}, {rolling}, {integrator}" + ("" if settled else ", not settled")
        found.append(Task("limits", name, take))
    return found


_SAMPLE = (("sliding", "reduced"), ("frozen", "reduced"), ("pendulum", "equality"), ("frozen", "contact"))


def grid(results: list[dict[str, Any]]) -> Grid:
    """The limits as a table, measured over predicted in brackets."""
    rows = []
    for each in results:
        accurate = "-"
        if "accurate" in each:
            accurate = f"{each['accurate']:.3g} ({each['accurate_ratio']:.3f})"
        start = "" if each["settled"] else ", not settled"
        verdict = "yes" if each["agrees"] else "NO"
        if each.get("lost_a_stage"):
            verdict = "no: a stage of RK4 loses the contact"
        rows.append((
            f"{each['case']}, {each['rolling']}{start}", each["integrator"],
            f"{each['stable']:.3f} ({each['stable_ratio']:.3f})", accurate, verdict,
        ))  # fmt: skip
    columns = ("scene", "integrator", "stable to omega h (over theory)", "accurate to omega h (over theory)", "agrees")
    return Grid("Largest timesteps of a small swing", columns, rows)


def _combinations() -> list[tuple[str, str, str, bool]]:
    found = []
    for case, kind in CASES.items():
        for rolling in ROLLINGS:
            if rolling != "reduced" and kind.scene.attachment == "sliding" and kind.scene.can.mass == 0:
                continue  # MuJoCo has no massless moving body
            found += [(case, rolling, integrator, True) for integrator in (*INTEGRATORS, DOP853)]
            if rolling == "contact":
                found.append((case, rolling, "RK4", False))
    return found


def _run(
    scene: Scene, rolling: str, integrator: str, timestep: float, amplitude: float, steps: int, settled: bool
) -> Motion:
    model = build(scene, rolling, integrator=integrator, timestep=timestep)
    start = state.start(model, scene, scene.equilibrium() + amplitude, 0.0)
    start = settle(model, start) if settled else start
    samples = np.arange(steps + 1)
    if integrator == DOP853:
        return state.read(model, scene, dop853.integrate(model, start, samples * timestep, timestep))
    return state.read(model, scene, stepping.step(model, start[None], samples)[0])


def _energy(scene: Scene, motion: Motion) -> float:
    """Largest energy above the equilibrium, over that of the start."""
    form, rest = scene.oscillator, scene.equilibrium()
    above = form.inertia(motion.phi) * motion.phi_dot**2 / 2 - form.drop(motion.phi, rest)
    return float((above / above[0]).max())


def _error(scene: Scene, motion: Motion, timestep: float) -> float:
    truth = exact(scene, np.arange(len(motion.phi)) * timestep, scene.equilibrium() + ACCURATE_AMPLITUDE)
    off = np.hypot(motion.phi - truth.phi, (motion.phi_dot - truth.phi_dot) / scene.frequency())
    return float(off.max()) / ACCURATE_AMPLITUDE


def _limit(holds: Callable[[float], bool], low: float, high: float) -> tuple[float, float]:
    """The largest value at which something holds and the least at which it does not, of those tried."""
    if not holds(low):
        return 0.0, low
    while holds(low * _RISE):
        low *= _RISE
        if low > high:
            return low, math.inf
    above = low * _RISE
    while above / low > _RESOLUTION:
        middle = math.sqrt(low * above)
        low, above = (middle, above) if holds(middle) else (low, middle)
    return low, above


def _predict_accurate(scene: Scene, rolling: str, integrator: str) -> float:
    """The limit of accuracy as theory has it, as omega h.

    A contact is soft, the softer the longer the timestep to which it is tuned: the can sinks in by delta, in
    proportion to h^2, and rolls as one of the radius a - delta/2. The equilibrium and the frequency of that can are
    in `linear_stability.error`.
    """
    stable = linear_stability.stable_limit(integrator)
    if rolling != "contact":
        return linear_stability.accurate_limit(integrator)
    omega, rest = scene.frequency(), scene.equilibrium()
    model = build(scene, rolling, integrator=integrator, timestep=1 / omega)
    settled = settle(model, state.start(model, scene, rest, 0.0))
    depth = -float(state.read(model, scene, settled[None]).lift[0])

    def excess(swing: float) -> float:
        form = _rolling_deep(scene, depth * swing**2)
        drift = (form.equilibrium() - rest) / ACCURATE_AMPLITUDE
        return linear_stability.error(integrator, swing, drift, form.frequency() / omega) - ACCURACY

    return linear_stability.first(excess, 5e-3, stable)


def _rolling_deep(scene: Scene, depth: float) -> Oscillator:
    """The oscillator of a can that has sunk in by a depth [m]."""
    reduce = Oscillator.sliding if scene.attachment == "sliding" else Oscillator.frozen
    can = replace(scene.can, radius=scene.can.radius - depth / 2)
    return reduce(can, scene.load, scene.incline, scene.gravity)


def _lost_a_stage(scene: Scene, integrator: str, timestep: float) -> bool:
    """Whether the last stage of the first step had no contact: it fell freely, and has a sixth of RK4's weight."""
    motion = _run(scene, "contact", integrator, timestep, STABLE_AMPLITUDE, 1, False)
    falls = -scene.gravity * math.cos(scene.incline) * timestep / 6
    return abs(motion.lift_dot[1] / falls - 1) < AGREEMENT


def _close(measured: float, predicted: float) -> bool:
    return abs(measured / predicted - 1) <= AGREEMENT
