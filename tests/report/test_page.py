"""The page: it is whole, it needs nothing from elsewhere, and it says what the audit found."""

import itertools
import json
import pathlib
import re
import shlex
import shutil
from collections.abc import Generator

import pytest

from mjbeer import paper
from mjbeer.cli.app import main
from mjbeer.drawing.film import Take
from mjbeer.paper import stories
from mjbeer.paper.row import Misprint
from mjbeer.report import films, formulas, page
from mjbeer.report.embed import data_uri
from mjbeer.studies.benchmark import points as measured
from mjbeer.studies.benchmark.points import SHIPPED, Benchmark
from mjbeer.studies.stability import stiff_maps
from tests.support import pages, stubs
from tests.support.pages import Page

VOID_OF_NETWORK = ("data:", "#")
SECTIONS = ["races", "scenes", "precision", "stability", "misprints", "stories", "verdict", "machine"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Generator[pathlib.Path]:
    """The files of a report with two stories and a race."""
    folder = tmp_path_factory.mktemp("report")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(stories, "stories", pages.stories)
        pages.fill(folder)
        yield folder


@pytest.fixture(scope="module")
def text(folder: pathlib.Path) -> str:
    return page.html(folder, pages.validation(), quick=False, not_drawn="")


def test_nothing_comes_from_elsewhere(text: str) -> None:
    """Links that a reader may follow are the only addresses; the policy forbids the rest, whatever scripts would do."""
    read = Page.of(text)
    taken = [
        element.attributes[name]
        for element in read.elements
        for name in ("src", "poster")
        if name in element.attributes
    ]
    taken += [element.attributes["href"] for element in read.all("link", "image", "use")]
    assert len(taken) > 10
    assert all(each.startswith(VOID_OF_NETWORK) for each in taken)
    style = "".join(element.text for element in read.all("style"))
    assert "url(" not in style
    assert "@import" not in style
    (policy,) = (element.attributes["content"] for element in read.all("meta") if "http-equiv" in element.attributes)
    assert "default-src 'none'" in policy
    assert not re.search(r"\bhttps?:|\*", policy)
    assert "sourceMappingURL" not in text


def test_the_sections_are_in_order_and_their_headings_too(text: str) -> None:
    read = Page.of(text)
    assert [element.attributes["id"] for element in read.all("section")] == SECTIONS
    assert [element.attributes["href"] for element in read.all("a") if "#" in element.attributes["href"]] == [
        "#content",
        *(f"#{section}" for section in SECTIONS),
    ]
    levels = [int(element.name[1]) for element in read.all("h1", "h2", "h3", "h4")]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(after <= before + 1 for before, after in itertools.pairwise(levels))


def test_everything_has_a_name_of_its_own(text: str) -> None:
    read = Page.of(text)
    names = [element.attributes["id"] for element in read.elements if "id" in element.attributes]
    assert len(names) == len(set(names))
    assert all(element.attributes["alt"] for element in read.all("img"))
    assert all(element.attributes["aria-label"] for element in read.all("video"))
    assert read.all("html")[0].attributes["lang"] == "en"
    assert not any("autoplay" in element.attributes for element in read.all("video"))


def test_every_film_is_in_the_page_whole(folder: pathlib.Path, text: str) -> None:
    read = Page.of(text)
    names = [*films.RACES, *(name for name in films.FILMS if name not in films.RACES), "paper/told"]
    assert [element.attributes["src"] for element in read.all("source")] == [
        data_uri(folder / f"{name}.mp4") for name in names
    ]


def test_a_film_that_the_page_has_no_room_for_is_linked(folder: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page, "LIMIT", 1)
    read = Page.of(page.html(folder, pages.validation(), quick=False, not_drawn=""))
    assert len(read.all("source")) == len(films.FILMS)
    assert "paper/told.mp4" in [element.attributes["href"] for element in read.all("a")]


def test_a_wide_plot_without_a_film_takes_the_width_of_the_page(text: str) -> None:
    """Both plots are three times as wide as high, and the first has a film."""
    figures = [
        element.attributes for element in Page.of(text).all("figure") if "story-" in element.attributes.get("id", "")
    ]
    assert [(each["id"], each["class"]) for each in figures] == [("story-told", "story"), ("story-still", "story wide")]


def test_a_quick_page_has_no_films_of_stories_and_says_so(folder: pathlib.Path) -> None:
    text = page.html(folder, pages.validation(), quick=True, not_drawn="")
    assert len(Page.of(text).all("source")) == len(films.FILMS)
    assert "The films were left out of this quick report." in text
    assert "mjbeer report --quick" in re.sub("<[^>]*>", "", text)


def test_the_misprints_have_the_numbers_of_the_findings(text: str) -> None:
    read = Page.of(text)
    found = pages.validation().findings
    numbers = [float(element.attributes["value"]) for element in read.all("data")]
    assert numbers == [number for finding in found for number in (finding.printed, finding.right)]
    told = [element.text for element in read.all("data")]
    assert told[:4] == ["1.3 %", "1.7\u2009·\u200910\N{MINUS SIGN}9", "2.5 %", "3.4\u2009·\u200910\N{MINUS SIGN}9"]
    assert len(read.all("math")) >= 2 * len(found)


MISPRINTS = [row.misprint for row in paper.rows() if row.misprint]


def test_each_thing_that_is_wrong_has_its_kind_and_the_paper_s_words(text: str) -> None:
    read = Page.of(text)
    kinds = [element.text for element in read.all("span") if element.attributes.get("class") == "kind"]
    assert kinds == [f"{each.kind} of {each.of}" if each.of else each.kind for each in MISPRINTS]
    assert "consequence of (39)" in kinds
    quotes = [row.quote for row in paper.rows() if row.misprint and row.quote]
    assert [element.text for element in read.all("blockquote")] == [f"“{quote}”" for quote in quotes]
    assert "18 misprints,\n  4 consequences of another misprint, and 3 approximations" in text


@pytest.mark.parametrize("misprint", MISPRINTS, ids=lambda misprint: misprint.about)
def test_formulas_are_mathml_with_what_differs_marked_and_nothing_left_of_latex(misprint: Misprint) -> None:
    assert misprint.printed != misprint.right
    for latex in (misprint.printed, misprint.right):
        assert not re.search("[<|>]", latex)
        shown = re.sub("<[^>]*>", "", formulas.mathml(latex))
        assert not re.search(r"[\\{}_^]", shown)
    assert 'class="differs"' in formulas.mathml(misprint.right)


def test_letters_of_the_audit() -> None:
    assert formulas.letters("phi_0^2/8, (omega h)^4, sin(theta), alphabet") == "φ₀²/8, (ω h)⁴, sin(θ), alphabet"
    assert formulas.letters("u_ddot, phi_dot") == "u\N{COMBINING DIAERESIS}, φ\N{COMBINING DOT ABOVE}"


def test_numbers() -> None:
    assert [page.power(value) for value in (0.0, 0.01, 1e-12)] == ["0", "0.01", "10<sup>\N{MINUS SIGN}12</sup>"]
    assert [page.share(value) for value in (1.92, 0.0053)] == ["192 %", "0.53 %"]


def test_the_verdict_has_its_tables_and_what_failed(text: str) -> None:
    read = Page.of(text)
    (verdict,) = (element for element in read.all("p") if element.attributes.get("class", "").startswith("verdict"))
    assert verdict.text.startswith("1 of 2 checks and 25 of 25 rows of the audit passed")
    assert verdict.attributes["class"] == "verdict failed"
    cells = [element.text for element in read.all("td")]
    assert {"fine", "a <stub>", "φ₀²"} <= set(cells)
    assert [element.text for element in read.all("strong")] == ["FAILED:", "FAIL"]
    assert "a <stub>" not in text


def test_without_films_the_page_says_why(folder: pathlib.Path, tmp_path: pathlib.Path) -> None:
    folder = pathlib.Path(shutil.copytree(folder, tmp_path / "report", ignore=shutil.ignore_patterns("*.mp4")))
    text = page.html(folder, pages.validation(), quick=False, not_drawn="not drawn because of <a test>: install it")
    read = Page.of(text)
    assert not read.all("video")
    assert "They were not drawn because of <a test>: install it." in "".join(element.text for element in read.all("p"))


def test_the_plots_have_every_point_and_every_map(text: str) -> None:
    (data,) = (element.text for element in Page.of(text).all("script") if element.attributes.get("id") == "plots")
    plots = json.loads(data)
    benchmark, maps = Benchmark.load(SHIPPED), stiff_maps.load()
    points = [point for case in benchmark.cases for point in measured.drawn(benchmark.of(case))]
    told = plots["precision"]["data"]["values"]
    assert [record["time"] for record in told] == pytest.approx([1e3 * point.time for point in points], rel=1e-3)
    assert {
        record["tool"] for record in told if record["setting"].startswith(("DOP853", "GaussJackson", "mjbeer"))
    } == {"mjbeer"}
    assert "mjbeer to 1e-09" in {record["setting"] for record in told}
    for case in benchmark.cases:
        ours = measured.ours(benchmark.of(case))
        levels = [measured.cheapest(ours, level) for level in measured.LEVELS]
        marked = {
            (record["setting"], record["rolling"]) for record in told if record["cheapest"] and record["case"] == case
        }
        assert len(marked) == len({id(point) for point in levels if point})
    assert len(plots) == 1 + len(maps["maps"])


@pytest.mark.parametrize("name", films.COMMANDS)
def test_the_command_under_a_film_draws_that_film(
    name: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = stubs.draw(monkeypatch)
    assert main([*shlex.split(films.COMMANDS[name])[1:], "--output", str(tmp_path / "film.mp4")]) == 0
    (call,) = calls
    drawn, film = call["trajectory"], films.FILMS[name]
    assert isinstance(film, Take)
    wanted = film.trajectory()
    assert call["speed"] == film.speed
    assert drawn.scene == wanted.scene
    assert drawn.time[-1] == wanted.time[-1]
    # The command has degrees to four decimals; a motion carries that difference on.
    assert drawn.phi[0] == pytest.approx(wanted.phi[0], abs=1e-6)
    assert abs(drawn.phi[-1] - wanted.phi[-1]) < 1e-3
