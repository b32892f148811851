r"""The formulas of the paper's misprints in LaTeX, printed and right, for each claim that the audit corrects.

What differs between the two stands in `\textcolor{differs}{...}`; `\\` begins a new line.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Formulas:
    """A formula as the paper prints it, and as it is right."""

    about: str
    """What the formula is of, as a heading."""
    printed: str
    """LaTeX."""
    right: str
    """LaTeX."""


_CAN = r"\Bigl(m_{\text{can}}+\frac{I_{\text{can}}}{a^2}\Bigr)"
_LEFT_49 = (
    r"(I_{\text{cm}}+mb^2\sin^2\!\varphi)\,\ddot\varphi+mb^2\sin\varphi\,\cos\varphi\,\dot\varphi^2\\ {}+" + _CAN + "("
)
_LEFT_61 = r"mb^2(\sin^2\!\varphi\,\ddot\varphi+\sin\varphi\,\cos\varphi\,\dot\varphi^2)\\ {}+2M("
_BRACKET = (
    r"b^2\textcolor{differs}{\cos^2\!\varphi}\,\ddot\varphi"
    r"\\ {}\textcolor{differs}{{}-b^2\sin\varphi\,\cos\varphi\,\dot\varphi^2}+b\cos\varphi\,\ddot s)"
)
_PRINTED_BRACKET = r"b^2\textcolor{differs}{\sin^2\!\varphi}\,\ddot\varphi\\ {}+b\cos\varphi\,\ddot s)"
_GRAVITY = r"\\ {}=-mgb\cos\alpha\,\sin\varphi"

FORMULAS = {
    (
        "Fig. 2",
        "C moves with the centre of mass along the incline; the caption puts it on a line along the surface",
    ): Formulas(
        "The line through the centre of mass on which the instantaneous centre C lies",
        r"\textcolor{differs}{\text{along the flat surface of the beer}}",
        r"\textcolor{differs}{\text{along the incline}}",
    ),
    ("(4)", "torque about C, linear form: its sign"): Formulas(
        "Torque about the instantaneous centre, for small angles",
        r"\tau_C\approx\textcolor{differs}{+}\,mbg\cos\alpha\,\varphi",
        r"\tau_C\approx\textcolor{differs}{-}\,mbg\cos\alpha\,\varphi",
    ),
    ("(10)", "omega^2, middle form: it lacks 1/a (in SI units)"): Formulas(
        "Frequency of small swings of a half-full can",
        r"\omega^2=\frac{24\pi g\cos\alpha}{9\pi^2-32}",
        r"\omega^2=\frac{24\pi g\cos\alpha}{9\pi^2-32}\textcolor{differs}{\cdot\frac1a}",
    ),
    ("(14)", "V, its first form: -mgz for +mgz"): Formulas(
        "Potential energy of the beer", r"V=\textcolor{differs}{-}mgz", r"V=\textcolor{differs}{+}mgz"
    ),
    ("(19), (22)", "equation of motion of phi or theta: its right side lacks g (in SI units)"): Formulas(
        "Equation of motion of φ, and that of θ alike",
        r"\frac{a^2}{2}\ddot\varphi-b\cos\varphi\,\ddot u=-b\sin(\alpha+\varphi)",
        r"\frac{a^2}{2}\ddot\varphi-b\cos\varphi\,\ddot u=-\textcolor{differs}{g}b\sin(\alpha+\varphi)",
    ),
    ("(25)", "u - s = b sin(phi), eq. (12); printed b cos(phi)"): Formulas(
        "How far the axis is ahead of the centre of mass",
        r"u-s=b\,\textcolor{differs}{\cos}\,\varphi",
        r"u-s=b\,\textcolor{differs}{\sin}\,\varphi",
    ),
    ("(25)", "amplitude of the ripple of u at omega: b phi_0; printed none"): Formulas(
        "Amplitude of the can's hesitation at the frequency ω of the swing",
        r"\textcolor{differs}{0}",
        r"\textcolor{differs}{b\,\varphi_0}",
    ),
    ("(25)", "amplitude of the ripple of u at 2 omega over that at omega: none; printed phi_0/2"): Formulas(
        "Amplitude of the can's hesitation at 2ω",
        r"\textcolor{differs}{b\,\varphi_0\cdot\frac{\varphi_0}{2}}",
        r"\textcolor{differs}{0}",
    ),
    ("(25)", "last step, sin^2 = 1/2 - cos(2wt)/2: the coefficient of phi_0^2 cos(2wt) is 1/4, printed 1/2"): Formulas(
        "The last step, from the sine's square to the double angle",
        r"-\frac{\varphi_0^2\sin^2\!\omega t}{2}=-\frac{\varphi_0^2}{4}"
        r"+\frac{\varphi_0^2\cos 2\omega t}{\textcolor{differs}{2}}",
        r"-\frac{\varphi_0^2\sin^2\!\omega t}{2}=-\frac{\varphi_0^2}{4}"
        r"+\frac{\varphi_0^2\cos 2\omega t}{\textcolor{differs}{4}}",
    ),
    ("sec. 2.3.1", "phi at which the surface is horizontal: -alpha; printed phi_0 = alpha"): Formulas(
        "The angle φ at which the beer's surface is level",
        r"\varphi_0=\textcolor{differs}{+}\alpha",
        r"\varphi_0=\textcolor{differs}{-}\alpha",
    ),
    ("(26)", "ripple of phi at 2 Omega: delta/4, whatever Omega; printed none"): Formulas(
        "Fast loops: the ripples of φ",
        r"\varphi=\Omega t+\varepsilon\sin\Omega t",
        r"\varphi=\Omega t+\varepsilon\sin\Omega t\textcolor{differs}{{}+\frac{\delta}{4}\sin2\Omega t,}\\ "
        r"\textcolor{differs}{\delta=\frac{mb^2/2}{mb^2/2+I_{\text{cm}}}}",
    ),
    ("(27), (28)", "epsilon, the ripple at Omega: 1 - 3 delta/8 of the printed one"): Formulas(
        "Fast loops: amplitude of the ripple at Ω",
        r"\varepsilon=\frac{mbg\cos\alpha}{\Omega^2(mb^2/2+I_{\text{cm}})}",
        r"\varepsilon=\textcolor{differs}{\Bigl(1-\frac{3}{8}\delta\Bigr)}"
        r"\frac{mbg\cos\alpha}{\Omega^2(mb^2/2+I_{\text{cm}})}",
    ),
    ("(29)", "amplitude of the ripple of u at Omega: b (1 + delta/8); printed b"): Formulas(
        "Fast loops: the ripple of u at Ω",
        r"b\sin\Omega t",
        r"b\textcolor{differs}{\Bigl(1+\frac{\delta}{8}\Bigr)}\sin\Omega t",
    ),
    ("(36)", "I_axis, third line: sin(2 beta) sin^2(beta)/4; printed /8"): Formulas(
        "The beer's inertia about the can's axis, third line",
        r"\frac{2\rho_{\text{beer}}a^4l}{3}\Bigl(\frac{3\beta}{4}-\frac{3\sin2\beta}{8}"
        r"+\frac{\sin2\beta\,\sin^2\!\beta}{\textcolor{differs}{8}}\Bigr)",
        r"\frac{2\rho_{\text{beer}}a^4l}{3}\Bigl(\frac{3\beta}{4}-\frac{3\sin2\beta}{8}"
        r"+\frac{\sin2\beta\,\sin^2\!\beta}{\textcolor{differs}{4}}\Bigr)",
    ),
    ("sec. 3.1", "phi = theta - alpha; printed theta + alpha"): Formulas(
        "The two angles of the beer",
        r"\varphi=\theta\,\textcolor{differs}{+}\,\alpha",
        r"\varphi=\theta\,\textcolor{differs}{-}\,\alpha",
    ),
    ("(39)", "T_can in s and phi: its last term has cos^2; printed sin^2"): Formulas(
        "Kinetic energy of the can",
        r"\frac12" + _CAN + r"\bigl(\dot s^2+2b\cos\varphi\,\dot s\,\dot\varphi\\ "
        r"{}+b^2\textcolor{differs}{\sin^2\!\varphi}\,\dot\varphi^2\bigr)",
        r"\frac12" + _CAN + r"\bigl(\dot s^2+2b\cos\varphi\,\dot s\,\dot\varphi\\ "
        r"{}+b^2\textcolor{differs}{\cos^2\!\varphi}\,\dot\varphi^2\bigr)",
    ),
    ("(42)", "x_dot = s_dot; printed s_dot^2 (in SI units)"): Formulas(
        "Velocity of the centre of mass along the incline",
        r"\dot x=\textcolor{differs}{\dot s^2}",
        r"\dot x=\textcolor{differs}{\dot s}",
    ),
    ("(47)", "equation of motion of theta: I_axis; printed m a^2 (for m a^2/2 of a half can)"): Formulas(
        "Massive can: equation of motion of θ",
        r"\textcolor{differs}{ma^2}\,\ddot\theta-mb\cos(\theta-\alpha)\,\ddot u=-mgb\sin\theta",
        r"\textcolor{differs}{I_{\text{axis}}}\,\ddot\theta-mb\cos(\theta-\alpha)\,\ddot u=-mgb\sin\theta",
    ),
    ("(49)", "equation of motion of phi: cos^2 for sin^2, and two terms that are not printed"): Formulas(
        "Massive can: equation of motion of φ",
        _LEFT_49 + _PRINTED_BRACKET + _GRAVITY,
        _LEFT_49 + _BRACKET + _GRAVITY + r"\textcolor{differs}{{}+m_{\text{can}}gb\sin\alpha\,\cos\varphi}",
    ),
    ("footnote 8", "the equation as typed in: 3(1) sin(x) (x')^2; printed 3(0.5)"): Formulas(
        "Frozen beer: the term ab sin φ φ̇² as typed in, with a = 3 cm and b = 1 cm",
        r"3(\textcolor{differs}{0.5})\sin(x)\,(x')^2",
        r"3(\textcolor{differs}{1})\sin(x)\,(x')^2",
    ),
    ("(54)", "change of sin(alpha + phi) to first order: its sign"): Formulas(
        "Frozen beer: the sine near the equilibrium",
        r"\sin(\alpha+\varphi)\approx\sin(\alpha+\varphi_0)\\ "
        r"{}\textcolor{differs}{-}\,\epsilon\cos\omega t\,\cos(\alpha+\varphi_0)",
        r"\sin(\alpha+\varphi)\approx\sin(\alpha+\varphi_0)\\ "
        r"{}\textcolor{differs}{+}\,\epsilon\cos\omega t\,\cos(\alpha+\varphi_0)",
    ),
    ("(55)", "omega of small oscillations: 2ab cos(phi_0); printed ab cos(phi_0)"): Formulas(
        "Frozen beer: frequency of small swings",
        r"\omega^2=\frac{gb\cos(\alpha+\varphi_0)}{\frac{3a^2}{2}-ab\cos\varphi_0}",
        r"\omega^2=\frac{gb\cos(\alpha+\varphi_0)}{\frac{3a^2}{2}-\textcolor{differs}{2}ab\cos\varphi_0}",
    ),
    ("(56)", "T in u and theta: the sign of u_dot theta_dot, and b^2 theta_dot^2"): Formulas(
        "Pendulum in a wheel: kinetic energy",
        r"M\dot u^2+\frac m2\bigl[\dot u^2\textcolor{differs}{{}+2b\cos(\theta-\alpha)\,\dot u\,\dot\theta}\bigr]",
        r"M\dot u^2+\frac m2\bigl[\dot u^2\textcolor{differs}{{}-2b\cos(\theta-\alpha)\,\dot u\,\dot\theta"
        r"+b^2\dot\theta^2}\bigr]",
    ),
    ("(58)", "equation of motion of theta: theta_ddot; printed theta (in SI units)"): Formulas(
        "Pendulum in a wheel: equation of motion of θ",
        r"mb^2\textcolor{differs}{\theta}-mb\cos(\theta-\alpha)\,\ddot u=-mgb\sin\theta",
        r"mb^2\textcolor{differs}{\ddot\theta}-mb\cos(\theta-\alpha)\,\ddot u=-mgb\sin\theta",
    ),
    ("(59)", "T in s and phi: cos^2; printed sin^2"): Formulas(
        "Pendulum in a wheel: kinetic energy of the wheel",
        r"M(\dot s^2+2b\cos\varphi\,\dot s\,\dot\varphi+b^2\textcolor{differs}{\sin^2\!\varphi}\,\dot\varphi^2)",
        r"M(\dot s^2+2b\cos\varphi\,\dot s\,\dot\varphi+b^2\textcolor{differs}{\cos^2\!\varphi}\,\dot\varphi^2)",
    ),
    ("(61)", "equation of motion of phi: cos^2 for sin^2, and two terms that are not printed"): Formulas(
        "Pendulum in a wheel: equation of motion of φ",
        _LEFT_61 + _PRINTED_BRACKET + _GRAVITY,
        _LEFT_61 + _BRACKET + _GRAVITY + r"\textcolor{differs}{{}+Mgb\sin\alpha\,\cos\varphi}",
    ),
}
"""The formulas by equation and quantity of the claim, in the paper's order."""
