"""The page of two racing cans: its physics is that of exact theory, and it needs nothing but a browser."""

import html
import json
import math
import pathlib
import re
import shutil
import subprocess
import urllib.parse
from functools import partial
from typing import Any

import numpy as np
import pytest
import quickjs

from mjbeer import Can, Scene, exact, frozen, liquid, read_track, sliding
from mjbeer.theory import can
from mjbeer.theory.liquid import LIQUIDS
from mjbeer.theory.scene import GRAVITY
from mjbeer.tracks.track import _COLUMNS, _COMMA, _GROUPED, _POINT, _TITLE
from tests.support.tables import TABLES, THOUSANDS, UNCLEAR

TEXT = pathlib.Path(__file__).parents[1].joinpath("docs", "live.html").read_text(encoding="utf-8")
PHYSICS = TEXT.split('<script id="physics">')[1].split("</script>")[0]
TRACK = "const DEGREE = Math.PI / 180;" + TEXT.split("// A track:")[1].partition("\n")[2].split("function take(")[0]
SYNTHETIC = pathlib.Path(__file__).parents[1].joinpath("examples", "synthetic_track.csv").read_text(encoding="utf-8")
INSIDE = ["no friction", "ice", *LIQUIDS]
LECTURE = pathlib.Path(__file__).parents[1].joinpath("docs", "lecture.md").read_text(encoding="utf-8")
ICE = 917.0  # its density [kg/m^3], as in the film that the lecture shows
# Of phi and of the distance over the radius [rad]: 8e-10 was measured, and 6e-6 if no step ends at the corners of |w|.
AGREES = 1e-8


def script(code: str, given: str = PHYSICS) -> Any:
    """What an expression is after a script has run."""
    return json.loads(quickjs.Context().eval(f"{given}\nJSON.stringify({code})"))


def scene_of(setting: dict[str, Any]) -> Scene:
    frozen_water = partial(frozen, density=ICE)
    make = {"no friction": sliding, "ice": frozen_water}.get(setting["inside"], partial(liquid, setting["inside"]))
    return make(setting["incline"], setting["fill"], Can.sheet_metal() if setting["metal"] else Can.massless())


def require_agreement(cases: list[tuple[dict[str, Any], list[float]]], within: float = AGREES) -> None:
    motions = script(f"{json.dumps(cases)}.map(([setting, times]) => motion(setting, times))")
    for (setting, times), found in zip(cases, motions, strict=True):
        truth = exact(scene_of(setting), times, setting["phi0"])
        assert np.abs(found["phi"] - truth.phi).max() < within, setting
        assert np.abs(found["distance"] - truth.distance).max() < within * can.RADIUS, setting
        for force in ("normal", "friction"):  # the rates, up to 1000 rad/s, count squared
            assert np.abs(found[force] - getattr(truth.forces, force)).max() < 1e3 * within, setting


def random_cases(count: int) -> list[tuple[dict[str, Any], list[float]]]:
    """Settings of all that can be inside, with one time or more, not evenly spaced."""
    random, cases = np.random.default_rng(20261123), []
    for k in range(count):
        incline, fill = math.radians(random.uniform(0, 30)) * (k % 10 > 0), random.uniform(0.05, 1.0)
        setting: dict[str, Any] = {"incline": incline, "fill": fill}
        setting |= {"inside": INSIDE[k % 7], "metal": k % 2 == 0, "phi0": random.uniform(-math.pi, math.pi)}
        cases.append((setting, np.sort(random.uniform(0, random.uniform(0.2, 3), random.integers(1, 20))).tolist()))
    return cases


@pytest.mark.slow
@pytest.mark.parametrize("count", [14, pytest.param(200, marks=pytest.mark.costly)])
def test_its_motions_are_those_of_exact_theory(count: int) -> None:
    require_agreement(random_cases(count))


