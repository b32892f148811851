"""Writes what a program can write in the documents anew: `make tables`.

It stands between `<!-- made: NAME -->` and `<!-- end -->`, and `MADE` has what makes it. `docs/stability.json` has the
counts of a long stability study; `python -m tests.support.documents FOLDER/stability.jsonl` takes them from a new one.
"""

import json
import math
import pathlib
import re
import sys
import textwrap
import warnings
from collections import Counter
from collections.abc import Callable
from typing import Any

from mjbeer import LiquidWarning, liquid, paper
from mjbeer.model.setting import DOP853, INTEGRATORS, ROLLINGS
from mjbeer.output.terminal import Table
from mjbeer.paper import real_beer
from mjbeer.paper.claim import APPROXIMATION, CONSEQUENCE, LIMIT, MISPRINT
from mjbeer.predictions import linear_stability, soft_constraint
from mjbeer.studies.benchmark import tables
from mjbeer.studies.benchmark.points import SHIPPED, Benchmark
from mjbeer.studies.study import Study
from mjbeer.studies.stability import limits, search, stiff_maps, study
from mjbeer.studies.stability.judge import NEVER, VERDICTS
from mjbeer.studies.validation.run import rows as checks
from mjbeer.theory.liquid import LIQUIDS, NAMES, centrifugal, liquid_in
from tests.support import rows

CHECKOUT = pathlib.Path(__file__).parents[2]
DOCUMENTS = [CHECKOUT / "README.md", *sorted(CHECKOUT.glob("docs/*.md"))]
COUNTS = CHECKOUT / "docs" / "stability.json"
MARKED = re.compile(r"(<!-- made: (?P<name>[\w-]+) -->\n).*?(<!-- end -->)", re.DOTALL)
GENTLE, USUAL = math.radians(2), math.radians(10)


def anew(text: str) -> str:
    """Return the text of a document with everything between its marks made anew."""
    return MARKED.sub(lambda found: f"{found[1]}{MADE[found['name']]().strip()}\n{found[3]}", text)


def counts_of(path: pathlib.Path) -> dict[str, Any]:
    """Return what the documents say of a stability study: how its runs ended, and how good its limits are."""
    found = Study.load(path, study.COMMAND)
    shown = {table.title: table for table in search.tables(found.results)}
    swings = [result.values for result in found.of(limits.GROUP)]
    batches = [result.values for result in found.of(search.RANDOM)]
    kept = [run for values in batches for run in values["overconfident"]]
    return {
        "made by": f"{found.command} --{found.settings['extent']}",
        "limits": {
            "cases": len(swings),
            "stable": max(
                abs(of["stable"] / of["stable_predicted"] - 1) for of in swings if not of.get("lost_a_stage")
            ),
            "accurate": max(abs(of["accurate"] / of["accurate_predicted"] - 1) for of in swings if "accurate" in of),
        },
        "known": [dict(zip(("kind", *VERDICTS), row, strict=True)) for row in shown["How runs ended"].rows],
        "regions": [
            dict(zip(shown["Random runs, by region"].columns, row, strict=True))
            for row in shown["Random runs, by region"].rows
        ],
        "overconfident": {"runs": len(kept), "by": max((run["error"] - run["admitted"] for run in kept), default=0.0)},
    }


def counts() -> dict[str, Any]:
    """Return the counts that the documents show."""
    return json.loads(COUNTS.read_text(encoding="utf-8"))


def table(columns: tuple[str, ...], lines: list[tuple[str, ...]], left: tuple[int, ...] = (0,)) -> str:
    """Return a table as Markdown."""
    return Table("", columns, lines, left).markdown(title=False)


def prose(text: str) -> str:
    """Return sentences in lines of the documents' width."""
    return textwrap.fill(text, 130)


def ratios(name: str) -> str:
    """Return the range of the run times of another tool over mjbeer's, at equal error; the page has the same."""
    shown = tables.others(Benchmark.load(SHIPPED))
    cells = [cell for row in shown.rows if (cell := row[shown.columns.index(name)]) != "-"]
    return f"{min(cells, key=float)} to {max(cells, key=float)}"


