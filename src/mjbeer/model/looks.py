"""The looks of a scene: geoms, meshes and cameras, which are included in the bodies of its mechanics and fit its sizes.

Across the can's axis, the y axis, everything grows with the radius, and along it with the can's length.
"""

import functools
import math
import pathlib
import xml.etree.ElementTree as ET

import mujoco
import numpy as np

from mjbeer.exceptions import TemplateError
from mjbeer.model import mjcf_file
from mjbeer.theory.can import LENGTH, RADIUS, Can, segment
from mjbeer.theory.scene import Scene
from mjbeer.theory.standing import Standing

INCLUDES = {
    "sliding": {"incline": ("board",), "can": ("can",), "load": ("beer",)},
    "frozen": {"incline": ("board",), "can": ("can",), "load": ("ice",)},
    "pendulum": {"incline": ("board",), "can": ("wheel", "spokes"), "load": ("bob",)},
    "hoop": {"incline": ("board",), "can": ("wheel",), "load": ("bar",)},
    "standing": {"can": ("upright",), "liquid": ("column",), "slosh1": ("top",)},
}
"""What is included in each body, by the name of what is seen; a load that is no body of its own is in the can."""
_NEEDED = {"camera": ("side", "quarter", "overview"), "mesh": ("can", "load"), "material": ("grid", "planks")}
_ROLLING, _UPRIGHT = ("load", "board", "wall"), ("can_wall", "can_end")
"""The elements that mjbeer addresses by name: in all looks, and geoms of a can that rolls, and of one that stands."""
TURNING = ("can_mark", "can_spot", "can_tab", "can_mouth", "can_spokes")
"""The geoms that show how far the can has turned."""
WALL = 0.06
"""Thickness of the drawn wall of the can, in radii. It lies outside the radius, so that the beer fills the inside."""
FOAM = 0.025
"""Largest thickness of the foam, in radii."""
EDGES = 256
"""Number of edges around the arc of the beer. The error of the polygon falls as its square; with 256 edges mass,
centroid and inertia are within 6e-4 for every fill up to 0.95."""

Mesh = tuple[np.ndarray, np.ndarray]
"""Vertices (n, 3) [m] and faces (k, 3), closed and oriented outwards. Where two surfaces meet at an edge that is to
look sharp, each has vertices of its own."""


def name(scene: Scene | Standing) -> str:
    """Return the name of a can's looks; a load without a fill is drawn as a ball."""
    if isinstance(scene, Standing):
        return "standing"
    filled, empty = ("sliding", "pendulum") if scene.attachment == "sliding" else ("frozen", "hoop")
    return empty if scene.load.fill is None else filled


def to_spec(root: ET.Element, path: pathlib.Path, can: Scene | Standing, visuals: bool) -> mujoco.MjSpec:
    """Return the specification in the tree of the mechanics file at a `path`, with the looks of a can if asked for."""
    if not visuals:
        return mjcf_file.to_spec(root, path)
    folder = path.parents[1]
    include_looks(root, name(can))
    spec = mjcf_file.to_spec(root, path)
    geoms = (*_UPRIGHT, *beer_column(can)) if isinstance(can, Standing) else _ROLLING
    for kind, names in {**_NEEDED, "geom": geoms}.items():
        for each in names:
            if getattr(spec, kind)(each) is None:
                raise TemplateError(f"{folder / 'looks'} has no {kind} named {each!r}, which mjbeer uses; restore it")
    _fit_sizes(spec, can.can, folder / "assets")
    if isinstance(can, Standing):
        _fit_to_standing(spec, can)
    else:
        _fit_to_scene(spec, can)
    return spec


def include_looks(root: ET.Element, what: str) -> None:
    """Include the looks of INCLUDES in the bodies of a mechanics file; its own geoms are then in group 3.

    A geom without a name, which shows where the load is in a file without looks, goes.
    """
    for body in root.iter("body"):
        for geom in body.findall("geom"):
            if geom.get("name") is None:
                body.remove(geom)
    for geom in root.iter("geom"):
        geom.attrib |= {"group": "3", "class": "main"}
    root.insert(0, ET.Element("include", file="looks/world.xml"))
    bodies = {body.get("name", ""): body for body in root.iter("body")}
    bodies.setdefault("load", bodies["can"])
    for body, files in INCLUDES[what].items():
        if (parent := bodies.get(body)) is None:  # as "slosh1" of a can without modes
            continue
        parent.set("childclass", "visual")
        place = next((place for place, each in enumerate(parent) if each.tag == "body"), len(parent))
        parent[place:place] = [ET.Element("include", file=f"looks/{file}.xml") for file in files]
    if what == "standing":
        ET.SubElement(ET.SubElement(root, "worldbody"), "include", file="looks/floor.xml")
    else:  # cameras are level, in a frame that turns back by the incline
        angle = float(bodies["incline"].get("euler", "0 0 0").split()[1])
        frame = ET.SubElement(bodies["can"], "frame", euler=f"0 {0 - angle:.17g} 0")
        ET.SubElement(frame, "include", file="looks/cameras.xml")


def _fit_to_scene(spec: mujoco.MjSpec, scene: Scene) -> None:
    """Draw the load of a scene, and nothing that turns with a can that has no joint."""
    if scene.attachment == "sliding" and spec.joint("phi") is not None:
        for geom in filter(None, map(spec.geom, TURNING)):
            spec.delete(geom)
    draw_load = _place_point_load if scene.load.fill is None else shape_beer
    draw_load(spec, scene)
    drawn = {geom.meshname for geom in spec.geoms}
    for mesh in spec.meshes:
        if mesh.name not in drawn:
            spec.delete(mesh)