@pytest.mark.slow
@pytest.mark.parametrize("inside", ["no friction", "ice"])
def test_so_they_are_beside_a_separatrix(inside: str) -> None:
    """Down to 1e-4 rad, nearer than anybody can let go: there an error grows 1e5 times."""
    setting = {"incline": 0.1, "fill": 0.4, "inside": inside, "metal": True}
    ends = scene_of(setting).separatrix()
    starts = [end + way * 10.0**-power for end in ends for way in (1, -1) for power in (2, 3, 4)]
    require_agreement([({**setting, "phi0": start}, [0.3, 1.0, 3.0]) for start in starts], 1e-7)


def test_balanced_and_full_cans_are_those_of_theory() -> None:
    level = {"incline": 0.0, "fill": 0.5, "metal": True, "phi0": math.pi}
    steep = {"incline": 0.2, "fill": 0.5, "inside": "no friction", "metal": False, "phi0": math.pi}
    full = {"incline": 0.2, "fill": 1, "metal": True, "phi0": 1.0}
    cases = [steep, *({**level, "inside": each} for each in INSIDE), *({**full, "inside": each} for each in INSIDE[:2])]
    require_agreement([(setting, [0.0, 2.0]) for setting in cases])


def test_its_constants_are_those_of_theory() -> None:
    found = script("[LIQUIDS, RADIUS, LENGTH, SHEET, GRAVITY, BEER]")
    assert found[0] == {name: each._asdict() for name, each in LIQUIDS.items()}
    assert found[1:] == [can.RADIUS, can.LENGTH, can.THICKNESS * can.ALUMINIUM, GRAVITY, can.BEER]


@pytest.mark.parametrize(("can", "inside"), [("a", "honey"), ("b", "ice")])
def test_honey_and_ice_take_the_times_that_the_lecture_has(can: str, inside: str) -> None:
    """By the link that the page itself offers: its cans are full to 75 %, and it shows them over one metre."""
    link = re.search(r'href="#([^"]*)">Honey and ice<', TEXT)
    told = re.search(rf"{inside} ([\d.]+) s", LECTURE)
    assert link
    assert told
    given = dict(urllib.parse.parse_qsl(html.unescape(link[1])))
    assert given[f"{can}-inside"] == inside
    setting: dict[str, Any] = {"inside": inside, "metal": True, "fill": float(given[f"{can}-fill"]) / 100}
    setting |= {"incline": math.radians(float(given["incline"])), "phi0": math.radians(float(given[f"{can}-phi0"]))}
    half_a_digit = 0.5 * 10.0 ** -len(told[1].partition(".")[2])
    around = [float(told[1]) - half_a_digit, float(told[1]) + half_a_digit]
    before, after = script(f"motion({json.dumps(setting)}, {around}).distance")
    assert before < 1 < after


@pytest.mark.parametrize(
    "wrong", [{"inside": "tea"}, {"inside": "water", "fill": 1}, {"fill": 0}, {"phi0": None}, {"times": [-1]}]
)
def test_what_is_not_allowed_is_refused(wrong: dict[str, Any]) -> None:
    given = {"incline": 0.1, "fill": 0.5, "inside": "ice", "metal": True, "phi0": 1, "times": [1]} | wrong
    with pytest.raises(quickjs.JSException, match="RangeError"):
        script(f"motion({json.dumps(given)}, {given['times']})")


def test_it_is_one_small_file_that_asks_for_nothing() -> None:
    assert len(TEXT.encode()) <= 60_000
    assert "default-src 'none'" in TEXT


def test_a_track_is_read_in_its_units_and_with_decimal_commas() -> None:
    table = "Time (ms);note;along [cm];phi [°]\r\n0;;5,0;90\r\n500;;7,5;45\r\n"
    found = script(f"readTrack({json.dumps(table)})", TRACK)
    assert found["distance"] == [[0, 0], [0.5, pytest.approx(0.025)]]
    assert found["phi"] == [[0, 90], [0.5, 45]]


