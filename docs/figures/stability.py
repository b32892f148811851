"""Draws the maps in docs/stability.md anew, from those that come with mjbeer: `python docs/figures/stability.py`."""

import pathlib

from mjbeer.studies.stability import stiff_maps

folder = pathlib.Path(__file__).parent
for name in stiff_maps.draw_all(stiff_maps.load(), folder):
    (folder / f"{name}.png").unlink()
