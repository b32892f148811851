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
_SIGNS, _OPENING = ("=", "≈", "+", "\N{MINUS SIGN}"), ("", "(", "[")
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
    return Markup("").join(_line(line) for line in re.split(r"\\\\\s", latex))


def letters(text: str) -> str:
    """Return a text of the audit with phi as φ, phi_dot as φ̇, a^2 as a² and phi_0 as φ₀."""
    text = _NAME.sub(lambda name: html.unescape(f"&{name[1]};"), text)
    text = _RATE.sub(lambda rate: rate[1] + _DOTS[rate[2]], text)
    return _POWER.sub(lambda power: power[1].translate(_RAISED), text).replace("_0", "₀")


def _line(latex: str) -> Markup:
    """Return a line as MathML that may be broken before the signs =, ≈, + and − between two terms.

    Browsers do not break an element; so each term, with its sign, is an element of its own.
    """
    text = convert(latex, display="block")
    for old, new in _REPLACED.items():
        text = text.replace(old, new)
    begin, end = text.index("<mrow>") + len("<mrow>"), text.rindex("</mrow>")
    terms, before = [""], ""
    for part in _parts(text[begin:end]):
        read = html.unescape(re.sub("<[^>]*>", "", part)).strip()
        starts = part.startswith(("<mo>", "<mstyle")) and read[:1] in _SIGNS and before not in _SIGNS + _OPENING
        if starts:
            terms.append("")
        # At its beginning a sign would stand close to what follows, as that of a number does.
        terms[-1] += part.replace("<mo>", '<mo form="infix">', 1) if starts else part
        before = read[-1:] or before
    elements = "\N{ZERO WIDTH SPACE}".join(f"{text[:begin]}{term}</mrow></math>" for term in terms)
    return Markup(f'<span class="line">{elements}</span>')


def _parts(mathml: str) -> list[str]:
    """Return the elements at the top of a row."""
    parts, level = [""], 0
    for piece in re.findall("<[^>]*>|[^<]+", mathml):
        parts[-1] += piece
        level += 0 if piece.endswith("/>") or piece[0] != "<" else (-1 if piece.startswith("</") else 1)
        if not level:
            parts.append("")
    return parts[:-1]
