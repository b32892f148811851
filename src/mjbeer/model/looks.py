"""The looks of a scene: an MJCF template without its mechanics, whose geoms, meshes and cameras fit the scene's sizes.

Across the can's axis, the y axis, everything grows with the radius. What is at one end of the can stays there.
"""

import functools
import math
import pathlib

import mujoco
import numpy as np

from mjbeer.exceptions import TemplateError
from mjbeer.theory.can import LENGTH, RADIUS, Can
from mjbeer.theory.load import segment
from mjbeer.theory.scene import Scene
from mjbeer.theory.standing import Standing

FOLDERS = (pathlib.Path(__file__).parents[1] / "mjcf", pathlib.Path(__file__).parents[3] / "mjcf")
"""Where the templates are in an installed wheel, and in a checkout."""
NEEDED = {
    "body": ("incline", "can", "load"),
    "frame": ("level",),
    "camera": ("side", "quarter", "overview"),
    "geom": ("load", "board"),
    "mesh": ("can",),
    "material": ("planks", "grid"),
    "default": ("collision",),
}
"""The elements that mjbeer addresses by name in every template, by kind; one with beer has a mesh "load" too."""
_STANDING = {
    "body": ("can", "liquid", "slosh1"),
    "frame": ("upright",),
    "camera": ("side", "quarter"),
    "geom": ("beer", "beer_top"),
    "mesh": ("can",),
    "material": ("grid",),
    "default": ("collision",),
}
"""The same in the template of a standing can."""
_TOP = 0.1
"""Thickness of the drawn surface of a standing can, in radii."""
_MECHANISM = ("keys", "sensors", "actuators", "equalities", "pairs", "excludes", "tendons", "joints")
"""Kinds of elements that mjbeer makes anew, or leaves out; what refers to others comes before them."""
_COLLIDING = ("surface", "can")
"""The geoms that collide where rolling is by contact. They are made anew as well."""
_ADDED = ("joint", "geom", "site", "equality", "pair", "tendon", "actuator")
"""Kinds of elements that mjbeer adds: with MuJoCo's own defaults, whatever those of the template are."""
_IDENTITY = ("name", "classname", "childclass", "info", "userdata", "plugin")
"""Attributes that identify an element."""
TURNING = ("can_mark", "can_spot", "can_tab", "can_mouth", "can_spokes")
"""The geoms that show how far the can has turned."""
WALL = 0.06
"""Thickness of the drawn wall of the can, in radii. It lies outside the radius, so that the beer fills the inside."""
FOAM, _FOAM_SHARE, _LEAST_FOAM = 0.025, 0.25, 1e-4
"""Thickness of the foam in radii, and its largest one over the depth of the beer and over the room above it; a thinner
one than the last is not drawn."""
_LEAST_FILL = 1e-6
"""Smallest fill that is drawn: a mesh must not be flat, and so little beer cannot be seen."""
_LEAST_VOLUME = 1e-12
"""Smallest volume [m^3] of a solid mesh. A smaller one becomes a shell, which looks the same: MuJoCo refuses 1e-15."""
EDGES = 256
"""Number of edges around the arc of the beer. The error of the polygon falls as its square; with 256 edges mass,
centroid and inertia are within 6e-4 for every fill up to 0.95."""
_HALF_TURNS = (-20, 980)
"""Where the templates' board begins and ends, in half turns of the can from u = 0. A half turn is two stripes."""
_SPARE = 20
"""Half turns of board beyond either end of a motion: more than a camera at the can sees."""
_ALONG_THE_AXES = (mujoco.mjtGeom.mjGEOM_BOX, mujoco.mjtGeom.mjGEOM_PLANE)
"""Types of geoms whose sides are parallel to the axes: each side is stretched by itself."""

Mesh = tuple[np.ndarray, np.ndarray]
"""Vertices (n, 3) [m] and faces (k, 3), closed and oriented outwards. Where two surfaces meet at an edge that is to
look sharp, each has vertices of its own."""


def folder() -> pathlib.Path:
    """Return the folder of the templates; if there is none, that is a TemplateError."""
    for candidate in FOLDERS:
        if (candidate / "shared.xml").is_file():
            return candidate
    raise TemplateError(f"no MJCF templates: neither {FOLDERS[0]} nor {FOLDERS[1]} holds them; reinstall mjbeer")


