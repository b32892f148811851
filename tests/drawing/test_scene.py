"""Whatever made a trajectory, the display model shows can and load where theory has them."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mjbeer import Can, Scene, frozen, sliding
from mjbeer.drawing.camera import scale
from mjbeer.drawing.scene import Display
from mjbeer.theory.can import RADIUS
from tests.support.scenes import METAL, scenes

# Rounding of a few products, relative to the distances in play.
ROUNDING = 1e-12


def check(display: Display, number: int, u: float, phi: float, roll: float, lift: float) -> None:
    """Check where a can of a posed display is, down the incline and above it."""
    scene = display.scenes[number]
    prefix = f"{number}-" if number else ""
    a = scene.can.radius
    b = scene.load.offset
    sine = math.sin(scene.incline)
    cosine = math.cos(scene.incline)
    can = display.data.body(prefix + "can")
    load = display.data.body(prefix + "load") if scene.attachment == "sliding" else can
    # Paper's Fig. 3: the axis at (u, 0), the load's centre of mass at (u - b sin phi, -b cos phi).
    # What was on top of the can where it has not rolled goes downhill from there.
    for body, up, along, height, turned in (
        (can, 0.0, u, a + lift, 0.0),
        (load, -b * scale(scene), u - b * math.sin(phi), a + lift - b * math.cos(phi), phi),
        (can, RADIUS, u + a * math.sin(roll), a + lift + a * math.cos(roll), roll),
    ):
        x, _, z = (body.xpos + body.xmat.reshape(3, 3) @ [0, 0, up]) / scale(scene)
        tolerance = ROUNDING * (abs(u) + abs(lift) + a) * (1 + abs(phi) + abs(turned))
        assert x * cosine - z * sine == pytest.approx(along, abs=tolerance)
        assert x * sine + z * cosine == pytest.approx(height, abs=tolerance)
    assert can.xpos[1] == pytest.approx(display.lanes[number], abs=ROUNDING)


@pytest.mark.slow
@settings(max_examples=50, deadline=None, derandomize=True)
@given(scenes(), *(st.floats(-10, 10),) * 4)
def test_any_scene_anywhere(
    scene: Scene, turns: float, phi: float, roll: float, height: float
) -> None:
    a = scene.can.radius
    phi = roll if scene.attachment == "frozen" else phi
    display = Display([scene])
    display.pose(np.array([[turns * a, phi, roll, height * a]]))
    check(display, 0, turns * a, phi, roll, height * a)


def test_cans_side_by_side_are_posed_and_painted_by_themselves() -> None:
    """Of another kind each, on one board that is as wide as all lanes.

    A load without a colour keeps its own.
    """
    display = Display(
        [sliding(0.1, can=METAL), frozen(0.1, can=METAL, fill=0.9), sliding(0.1, can=METAL)],
        apart=0.2,
    )
    positions = np.array([[0.1, 0.5, 3.0, 0.0], [0.2, 1.0, 1.0, 0.01], [0.3, 7.0, 7.0, 0.0]])
    display.pose(positions)
    for number, position in enumerate(positions):
        check(display, number, *position)
    assert display.lanes == [0.0, 0.2, 0.4]
    board = display.model.geom("board")
    assert board.pos[1] - board.size[1] == pytest.approx(-0.075)
    assert board.pos[1] + board.size[1] == pytest.approx(0.475)
    beer = display.model.mat("2-beer").rgba.tolist()
    green = (0.0, 1.0, 0.0)
    display.paint([(1.0, 0.0, 0.0), (0.0, 0.0, 1.0), green], [green, green, None])
    painted = {
        "label": [1, 0, 0, 1],
        "1-label": [0, 0, 1, 1],
        "beer": [0, 1, 0, 1],
        "1-ice": [0, 1, 0, 1],
    }
    for material, colour in painted.items():
        assert display.model.mat(material).rgba.tolist() == colour
    assert display.model.mat("2-beer").rgba.tolist() == beer != [0, 1, 0, 1]
    foam = display.model.mat("foam").rgba
    assert 0 < foam[0] == foam[2] < foam[1] == 1


@pytest.mark.parametrize("radius", [1e-3, 1.0])
def test_size_does_not_show(radius: float) -> None:
    """The same geoms and vertices for a can of 1 mm as for one of 1 m."""
    one = Display([sliding(can=Can.massless(0.05, 0.1))]).model
    other = Display([sliding(can=Can.massless(radius, 2 * radius))]).model
    for field in ("geom_pos", "geom_size", "mesh_vert", "mat_texrepeat", "body_pos"):
        assert np.allclose(getattr(one, field), getattr(other, field), rtol=1e-6, atol=1e-9), field
    assert one.stat.extent == pytest.approx(other.stat.extent)
