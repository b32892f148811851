"""Plots as they were saved, and what is wrong with them: texts that clash, axes without a unit, letters spelled out."""

import itertools
import re

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.text import Text
from matplotlib.transforms import Bbox

SPELLED = re.compile(r"\b(phi|alpha|omega|mu|beta|delta|epsilon|tau|zeta)(?![a-z])|degrees?\b", re.IGNORECASE)
"""Letters of the formulas, with or without an index, and degrees."""
_HAS_UNIT = re.compile(r"\[[^\]]+\]|.+ [/×] .+|share|number of")
"""A unit in brackets, or the name of something without one: a ratio, a product, a share or a number of things."""
_SMALLEST = 8 / 0.85
"""Least size of a text [points]: the page shows a plot with at least 0.85 pixels a point, and letters of 8 pixels."""
_TOUCHING = 1.0
"""Overlap [pixels] of boxes that counts as touching: letters do not fill their boxes."""


def saved(monkeypatch: pytest.MonkeyPatch) -> list[Figure]:
    """Return a list to which every figure is added when it is saved."""
    figures: list[Figure] = []
    original = Figure.savefig

    def keep(figure: Figure, *args: object, **kwargs: object) -> None:
        if figure not in figures:
            figures.append(figure)
        original(figure, *args, **kwargs)

    monkeypatch.setattr(Figure, "savefig", keep)
    return figures


def faults(figure: Figure) -> list[str]:
    """Return a sentence for each fault of a figure that was saved, which has laid it out."""
    figure.set_dpi(100)  # with fewer, letters that are hinted to whole pixels are too wide
    boxes = _texts(figure)
    found = [f"{text!r} spells out a letter or a unit" for text, _ in boxes if SPELLED.search(text)]
    found += [
        f"{text.get_text()!r} is too small" for text in figure.findobj(Text) if float(text.get_fontsize()) < _SMALLEST
    ]
    whole = figure.bbox.padded(0.5)
    found += [
        f"{text!r} is cut off"
        for text, box in boxes
        if not (whole.contains(box.x0, box.y0) and whole.contains(box.x1, box.y1))
    ]
    found += [
        f"{text!r} and {other!r} overlap"
        for (text, box), (other, another) in itertools.combinations(boxes, 2)
        if _overlap(box, another)
    ]
    for axes in figure.axes:
        if axes.axison and axes.get_visible():
            found += _unnamed(axes, figure) + _covered(axes)
    return found


def _texts(figure: Figure) -> list[tuple[str, Bbox]]:
    """Return every text that is drawn, with its box [pixels]."""
    drawn: list[tuple[str, Bbox]] = []
    original = Text.draw
    canvas = FigureCanvasAgg(figure)

    def keep(text: Text, renderer: object, *args: object, **kwargs: object) -> None:
        if text.get_visible() and text.get_text().strip():
            drawn.append((text.get_text(), Text.get_window_extent(text, canvas.get_renderer())))
        original(text, renderer, *args, **kwargs)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Text, "draw", keep)
        figure.draw_without_rendering()
    return drawn


def _overlap(one: Bbox, other: Bbox) -> bool:
    common = Bbox.intersection(one, other)
    return common is not None and min(common.width, common.height) > _TOUCHING


def _unnamed(axes: Axes, figure: Figure) -> list[str]:
    """Return the axes without a label that has a unit; panels of the same range may share the label of one of them."""
    below = [other.get_xlabel() for other in figure.axes if other.get_xlim() == axes.get_xlim()]
    beside = [other.get_ylabel() for other in figure.axes if other.get_ylim() == axes.get_ylim()]
    words = any(re.search("[A-Za-z]", label.get_text()) for label in axes.get_xticklabels())
    labels = {
        "horizontal": "[words]" if words else axes.get_xlabel() or max(below),
        "vertical": axes.get_ylabel() or max(beside),
    }
    return [
        f"the {side} axis of {axes.get_title(loc='left')!r} has no unit: {label!r}"
        for side, label in labels.items()
        if not _HAS_UNIT.search(label)
    ]


def _covered(axes: Axes) -> list[str]:
    """Return the notes and legends that lie on a line or a point of the same axes."""
    boxes = [(text.get_text(), Text.get_window_extent(text)) for text in axes.texts if text.get_text()]
    boxes += [
        ("the legend", legend.get_window_extent()) for legend in axes.get_children() if isinstance(legend, Legend)
    ]
    paths = [line.get_transform().transform_path(line.get_path()) for line in axes.lines if len(line.get_xdata())]
    inside = [(name, box.padded(-_TOUCHING)) for name, box in boxes]
    return [
        f"{name!r} lies on a line"
        for name, box in inside
        if any(np.isfinite(path.vertices).any() and path.intersects_bbox(box, filled=False) for path in paths)
    ]
