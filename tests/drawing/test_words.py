"""A scene in words, as titles and captions have it."""

import math

from mjbeer import Can, Damping, frozen, liquid, pendulum, sliding
from mjbeer.drawing.words import damping_in_words, in_words


def test_a_scene_in_words() -> None:
    assert in_words(frozen()) == "half-full massless can, beer frozen, incline 10°"
    can = Can.sheet_metal()
    water = liquid("water", math.radians(2), 0.75, can)
    assert in_words(water) == "three-quarters-full can of 8.57 g, water, incline 2°"
    assert in_words(pendulum(0.0)) == "wheel of 200 g with a bob of 100 g, level ground"


def test_damping_in_words() -> None:
    linear = sliding(damping=0.001)
    cubic = sliding(damping=Damping(1e-5, 0.0, 2e-8))

    assert in_words(linear).endswith("beer sliding, damping 0.001 N m s, incline 10°")
    assert in_words(cubic).endswith("beer sliding, damped, incline 10°")
    assert damping_in_words(sliding()) == "0"
    assert damping_in_words(linear) == "0.001 N m s"
    assert damping_in_words(cubic) == "1e-05 N m s + 2e-08 N m s^3 w^2"