def name(scene: Scene) -> str:
    """Return the name of the template for a scene; a load without a fill is drawn as a ball."""
    if scene.attachment == "sliding":
        return "pendulum" if scene.load.fill is None else "sliding"
    return "hoop" if scene.load.fill is None else "frozen"


def template(scene: Scene) -> pathlib.Path:
    """Return the template's file for a scene, with the errors of `folder`."""
    return folder() / f"{name(scene)}.xml"


def dressed(scene: Scene) -> mujoco.MjSpec:
    """Return what is drawn of a scene: its template, of which nothing is left that mjbeer makes anew.

    It has the bodies "incline", "can" and "load" without joints and masses, and MuJoCo's own options and defaults.

    Raises:
      TemplateError: if it cannot be read, or lacks an element that mjbeer addresses by name.
    """
    needed = NEEDED | ({"mesh": ("can", "load")} if scene.load.fill is not None else {})
    spec = _read(template(scene), needed)
    _remove_mechanics(spec)
    _fit(spec, scene)
    return spec


def upright(standing: Standing) -> mujoco.MjSpec:
    """Return what is drawn of a standing can, as `dressed` does, with the same errors.

    The beer is a column in the body "liquid" under a disc that tilts with the body "slosh1".
    """
    can = standing.can
    spec = _read(folder() / "standing.xml", _STANDING)
    _remove_mechanics(spec)
    for site in spec.sites:
        spec.delete(site)
    _fit_sizes(spec, can)
    spec.frame("upright").pos = [0, 0, can.length / 2]
    if standing.modes == 0:
        spec.delete(spec.body("slosh1"))
    for name, (low, high) in column(standing).items():
        spec.geom(name).pos, spec.geom(name).size = [0, 0, (low + high) / 2], [can.radius, (high - low) / 2, 0]
    return spec


def column(standing: Standing) -> dict[str, tuple[float, float]]:
    """Return from where to where the geoms reach that draw the beer, along the axes of their bodies [m]."""
    height = standing.height
    if standing.modes == 0:
        return {"beer": (0.0, height)}
    thickness, pivot = min(_TOP * standing.can.radius, height / 4), standing.pivots(1)[0]
    return {"beer": (0.0, height - thickness), "beer_top": (height - 2 * thickness - pivot, height - pivot)}


def _read(path: pathlib.Path, needed: dict[str, tuple[str, ...]]) -> mujoco.MjSpec:
    """Return the specification in a template, which must have the elements that mjbeer addresses by name."""
    try:
        spec = mujoco.MjSpec.from_file(str(path))
    except (ValueError, OSError) as error:
        raise TemplateError(f"{path} is not readable MJCF: {error}") from error
    for kind, names in needed.items():
        find = spec.find_default if kind == "default" else getattr(spec, kind)
        for each in names:
            if find(each) is None:
                raise TemplateError(f"{path} has no {kind} named {each!r}, which mjbeer uses; restore the template")
    return spec


def _remove_mechanics(spec: mujoco.MjSpec) -> None:
    """Remove what mjbeer makes anew, and give what it adds to, and all options, MuJoCo's own values."""
    colliding = filter(None, map(spec.geom, _COLLIDING))
    for element in (*(each for kind in _MECHANISM for each in getattr(spec, kind)), *colliding):
        spec.delete(element)
    for geom in spec.geoms:
        geom.contype, geom.conaffinity, geom.mass = 0, 0, 0.0
    fresh = mujoco.MjSpec()
    body = fresh.worldbody.add_body()
    pairs = [(element, body) for element in spec.bodies[1:]]
    pairs += [(getattr(spec.default, kind), getattr(fresh.default, kind)) for kind in _ADDED]
    for element, own in (*pairs, (spec.option, fresh.option)):
        for attribute in attributes(type(own)):
            setattr(element, attribute, getattr(own, attribute))
    spec.memory, spec.stat.meaninertia = fresh.memory, math.nan  # both act on contacts


@functools.cache
def attributes(kind: type) -> tuple[str, ...]:
    """Return the names of the attributes that can be set in a kind of element, except those that identify it."""
    settable = (each for each in dir(kind) if getattr(getattr(kind, each), "fset", None) is not None)
    return tuple(each for each in settable if each not in _IDENTITY)


