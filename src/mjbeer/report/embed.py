"""Files as texts that a page can hold, so that it needs no other file and fetches nothing."""

import base64
import pathlib

_KINDS = {".mp4": "video/mp4", ".png": "image/png", ".svg": "image/svg+xml"}
_VENDORED = pathlib.Path(__file__).with_name("vendored")
_SCRIPTS = ("vega", "vega-lite", "vega-embed")
_MAP = "//# sourceMappingURL="


def data_uri(path: pathlib.Path) -> str:
    """Return a video or a picture as a data: URI."""
    return f"data:{_KINDS[path.suffix]};base64,{base64.b64encode(path.read_bytes()).decode()}"


def plotting() -> str:
    """Return the JavaScript that draws Vega-Lite's plots, without the names of maps that a browser would look for."""
    texts = [(_VENDORED / f"{name}.min.js").read_text(encoding="utf-8") for name in _SCRIPTS]
    return "\n".join(text.partition(_MAP)[0] for text in texts)
