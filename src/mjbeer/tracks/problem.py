"""The least squares behind a fit: a track's distances from a simulated motion, their derivatives, and starts."""

import inspect
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import OptimizeResult, least_squares
from scipy.special import fdtrc

from mjbeer.exceptions import MjbeerError
from mjbeer.simulation.run import Run
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.scene import Scene
from mjbeer.tracks.track import Track

FREE = "incline", "fill", "damping", "drag"
"""What a scene has that can be fitted."""
SIZES = {
    "incline": math.radians(1), "fill": 0.1, "damping": 1.0, "drag": 1e-3, "phi0": 0.2, "place": 0.02, "released": 0.1,
    "bend": 5e-3, "scale": 0.02, "turned": 0.2,
}  # fmt: skip
"""What is much of each value: the solver's units. The damping counts in its logarithm."""
_WITHIN = {
    "incline": (-1.5, 1.5),
    "fill": (0.01, 0.99),
    "damping": (-5.0, 5.0),
    "drag": (1e-8, 1.0),
    "scale": (0.5, 2.0),
}
_TOLERANCE = 1e-7
"""Tolerance of the simulated angles [rad]: some nanometres of the way."""
_DIFFERENCE = 1e-3
"""Distance of the two motions of a derivative, in units: its square and the tolerance over it are small beside 1."""
_NODES = 0.25
"""Time between the nodes of the motion's splines over sqrt(a/g): their error is below 1e-6 radii."""
_FAR = 6.0
"""Distance of a point from the motion, over the noise, from which on it is no noise: it is left out."""
_WORSE = 1.3
"""Noise over that of a better start with which a start is given up."""
_LEAST_NOISE = 1e-9
"""Noise of a track without any [m or rad]."""
_WAVES = 4, 8, 16, 32
"""Numbers of slow waves in which what is left is looked for."""


def remade(scene: Scene, changes: Mapping[str, float]) -> Scene:
    """Return a scene made anew with other arguments, such as a fill; what is none of them is a field."""
    make, given = scene.made_by or (Scene, {})
    usual = inspect.signature(make).parameters if scene.made_by else ()
    own: dict[str, Any] = {name: changes[name] for name in changes if name in usual}
    others: dict[str, Any] = {name: changes[name] for name in changes if name not in own}
    scene = make(**given | own) if own else scene
    return replace(scene, **others) if others else scene


