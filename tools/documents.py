"""Writes what a program can write in the documents anew: `make tables`.

It stands between `<!-- made: NAME -->` and `<!-- end -->`, and `MADE` has what makes it.
`docs/stability.json` has the counts of a stability study: it is the totals.json that
`mjbeer stability` writes.
"""

import json
import math
import pathlib
import re
import sys
import textwrap
import warnings
from collections import Counter
from collections.abc import Callable, Sequence

import numpy as np

from mjbeer import LiquidWarning, liquid, paper
from mjbeer.output.terminal import Table
from mjbeer.paper.claim import APPROXIMATION, CONSEQUENCE, MISPRINT
from mjbeer.studies import contact_creep, polygon, predictions, stored_tables
from mjbeer.studies.benchmark import benchmark_tables, work_precision
from mjbeer.studies.benchmark.benchmark_tables import RK4
from mjbeer.studies.benchmark.other_tools import (
    COMPILED_DOP853,
    COMPILED_ODEINT,
    HEYOKA,
    ODEINT,
)
from mjbeer.studies.benchmark.points import SHIPPED, Benchmark, two_digits
from mjbeer.studies.engines import engine_plot, engine_tables, findings
from mjbeer.studies.engines.results import Results
from mjbeer.studies.stability import stability_maps, stability_study
from mjbeer.studies.stability.judge import (
    NOBODY,
    RIGHT,
    SERIES,
    THEORY,
    UNDETECTED_ERROR,
    VERDICTS,
    WARNED,
)
from mjbeer.studies.validation.validate import checks
from mjbeer.theory import slosh
from mjbeer.theory.can import Can
from mjbeer.theory.liquid import centrifugal_ratio, liquid_in
from mjbeer.theory.liquid_damping import COATING_SHARE
from mjbeer.theory.liquid_properties import LIQUIDS, NAMES
from mjbeer.theory.paper_scenes import frozen, sliding
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

CHECKOUT = pathlib.Path(__file__).parents[1]
sys.path[:0] = [str(CHECKOUT), str(CHECKOUT / "docs" / "figures")]
import gauss_jackson as gauss_jackson_figure  # noqa: E402 - beside the figures that it draws
import real_beer  # noqa: E402

from tests.support import rows  # noqa: E402

DOCUMENTS = [
    CHECKOUT / "README.md",
    *sorted(CHECKOUT.glob("docs/*.md")),
    CHECKOUT / "engines" / "SETTINGS.md",
]
COUNTS = json.loads((CHECKOUT / "docs" / "stability.json").read_text(encoding="utf-8"))
BENCHMARK = Benchmark.load(SHIPPED)
MAPS = stability_maps.load().maps
ENGINES = Results.load()
EXPONENT = re.compile(r"\d(\.\d+)?e[-+]\d+")
MARKED = re.compile(r"(<!-- made: (?P<name>[\w-]+) -->\n).*?(<!-- end -->)", re.DOTALL)
ACCURATE = 1e-6
"""The error [rad] at which tables compare run times scene by scene."""
LEFT_OUT = ("sliding-metal",)  # it takes as long as the massless can, within 5 %
PEERS = {"mujoco": "MuJoCo", "scipy": "SciPy", "numba": "numba", "heyoka": "heyoka"}
"""Packages whose versions the benchmark's page has, with their names as their makers write them."""
GENTLE = math.radians(2)
"""The incline [rad] of estimates for a real can."""
USUAL = math.radians(10)
"""The incline [rad] of the examples."""
_CYLINDER = (2.119, 1.835)
"""Times of an empty and of a filled cylinder [s]: physics.stackexchange.com, question 334250."""
_SOUPS = (2.21, 2.65)
"""Times of broth and cream of mushroom [s]: "Soup Can Lab", scribd.com, document 450335766."""


def anew(text: str) -> str:
    """Return the text of a document with everything between its marks made anew."""
    return MARKED.sub(lambda found: f"{found[1]}{MADE[found['name']]().strip()}\n{found[3]}", text)


def table(
    columns: tuple[str, ...], lines: Sequence[tuple[str, ...]], left: tuple[int, ...] = (0,)
) -> str:
    """Return a table as Markdown."""
    return Table("", columns, lines, left).markdown()


def plain(shown: Table) -> str:
    """Return a table without its title as Markdown."""
    return table(shown.columns, shown.rows, shown.left)