def _fit(spec: mujoco.MjSpec, scene: Scene) -> None:
    """Fit what is drawn to the scene's sizes."""
    _fit_sizes(spec, scene.can)
    if scene.load.fill is not None:
        pour(spec, scene)
    else:
        _hang(spec, scene)


def _fit_sizes(spec: mujoco.MjSpec, can: Can) -> None:
    """Fit what is drawn to the sizes of a can."""
    size, length = can.radius / RADIUS, can.length
    for geom in spec.geoms:
        _stretch(geom, size, length)
    for camera in spec.cameras:
        camera.pos = _stretched(camera.pos, size, length)
    grid = spec.material("grid")
    grid.texrepeat = np.array(grid.texrepeat) / size
    spec.stat.extent, spec.stat.center = spec.stat.extent * size, np.array(spec.stat.center) * size
    for element in spec.meshes:
        _fit_mesh(element, pathlib.Path(spec.modelfiledir, spec.meshdir), size, length)


def lengthen(spec: mujoco.MjSpec, scene: Scene, low: float, high: float) -> None:
    """Make the board long enough for a motion from u = `low` to `high` [m]."""
    turn = math.pi * scene.can.radius
    first = min(_HALF_TURNS[0], math.floor(low / turn) - _SPARE)
    last = max(_HALF_TURNS[1], math.ceil(high / turn) + _SPARE)
    board, planks = spec.geom("board"), spec.material("planks")
    board.pos = [(first + last) / 2 * turn, *board.pos[1:]]
    board.size = [(last - first) / 2 * turn, *board.size[1:]]
    planks.texrepeat = [last - first, planks.texrepeat[1]]


def _stretch(geom: mujoco.MjsGeom, size: float, length: float) -> None:
    """Move and scale a geom of the template to fit a can that is `size` times as wide and has a `length` [m]."""
    if not math.isnan(geom.fromto[0]):
        geom.fromto = _stretched(np.reshape(geom.fromto, (2, 3)), size, length).ravel()
        geom.size = np.array(geom.size) * size
    elif geom.type in _ALONG_THE_AXES and geom.size[0] > 0:  # an infinite plane has size 0
        low, high = (_stretched(np.array(geom.pos) + side * geom.size, size, length) for side in (-1, 1))
        geom.pos, geom.size = (low + high) / 2, (high - low) / 2
    else:
        geom.pos, geom.size = _stretched(geom.pos, size, length), np.array(geom.size) * size


def _stretched(points: np.ndarray, size: float, length: float) -> np.ndarray:
    """Return where points of the template, shape (..., 3), belong on a can `size` times as wide and `length` [m] long.

    Across the axis they scale with the radius. Along the axis their distance from the nearer end of the can does, but
    so that what is inside stays in its half.
    """
    points = size * np.array(points)
    y = points[..., 1]
    inside = size * LENGTH / 2 - np.abs(y)
    inside = np.where(inside > 0, inside * min(1.0, length / (size * LENGTH)), inside)
    points[..., 1] = np.where(y == 0, 0.0, np.copysign(length / 2 - inside, y))
    return points


def _fit_mesh(element: mujoco.MjsMesh, place: pathlib.Path, size: float, length: float) -> None:
    """Stretch a mesh of the template, so that no file is needed; one that is not as mjbeer's keeps its proportions."""
    path = place / element.file
    if path.suffix == ".obj" and path.is_file() and (shape := _triangles(path, path.stat().st_mtime_ns)):
        vertices, places, faces = shape
        element.usertexcoord = places
        _reshape(element, (_stretched(vertices * element.scale, size, length), faces))
    else:
        element.scale = np.array(element.scale) * size  # if the file is missing, MuJoCo says so


