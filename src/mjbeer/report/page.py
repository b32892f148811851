"""The page of the report: everything in one file that opens from the disk, and that fetches nothing."""

import json
import math
import pathlib
import re
from collections import Counter
from dataclasses import dataclass
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup, escape

from mjbeer import paper
from mjbeer.paper import stories
from mjbeer.paper.row import Finding, Row
from mjbeer.report import precision, stability
from mjbeer.report.embed import data_uri, plotting
from mjbeer.report.films import COMMANDS, FILMS, RACES
from mjbeer.report.formulas import letters, mathml
from mjbeer.studies.benchmark.points import SHIPPED, Benchmark
from mjbeer.studies.rows import machine
from mjbeer.studies.stability import stiff_maps
from mjbeer.studies.validation.run import Validation

LIMIT = 25e6
"""Largest size of the page [bytes]; films of the paper that would exceed it stay beside it as files."""
_BASE64 = 4 / 3
"""Size of a file in a page over that on the disk."""
_SMALL = 1e-3
"""A smaller share is a power of ten and not a percentage."""
_WIDE = 2.0
"""Width over height from which a plot takes the width of the page."""
_BOX = re.compile(r'viewBox="\S+ \S+ (\S+) (\S+)"')
_FAILED = re.compile(r"\*\*(.+?)\*\*")


@dataclass(frozen=True)
class Shown:
    """A film or a plot as the page shows it."""

    name: str
    caption: str
    command: str
    video: str = ""
    """The film as a data: URI; empty if there is none."""
    picture: str = ""
    """The poster of the film, or the plot, as a data: URI; empty if there is none."""
    poster: str = ""
    """The poster of a story's film as a data: URI; empty if the film is not in the page."""
    beside: str = ""
    """Where the film is, relative to the page, if it is too large for it."""
    wide: bool = False
    """Whether the plot has several panels side by side, and no film below: it needs the width of the page."""


def html(folder: pathlib.Path, validation: Validation, quick: bool, not_drawn: str) -> str:
    """Return the page on the films and stories in a folder; `not_drawn` says why films are missing, or is empty."""
    environment = Environment(
        loader=PackageLoader("mjbeer.report", "web"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"mathml": mathml, "power": power, "share": share, "marked": _marked}
    benchmark, maps = Benchmark.load(SHIPPED), stiff_maps.load()
    films = {name: _film(folder, name) for name in FILMS}
    groups = stability.groups(maps["maps"])
    plots = {"precision": precision.plot(benchmark)}
    plots |= {f"{group['name']}-{place}": each["plot"] for group in groups for place, each in enumerate(group["plots"])}
    return environment.get_template("page.html").render(
        sketch=data_uri(folder / "paper" / "letters.svg"),
        races=[films.pop(name) for name in RACES],
        films=list(films.values()),
        not_drawn=not_drawn,
        tools=precision.TOOLS,
        cases=precision.cases(benchmark),
        benchmark=benchmark,
        maps=maps,
        groups=groups,
        misprints=(misprints := _misprints(validation)),
        kinds=Counter(row.misprint.kind for _, row in misprints if row.misprint),
        quoted=[row for row in paper.rows() if row.quote and not row.misprint],
        findings=len(validation.findings),
        stories=_stories(folder, quick, LIMIT - sum(_size(film) for film in films.values())),
        sentence=validation.sentence,
        failures=validation.failures,
        passed=validation.passed,
        tables=validation.tables(document=True),
        machine=machine(),
        quick=quick,
        plots=Markup(_json(plots)),
        plotting=Markup(plotting()),
    )


def power(value: float) -> Markup:
    """Return a number in two digits as HTML: 0.0021 as it is, and smaller ones as a power of ten."""
    if value == 0 or 1e-3 <= abs(value) < 1e4:
        return escape(f"{value:.2g}")
    digits, exponent = f"{value:.1e}".split("e")
    raised = Markup("10<sup>{}</sup>").format(str(int(exponent)).replace("-", "\N{MINUS SIGN}"))
    if math.isclose(value, float(f"1e{exponent}"), rel_tol=1e-9):
        return raised
    return Markup("{}&thinsp;·&thinsp;{}").format(digits, raised)


def share(value: float) -> Markup:
    """Return a share of the largest term as HTML: a percentage in two digits, three from 100 on, or a power of ten."""
    if abs(value) < _SMALL:
        return power(value)
    return escape(f"{100 * value:.3g} %" if abs(value) >= 1 else f"{100 * value:.2g} %")


def _film(folder: pathlib.Path, name: str) -> Shown:
    """Return a film of the scenes with its poster, or without both if it was not drawn."""
    video, poster = folder / f"{name}.mp4", folder / f"{name}-still.png"
    command = f"{COMMANDS[name]} --output {name}.mp4" if name in COMMANDS else "mjbeer report"
    if not video.exists():
        return Shown(name, FILMS[name].caption, command)
    return Shown(name, FILMS[name].caption, command, data_uri(video), data_uri(poster))


def _stories(folder: pathlib.Path, quick: bool, room: float) -> list[Shown]:
    """Return the paper's stories: each film goes into the page as long as there is `room` [bytes] for it.

    A `quick` report has no films of stories; an earlier one may have left some.
    """
    command = "mjbeer paper" if quick else "mjbeer paper --films"
    shown = []
    for story in stories.stories():
        plot, video = (folder / "paper" / f"{story.name}.{kind}" for kind in ("svg", "mp4"))
        picture = data_uri(plot)
        room -= len(picture)
        film, poster, beside = "", "", ""
        if story.film is not None and not quick and video.exists():
            fits = _BASE64 * video.stat().st_size < room
            if fits:
                film, poster = data_uri(video), data_uri(video.with_name(f"{story.name}-still.png"))
            else:
                beside = f"paper/{story.name}.mp4"
            room -= len(film) + len(poster)
        wide = story.film is None and _aspect(plot) > _WIDE
        shown.append(Shown(story.name, story.caption, command, film, picture, poster, beside, wide))
    return shown


def _aspect(plot: pathlib.Path) -> float:
    """Return the width of a plot (SVG) over its height; 1 if it does not say."""
    box = _BOX.search(plot.read_text(encoding="utf-8"))
    return float(box[1]) / float(box[2]) if box else 1.0


def _size(film: Shown) -> int:
    return len(film.video) + len(film.picture)


def _misprints(validation: Validation) -> list[tuple[Finding, Row]]:
    """Return the findings of what is wrong in the paper, each with its row."""
    rows = {(row.equation, row.quantity): row for row in paper.rows() if row.misprint}
    named = [((finding.equation, finding.quantity), finding) for finding in validation.findings]
    return [(finding, rows[name]) for name, finding in named if name in rows]


def _marked(cell: str) -> Markup:
    """Return a text of a table as HTML, with Greek letters; what stands between two pairs of asterisks is strong."""
    return Markup(_FAILED.sub(r"<strong>\1</strong>", str(escape(letters(cell)))))


def _json(content: Any) -> str:
    """Return JSON that may stand in a script element."""
    return json.dumps(content, separators=(",", ":"), ensure_ascii=False).replace("<", "\\u003c")
