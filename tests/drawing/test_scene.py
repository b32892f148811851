"""Whatever made a trajectory, the display model shows can and load where theory has them."""

import math
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mjbeer import Can, Scene, frozen, liquid, sliding
from mjbeer.drawing.camera import scale
from mjbeer.drawing.scene import Display
from mjbeer.exceptions import ParameterError
from mjbeer.theory.can import RADIUS
from tests.support.scenes import METAL, scenes

# Rounding of a few products, relative to the distances in play.
ROUNDING = 1e-12


class Position(NamedTuple):
    """Where a can is: a row of what `Display.pose` takes."""

    u: float
    phi: float
    roll: float
    lift: float


def seen(display: Display, body: str, up: float) -> tuple[float, float]:
    """Return how far down the incline and above it a point of a body is, in the scene's metres.

    The point is `up` metres, as drawn, from the body's origin towards what is its top at rest.
    """
    scene = display.scenes[0]
    data = display.data.body(body)
    x, _, z = (data.xpos + data.xmat.reshape(3, 3) @ [0, 0, up]) / scale(scene)
    sine = math.sin(scene.incline)
    cosine = math.cos(scene.incline)
    return x * cosine - z * sine, x * sine + z * cosine


def check(display: Display, number: int, position: Position) -> None:
    """Check where a can of a posed display is, down the incline and above it.

    By the paper's Fig. 3 the axis is at (u, 0), and the load's centre of mass at (u - b sin phi,
    -b cos phi). What was on top of the can where it has not rolled goes downhill from there.
    """
    u, phi, roll, lift = position
    scene = display.scenes[number]
    a = scene.can.radius
    b = scene.load.offset
    prefix = f"{number}-" if number else ""
    can = f"{prefix}can"
    load = f"{prefix}load" if scene.attachment == "sliding" else can

    axis = seen(display, can, 0.0)
    centre = seen(display, load, -b * scale(scene))
    top = seen(display, can, RADIUS)

    error = ROUNDING * (abs(u) + abs(lift) + a)
    height = a + lift
    below = (u - b * math.sin(phi), height - b * math.cos(phi))
    rolled = (u + a * math.sin(roll), height + a * math.cos(roll))
    assert axis == pytest.approx((u, height), abs=error * (1 + abs(phi)))
    assert centre == pytest.approx(below, abs=error * (1 + 2 * abs(phi)))
    assert top == pytest.approx(rolled, abs=error * (1 + abs(phi) + abs(roll)))
    assert display.data.body(can).xpos[1] == pytest.approx(display.lanes[number], abs=ROUNDING)


@pytest.mark.slow
@settings(max_examples=50, deadline=None, derandomize=True)
@given(scenes(), *(st.floats(-10, 10),) * 4)
def test_any_scene_anywhere(
    scene: Scene, turns: float, phi: float, roll: float, height: float
) -> None:
    a = scene.can.radius
    if scene.attachment == "frozen":
        phi = roll
    position = Position(turns * a, phi, roll, height * a)
    display = Display([scene])

    display.pose(np.array([position]))

    check(display, 0, position)


def test_a_liquid_that_sloshes_is_posed_as_any_load_is() -> None:
    scene = liquid("water", incline=0.1, can=METAL)
    display = Display([scene])
    position = Position(u=0.1, phi=0.5, roll=3.0, lift=0.0)

    display.pose(np.array([position]))

    check(display, 0, position)


def three_cans() -> Display:
    """Return a display of a can with beer, one with ice, and one with beer."""
    with_beer = sliding(0.1, can=METAL)
    with_ice = frozen(0.1, can=METAL, fill=0.9)
    return Display([with_beer, with_ice, with_beer], apart=0.2)


def test_cans_side_by_side_are_posed_by_themselves() -> None:
    display = three_cans()
    positions = [
        Position(u=0.1, phi=0.5, roll=3.0, lift=0.0),
        Position(u=0.2, phi=1.0, roll=1.0, lift=0.01),
        Position(u=0.3, phi=7.0, roll=7.0, lift=0.0),
    ]

    display.pose(np.array(positions))

    for number, position in enumerate(positions):
        check(display, number, position)


def test_the_board_is_as_wide_as_all_lanes() -> None:
    display = three_cans()

    board = display.model.geom("board")

    assert display.lanes == [0.0, 0.2, 0.4]
    assert board.pos[1] - board.size[1] == pytest.approx(-0.075)
    assert board.pos[1] + board.size[1] == pytest.approx(0.475)


def test_cans_side_by_side_are_painted_by_themselves() -> None:
    """A load without a colour keeps its own."""
    display = three_cans()
    beer = display.model.mat("2-beer").rgba.tolist()
    red = (1.0, 0.0, 0.0)
    green = (0.0, 1.0, 0.0)
    blue = (0.0, 0.0, 1.0)

    display.paint(labels=[red, blue, green], loads=[green, green, None])

    def colour(material: str) -> tuple[float, ...]:
        return tuple(display.model.mat(material).rgba[:3].tolist())

    assert colour("label") == red
    assert colour("1-label") == blue
    assert colour("beer") == green
    assert colour("1-ice") == green
    assert display.model.mat("2-beer").rgba.tolist() == beer
    assert colour("2-beer") != green
    red_of_foam, green_of_foam, blue_of_foam = colour("foam")
    assert 0 < red_of_foam == blue_of_foam < green_of_foam == 1


def test_more_than_five_cans_are_refused() -> None:
    """MuJoCo has six groups of geoms: one for each can, and one for what is not drawn."""
    assert len(Display([frozen()] * 5, apart=0.2).lanes) == 5
    with pytest.raises(ParameterError, match="at most 5 cans can be drawn together, got 6"):
        Display([frozen()] * 6, apart=0.2)


@pytest.mark.parametrize("radius", [1e-3, 1.0])
def test_size_does_not_show(radius: float) -> None:
    """The same geoms and vertices for a can of 1 mm as for one of 1 m."""
    one = Display([sliding(can=Can.massless(0.05, 0.1))]).model
    other = Display([sliding(can=Can.massless(radius, 2 * radius))]).model
    for field in ("geom_pos", "geom_size", "mesh_vert", "mat_texrepeat", "body_pos"):
        assert np.allclose(getattr(one, field), getattr(other, field), rtol=1e-6, atol=1e-9), field
    assert one.stat.extent == pytest.approx(other.stat.extent)