def readable(shown: Table) -> Table:
    """Return a table whose numbers have no more exponent than they need: 1e-6 and 4.6."""

    def shortened(found: re.Match[str]) -> str:
        number = float(found[0])
        if number >= 0.01:
            return two_digits(number)
        digits, _, power = found[0].partition("e")
        return f"{digits}e{int(power)}"

    rows = [tuple(EXPONENT.sub(shortened, cell) for cell in row) for row in shown.rows]
    return Table(shown.title, shown.columns, rows, shown.left)


def in_milliseconds(shown: Table, first: int, last: int) -> Table:
    """Return a table with the unit of the times in the heads of their columns.

    These columns are the `first` to the `last` one.
    """

    def without(row: Sequence[str]) -> tuple[str, ...]:
        return tuple(
            cell.replace(" ms", "") if first <= at <= last else cell for at, cell in enumerate(row)
        )

    columns = tuple(
        f"{name} [ms]" if any(" ms" in row[at] for row in shown.rows) else name
        for at, name in enumerate(shown.columns)
    )
    return Table(shown.title, columns, [without(row) for row in shown.rows], shown.left)


def prose(text: str, indent: str = "") -> str:
    """Return sentences in lines of the documents' width; addresses are not broken."""
    return textwrap.fill(
        text, 130, subsequent_indent=indent, break_on_hyphens=False, break_long_words=False
    )


def ratio(name: str, error: float) -> str:
    """Return the run time of another tool divided by mjbeer's, at equal error [rad].

    It is the range of all scenes.
    """
    return benchmark_tables.ratio_range(BENCHMARK, name, error)


def holds() -> str:
    """What holds, with the numbers that programs know."""
    wrong = Counter(row.misprint.kind for row in paper.claims() if row.misprint)
    random = COUNTS["kinds"]["all"]
    return table(
        ("", ""),
        [
            (
                "**accuracy**",
                f"{len(checks())} checks, nearly all against exact theory, each with a bound and "
                "its reason; at best, periods agree to 1e-12 and trajectories to 1e-10 rad "
                "([validation](docs/validation.md))",
            ),
            (
                "**run time**",
                f"for an error of 1e-6 rad MuJoCo's RK4 needs {ratio(RK4, 1e-6)} times the time of "
                "mjbeer's best setting on the same model; tools that integrate compiled equations "
                f"without MuJoCo need {ratio(COMPILED_DOP853, 1e-6)} of it (DOP853) or "
                f"{ratio(HEYOKA, 1e-6)} (heyoka) ([error against run time](docs/benchmark.md))",
            ),
            (
                "**stability**",
                f"the longest stable timestep of a swing is within {border_error():.2g} % of "
                f"linear theory; of {ended(random):,} new random runs, many of them deliberately "
                f"extreme or impossible, {trusted(random):,} were trusted, and "
                f"{wrong_of(random)}{at_most(random)} ([stability](docs/stability.md))",
            ),
            (
                "**the paper**",
                f"an audit of its 61 equations, footnotes and figures has {len(paper.claims())} "
                "rows; "
                f"{sum(wrong.values())} hold only after a correction: {wrong[MISPRINT]} misprints, "
                f"{wrong[CONSEQUENCE]} consequences of one, and {wrong[APPROXIMATION]} "
                "approximations that leave out too much ([the physics](docs/physics.md))",
            ),
        ],
        left=(0, 1),
    )


def gauss_jackson() -> str:
    """How many times more evaluations DOP853 takes than Gauss-Jackson."""
    columns = ["", *(f"to 1e{math.log10(error):.0f} rad" for error in gauss_jackson_figure.ERRORS)]
    return table(tuple(columns), gauss_jackson_figure.rows())


def misprints() -> str:
    """What is wrong in the paper, and by how much."""
    notes = {MISPRINT: "", CONSEQUENCE: " (follows)", APPROXIMATION: " (approximation)"}
    lines = []
    for row in paper.claims():
        wrong = row.misprint
        if wrong:
            about = wrong.about + notes[wrong.kind]
            lines.append((row.equation, about, f"{wrong.expected_error:.2g}"))
    columns = ("equation", "what is wrong in it", "relative error as printed")
    return table(columns, lines, left=(0, 1))


