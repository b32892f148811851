"""The mesh files of the templates: `python -m tests.support.assets` writes them anew from mjbeer's own shapes."""

import numpy as np

from mjbeer.model import appearance, mesh, parts, templates
from mjbeer.theory.can import LENGTH, RADIUS

COARSE = 40
"""Number of edges of what is turned, which makes the files shorter."""
TURNED = ("can.obj", "label.obj", "lid.obj")
SHAPES = {
    **{file: part(RADIUS, LENGTH) for file, part in parts.PARTS.items() if file not in TURNED},
    "can.obj": parts.wall(RADIUS, LENGTH, COARSE),
    "label.obj": parts.label(RADIUS, LENGTH, COARSE),
    "lid.obj": parts.lid(RADIUS, LENGTH, COARSE),
    "beer_half.obj": mesh.beer(0.5, RADIUS, LENGTH),
    "foam_half.obj": mesh.layer(0.5, appearance.FOAM, RADIUS, LENGTH),
}
"""The shapes, by file."""


def text(file: str) -> str:
    """Return a file: vertices with six digits, places in a texture if it has them, and faces that count from 1."""
    vertices, faces = SHAPES[file]
    textured = file in appearance.TEXTURED
    corner = "{0}/{0}".format if textured else "{}".format
    return "".join(
        f"{' '.join(words)}\n"
        for words in (
            *(("v", *(f"{number:.6g}" for number in _zeroed(vertex))) for vertex in vertices),
            *(("vt", *(f"{number:.4g}" for number in place)) for place in mesh.texture(vertices, RADIUS) if textured),
            *(("f", *(corner(index) for index in face + 1)) for face in faces),
        )
    )


def _zeroed(vertex: np.ndarray) -> np.ndarray:
    """Return a vertex [m] without what is only rounding."""
    return np.where(np.abs(vertex) < np.finfo(float).eps, 0.0, vertex)


if __name__ == "__main__":
    for name in SHAPES:
        (templates.folder() / "assets" / name).write_text(text(name))
