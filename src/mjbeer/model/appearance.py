"""The looks of a scene: geoms and cameras of a template are fitted to the scene's sizes, or removed."""

import math

import mujoco
import numpy as np

from mjbeer.model import mesh
from mjbeer.model.parts import PARTS
from mjbeer.theory.can import LENGTH, RADIUS
from mjbeer.theory.scene import Scene

_HALF_TURNS = (-20, 980)
"""Where the templates' board begins and ends, in half turns of the can from u = 0. A half turn is two stripes."""
_SPARE = 20
"""Half turns of board beyond either end of a motion: more than a camera at the can sees."""
TEXTURED = ("can.obj", "lid.obj", "beer_half.obj")
"""The mesh files of the templates that say where a vertex is in a texture."""
_LEAST_FILL = 1e-6
"""Smallest fill that is drawn: a mesh must not be flat, and so little beer cannot be seen."""
_LEAST_VOLUME = 1e-12
"""Smallest volume [m^3] of a solid mesh. A smaller mesh becomes a shell, which looks the same: below 1e-15 m^3 MuJoCo
refuses a solid one."""
TURNING = ("can_mark", "can_spot", "can_tab", "can_mouth", "can_spokes")
"""The geoms of the templates that show how far the can has turned."""
DRAWN = (
    "geoms", "sites", "cameras", "lights", "keys", "skins", "meshes", "hfields", "materials", "textures", "numerics",
    "texts", "tuples",
)  # fmt: skip
"""The kinds of elements in a template that are only drawn and do not act on the motion."""
FOAM = 0.025
"""Thickness of the foam on the beer, in radii."""
_SHARE = 0.25
"""Largest thickness of the foam over the depth of the beer, and over the room above it."""
_LEAST_FOAM = 1e-4
"""Smallest thickness of foam that is drawn, in radii."""
_ALONG_THE_AXES = (mujoco.mjtGeom.mjGEOM_BOX, mujoco.mjtGeom.mjGEOM_PLANE)
"""Types of geoms whose sides are parallel to the axes: each side is stretched by itself."""


def strip(spec: mujoco.MjSpec) -> None:
    """Remove all elements that are only drawn from a template."""
    for kind in DRAWN:
        for element in getattr(spec, kind):
            spec.delete(element)


def dress(spec: mujoco.MjSpec, scene: Scene) -> None:
    """Fit what is drawn to the scene's sizes, and remove the template's keyframes, which belong to another scene."""
    for key in spec.keys:
        spec.delete(key)
    radius, length = scene.can.radius, scene.can.length
    size = radius / RADIUS
    for geom in spec.geoms:
        _stretch(geom, size, length)
    for element in spec.meshes:
        element.scale = np.array(element.scale) * size
    for camera in spec.cameras:
        camera.pos = _scale_point(camera.pos, size, length)
    grid = spec.material("grid")
    grid.texrepeat = np.array(grid.texrepeat) / size
    spec.stat.extent, spec.stat.center = spec.stat.extent * size, np.array(spec.stat.center) * size
    for element in spec.meshes:
        if (part := PARTS.get(element.file)) is not None:
            _reshape(element, part(radius, length), radius)  # a file of the user's own keeps its proportions
    _fit_load(spec, scene)


def lengthen(spec: mujoco.MjSpec, scene: Scene, low: float, high: float) -> None:
    """Make the board long enough for a motion from u = `low` to `high` [m]."""
    turn = math.pi * scene.can.radius
    first = min(_HALF_TURNS[0], math.floor(low / turn) - _SPARE)
    last = max(_HALF_TURNS[1], math.ceil(high / turn) + _SPARE)
    board = spec.geom("board")
    board.pos = [(first + last) / 2 * turn, *board.pos[1:]]
    board.size = [(last - first) / 2 * turn, *board.size[1:]]
    planks = spec.material("planks")
    planks.texrepeat = [last - first, planks.texrepeat[1]]


def _stretch(geom: mujoco.MjsGeom, size: float, length: float) -> None:
    """Move and scale a geom of the template to fit a can that is `size` times as wide and has a `length` [m]."""
    if not math.isnan(geom.fromto[0]):
        geom.fromto = [*_scale_point(geom.fromto[:3], size, length), *_scale_point(geom.fromto[3:], size, length)]
        geom.size = np.array(geom.size) * size
    elif geom.type in _ALONG_THE_AXES and geom.size[0] > 0:  # an infinite plane has size 0
        low = _scale_point(np.array(geom.pos) - geom.size, size, length)
        high = _scale_point(np.array(geom.pos) + geom.size, size, length)
        geom.pos, geom.size = (low + high) / 2, (high - low) / 2
    else:
        geom.pos, geom.size = _scale_point(geom.pos, size, length), np.array(geom.size) * size


def _scale_point(point: np.ndarray, size: float, length: float) -> np.ndarray:
    """Return where a point of the template belongs on a can that is `size` times as wide and has a `length` [m].

    Across the axis it scales with the radius. Along the axis its distance from the nearer end of the can does.
    """
    x, y, z = point
    inside = LENGTH / 2 - abs(y)
    inside = min(inside * size, inside * length / LENGTH) if inside > 0 else inside * size  # stays in its half
    return np.array([x * size, math.copysign(length / 2 - inside, y) if y else 0.0, z * size])


def _fit_load(spec: mujoco.MjSpec, scene: Scene) -> None:
    """Give the beer and its foam the scene's fill, or put the bob or the bar where the scene has it."""
    load = scene.load
    if load.fill is not None:
        _fill(spec, scene, max(load.fill, _LEAST_FILL))
        return
    ball, arm = spec.geom("load"), spec.geom("load_arm")
    if arm is not None:
        ball.pos = [0, ball.pos[1], -load.offset]
        arm.pos, arm.size = [0, arm.pos[1], -load.offset / 2], [arm.size[0], max(load.offset / 2, arm.size[0] / 100), 0]
        return
    depth = -min(load.offset, scene.can.radius - ball.size[0])  # a load on the rim is drawn just inside it
    if math.isnan(ball.fromto[0]):
        ball.pos = [0, ball.pos[1], depth]
    else:
        ball.fromto = [*ball.fromto[:2], depth, *ball.fromto[3:5], depth]


def _fill(spec: mujoco.MjSpec, scene: Scene, fill: float) -> None:
    """Give the beer its `fill`, and put the foam on it, which gets thin or goes where there is no room or no beer."""
    radius, length = scene.can.radius, scene.can.length
    thickness = min(FOAM, _SHARE * 2 * fill, _SHARE * 2 * (1 - fill))
    if thickness < _LEAST_FOAM:
        for element in (spec.geom("foam"), spec.mesh("foam")):
            if element is not None:
                spec.delete(element)
    for element in spec.meshes:
        if element.file == "beer_half.obj":
            _reshape(element, mesh.beer(fill, radius, length), radius)
        elif element.file == "foam_half.obj":
            _reshape(element, mesh.layer(fill, thickness, radius, length), radius)


def _reshape(element: mujoco.MjsMesh, shape: mesh.Mesh, radius: float) -> None:
    """Replace the file of a template's mesh by a shape for a can of a `radius` [m], so that the model needs no file."""
    vertices, faces = shape
    if element.file in TEXTURED:
        element.usertexcoord = mesh.texture(vertices, radius).ravel()
    element.scale = [1, 1, 1]
    element.file, element.content_type = "", ""
    element.uservert, element.userface = vertices.ravel(), faces.ravel()
    if mesh.volume(shape) < _LEAST_VOLUME:
        element.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