def some(shown: Table, left_out: Sequence[str] = LEFT_OUT) -> Table:
    """Return a table without the rows that say little more than their neighbours."""
    kept = [row for row in shown.rows if not any(name in row[0] for name in left_out)]
    return Table(shown.title, shown.columns, kept, shown.left)


def without_columns(shown: Table, left_out: Sequence[str]) -> Table:
    """Return a table without the columns of these names."""
    kept = [at for at, name in enumerate(shown.columns) if name not in left_out]
    return Table(
        shown.title,
        tuple(shown.columns[at] for at in kept),
        [tuple(row[at] for at in kept) for row in shown.rows],
        shown.left,
    )


def of_one_error(shown: Table) -> Table:
    """Return a table of one error with the error in its head, and not in each row."""
    (error,) = {row[0].partition(", ")[2] for row in shown.rows}
    columns = (f"to {error.replace('e-0', 'e-')}", *shown.columns[1:])
    rows = [(row[0].partition(", ")[0], *row[1:]) for row in shown.rows]
    return Table(shown.title, columns, rows, shown.left)


def others() -> str:
    """Run times of other tools at equal error, and how much they scatter.

    Interpreted and compiled equations take odeint about as long, so that one column has both.
    """
    ratios = of_one_error(benchmark_tables.ratios(BENCHMARK, (ACCURATE,)))
    shown = without_columns(some(ratios), [COMPILED_ODEINT])
    # A ratio is followed by its range in brackets.
    rows = [(row[0], row[1], *(cell.partition(" (")[0] for cell in row[2:])) for row in shown.rows]
    without_ranges = Table(shown.title, shown.columns, rows, shown.left)
    times_alone = in_milliseconds(readable(without_ranges), 1, 1)
    return f"{plain(times_alone).rstrip()}\n\n{scatter()}"


def scatter() -> str:
    """How far ratios of single rounds are from those of the least times."""
    relative = []
    for case in BENCHMARK.cases:
        for name in benchmark_tables.OTHERS:
            found = benchmark_tables.time_ratio(BENCHMARK, case, name, ACCURATE)
            if found is not None:
                relative += [found.smallest / found.of_least, found.largest / found.of_least]
    return prose(
        f"The ratios are of the least times of five rounds. In single rounds they were "
        f"{min(relative):.2g} to {max(relative):.2g} times as large."
    )


def whole_calls() -> str:
    """Times of whole calls."""
    calls = some(benchmark_tables.whole_calls(BENCHMARK), (*LEFT_OUT, "1e-03"))
    shown = of_one_error(calls)
    return plain(in_milliseconds(readable(shown), 1, len(shown.columns)))


def long_run() -> str:
    """Errors and drifts of a motion of 1,000 s."""
    (case,) = BENCHMARK.long_cases
    left_out = ("RK4 4 ms", "DOP853 16 ms", "to 1e-06", "compiled equations to 1e-09")
    return plain(readable(some(benchmark_tables.drift(BENCHMARK, case), left_out)))


def contact() -> str:
    """Errors of a contact at timesteps from 8 ms to 0.125 ms, and the run time of DOP853."""
    shown = benchmark_tables.convergence(BENCHMARK, "frozen", 4)
    rows = [row[:4] for row in shown.rows[1:9:2]]
    errors = plain(readable(Table(shown.title, shown.columns[:4], rows, shown.left)))
    dop853 = work_precision.contact_ratio(BENCHMARK)
    assert dop853 is not None, "both reach the error in the stored study"
    slower = prose(
        "RK4 is the faster integrator here: for an error of 1e-6 rad mjbeer's DOP853 takes "
        f"{two_digits(dop853.of_least)} times as long."
    )
    return f"{errors.rstrip()}\n\n{slower}"


def measured() -> str:
    """When and where the benchmark that comes with mjbeer was measured."""
    machine = BENCHMARK.machine
    versions = machine["versions"]
    used = [f"Python {machine['python']}"]
    used += [f"{name} {versions[key]}" for key, name in PEERS.items()]
    return prose(
        "The stored study was measured in November 2026 on a machine with "
        f"{machine['cores']} cores of an {machine['processor']}, with {', '.join(used)}."
    )


