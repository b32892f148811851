"""How a scene looks: geoms and cameras of the templates fitted to its sizes, or taken away."""

import math

import mujoco
import numpy as np

from mjbeer.model import mesh
from mjbeer.theory.can import LENGTH, RADIUS
from mjbeer.theory.scene import Scene

WALL = 0.04
"""Thickness of the can's drawn wall, in radii: outside of the radius, so that the beer fills the inside."""
_HALF_TURNS = (-20, 96)
"""The templates' board begins and ends these half turns of the can from u = 0. Two of its stripes are one."""
_SPARE = 20
"""Half turns of board beyond a motion's ends: more than a camera at the can sees."""
_MARGIN = 1.1
"""How much more than the motion the overview shows."""
_LEAST_FILL = 1e-6
"""Fill that is drawn of an emptier can: a mesh must not be flat, and one sees nothing of it anyway."""
_LEAST_VOLUME = 1e-12
"""MuJoCo refuses solid meshes of under 1e-15 m^3; well before, they become shells, which look the same."""
DRAWN = (
    "geoms", "sites", "cameras", "lights", "keys", "skins", "meshes", "hfields", "materials", "textures", "numerics",
    "texts", "tuples",
)  # fmt: skip
"""All kinds of elements in a template that act on no motion."""
_SHAPES = ("can.obj", "beer_half.obj")
"""The templates' mesh files, in whose place a scene has shapes that fit it."""
_ALONG_THE_AXES = (mujoco.mjtGeom.mjGEOM_BOX, mujoco.mjtGeom.mjGEOM_PLANE)


def strip(spec: mujoco.MjSpec) -> None:
    """Remove all that is only drawn, from a template as it is read."""
    for kind in DRAWN:
        for element in getattr(spec, kind):
            spec.delete(element)


def dress(spec: mujoco.MjSpec, scene: Scene) -> None:
    """Fit what is drawn to the scene's sizes; the template's keyframes go, as they were another scene's."""
    for each in spec.keys:
        spec.delete(each)
    radius, length = scene.can.radius, scene.can.length
    size = radius / RADIUS
    for geom in spec.geoms:
        _stretch(geom, size, length)
    if (end := spec.geom("can_end")) is not None:
        end.size = [end.size[0], length / 2 - end.pos[1], 0]
    for own in spec.meshes:
        own.scale = np.array(own.scale) * size
    for camera in spec.cameras:
        camera.pos = _point(camera.pos, size, length)
    grid = spec.material("grid")
    grid.texrepeat = np.array(grid.texrepeat) / size
    spec.stat.extent, spec.stat.center = spec.stat.extent * size, np.array(spec.stat.center) * size
    _shape(spec, "can", mesh.tube(radius, radius * (1 + WALL), length))
    _load(spec, scene)


def extend(spec: mujoco.MjSpec, scene: Scene, low: float, high: float, aspect: float) -> None:
    """Make the board long enough for a motion from u = `low` to `high` [m], and let the overview show all of it.

    `aspect` is the width of the picture over its height.
    """
    turn = math.pi * scene.can.radius
    first = min(_HALF_TURNS[0], math.floor(low / turn) - _SPARE)
    last = max(_HALF_TURNS[1], math.ceil(high / turn) + _SPARE)
    for geom in (spec.geom("board"), spec.geom("board_side")):
        geom.pos = [(first + last) / 2 * turn, *geom.pos[1:]]
        geom.size = [(last - first) / 2 * turn, *geom.size[1:]]
    planks = spec.material("planks")
    planks.texrepeat = [last - first, planks.texrepeat[1]]
    overview, along = spec.camera("overview"), np.array([math.cos(scene.incline), 0, -math.sin(scene.incline)])
    seen = np.abs((high - low) * along) + 10 * scene.can.radius
    distance = _MARGIN * max(seen[0] / aspect, seen[2]) / (2 * math.tan(math.radians(overview.fovy) / 2))
    overview.pos = (low + high) / 2 * along + distance * _backwards(spec, overview)
    spec.visual.map.zfar = max(spec.visual.map.zfar, 4 * distance / spec.stat.extent)


def _backwards(spec: mujoco.MjSpec, camera: mujoco.MjsCamera) -> np.ndarray:
    """Return the unit vector against which a camera of the world looks."""
    quaternion, axes = np.array(camera.quat), np.zeros(9)
    if camera.alt.type != mujoco.mjtOrientation.mjORIENTATION_QUAT:
        quaternion = spec.resolve_orientation(spec.compiler.degree, spec.compiler.eulerseq, camera.alt)
    mujoco.mju_quat2Mat(axes, np.array(quaternion))
    return axes.reshape(3, 3)[:, 2]


def _stretch(geom: mujoco.MjsGeom, size: float, length: float) -> None:
    """Put a geom of the template where it belongs on a can `size` times as wide and of a `length` [m]."""
    if not math.isnan(geom.fromto[0]):
        geom.fromto = [*_point(geom.fromto[:3], size, length), *_point(geom.fromto[3:], size, length)]
        geom.size = np.array(geom.size) * size
    elif geom.type in _ALONG_THE_AXES and geom.size[0] > 0:  # an infinite plane has size 0
        low = _point(np.array(geom.pos) - geom.size, size, length)
        high = _point(np.array(geom.pos) + geom.size, size, length)
        geom.pos, geom.size = (low + high) / 2, (high - low) / 2
    else:
        geom.pos, geom.size = _point(geom.pos, size, length), np.array(geom.size) * size


def _point(point: np.ndarray, size: float, length: float) -> np.ndarray:
    """Where a point of the template goes: all grows with the radius, and keeps its distance from the can's ends."""
    x, y, z = point
    inside = LENGTH / 2 - abs(y)
    inside = min(inside * size, inside * length / LENGTH) if inside > 0 else inside * size  # in the same half
    return np.array([x * size, math.copysign(length / 2 - inside, y) if y else 0.0, z * size])


def _load(spec: mujoco.MjSpec, scene: Scene) -> None:
    load = scene.load
    if load.fill is not None:
        _shape(spec, "load", mesh.beer(max(load.fill, _LEAST_FILL), scene.can.radius, scene.can.length))
        return
    drawn, arm = spec.geom("load"), spec.geom("load_arm")
    if arm is not None:
        drawn.pos = [0, drawn.pos[1], -load.offset]
        arm.pos, arm.size = [0, arm.pos[1], -load.offset / 2], [arm.size[0], max(load.offset / 2, arm.size[0] / 100), 0]
        return
    depth = -min(load.offset, scene.can.radius - drawn.size[0])  # along the rim, and drawn just inside
    if math.isnan(drawn.fromto[0]):
        drawn.pos = [0, drawn.pos[1], depth]
    else:
        drawn.fromto = [*drawn.fromto[:2], depth, *drawn.fromto[3:5], depth]


def _shape(spec: mujoco.MjSpec, name: str, shape: mesh.Mesh) -> None:
    """Put vertices in the place of the template's mesh file: the model is then complete in itself.

    Another file than the one that came with mjbeer stays, and has the proportions of the template's can.
    """
    vertices, faces = shape
    element = spec.mesh(name)
    if element.file not in _SHAPES:
        return
    element.scale = [1, 1, 1]
    element.file, element.content_type = "", ""
    element.uservert, element.userface = vertices.ravel(), faces.ravel()
    volume = np.einsum("ij,ij->", vertices[faces[:, 0]], np.cross(vertices[faces[:, 1]], vertices[faces[:, 2]])) / 6
    if volume < _LEAST_VOLUME:
        element.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