def holds() -> str:
    """What holds, with the numbers that programs know."""
    wrong = Counter(row.misprint.kind for row in paper.claims() if row.misprint)
    maps, random = stiff_maps.load(), counts()["regions"][-1]
    cells = sum(len(line) for each in maps["maps"] for line in each["measured"])
    same = sum(each["same"] for each in maps["maps"]) / len(maps["maps"])
    never = sum(int(random[VERDICTS[verdict]]) for verdict in NEVER)
    return table(
        ("", ""),
        [
            (
                "**accuracy**",
                f"{len(checks())} checks, nearly all against exact theory, each with a bound and its reason: periods "
                "to 1e-12, trajectories to a tolerance of 1e-10 rad ([validation](docs/validation.md))",
            ),
            (
                "**run time**",
                f"on the same reduced model, at the same error, MuJoCo's RK4 takes {ratios('MuJoCo RK4')} times as "
                "long as mjbeer's best setting; "
                f"heyoka, which compiles equations derived by hand, takes {ratios('heyoka')} times as long "
                "([error against run time](docs/benchmark.md))",
            ),
            (
                "**stability**",
                f"of {cells:,} short runs in {len(maps['maps'])} maps, {100 * same:.4g} % end as linear theory allows; "
                f"of {int(random['runs']):,} random runs, {never} were wrong without a warning, missed their tolerance "
                "or made two theories disagree ([stability](docs/stability.md))",
            ),
            (
                "**the paper**",
                f"its 61 equations are audited in {len(paper.claims())} rows; {sum(wrong.values())} hold only after a "
                f"correction: {wrong[MISPRINT]} misprints, {wrong[CONSEQUENCE]} consequences of one, and "
                f"{wrong[APPROXIMATION]} approximations that leave out too much ([the physics](docs/physics.md))",
            ),
        ],
        left=(0, 1),
    )


def misprints() -> str:
    """What is wrong in the paper, and by how much."""
    found = [(row.equation, row.misprint) for row in paper.claims() if row.misprint]
    kinds = {MISPRINT: "", CONSEQUENCE: " (follows)", APPROXIMATION: " (approximation)"}
    lines = [(name, each.about + kinds[each.kind], f"{each.expected_error:.2g}") for name, each in found]
    return table(("equation", "what is wrong in it", "misses by"), lines, left=(0, 1))


def validity() -> str:
    """What is true only within limits, and by how much it misses beyond them."""
    found = [(row, row.limit) for row in paper.claims() if row.verdict == LIMIT and row.limit]
    lines = [(row.equation, row.quantity.partition(":")[0], f"{limit.expected_error:.2g}") for row, limit in found]
    return table(("where", "claim", "beyond, misses by"), lines, left=(0, 1))


def causes() -> str:
    """The causes of errors in the validation, each without its particulars, with the bounds that follow."""
    found: dict[tuple[str, str], list[float]] = {}
    for row in checks():
        found.setdefault(
            (re.split("[:;,]", row.reason)[0].replace("as above", "RK4's own error"), row.unit), []
        ).append(row.bound)
    lines = []
    for (reason, unit), bounds in found.items():
        span = sorted({min(bounds), max(bounds)})
        lines.append((reason, str(len(bounds)), f"{' to '.join(f'{each:.2g}' for each in span)} {unit}".strip()))
    return table(("what dominates the error", "checks", "error at most"), lines)


def cheapest() -> str:
    """The cheapest settings for frozen beer."""
    return tables.cheapest(Benchmark.load(SHIPPED), "frozen").markdown(title=False)


def others() -> str:
    """Run times of other tools at one error; the page has all."""
    shown = tables.others(Benchmark.load(SHIPPED))
    lines = [row for row in shown.rows if "1e-09" in row[0]]
    return table(shown.columns, lines)


def tolerances() -> str:
    """Run times to one tolerance; the page has all."""
    shown = tables.tolerances(Benchmark.load(SHIPPED))
    return table(shown.columns, [row for row in shown.rows if row[0].endswith("1e-9")])


def swept() -> str:
    """Times of many scenes, if the study that comes with mjbeer has them."""
    found = Benchmark.load(SHIPPED)
    if not found.sweeps:
        return "The study that comes with mjbeer has no sweeps in it yet."
    return tables.sweeps(found).markdown(title=False)


def ranges() -> str:
    """Two sentences on RK4 and heyoka."""
    return prose(
        f"At the same error MuJoCo's own RK4 takes {ratios('MuJoCo RK4')} times as long as mjbeer's best setting, and "
        f"heyoka {ratios('heyoka')} times as long."
    )