@functools.lru_cache(maxsize=32)
def _triangles(path: pathlib.Path, _changed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """Return vertices, their places in a texture as one row, and faces of a file; None for one unlike mjbeer's.

    mjbeer's files have triangles, and as many places in a texture as vertices, or none.
    """
    rows = [line.split() for line in path.read_text().splitlines()]
    vertices, places, faces = ([row[1:] for row in rows if row[:1] == [kind]] for kind in ("v", "vt", "f"))
    corners = [each.split("/") for face in faces for each in face]
    alike = len(places) in (0, len(vertices)) and all(len(set(each)) == 1 for each in corners)
    if not alike or any(len(face) != 3 for face in faces):
        return None
    indices = np.array([int(first) - 1 for first, *_ in corners]).reshape(-1, 3)
    return np.array(vertices, float), np.array(places, float).ravel(), indices


def _reshape(element: mujoco.MjsMesh, shape: Mesh) -> None:
    """Replace the file of a template's mesh by a shape."""
    vertices, faces = shape
    element.scale, element.file, element.content_type = [1, 1, 1], "", ""
    element.uservert, element.userface = vertices.ravel(), faces.ravel()
    corners = vertices[faces]
    if np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6 < _LEAST_VOLUME:
        element.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL


def _hang(spec: mujoco.MjSpec, scene: Scene) -> None:
    """Put the bob with its arm, or the bar on the rim, where the scene has it."""
    offset, ball, arm = scene.load.offset, spec.geom("load"), spec.geom("load_arm")
    if arm is not None:
        arm.pos, arm.size = [0, arm.pos[1], -offset / 2], [arm.size[0], max(offset / 2, arm.size[0] / 100), 0]
    else:
        offset = min(offset, scene.can.radius - ball.size[0])  # a load on the rim is drawn just inside it
    if math.isnan(ball.fromto[0]):
        ball.pos = [0, ball.pos[1], -offset]
    else:
        ball.fromto = [*ball.fromto[:2], -offset, *ball.fromto[3:5], -offset]


def pour(spec: mujoco.MjSpec, scene: Scene, edges: int = EDGES) -> None:
    """Give the beer its fill, and put the foam on it, which gets thin or goes where there is no room or no beer."""
    radius, length, fill = scene.can.radius, scene.can.length, max(scene.load.fill or 0.0, _LEAST_FILL)
    thickness = min(FOAM, _FOAM_SHARE * 2 * fill, _FOAM_SHARE * 2 * (1 - fill))
    liquid, foam = spec.mesh("load"), spec.mesh("foam")
    shape = beer(fill, radius, length, edges)
    if len(liquid.usertexcoord):  # the texture covers the can's cross-section; multiples of 1/512 have few digits
        liquid.usertexcoord = (np.round(512 * (shape[0][:, [0, 2]] / (2 * radius) + 0.5)) / 512).ravel()
    _reshape(liquid, shape)
    if foam is not None and thickness >= _LEAST_FOAM:
        heights = 2 * fill - 1 + thickness * np.array([0, 0, 1, 1])
        across = np.sqrt((1 - heights) * (1 + heights)) * [-1, 1, 1, -1]
        _reshape(foam, _prism(radius * np.stack([across, heights], axis=1), length))
    else:
        for element in filter(None, (spec.geom("foam"), foam)):
            spec.delete(element)


def beer(fill: float, radius: float, length: float, edges: int = EDGES) -> Mesh:
    """Return the beer of a given `fill`, eq. (32), in a can of `radius` and `length` [m]: a prism along the axis."""
    beta = segment(fill).half_angle
    # The arc of a full can closes on itself, so that its last vertex would repeat the first.
    angles = np.linspace(-beta, beta, edges + 1)[: None if fill < 1 else -1]
    return _prism(radius * np.stack([np.sin(angles), -np.cos(angles)], axis=1), length)


def _prism(outline: np.ndarray, length: float) -> Mesh:
    """Return the prism of a `length` [m] on a convex outline in (x, z), counter-clockwise seen from -y.

    The near face and the side from the last point to the first, which is the beer's surface, look flat.
    """
    n = len(outline)
    front, back = (np.insert(outline, 1, y, axis=1) for y in (-length / 2, length / 2))
    vertices = np.concatenate([front, front, back, front[[n - 1, 0]], back[[n - 1, 0]]])
    fan = np.stack([np.zeros(n - 2, int), np.arange(1, n - 1), np.arange(2, n)], 1)
    sides, top = _strip(2 * n + np.arange(n), n + np.arange(n)), _strip(3 * n + np.array([2, 3]), 3 * n + np.arange(2))
    return vertices, np.concatenate([fan, 2 * n + fan[:, ::-1], sides, top])


def _strip(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the faces between two lines of as many vertices: first those with two corners on `one`, then the rest."""
    first = np.stack([one[:-1], one[1:], other[1:]], 1)
    return np.concatenate([first, np.stack([one[:-1], other[1:], other[:-1]], 1)])