def ranges() -> str:
    """Run times of RK4 and of the tools without MuJoCo, over all scenes."""
    errors = (*benchmark_tables.COMPARED, benchmark_tables.FINEST)
    columns = ["run time divided by mjbeer's", *(f"to {error:.0e} rad" for error in errors)]
    lines = []
    for name in (RK4, ODEINT, COMPILED_DOP853, HEYOKA):
        lines.append((name, *(ratio(name, error) for error in errors)))
    return table(tuple(column.replace("e-0", "e-") for column in columns), lines)


def stable_slip(integrator: str) -> float:
    """Return the largest h/timeconst with a bounded friction row of impedance 1.

    Such a row has a damping and no stiffness. The limit is 1 under semi-implicit Euler, and half of
    the limit on the negative real axis under a Runge-Kutta method.
    """
    return math.inf if integrator == "discrete" else stable_decay(integrator) / 2


def stable_decay(integrator: str) -> float:
    """Return the largest h |s| with which exp(-|s| t) stays bounded, where it is explicit."""
    if integrator not in predictions.RUNGE_KUTTA:
        return 2.0
    coefficients = predictions.polynomial(integrator)[::-1]

    def growth(rate: float) -> float:
        return abs(float(np.polyval(coefficients, -rate))) - 1

    return predictions.first(growth, 0.1, 50.0)


def steps() -> str:
    """The largest stable timesteps that theory predicts."""
    methods = ("Euler", "discrete", "RK4", "DOP853")

    def spring(method: str) -> float:
        return math.inf if method == "discrete" else predictions.stable_limit(method)

    def underdamped(method: str) -> float:
        return rows.stable_ratio(method, 0.1)

    def direct(method: str) -> float:
        return rows.stable_timestep(method, predictions.direct(1.0, 2.0, 0.9))

    bounded: dict[str, Callable[[str], float]] = {
        "swing by gravity: ωh below": predictions.stable_limit,
        "swing by a joint's spring: ωh below": spring,
        "equality, ζ = 1: h/τ below": rows.stable_ratio,
        "equality, ζ = 0.1: h/τ below": underdamped,
        "friction of a contact: h/τ below": stable_slip,
        "direct `solref`, B = 2√K: h√K below": direct,
        "swing within 1 % for ten periods: ωh below": predictions.accurate_limit,
    }
    lines = []
    for name, limit in bounded.items():
        longest = [limit(method) for method in methods]
        cells = ["no limit" if math.isinf(most) else f"{most:.2g}" for most in longest]
        lines.append((name, *cells))
    explicit = [f"{stable_decay(method):.2g}" for method in ("Euler", *predictions.RUNGE_KUTTA)]
    euler = f"{explicit[0]}, but no limit with implicit and implicitfast"
    lines.insert(-1, ("damping, reduced: h\\|s\\| below", euler, "no limit", *explicit[1:]))
    columns = ("", "Euler, implicit, implicitfast", "discrete", "RK4", "DOP853 around MuJoCo")
    return table(columns, lines)


def agreement() -> str:
    """How the maps came out, and how near their borders in gravity are to the limit of a swing."""
    maps = [drawn for drawn in MAPS if drawn.family != "damping"]
    runs, _ = stability_maps.summary(maps)
    return prose(
        f"{len(maps)} maps of timestep and stiffness, {runs:,} short runs in all, agree with this. "
        "In gravity the border was found by bisection, and the longest stable timestep is within "
        f"{border_error():.2g} % of the limit of ωh."
    )


def border_error() -> float:
    """Return how far measured borders in gravity are from the limit of a swing [%], at worst."""
    worst = 0.0
    for drawn in MAPS:
        if drawn.family != "gravity":
            continue
        limit = predictions.stable_limit(drawn.integrator)
        for value, (border, _) in zip(drawn.values, drawn.boundaries, strict=True):
            # At the shortest timestep there is no border to measure: all runs explode.
            if border and border > drawn.timesteps[0]:
                frequency = frozen(0.0, gravity=value).frequency()
                worst = max(worst, abs(border * frequency / limit - 1))
    return 100 * worst


def damped_runs() -> str:
    """How near the borders in the maps of damping are to linear theory."""
    maps = [drawn for drawn in MAPS if drawn.family == "damping"]
    runs, worst = stability_maps.summary(maps)
    return prose(
        f"In {runs:,} runs the borders of stability and of accuracy agree with linear theory "
        f"within {100 * worst:.2g} %."
    )


