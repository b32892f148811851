"""The regions of the search, each of which takes one thing or all to its extremes, and the run that a number makes."""

from collections.abc import Callable
from dataclasses import dataclass

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import DOP853
from mjbeer.studies.stability.search import paces, samples, scenes, settings, starts
from mjbeer.studies.stability.search.paces import Pace
from mjbeer.studies.stability.search.pick import Pick
from mjbeer.studies.stability.search.random_run import RandomRun
from mjbeer.studies.stability.search.samples import Samples
from mjbeer.studies.stability.search.settings import Choice
from mjbeer.studies.stability.search.starts import Start
from mjbeer.theory.scene import Scene


@dataclass(frozen=True)
class Region:
    """A part of the search: how its runs choose scene, start, pace, setting and samples."""

    name: str
    scene: Callable[[Pick], Scene] = scenes.ordinary
    start: Callable[[Pick, Scene], Start] = starts.ordinary
    pace: Callable[[Pick, Scene, Start], Pace] = paces.ordinary
    setting: Callable[[Pick, Scene], Choice] = settings.ordinary
    samples: Callable[[Pick, int, bool], Samples] = samples.regular

    def draw(self, pick: Pick) -> RandomRun:
        """Return a random run of this region.

        Raises:
          ParameterError: if the choices make a scene that cannot be.
        """
        scene = self.scene(pick)
        start = self.start(pick, scene)
        timestep, steps = self.pace(pick, scene, start)
        choice = self.setting(pick, scene)
        anywhere = choice.tolerance is not None or choice.integrator == DOP853
        every, moments = self.samples(pick, steps, anywhere)
        return RandomRun(
            region=self.name,
            scene=scene,
            phi0=start[0],
            phi_dot0=start[1],
            rolling=choice.rolling,
            integrator=choice.integrator if choice.tolerance is None else None,
            timestep=timestep,
            tolerance=choice.tolerance,
            friction=choice.friction,
            steps=steps,
            every=every,
            moments=moments,
        )


def _any_scene(pick: Pick) -> Scene:
    kinds = scenes.ordinary, scenes.steady, scenes.anything, scenes.ratios, scenes.fills, scenes.steep, scenes.gravity
    return pick.one(*kinds)(pick)


def _any_damped(pick: Pick) -> Scene:
    return scenes.damped(pick, _any_scene(pick))


def _any_pace(pick: Pick, scene: Scene, start: Start) -> Pace:
    kinds = paces.ordinary, paces.swinging, paces.anything, paces.fast, paces.resonant, paces.few, paces.long
    return pick.one(*kinds)(pick, scene, start)


REGIONS = (
    Region("ordinary"),
    Region("anything", scenes.anything, starts.anything, paces.anything, settings.anything),
    Region("sparse samples", scenes.mostly_ordinary, pace=paces.either, samples=samples.sparse),
    Region("single late sample", scenes.mostly_ordinary, pace=paces.either, samples=samples.late),
    Region("few steps", pace=paces.few),
    Region("fast rotation", scenes.steady_or_ordinary, start=starts.fast, pace=paces.fast),
    Region("resonance", scenes.steady_or_ordinary, start=starts.fast, pace=paces.resonant, samples=samples.anything),
    Region("contact friction", setting=settings.contact),
    Region("mass ratios", scenes.ratios, pace=paces.either),
    Region("thin or full", scenes.fills, pace=paces.either, samples=samples.anything),
    Region("long", pace=paces.long, samples=samples.anything),
    Region("far angles", start=starts.far, samples=samples.anything),
    Region("steep", scenes.steep),
    Region("weak or strong gravity", scenes.gravity),
    Region("beside the separatrix", start=starts.beside_the_separatrix, samples=samples.anything),
    Region("mixed", _any_scene, starts.anything, _any_pace, settings.anything, samples.anything),
    Region("damped", scenes.damped_ordinary, pace=paces.either),
    Region("damped, mixed", _any_damped, starts.anything, _any_pace, settings.anything, samples.anything),
)
"""All regions; as many runs are drawn from each."""


def random_run(number: int) -> RandomRun:
    """Return the run of a number from 0 on, in the regions by turns."""
    pick, region = Pick(number), REGIONS[number % len(REGIONS)]
    while True:
        try:
            run = region.draw(pick)
            require.start(run.phi0, run.phi_dot0)
            require.within("timestep", run.timestep, *require.TIMESTEP)
            return run
        except ParameterError:  # outside the domain: choose again
            pass
