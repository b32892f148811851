"""The cameras of films, by name."""

from typing import Literal

Camera = Literal["auto", "fixed", "pan", "close"]
"""fixed: still, and so far away that all of the motion is seen. pan: moves along the incline with the constant
acceleration that fits the motion best. close: goes along with the can. auto: fixed, or pan where the can would be
small."""
CAMERAS: tuple[Camera, ...] = ("auto", "fixed", "pan", "close")
