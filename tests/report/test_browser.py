"""The page in a real browser: films play, plots tell what they show, nothing is fetched, and everyone can read it."""

from collections.abc import Generator
from dataclasses import dataclass, field

import pytest
from playwright.sync_api import Browser, Page

from mjbeer.report import films, page
from mjbeer.studies.benchmark import points as measured
from mjbeer.studies.benchmark.points import SHIPPED, Benchmark
from tests.support import browser, pages

pytestmark = [pytest.mark.slow, pytest.mark.browses]

PHONE, PROJECTOR = 360, 1600
"""Narrowest and widest screen [pixels]."""
LONGEST = slice(15, 19)
"""Those of the misprints that have the longest formulas, eqs. (39) to (49)."""
POINTS = "[data-plot=precision] g.mark-symbol.role-mark path"


@dataclass
class Visit:
    """The page as it is open in the browser, with all that it asked for and all that went wrong."""

    page: Page
    asked: list[str] = field(default_factory=list)
    said: list[str] = field(default_factory=list)

    def show(self, selector: str) -> None:
        """Scroll to an element, and wait for the plot in it, if it is one."""
        self.page.locator(selector).first.scroll_into_view_if_needed()
        if "data-plot" in selector:
            self.page.wait_for_selector(f"{selector}[data-drawn]")


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Where the page is, with films of a second, and with a few misprints: axe-core looks at every letter for long."""
    folder = tmp_path_factory.mktemp("report")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mjbeer.paper.stories.stories", pages.stories)
        pages.fill(folder, encoded=True)
        text = page.html(folder, pages.validation(LONGEST), quick=False, not_drawn="")
    (folder / "index.html").write_text(text)
    return (folder / "index.html").as_uri()


@pytest.fixture(scope="module")
def chromium() -> Generator[Browser]:
    with browser.chromium() as started:
        yield started


@pytest.fixture
def visit(chromium: Browser, address: str, request: pytest.FixtureRequest) -> Generator[Visit]:
    """The page, opened in a window of the width and the colours that a test asks for; at the end nothing was amiss."""
    width, colours = getattr(request, "param", (PROJECTOR, "light"))
    context = chromium.new_context(
        viewport={"width": width, "height": 900}, color_scheme=colours, reduced_motion="reduce"
    )
    context.set_default_timeout(600_000)  # only a guard: how long the machine takes is not tested
    visit = Visit(context.new_page())
    visit.page.on("request", lambda asked: visit.asked.append(asked.url))
    visit.page.on("console", lambda message: visit.said.append(message.text))
    visit.page.on("pageerror", lambda error: visit.said.append(str(error)))
    visit.page.goto(address)
    yield visit
    assert [each for each in visit.asked if not each.startswith("data:")] == [address]
    assert not visit.said
    context.close()


def test_every_film_plays(visit: Visit) -> None:
    count = visit.page.locator("video").count()
    assert count == len(films.FILMS) + 1  # with the story
    for place in range(count):
        film = visit.page.locator("video").nth(place)
        film.scroll_into_view_if_needed()
        assert film.evaluate("film => film.paused")
        film.evaluate("film => { film.muted = true; film.play().catch(() => {}); }")  # it may never say that it cannot
        visit.page.wait_for_function("film => film.currentTime > 0.2", arg=film.element_handle())
        assert film.evaluate("film => [film.videoWidth, film.duration]") == [pages.SIZE[0], pytest.approx(1, abs=0.1)]


@pytest.mark.parametrize("visit", [(PHONE, "light"), (PROJECTOR, "light")], indirect=True)
def test_a_point_tells_its_setting(visit: Visit) -> None:
    visit.show("[data-plot=precision]")
    assert visit.page.locator(POINTS).count() >= len(measured.drawn(Benchmark.load(SHIPPED).of("sliding")))
    visit.page.locator(POINTS).last.hover(force=True)
    tip = visit.page.locator("#vg-tooltip-element.visible")
    tip.wait_for()
    heads = [each.strip() for each in tip.locator("td.key").all_text_contents()]
    assert heads == [
        "tool", "integrator", "rolling", "setting", "error", "run time", "run time over the cheapest",
    ]  # fmt: skip
    assert all(tip.locator("td.value").all_text_contents())
    box = tip.bounding_box()
    assert box
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= visit.page.evaluate("innerWidth")


def test_the_controls_choose_what_is_shown(visit: Visit) -> None:
    visit.show("[data-plot=precision]")
    before = visit.page.locator(POINTS).count()
    visit.page.locator("input[value=heyoka]").uncheck()
    visit.page.wait_for_function(
        "([name, count]) => document.querySelectorAll(name).length < count", arg=[POINTS, before]
    )
    visit.page.locator("input[value=frozen]").check()
    assert visit.page.locator("[data-case=frozen]").is_visible()
    assert not visit.page.locator("[data-case=sliding]").is_visible()


def test_a_map_tells_its_outcome(visit: Visit) -> None:
    visit.show("[data-plot=stability-solref-0]")
    box = visit.page.locator("[data-plot=stability-solref-0] g.mark-rect path").first
    box.hover(force=True)
    tip = visit.page.locator("#vg-tooltip-element.visible")
    tip.wait_for()
    assert tip.locator("td.key").first.text_content() == "outcome"
    assert tip.locator("td.value").first.text_content() in (
        "unstable",
        "stable, error above 1 %",
        "stable and accurate",
    )


def test_a_plot_is_drawn_once(visit: Visit) -> None:
    visit.show("[data-plot=precision]")
    visit.page.evaluate(
        "window.changes = 0; new MutationObserver(all => { changes += all.length; }).observe("
        "document.querySelector('[data-plot=precision]'), {subtree: true, childList: true, attributes: true})"
    )
    visit.show("[data-plot=stability-solref-0]")
    visit.page.wait_for_timeout(300)  # what Vega draws, it draws at the next frames
    assert visit.page.evaluate("changes") == 0


def test_without_javascript_no_heading_stands_over_nothing(chromium: Browser, address: str) -> None:
    context = chromium.new_context(java_script_enabled=False)
    read = context.new_page()
    read.goto(address)
    assert not [heading for heading in read.locator("h4").all() if heading.is_visible()]
    assert not read.locator(".controls").is_visible()
    assert read.locator("#stability .absent").is_visible()
    context.close()


def test_the_keyboard_reaches_the_content_and_the_controls(visit: Visit) -> None:
    visit.page.keyboard.press("Tab")
    assert visit.page.evaluate("document.activeElement.className") == "skip"
    visit.page.keyboard.press("Enter")
    assert visit.page.evaluate("document.activeElement.id") == "content"
    visit.page.locator("input[value=sliding]").focus()
    visit.page.keyboard.press("ArrowRight")
    assert visit.page.locator("input[value=sliding-metal]").is_checked()


@pytest.mark.parametrize("visit", [(PHONE, "light"), (PROJECTOR, "light")], indirect=True)
def test_nothing_is_wider_than_the_screen(visit: Visit) -> None:
    visit.page.evaluate("for (const each of document.querySelectorAll('details')) each.open = true")
    for place in visit.page.locator(".chart").all():
        place.scroll_into_view_if_needed()
        place.locator("svg").first.wait_for()
    assert visit.page.evaluate("document.documentElement.scrollWidth") <= visit.page.evaluate("innerWidth")
    # What scrolls by itself may be wider inside.
    wide = visit.page.evaluate(
        "[...document.querySelectorAll('body *')].filter(each => !each.closest('.scroll, .formula, .skip, defs')"
        " && each.getBoundingClientRect().right > innerWidth + 1).map(each => each.outerHTML.slice(0, 80))"
    )
    assert not wide


@pytest.mark.parametrize("visit", [(PHONE, "light"), (PROJECTOR, "dark")], indirect=True)
def test_axe_finds_nothing(visit: Visit) -> None:
    """Among its rules are contrast, names of controls, the order of headings, and landmarks.

    Of the maps, whose boxes would take it a quarter of a minute, it sees the first.
    """
    for group in visit.page.locator("#verdict details").all():
        group.evaluate("group => { group.open = true; }")
    visit.show("[data-plot=precision]")
    visit.show("[data-plot=stability-solref-0]")
    visit.page.evaluate(browser.AXE.read_text())
    found = visit.page.evaluate("axe.run({exclude: ['.grid > :nth-child(n + 2)'], resultTypes: ['violations']})")
    rules = {rule["id"] for rule in found["passes"]}
    assert rules >= {"color-contrast", "heading-order", "image-alt", "label", "region"}
    wrong = [(rule["id"], node["html"][:120]) for rule in found["violations"] for node in rule["nodes"]]
    assert not wrong