def ended(count: dict[str, int]) -> int:
    """Return the number of runs."""
    return sum(count.get(verdict, 0) for verdict in VERDICTS)


def trusted(count: dict[str, int]) -> int:
    """Return the number of runs that did not doubt themselves."""
    return count.get(RIGHT, 0) + count.get(UNDETECTED_ERROR, 0)


def wrong_of(count: dict[str, int]) -> str:
    """Return how many of the trusted runs were wrong."""
    wrong = count.get(UNDETECTED_ERROR, 0)
    return f"{wrong or 'none'} of these {'was' if wrong < 2 else 'were'} wrong"


def at_most(count: dict[str, int]) -> str:
    """Return how many of the trusted runs may be wrong, in parentheses."""
    share = stability_study.bound(count)
    if share is None:
        return ""
    percent = stability_study.rounded_up(100 * share)
    return f" (at most {percent} % of such runs are, with 95 % confidence)"


def alone(count: dict[str, int]) -> int:
    """Return the number of runs that had one independent check."""
    return sum(count.get(judge, 0) for judge in (THEORY, SERIES))


def kinds() -> str:
    """How the random runs ended, by kind of model."""
    counted = stability_study.Totals(COUNTS["known"], COUNTS["kinds"])
    tables = stability_study.search_tables(counted)
    (shown,) = [found for found in tables if "by model" in found.title]
    kept = ["runs", *VERDICTS, stability_study.NEEDLESS]
    columns = [shown.columns.index(name) for name in kept]
    by_runs = sorted(shown.rows, key=lambda row: (row[0] == "all", -int(row[columns[0]])))
    lines = [(row[0], *(row[at] for at in columns)) for row in by_runs]
    return table(("model and rolling", *kept), lines)


def answer() -> str:
    """Whether a run that is trusted was ever wrong, and what that allows."""
    found = COUNTS["kinds"]["all"]
    return prose(
        f"A [random search](#the-random-search) trusted {trusted(found):,} of {ended(found):,} "
        f"runs, and {wrong_of(found)}{at_most(found)}."
    )


def honesty() -> str:
    """What the table of `kinds` does not say: whether estimates and checks were good enough."""
    found = COUNTS["kinds"]["all"]
    known = COUNTS["known"]
    first = COUNTS["settings"][stability_study.FIRST]
    above = found.get(stability_study.ABOVE, 0)
    twice = found.get(stability_study.TWICE, 0)
    checked = trusted(found) + found.get(WARNED, 0)
    unchecked = found.get(NOBODY, 0)
    without = (
        f", and {unchecked} had none because neither theory could compute them" if unchecked else ""
    )
    return prose(
        f"The runs are numbered from {first} on. "
        f"The error of {above} trusted runs was larger than their own estimate, in "
        f"{twice or 'none'} of them more than twice as large. "
        f"Of the {checked:,} runs that were not refused, {alone(found):,} had only one of the two "
        f"checks{without}. "
        f"Of {ended(known):,} runs of known cases {trusted(known):,} were trusted, and "
        f"{wrong_of(known)}."
    )


def swings() -> str:
    """How fast beer swings in a can of 33 mm on level ground, as a solid and as a liquid.

    A frequency is in brackets where another mode than the slowest has more of the energy.
    """
    columns = (
        "fill (depth / diameter)",
        "massless: solid [Hz]",
        "massless: liquid [Hz]",
        "12-oz can: solid [Hz]",
        "12-oz can: liquid [Hz]",
        "its share of the energy (12-oz can)",
        "amplitude halved after (12-oz can)",
    )
    lines = []
    for fill in (0.1, 0.25, 0.5, 0.75, 0.9):
        cells = [f"{fill:g}"]
        for can in (Can(), real_beer.CAN):
            ice = sliding(0.0, fill, can, LIQUIDS["beer"].density)
            modes = slosh.rolling(fill, ice.effective_mass / ice.load.mass)
            hertz = modes.frequencies(can.radius, ice.gravity)[0] / math.tau
            is_most = modes.energy_shares.argmax() == 0
            cells += [f"{ice.frequency() / math.tau:.2f}", f"{hertz:.2f}"]
            if not is_most:
                cells[-1] = f"({cells[-1]})"
        ratios = modes.damping_ratios(
            can.radius, can.length, ice.gravity, LIQUIDS["beer"].viscosity
        )
        periods = math.log(2) / (math.tau * (ratios.layers + ratios.bulk))
        cells += [f"{100 * modes.energy_shares[0]:.0f} %", f"{periods:.0f} swings"]
        lines.append(tuple(cells))
    return table(columns, lines)