def steps() -> str:
    """The largest stable timesteps that theory predicts."""
    methods = ("Euler", "discrete", "RK4", DOP853)

    def spring(method: str) -> float:
        return math.inf if method == "discrete" else linear_stability.stable_limit(method)

    bounded: dict[str, Callable[[str], float]] = {
        "swing by gravity: ωh below": linear_stability.stable_limit,
        "swing by a joint's spring: ωh below": spring,
        "equality, ζ = 1: h/τ below": rows.stable_ratio,
        "equality, ζ = 0.1: h/τ below": lambda method: rows.stable_ratio(method, 0.1),
        "friction of a contact: h/τ below": rows.stable_slip,
        "direct `solref`, B = 2√K: h√K below": lambda method: rows.stable_timestep(
            method, soft_constraint.direct(1.0, 2.0, 0.9)
        ),
        "swing within 1 % for ten periods: ωh below": linear_stability.accurate_limit,
    }
    lines = [
        (name, *("no limit" if (most := limit(each)) == math.inf else f"{most:.2g}" for each in methods))
        for name, limit in bounded.items()
    ]
    return table(("", "Euler, implicit, implicitfast", "discrete", "RK4", "DOP853 around MuJoCo"), lines)


def agreement() -> str:
    """How well theory predicts the limits, and how the maps came out."""
    maps, swings = stiff_maps.load(), counts()["limits"]
    cells = sum(len(line) for each in maps["maps"] for line in each["measured"])
    same = sum(each["same"] for each in maps["maps"]) / len(maps["maps"])
    return prose(
        f"The longest stable timestep of a small swing was measured for {swings['cases']} combinations of scene, way "
        "of rolling and integrator, and differs from the prediction by "
        f"{100 * swings['stable']:.2g} % at most; the largest accurate timestep differs by "
        f"{100 * swings['accurate']:.2g} %. Besides, there are {len(maps['maps'])} maps of timestep and stiffness with "
        f"{cells:,} short runs, of which {100 * same:.4g} % end as theory allows."
    )


def damped() -> str:
    """How damped runs of a millisecond a step end, by damping."""
    maps = {each["name"]: each for each in stiff_maps.load()["damped"]}
    words = ("explodes", "inaccurate", "accurate", "accurate", "WRONG AND SILENT")
    lines = []
    for name in (*INTEGRATORS, DOP853):
        cells = []
        for rolling in ROLLINGS:
            of = maps[f"{rolling}, {name}"]
            step = min(range(len(of["timesteps"])), key=lambda at: abs(math.log(of["timesteps"][at] / 1e-3)))
            ended = []
            for damping in (0.01, 0.1, 1.0):
                value = min(range(len(of["values"])), key=lambda at: abs(math.log(of["values"][at] / damping)))
                ended.append(words[int(of["measured"][value][step])])
            cells.append(ended[0] if len(set(ended)) == 1 else ", ".join(ended))
        lines.append((name, *cells))
    return table(("1 ms", *ROLLINGS), lines, left=(0, 1, 2, 3))


def damped_runs() -> str:
    """How the runs in the maps of damping ended."""
    maps = stiff_maps.load()["damped"]
    ended = Counter("".join("".join(each["measured"]) for each in maps))
    exploded, inaccurate, warned, trusted, silent = (ended[str(code)] for code in range(5))
    worst = max(each["worst"] for each in maps if not each["name"].startswith("contact"))
    contact = max(each["worst"] for each in maps if each["name"].startswith("contact"))
    return prose(
        f"Of {ended.total():,} runs in these maps {exploded:,} explode, and {inaccurate:,} are inaccurate and say so; "
        f"{silent} are wrong and silent. Of {warned + trusted:,} accurate runs {warned:,} warn all the same. "
        f"Measured and predicted borders agree within {100 * worst:.2g} %, in contact within {100 * contact:.2g} %."
    )


def known() -> str:
    """How the runs of the known cases ended."""
    lines = [tuple(of.values()) for of in counts()["known"]]
    return table(("cases", *VERDICTS.values()), lines)


