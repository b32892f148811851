"""The paper's stories: their plots, films and text, as `mjbeer paper` writes them."""

import math
import os
import pathlib

import numpy as np
import pytest

from mjbeer import exact
from mjbeer.cli.app import main
from mjbeer.drawing import opengl
from mjbeer.paper import stories
from mjbeer.paper.story_plots import footnote_8_as_printed
from mjbeer.paper.witness import footnote_scene
from tests.support import stubs

pytestmark = pytest.mark.slow

STORIES = {story.name: story for story in stories.STORIES}


@pytest.mark.costly
@pytest.mark.parametrize("name", STORIES)
def test_a_plot_is_drawn_and_small(name: str, tmp_path: pathlib.Path) -> None:
    STORIES[name].plot(tmp_path / name)
    assert os.listdir(tmp_path) == [f"{name}.svg"]
    assert (tmp_path / f"{name}.svg").stat().st_size < 150_000


def test_footnote_8_as_printed_is_another_motion() -> None:
    times = np.linspace(0, 3, 301)
    truth = exact(footnote_scene(), times, 0.0).phi
    printed = footnote_8_as_printed(footnote_scene(), times, 0.0)
    assert np.abs(printed - truth).max() > math.radians(4)


@pytest.mark.parametrize(
    ("options", "problem"), [([], None), (["--films"], None), (["--films"], "no OpenGL")]
)
def test_the_command(
    options: list[str],
    problem: str | None,
    tmp_path: pathlib.Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture,
) -> None:
    """Films that cannot be drawn are named."""
    stubs.draw(monkeypatch)
    monkeypatch.setattr(opengl, "problem", lambda: problem)

    status = main(["paper", *options, "--output", str(tmp_path)])

    assert status == 0
    text = (tmp_path / "stories.md").read_text()
    err = capsys.readouterr().err
    filmed = bool(options) and not problem
    names = {name for name in os.listdir(tmp_path) if not name.startswith(".")}
    assert names == {"letters.svg", "told.svg", "stories.md"} | ({"told.mp4"} if filmed else set())
    for line in ("## told", "![told](told.svg)", "A stub's story."):
        assert line in text
    assert ("[Film](told.mp4)" in text) == filmed
    missing = opengl.missing_films_message(["told.mp4"])
    assert (f"Films: {missing}\n" in text) == bool(problem)
    assert (missing in err) == bool(problem)
    assert f"the stories are in {tmp_path / 'stories.md'}\n" in err