def _fit_to_standing(spec: mujoco.MjSpec, standing: Standing) -> None:
    """Fit what is drawn to a standing can: a column of beer under a cylinder that tilts with the body "slosh1"."""
    for each in _UPRIGHT:
        spec.geom(each).pos = [0, 0, standing.can.length / 2]
    for each, (low, high, radius) in beer_column(standing).items():
        spec.geom(each).pos = [0, 0, (low + high) / 2]
        spec.geom(each).size = [radius, (high - low) / 2, 0]


def beer_column(standing: Standing) -> dict[str, tuple[float, float, float]]:
    """Return from where to where the geoms reach that draw the beer, along the axes of their bodies, and radii [m].

    What tilts turns about its pivot, and so remains in the can if it is in a ball around it that is: its upper face is
    narrower than the can. Where there is no such face, as in a nearly full can, the column is all that is seen.
    """
    height, radius, length = standing.height, standing.can.radius, standing.can.length
    if standing.moving_modes == 0:
        return {"beer": (0.0, height, radius)}
    pivot, thickness = standing.pivots(1)[0], min(0.2 * radius, height / 4)
    top, ball, dot = height - pivot, min(radius, pivot, length - pivot), 1e-4 * radius
    depth = max(top, thickness - top)  # of its lower face below the pivot
    if ball <= depth:
        return {"beer": (0.0, height, radius), "beer_top": (-dot, dot, dot)}
    return {"beer": (0.0, height - thickness, radius), "beer_top": (-depth, top, math.sqrt(ball**2 - depth**2))}


def _fit_sizes(spec: mujoco.MjSpec, can: Can, assets: pathlib.Path) -> None:
    """Fit what is drawn to the sizes of a can."""
    size = can.radius / RADIUS
    stretch = np.array([size, can.length / LENGTH, size])
    for geom in spec.geoms:
        if geom.group == 2:  # of the geoms that are only drawn
            geom.pos, geom.fromto = geom.pos * stretch, geom.fromto * np.tile(stretch, 2)
            geom.size = geom.size * (stretch if geom.type == mujoco.mjtGeom.mjGEOM_BOX else size)
    for camera in spec.cameras:  # as many radii from the can's near end
        camera.pos = size * camera.pos - [0, (can.length - size * LENGTH) / 2, 0]
    spec.material("grid").texrepeat /= size
    spec.stat.extent *= size
    spec.stat.center *= size
    for mesh in spec.meshes:
        path = assets / mesh.file
        try:
            content = path.read_bytes()
        except OSError as error:
            raise TemplateError(f"{path} is no mesh that can be read: {error}") from error
        vertices, faces, mesh.usertexcoord = _shape(path, content)
        _reshape(mesh, (vertices * mesh.scale * stretch, faces))
    spec.meshdir = ""


@functools.lru_cache(maxsize=32)
def _shape(path: pathlib.Path, content: bytes) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return vertices, faces, and places in a texture as one row, of a mesh, as MuJoCo reads a file of this content."""
    spec = mujoco.MjSpec()
    spec.assets = {path.name: content}
    spec.add_mesh(name="mesh", file=path.name, inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL)
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="mesh")
    try:
        model, turned = spec.compile(), np.zeros(9)
    except ValueError as error:
        raise TemplateError(f"{path} is no mesh that MuJoCo can read: {error}") from error
    mujoco.mju_quat2Mat(turned, model.mesh_quat[0])  # MuJoCo keeps it along its principal axes
    vertices = model.mesh_vert @ turned.reshape(3, 3).T + model.mesh_pos[0]
    return vertices, model.mesh_face.copy(), model.mesh_texcoord.astype(float).ravel()


def _reshape(element: mujoco.MjsMesh, shape: Mesh) -> None:
    """Replace the file of a mesh by a shape."""
    vertices, faces = shape
    element.scale, element.file, element.content_type = [1, 1, 1], "", ""
    element.uservert, element.userface = vertices.ravel(), faces.ravel()


def _place_point_load(spec: mujoco.MjSpec, scene: Scene) -> None:
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


def shape_beer(spec: mujoco.MjSpec, scene: Scene, edges: int = EDGES) -> None:
    """Give the beer its fill, and put the foam on it, which gets thin or goes where there is no room or no beer."""
    radius, length, fill = scene.can.radius, scene.can.length, max(scene.load.fill or 0.0, 1e-6)  # a mesh is not flat
    thickness = min(FOAM, fill / 2, (1 - fill) / 2)  # a quarter of the beer's depth, and of the room above it
    liquid, foam = spec.mesh("load"), spec.mesh("foam")
    shape = beer(fill, radius, length, edges)
    if len(liquid.usertexcoord):  # the texture covers the can's cross-section; multiples of 1/512 have few digits
        liquid.usertexcoord = (np.round(512 * (shape[0][:, [0, 2]] / (2 * radius) + 0.5)) / 512).ravel()
    _reshape(liquid, shape)
    if foam is not None and thickness >= 1e-4:  # what is thinner is not seen
        heights = 2 * fill - 1 + thickness * np.array([0, 0, 1, 1])
        across = np.sqrt((1 - heights) * (1 + heights)) * [-1, 1, 1, -1]
        _reshape(foam, _prism(radius * np.stack([across, heights], axis=1), length))
    elif (drawn := spec.geom("foam")) is not None:
        spec.delete(drawn)


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