def regions() -> str:
    """How many random runs of each region were accurate, and how many of those had a false alarm."""
    columns = ("region", "accurate", "false alarms")
    return table(columns, [tuple(of[name] for name in columns) for of in counts()["regions"]])


def honesty() -> str:
    """How often a run said too little of its error, and how often too much."""
    found = counts()
    random, over = found["regions"][-1], found["overconfident"]
    silent, missed, theories = (random[VERDICTS[verdict]] for verdict in NEVER)
    return prose(
        f"Of {int(random['runs']):,} random runs {silent} were wrong without a warning and {missed} missed their "
        f"tolerance; the two theories disagreed on {theories}. Of {int(random['accurate']):,} accurate runs "
        f"{over['runs']} were trusted with an error above their estimate, by {over['by']:.0e} rad at most, and "
        f"{random['false alarms']} had a false alarm."
    )


def speeds() -> str:
    """Terminal speeds of liquids in the model of one lump, in brackets where the model does not hold."""
    lines = []
    for name in NAMES:
        used = liquid_in(name, USUAL)
        cells = []
        for incline in (GENTLE, USUAL):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", LiquidWarning)
                scene = liquid(name, incline)
            speed = scene.terminal_speed()
            within = centrifugal(scene, speed) < 1 and liquid_in(name, incline).carried < 1 / 3
            cells.append(f"{speed:.2g}" if within else f"({speed:.2g})")
        arc = math.pi * scene.can.radius
        lines.append((
            name, f"{LIQUIDS[name].density:.4g}", f"{LIQUIDS[name].viscosity:.2g}", *cells,
            f"{speed * arc / used.viscosity:.2g}", f"{speed**2 / (scene.can.radius * scene.gravity):.2g}",
            f"{100 * used.carried:.0f} %",
        ))  # fmt: skip
    return table(
        ("at 20 °C", "density [kg/m³]", "ν [m²/s]", "at 2° [m/s]", "at 10° [m/s]", "Reynolds number", "at the wall [g]",
         "film could hold"),
        lines,
    )  # fmt: skip


def metre() -> str:
    """Mean accelerations over the first metre, over g sin(alpha), with their spread."""
    lines = []
    for volume in (1.0, 6.0, 10.0, 20.0, 50.0, 177.0, 350.0):
        free = real_beer.water_in(volume, GENTLE, friction=0.0)
        runs = []
        for friction, drag in ((1.0, 0.0), (1 / real_beer.SPREAD, 0.0), (real_beer.SPREAD, 0.0), (1.0, real_beer.DRAG)):
            scene = real_beer.water_in(volume, GENTLE, friction, drag)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", LiquidWarning)
                runs.append(real_beer.let_go(scene, real_beer.times_of(scene)))
        usual, least, most, air = (f"{real_beer.over_first_metre(run):.2f}" for run in runs)
        none = free.acceleration() / (free.gravity * math.sin(GENTLE))
        depth = 2e3 * (free.load.fill or 0) * free.can.radius
        until = real_beer.lump_until(runs[0])
        lines.append((f"{volume:g}", f"{depth:.2g}", f"{none:.2f}", usual, f"{most} to {least}", air,
                      "the whole metre" if until > 1 else f"{until:.1f} m"))  # fmt: skip
    return table(
        ("water [mL]", "depth [mm]", "no friction", "friction", "friction doubled to halved", "with air",
         "model holds for"),
        lines,
    )  # fmt: skip


MADE: dict[str, Callable[[], str]] = {
    "holds": holds,
    "misprints": misprints,
    "validity": validity,
    "causes": causes,
    "cheapest": cheapest,
    "others": others,
    "tolerances": tolerances,
    "swept": swept,
    "ranges": ranges,
    "steps": steps,
    "agreement": agreement,
    "damped": damped,
    "damped-runs": damped_runs,
    "known": known,
    "regions": regions,
    "honesty": honesty,
    "speeds": speeds,
    "metre": metre,
}

if __name__ == "__main__":
    if len(sys.argv) > 1:
        taken = [f"{json.dumps(name)}: {json.dumps(of)}" for name, of in counts_of(pathlib.Path(sys.argv[1])).items()]
        COUNTS.write_text("{\n" + ",\n".join(taken) + "\n}\n", encoding="utf-8")
    for document in DOCUMENTS:
        document.write_text(anew(document.read_text(encoding="utf-8")), encoding="utf-8")