@dataclass
class Problem:
    """What a solver needs: residuals over their noise, and their derivatives, by the values over their `SIZES`."""

    track: Track
    scene: Scene
    names: list[str]
    known: Mapping[str, tuple[float, float]]
    phi0: float | str
    noise: dict[str, float] = field(default_factory=dict)
    kept: dict[str, np.ndarray] = field(default_factory=dict)
    _motions: dict[tuple[float, ...], tuple[np.ndarray, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.data = {name: data for name in ("along", "roll", "phi") if (data := getattr(self.track, name)) is not None}
        self.kept = {name: np.ones(len(data), bool) for name, data in self.data.items()}
        self.least = math.inf
        self.sizes = np.array([SIZES[name] for name in self.names])
        self.span, self.length = float(np.ptp(self.track.time)), float(np.ptp(self.track.along))
        latest = float(self.track.time[-1])
        within = _WITHIN | {"released": (latest - 4 * self.span, latest - 0.1 * self.span)}
        self.within = np.array([within.get(name, (-math.inf, math.inf)) for name in self.names]).T / self.sizes

    def scene_of(self, values: Mapping[str, float]) -> tuple[Scene, float]:
        """Return the scene and phi0 [rad] of some values."""
        scene = remade(self.scene, {name: values[name] for name in ("incline", "fill", "drag") if name in values})
        if "damping" in values:
            law, factor = scene.damping_law, math.exp(values["damping"])
            terms = dict(
                zip(("linear", "quadratic", "cubic"), (factor * each for each in law.coefficients), strict=True)
            )
            scene = replace(scene, damping=replace(law, **terms))
        if "phi0" in values:
            return scene, values["phi0"]
        return scene, -scene.incline if isinstance(self.phi0, str) else self.phi0

    def simulate(self, values: Mapping[str, float], duration: float) -> Run:
        """Return the motion since the can was let go."""
        scene, phi0 = self.scene_of(values)
        step = _NODES * math.sqrt(scene.can.radius / max(scene.gravity, 1.0))
        nodes = np.linspace(0, duration, min(5000, max(50, math.ceil(duration / step))))
        return simulate(scene, duration, phi0, tolerance=_TOLERANCE, times=nodes)

    def _motion(self, values: Mapping[str, float]) -> tuple[np.ndarray, ...]:
        """Return distance [m], speed [m/s], phi [rad] and its rate [rad/s] at the times of the track."""
        key = tuple(value for name, value in values.items() if name in (*FREE, "phi0", "released"))
        if key not in self._motions:
            since = np.maximum(self.track.time - values["released"], 0.0)
            run = self.simulate(values, float(since[-1]))
            way = CubicHermiteSpline(run.time, run.distance, run.u_dot)
            phi = CubicHermiteSpline(run.time, run.phi, run.phi_dot)
            while len(self._motions) > 1:  # the solver asks for residuals and derivatives in turn
                self._motions.pop(next(iter(self._motions)))
            self._motions[key] = way(since), way(since, 1) * (since > 0), phi(since), phi(since, 1) * (since > 0)
        return self._motions[key]

    def model(self, values: Mapping[str, float]) -> dict[str, np.ndarray]:
        """Return what the track would be without noise."""
        distance, _, phi, _ = self._motion(values)
        along = values["place"] + distance
        bent = values.get("bend", 0.0) * self._bent(along)[0]
        roll = values.get("turned", 0.0) + distance / self.scene.can.radius
        found = {"along": values.get("scale", 1.0) * along + bent, "roll": roll, "phi": phi}
        return {name: found[name] for name in self.data}

    def _bent(self, along: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return a parabola over the track that is 1 in its middle, and its slope [1/m], from places without noise."""
        # From the measured places it would have their noise, which the residuals have too: a bias of the bend.
        share = (along - self.track.along.min()) / self.length
        return 4 * share * (1 - share), 4 * (1 - 2 * share) / self.length

    def values(self, z: np.ndarray) -> dict[str, float]:
        """Return the values of a solver's vector."""
        return dict(zip(self.names, (z * self.sizes).tolist(), strict=True))

    def residuals(self, z: np.ndarray) -> np.ndarray:
        """Return the distances of track and known values, infinite where there is no such motion: it steps back."""
        values = self.values(z)
        try:
            found = self.model(values)
        except MjbeerError:
            return np.full(len(self.data) * len(self.track.time) + len(self.known), math.inf)
        far = [self.kept[name] * (found[name] - data) / self.noise[name] for name, data in self.data.items()]
        return np.concatenate([*far, [(values[name] - value) / error for name, (value, error) in self.known.items()]])

    def jacobian(self, z: np.ndarray) -> np.ndarray:
        """Return the derivatives of the residuals, of shape (residuals, values)."""
        values, radius = self.values(z), self.scene.can.radius
        distance, speed, _, phi_dot = self._motion(values)
        zero, (bent, slope) = np.zeros_like(distance), self._bent(values["place"] + distance)
        steep = values.get("scale", 1.0) + values.get("bend", 0.0) * slope
        by = {
            "place": {"along": steep},
            "released": {"along": -steep * speed, "roll": -speed / radius, "phi": -phi_dot},
            "bend": {"along": bent},
            "scale": {"along": values["place"] + distance},
            "turned": {"roll": zero + 1},
        }
        columns = []
        for name, size, lowest, highest in zip(self.names, self.sizes, *self.within, strict=True):
            if name not in by:
                ends = np.clip(values[name] / size + np.array([-_DIFFERENCE, _DIFFERENCE]), lowest, highest) * size
                (low, _, low_phi, _), (high, _, high_phi, _) = (self._motion(values | {name: end}) for end in ends)
                way, phi = (high - low) / np.ptp(ends), (high_phi - low_phi) / np.ptp(ends)
                by[name] = {"along": steep * way, "roll": way / radius, "phi": phi}
            rows = [self.kept[each] * by[name].get(each, zero) / self.noise[each] for each in self.data]
            columns.append(
                size * np.concatenate([*rows, [(name == each) / self.known[each][1] for each in self.known]])
            )
        return np.stack(columns, axis=1)

    def begin(self, values: dict[str, float]) -> tuple[float, dict[str, float]]:
        """Return values with the place and the release that suit them best, and what is left [m].

        A sliding load's incline is made to suit, too, as its way is nearly proportional to it.
        """
        some = slice(None, None, max(1, len(self.track.time) // 100))
        time, along = self.track.time[some], self.track.along[some]
        best, stretches = (math.inf, values), "incline" in values and self.scene.attachment == "sliding"
        try:
            run = self.simulate(values, 2 * self.span)
        except MjbeerError:
            return best
        released = time[0] + self.span * np.linspace(-1, 0.8, 91)
        ways = np.interp(time - released[:, np.newaxis], run.time, run.distance)
        beside, stretch = ways - ways.mean(axis=1, keepdims=True), np.ones(len(ways))
        if stretches:
            stretch = np.clip(beside @ along / np.maximum((beside**2).sum(axis=1), 1e-30), 0.5, 2.0)
        left = np.std(along - stretch[:, np.newaxis] * ways, axis=1)
        at = int(np.argmin(left))
        suited = {"released": float(released[at]), "place": float(np.mean(along - stretch[at] * ways[at]))}
        best = float(left[at]), values | suited
        if stretches:
            best[1]["incline"] *= float(stretch[at])
        return best

    def solve(self, values: dict[str, float], left: float) -> OptimizeResult:
        """Return what least squares find from a start, with the noise, of which `left` is a first guess [m]."""
        self.noise = {name: left / (1 if name == "along" else self.scene.can.radius) for name in self.data}
        self.kept = {name: np.ones(len(data), bool) for name, data in self.data.items()}
        if "turned" in values:
            values["turned"] = float(np.mean(self.data["roll"] - self.model(values)["roll"]))
        z = np.clip(np.array([*values.values()]) / self.sizes, *self.within)
        for _ in range(5):
            found = least_squares(self.residuals, z, self.jacobian, self.within, ftol=1e-6, xtol=1e-6, max_nfev=50)
            z, before, model = found.x, dict(self.noise), self.model(self.values(found.x))
            for name, data in self.data.items():
                far = model[name] - data
                self.kept[name] = np.abs(far) <= _FAR * 1.4826 * np.median(np.abs(far))
                kept = far[self.kept[name]]
                spare = max(1.0, len(kept) - len(self.names) / len(self.data))
                self.noise[name] = math.sqrt(_LEAST_NOISE**2 + kept @ kept / spare)
            settled = all(abs(self.noise[name] / before[name] - 1) < 0.01 for name in self.noise)
            if settled or self.noise["along"] > _WORSE * self.least:
                break
        self.least = min(self.least, self.noise["along"])
        found.fun, found.jac = self.residuals(z), self.jacobian(z)
        found.noise, found.kept = dict(self.noise), dict(self.kept)
        return found

    def chance(self, found: OptimizeResult) -> float:
        """Return how probable it is that noise alone leaves as much as was left in slow waves: an F test."""
        kept, values = int(self.kept["along"].sum()), len(self.names)
        rows, probability = len(found.fun), 1.0
        for count in _WAVES:
            waves = np.zeros((rows, count))
            phase = math.pi * (np.arange(len(self.track.time)) + 0.5) / len(self.track.time)
            waves[: len(phase)] = np.cos(np.outer(phase, np.arange(1, count + 1))) * self.kept["along"][:, None]
            if (rest := kept - values - count) < count:
                break
            # What the values can follow is no noise's: only the part of each wave beside that counts.
            slow = np.linalg.qr(np.hstack([found.jac, waves])).Q[:, values:].T @ found.fun
            square = slow @ slow
            ratio = square / count / ((found.fun @ found.fun - square) / rest)
            probability = min(probability, len(_WAVES) * float(fdtrc(count, rest, ratio)))
        return probability
