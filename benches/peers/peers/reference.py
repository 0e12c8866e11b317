"""What the ends are compared with: (x, y, heading) at the end of a run, in more digits than any peer has."""

from dataclasses import dataclass

import mpmath as mp

from . import equations
from .measure import largest

DIGITS = 38
TOLERANCE = mp.mpf("1e-30")
LOOSER = mp.mpf("1e-26")
# Stages of the extrapolation: order 28.
COLUMNS = 14


@dataclass
class Reference:
    """The end (m, m, rad), its own estimated error (the same measure as the peers'), and where it is from."""

    end: tuple
    error: float
    source: str

    def as_dict(self):
        x, y, heading = map(float, self.end)
        return {"x": x, "y": y, "heading": heading, "error": self.error, "source": self.source}


def closed_form(problem):
    """The free sleigh with `offset != 0` and `turn_rate != 0`: speed and turn rate are hyperbolic functions of time.

    u = U tanh s, omega = +-U sqrt(m/J) sech s, s = s0 + kappa t, kappa = a U m / J,
    heading = theta0 +- sqrt(J/m)/a (gd(s) - gd(s0)), gd(s) = 2 atan(tanh(s/2)); the position by quadrature.
    """
    with mp.workdps(DIGITS):
        m, inertia, a, end = (mp.mpf(v) for v in (problem.mass, problem.inertia, problem.offset, problem.duration))
        x0, y0, th0, u0, w0 = (mp.mpf(v) for v in problem.start)
        j = inertia + m * a * a
        top = mp.sqrt(u0**2 + j * w0**2 / m)
        kappa, s0 = a * top * m / j, mp.atanh(u0 / top)
        gd = lambda s: 2 * mp.atan(mp.tanh(s / 2))
        heading = lambda t: th0 + mp.sign(w0) * mp.sqrt(j / m) / a * (gd(s0 + kappa * t) - gd(s0))
        rate = lambda t: top * mp.tanh(s0 + kappa * t) * mp.expj(heading(t))
        pieces = mp.linspace(0, end, int(mp.ceil(end)) + 1)
        way, error = mp.quad(rate, pieces, error=True)
        # The sum of the pieces' estimates, and the rounding of their sum.
        error = float(error + len(pieces) * mp.eps * abs(way))
        source = "closed form, position by quadrature (mpmath)"
        return Reference((x0 + way.real, y0 + way.imag, heading(end)), error, source)


def extrapolated_step(slope, y, h):
    """One step of the modified midpoint rule, extrapolated in h^2; the end and an estimate of its error.

    (Hairer, Norsett, Wanner 1993, section II.9, with the sequence 2, 4, 6, ..)
    """
    f0, row = slope(y), []
    for k in range(COLUMNS):
        n = 2 * (k + 1)
        step = h / n
        before, now = y, [p + step * q for p, q in zip(y, f0)]
        for _ in range(n - 1):
            before, now = now, [p + 2 * step * q for p, q in zip(before, slope(now))]
        # Gragg's last half step.
        entry = [(p + q + step * d) / 2 for p, q, d in zip(before, now, slope(now))]
        new = [entry]
        for i, old in enumerate(row):
            ratio = mp.mpf(n) / (2 * (k - i))
            new.append([p + (p - q) / (ratio**2 - 1) for p, q in zip(new[-1], old)])
        row = new
    return row[-1], max(abs(p - q) for p, q in zip(row[-1], row[-2]))


def extrapolation(problem, tolerance):
    """The reduced equations by extrapolation in many digits."""
    slope = equations.namespace(problem, mp.mpf, mp.cos, mp.sin, mp.exp)["reduced"]
    y, t, end = [mp.mpf(v) for v in problem.start], mp.mpf(0), mp.mpf(problem.duration)
    h = min(mp.mpf("0.5"), end)
    while t < end:
        h = min(h, end - t)
        new, error = extrapolated_step(lambda p: slope(*p), y, h)
        if error <= tolerance:
            y, t = new, t + h
        # The estimate is of the order of one column less.
        factor = (tolerance / max(error, mp.eps**2)) ** (mp.mpf(1) / (2 * COLUMNS - 1))
        h *= min(mp.mpf(2), max(mp.mpf("0.2"), mp.mpf("0.9") * factor))
    return tuple(y[:3])


def taylor(problem):
    """Full coordinates by heyoka's Taylor series in 128 bits: other equations by another method."""
    import heyoka as hy

    bits = 128
    real = lambda v: hy.real(v, bits)
    from .lines.heyoka_lines import system

    with mp.workdps(DIGITS):
        x, y, th, u, w = (mp.mpf(v) for v in problem.start)
        start = [mp.nstr(v, DIGITS) for v in (x, y, th, u * mp.cos(th), u * mp.sin(th), w)]
    solver = hy.taylor_adaptive(system(problem, "full", real), [hy.real(v, prec=bits) for v in start],
                                fp_type=hy.real, tol=hy.real("1e-33", prec=bits))
    solver.propagate_until(real(problem.duration))
    with mp.workdps(DIGITS):
        return tuple(mp.mpf(str(v)) for v in solver.state[:3])


def general(problem):
    """Any motion: extrapolation in 38 digits; its error from a looser run, and from `taylor` where heyoka is there."""
    with mp.workdps(DIGITS):
        end, looser = extrapolation(problem, TOLERANCE), extrapolation(problem, LOOSER)
        error, source = float(largest(looser, end)), "extrapolated midpoint rule in 38 digits (mpmath)"
        try:
            error = max(error, float(largest(taylor(problem), end)))
            source += ", checked by Taylor series in 128 bits (heyoka)"
        except (ImportError, AttributeError) as missing:
            source += f", heyoka's check missing ({missing})"
        return Reference(end, error, source)


def reference(problem):
    """The closed form where there is one, `general` elsewhere."""
    free = not problem.effects and problem.offset != 0.0 and problem.start[4] != 0.0
    return closed_form(problem) if free else general(problem)