@pytest.mark.parametrize(
    ("table", "sentence"),
    [
        ("", "the line above its numbers must name time, and x or phi; it has nothing"),
        ("time,z\n0,1\n", "the line above its numbers must name time, and x or phi; it has “time”, “z”"),
        ("time,along\n0,0\n1,two\n", "line 3, column 2 has “two”, where a number must be"),
        ("time,along,x\n0,0,1\n", "“along” and “x” mean the same"),
        ("time,along [ft]\n0,0\n1,2\n", "the unit of “along [ft]” must be one of m, cm, mm"),
        ("t,x,y\n0,0,0\n1,1,0.1\n2,2,0\n", "x and y are 47 mm off a straight line"),
        ("t\tphi\n1\t0\n\n1\t2\n", "the time in line 4 must be 0 or more, and after that of the line before"),
    ],
)
def test_a_bad_track_gets_a_sentence(table: str, sentence: str) -> None:
    with pytest.raises(quickjs.JSException, match=re.escape(sentence)):
        script(f"readTrack({json.dumps(table)})", TRACK)


@pytest.mark.parametrize("text", [*TABLES.values(), *(text for text, _ in THOUSANDS.values()), SYNTHETIC])
def test_it_reads_a_track_as_read_track_does(text: str, tmp_path: pathlib.Path) -> None:
    (path := tmp_path / "can.txt").write_text(text, encoding="utf-8")
    track = read_track(path)
    found = np.array(script(f"readTrack({json.dumps(text)})", TRACK)["distance"])
    assert found[:, 0] == pytest.approx(track.time, rel=1e-12)
    assert found[:, 1] == pytest.approx(track.along - track.along[0], abs=1e-12)


@pytest.mark.parametrize(("place", "text"), [(each.split(":")[0], text) for each, text in UNCLEAR.items()])
def test_it_refuses_where_read_track_does(place: str, text: str) -> None:
    line, column = place.split(", ")
    with pytest.raises(quickjs.JSException, match=rf"{line}(, {column})? has"):
        script(f"readTrack({json.dumps(text)})", TRACK)


def test_its_names_and_units_are_those_of_read_track() -> None:
    found = script("COLUMNS", TRACK)
    assert {name: (units, usual) for name, (units, usual) in found.items()} == {name: _COLUMNS[name] for name in found}
    assert script("[TITLE, POINT, COMMA, GROUPED].map(each => each.source)", TRACK) == [
        f"^{_TITLE.pattern}",
        *(f"^{form.pattern}$" for form in (_POINT, _COMMA, _GROUPED)),
    ]


# A headless browser may draw no frame: so each is asked for.
RACE = """<script>
function slide(id, to) { $(id).value = to; $(id).dispatchEvent(new Event("input", {bubbles: true})); }
slide("incline-slider", 7.1); slide("a-fill-slider", 60); change("a-inside", "water");
guesses[1].click(); $("go").click();
for (let now = last; running; now += 16) frame(now);
</script></body>"""


@pytest.mark.slow
def test_a_browser_races_and_says_who_won(tmp_path: pathlib.Path) -> None:
    if not (chromium := shutil.which("chromium") or shutil.which("google-chrome")):
        pytest.skip("no Chromium: `apt-get install chromium` brings one")
    (page := tmp_path / "live.html").write_text(TEXT.replace("</body>", RACE), encoding="utf-8")
    command = [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom", page.as_uri()]
    shown = subprocess.run(command, capture_output=True, text=True, check=True, timeout=120).stdout
    verdict = shown.split('id="verdict"')[1].split(">", 1)[1].split("</p>")[0]
    time = re.match(r"<strong>Can A \(water\) wins</strong> after ([\d.]+) s\.", verdict)
    assert time, verdict
    assert verdict.endswith("Your guess was can B.")
    around = [float(time[1]) - 6e-4, float(time[1]) + 6e-4]  # it is told to a thousandth
    run = exact(liquid("water", math.radians(7.1), 0.6, Can.sheet_metal()), around, math.radians(30))
    assert run.distance[0] < 1 < run.distance[1]
    assert "as one lump is an order of magnitude only" in shown.split('id="limits"')[1]