def speeds() -> str:
    """Terminal speeds of liquids in the model of one lump.

    They are in brackets where the model does not hold.
    """
    columns = (
        "liquid",
        "ν [m²/s]",
        "at 2° [m/s]",
        "at 10° [m/s]",
        "Reynolds number",
        "centrifugal [g]",
        "film could hold, of the liquid",
    )
    lines = []
    for name in NAMES:
        used = liquid_in(name, USUAL)
        scene = without_doubts(name, USUAL)
        radius = scene.can.radius
        speed = scene.terminal_speed()
        cells = (
            name,
            f"{LIQUIDS[name].viscosity:.2g}",
            terminal_speed(name, GENTLE),
            terminal_speed(name, USUAL),
            f"{speed * math.pi * radius / used.viscosity:.2g}",
            f"{speed**2 / (radius * scene.gravity):.2g}",
            f"{100 * used.carried:.0f} %",
        )
        lines.append(cells)
    return table(columns, lines)


def without_doubts(name: str, incline: float) -> Scene:
    """Return a can with a liquid on an `incline` [rad], and do not say whether its model holds."""
    with warnings.catch_warnings(action="ignore", category=LiquidWarning):
        return liquid(name, incline)


def terminal_speed(name: str, incline: float) -> str:
    """Return a liquid's terminal speed [m/s] as text, in brackets where the model does not hold."""
    scene = without_doubts(name, incline)
    speed = scene.terminal_speed()
    is_below = centrifugal_ratio(scene, speed) < 1
    is_one_lump = liquid_in(name, incline).carried < COATING_SHARE
    return f"{speed:.2g}" if is_below and is_one_lump else f"({speed:.2g})"


def metre() -> str:
    """Mean accelerations over the first metre, divided by g sin(alpha), with their spread."""
    columns = (
        "water [mL]",
        "no friction",
        "friction",
        "doubled to halved",
        "model holds for",
    )
    lines = []
    for volume in (1.0, 10.0, 20.0, 50.0, 177.0, 350.0):
        free = real_beer.water_in(volume, GENTLE, friction=0.0)
        none = free.acceleration() / (free.gravity * math.sin(GENTLE))
        usual = with_water(volume)
        halved = with_water(volume, friction=1 / real_beer.SPREAD)
        doubled = with_water(volume, friction=real_beer.SPREAD)
        until = real_beer.lump_until(usual)
        mean = f"{real_beer.over_first_metre(usual):.2f}"
        cells = (
            f"{volume:g}",
            f"{none:.2f}",
            mean if until > 1 else f"({mean})",
            f"{real_beer.over_first_metre(doubled):.2f} to "
            f"{real_beer.over_first_metre(halved):.2f}",
            "the whole metre" if until > 1 else f"{until:.2f} m",
        )
        lines.append(cells)
    return table(columns, lines)


def measured_by_others() -> str:
    """How the times of rolling cylinders compare, as others measured them and by theory."""
    down = frozen(USUAL).gravity * math.sin(USUAL)
    solid = frozen(USUAL, 1.0).acceleration()

    empty = 0.073  # [kg]
    heaviest = 2.278
    wall = Can.hoop(mass=empty)
    contents = (heaviest - empty) / (math.pi * wall.radius**2 * wall.length)
    turning = frozen(USUAL, 1.0, wall, contents).acceleration()
    not_turning = sliding(USUAL, 1.0, wall, contents).acceleration()
    shell = down / 2

    tin = Can.hoop(mass=sliding(USUAL, 1.0).mass / 9)  # a tenth of the whole
    cream_in_tin = frozen(USUAL, 1.0, tin).acceleration()
    broth_in_tin = sliding(USUAL, 1.0, tin).acceleration()

    cylinder = quotient(*_CYLINDER)
    soups = quotient(*_SOUPS)
    lines = [
        (
            "cylinder, empty and filled: a thin shell, and a solid without a wall",
            f"{_CYLINDER[0]:.3f} s / {_CYLINDER[1]:.3f} s = {cylinder}",
            time_ratio(shell, solid),
        ),
        ("a thin wall of 0.073 kg, and what is inside turns", cylinder, time_ratio(shell, turning)),
        ("the same, and what is inside does not turn", cylinder, time_ratio(shell, not_turning)),
        (
            "broth and cream: the broth does not turn, the cream does; cans without mass",
            f"{_SOUPS[0]:.2f} s / {_SOUPS[1]:.2f} s = {soups}",
            time_ratio(down, solid),
        ),
        ("the same; cans of a tenth of the mass", soups, time_ratio(broth_in_tin, cream_in_tin)),
        ("both turn with their cans", soups, time_ratio(solid, solid)),
    ]
    return table(("what theory assumes", "measured ratio of times", "by theory"), lines)


