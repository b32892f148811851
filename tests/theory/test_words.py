"""Scenes in words."""

import math

import pytest

from mjbeer import Can, Damping, Load, Scene, frozen, hoop, pendulum, sliding
from mjbeer.theory.scene import damping_in_words, in_degrees, in_words


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        (frozen(), "half-full massless can, beer frozen, incline 10°"),
        (sliding(math.radians(-2.5), 0.37, Can.sheet_metal()), "37 % full can of 8.57 g, beer sliding, incline −2.5°"),
        (frozen(0.0, 1.0), "full massless can, beer frozen, level ground"),
        (pendulum(), "wheel with a pendulum, M = 200 g, m = 100 g, incline 10°"),
        (hoop(), "hoop with a weight on its rim, M = 10 g, m = 200 g, level ground"),
        (sliding(damping=1e-3), "half-full massless can, beer sliding, damping 0.001 N m s, incline 10°"),
        (
            sliding(damping=Damping(1e-5, 1e-6), drag=2e-4),
            "half-full massless can, beer sliding, damped, drag 0.0002 kg/m, incline 10°",
        ),
        (
            Scene(Can.massless(), Load(0.2, 0.01, 1e-5), 0.0),
            "massless can, load sliding, its centre of mass 10 mm from the axis, level ground",
        ),
    ],
)
def test_a_scene_in_words(scene: Scene, words: str) -> None:
    assert in_words(scene) == words


def test_what_varies_is_left_out() -> None:
    assert in_words(frozen(), {"incline"}) == "half-full massless can, beer frozen"
    assert in_words(frozen(), {"fill", "can", "load"}) == "can, incline 10°"
    assert in_words(hoop(), {"load", "incline"}) == "hoop with a weight on its rim"
    assert in_words(sliding(damping=1e-3, drag=1e-3), {"damping"}) == in_words(sliding())


def test_damping_in_words() -> None:
    assert damping_in_words(sliding(damping=Damping(1e-5, 0.0, 2e-8))) == "1e-05 N m s w + 2e-08 N m s^3 w^3"
    assert damping_in_words(sliding(damping=Damping(0.0, 3e-6))) == "3e-06 N m s^2 w|w|"
    assert damping_in_words(sliding()) == "0"


def test_degrees_are_rounded_to_a_tenth() -> None:
    assert [in_degrees(angle) for angle in (1.0, -math.pi, 0.0)] == ["57.3°", "−180°", "0°"]
