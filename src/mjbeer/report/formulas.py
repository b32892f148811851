"""LaTeX as MathML, which browsers set and screen readers read out; and the letters of formulas in a text."""

import html
import re

from latex2mathml.converter import convert
from markupsafe import Markup

_REPLACED = {
    'display="block"': 'display="inline" displaystyle="true"',
    'mathcolor="differs"': 'class="differs"',
    "<mi>sin</mi>": '<mi class="function">sin</mi>',  # so that the style can set them apart from the letters around
    "<mi>cos</mi>": '<mi class="function">cos</mi>',
    '<mspace width="negativethinmathspace" />': "",  # a name of MathML 2, which browsers no longer know
}
_GREEK = ("alpha", "beta", "delta", "epsilon", "theta", "mu", "pi", "phi", "omega", "Omega")
_NAME = re.compile(rf"(?<![A-Za-z])({'|'.join(_GREEK)})(?![A-Za-z])")
_RATE = re.compile(r"(?<![A-Za-z])(\w)_(d?)dot")
_POWER = re.compile(r"\^(\d)(?!\d)")
_RAISED = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")
_DOTS = {"": "\N{COMBINING DOT ABOVE}", "d": "\N{COMBINING DIAERESIS}"}


def mathml(latex: str) -> Markup:
    r"""Return the MathML of a formula, one `math` element for each line; `\\` separates the lines.

    `\textcolor{differs}{...}` becomes an element of the class "differs".
    """
    text = "".join(convert(line, display="block") for line in re.split(r"\\\\\s", latex))
    for old, new in _REPLACED.items():
        text = text.replace(old, new)
    return Markup(text)


def letters(text: str) -> str:
    """Return a text of the audit with phi as φ, phi_dot as φ̇, a^2 as a² and phi_0 as φ₀."""
    text = _NAME.sub(lambda name: html.unescape(f"&{name[1]};"), text)
    text = _RATE.sub(lambda rate: rate[1] + _DOTS[rate[2]], text)
    return _POWER.sub(lambda power: power[1].translate(_RAISED), text).replace("_0", "₀")
