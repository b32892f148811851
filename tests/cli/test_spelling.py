"""A word that is no command, scene or option where it stands: one line that says what may have been meant."""

import re

import pytest

from mjbeer.cli.app import COMMANDS, main, parse
from mjbeer.cli.arguments import SCENES
from mjbeer.cli.spelling import options

SCENE_LIST = "sliding, liquid, frozen, pendulum"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("simlate sliding", "'simlate' is no command; did you mean simulate?"),
        ("VALIDATE", "'VALIDATE' is no command; did you mean validate?"),
        ("Validate", "'Validate' is no command; did you mean validate?"),
        ("--verson", "'--verson' is no command; did you mean --version?"),
        ("--phi0 3 simulate sliding", "'--phi0' is no command; the commands are simulate, render, view, export, "),
        ("simulate slding", "'slding' is no scene; did you mean sliding?"),
        ("render --phi0 30 Frozen", "'Frozen' is no scene; did you mean frozen?"),
        ("export pendulm -h", "'pendulm' is no scene; did you mean pendulum?"),
        ("simulate xyz", f"'xyz' is no scene; the scenes are {SCENE_LIST} and hoop"),
        ("simulate sliding --tolernce 1e-3", "`mjbeer simulate sliding` has no option --tolernce; did you mean --tole"),
        ("simulate sliding --phi 3", "`mjbeer simulate sliding` has no option --phi; did you mean --phi0 or --phi-do"),
        ("simulate --timestp=3 sliding", "`mjbeer simulate` has no option --timestp; did you mean --timestep?"),
        ("validate --jsn", "`mjbeer validate` has no option --jsn; did you mean --json?"),
        ("simulate sliding --wheel-mass 1", "`mjbeer simulate sliding` has no option --wheel-mass; pendulum has it"),
        ("simulate hoop --fill 1", "`mjbeer simulate hoop` has no option --fill; sliding, liquid and frozen have it"),
        (
            "simulate frozen --speed 2",
            "`mjbeer simulate frozen` has no option --speed; `mjbeer render` and `mjbeer view` have it",
        ),
        (
            "paper --quick",
            "`mjbeer paper` has no option --quick; `mjbeer benchmark`, `mjbeer stability` and `mjbeer report` have it",
        ),
        ("simulate --fill 0.3 sliding", "--fill is an option of the scene: write it after sliding, liquid or frozen"),
        ("paper --xyzzy", "`mjbeer paper` has no option --xyzzy; `mjbeer paper --help` lists them"),
        ("", "a command is missing: simulate, render, view, export, scenes, "),
        ("simulate", f"a scene is missing: {SCENE_LIST} or hoop; see `mjbeer scenes`"),
        ("--tyro-print-completion tcsh", "--tyro-print-completion must be followed by bash, zsh or fish"),
        ("--tyro-write-completion", "--tyro-write-completion must be followed by bash, zsh or fish"),
    ],
)
def test_a_wrong_word_gets_a_suggestion(words: str, message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words.split()) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"mjbeer: {message}")
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    "words",
    [
        "simulate sliding --phi_dot0 -20 --fill=0.3",  # an underscore, a negative value, a value after =
        "simulate --integrator RK4 --json frozen --output -",
        "render --output frozen sliding",  # names of scenes that are values
        "benchmark frozen hoop --quick",
        "advise frozen --rolling contact",
    ],
)
def test_a_right_word_passes(words: str) -> None:
    parse(words.split())


@pytest.mark.parametrize("name", COMMANDS)
def test_the_options_known_are_those_of_the_help(
    name: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    takes_scene = name in ("simulate", "sweep", "render", "export")
    for scene in SCENES if takes_scene else [None]:
        with pytest.raises(SystemExit):
            main([name, *([scene] if scene else []), "--help"])
        shown = set(re.findall(r"^\W*(?:-h, )?(--[a-z][\w-]*)", capsys.readouterr().out, re.MULTILINE)) - {"--help"}
        assert shown == set(options(COMMANDS[name])) | set(options(SCENES[scene]) if scene else [])


@pytest.mark.parametrize("words", ["--help", "simulate --help", "export frozen -h", "simulate -h slding"])
def test_help_is_shown_whatever_is_missing(words: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(words.split())
    assert not ended.value.code
    assert "usage: mjbeer" in capsys.readouterr().out