def quotient(first: float, second: float) -> str:
    """Return the ratio of two times as text."""
    return f"{first / second:.3f}"


def time_ratio(first: float, second: float) -> str:
    """Return the ratio of the times that two accelerations take for one distance, as text."""
    return f"{math.sqrt(second / first):.3f}"


def with_water(volume: float, friction: float = 1.0) -> Trajectory:
    """Return the first metre of a can with a `volume` [mL] of water on the gentle incline."""
    scene = real_beer.water_in(volume, GENTLE, friction)
    with warnings.catch_warnings(action="ignore", category=LiquidWarning):
        return real_beer.let_go(scene, real_beer.times_of(scene))


def engines() -> str:
    """The answer of the can test, in some sentences."""
    return prose(findings.answer(ENGINES))


def engine_errors() -> str:
    """Errors of a can in physics engines, at their defaults and at the closest setting."""
    return plain(engine_tables.errors(ENGINES, engine_tables.main_ways(ENGINES)))


def all_engine_errors() -> str:
    """Errors with all shapes and settings."""
    return plain(engine_tables.errors(ENGINES))


def contact_errors() -> str:
    """Errors and costs from MuJoCo's default contact to a stiff one."""
    return stored_tables.load(contact_creep.STORED, "errors").markdown()


def contact_law() -> str:
    """Errors of MuJoCo's soft contacts, predicted and measured."""
    return stored_tables.load(contact_creep.STORED, "law").markdown()


def prisms() -> str:
    """Where prisms end by theory and in MuJoCo."""
    return stored_tables.load(polygon.STORED, "mujoco").markdown()


def physx_prisms() -> str:
    """Where PhysX's hulls end by theory and in PhysX."""
    return stored_tables.load(polygon.STORED, "physx").markdown()


def engine_conservation() -> str:
    """What else should not change while a can rolls."""
    return plain(engine_tables.conservation(ENGINES))


def engine_tuning() -> str:
    """What was tuned."""
    return plain(engine_tables.tuning(ENGINES))


def engine_findings() -> str:
    """What the table of errors shows, with causes and sources."""
    found = findings.findings(ENGINES)
    return "\n".join(prose(f"- {sentence}", indent="  ") for sentence in found)


def engine_versions() -> str:
    """What was measured, and on which machine."""
    return prose(engine_tables.measured(ENGINES))


_OF_THE_PAPER = (holds, misprints)
_OF_THE_BENCHMARK = (others, whole_calls, ranges, measured, long_run, contact)
_OF_STABILITY = (answer, steps, agreement, damped_runs, kinds, honesty)
_OF_REAL_BEER = (swings, speeds, metre)
_OF_ENGINES = (
    engines,
    engine_errors,
    all_engine_errors,
    engine_conservation,
    engine_tuning,
    engine_findings,
    engine_versions,
    contact_errors,
    contact_law,
    prisms,
    physx_prisms,
)
_ALL = (
    *_OF_THE_PAPER,
    gauss_jackson,
    *_OF_THE_BENCHMARK,
    *_OF_STABILITY,
    *_OF_REAL_BEER,
    measured_by_others,
    *_OF_ENGINES,
)
MADE = {made.__name__.replace("_", "-"): made for made in _ALL}
"""What makes the text between two marks, by their name."""

if __name__ == "__main__":
    engine_plot.draw(ENGINES, CHECKOUT / "renders" / "engines")
    for document in DOCUMENTS:
        document.write_text(anew(document.read_text(encoding="utf-8")), encoding="utf-8")
