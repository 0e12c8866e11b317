"""Reference values of the free Chaplygin sleigh, from its closed form in 50-digit arithmetic.

Regenerate, from this directory:

    pip install mpmath
    python3 exact.py > exact.txt

A row holds the inputs m I a x0 y0 theta0 u0 omega0 t, each exactly the double that is printed, and the state
x y theta u omega at time t to 32 digits, then the length of the blade's path. The path is integrated by mpmath's
adaptive quadrature of tanh(s) exp(i sigma (gd s - gd s0)) over s, in pieces of at most two radians; beyond |s| = 140,
where 1 - tanh and the remaining turn are below 1e-58, it is a straight line. `check` compares the result with the
formula by the hypergeometric function and with an integration of the equations of motion.
"""

import sys
from mpmath import asinh, atan, cos, cosh, exp, expj, hyp2f1, log, mp, mpc, mpf, nstr, odefun, quad, sech, sign, sin, sqrt, tanh

mp.dps = 50
STRAIGHT = mpf(140)


def gd(s):
    return 2 * atan(tanh(s / 2))


def gd_difference(s, s0):
    """gd s - gd s0, by the atan of a quotient of differences."""
    return 2 * atan(mp.sinh((s - s0) / 2) / cosh((s + s0) / 2))


def path(s0, s1, sigma):
    """Integral of tanh(s) exp(i sigma (gd s - gd s0)) over s."""
    if s1 < s0:
        # From the other end, with the phase of this one.
        return -path(s1, s0, sigma) * expj(sigma * gd_difference(s1, s0))
    total = mpc(0)
    # Straight lines before and after.
    if s0 < -STRAIGHT:
        end = min(s1, -STRAIGHT)
        total -= end - s0
    if s1 > STRAIGHT:
        begin = max(s0, STRAIGHT)
        total += (s1 - begin) * expj(sigma * gd_difference(s1, s0))
    left, right = max(s0, -STRAIGHT), min(s1, STRAIGHT)
    if left < right:
        turn = sigma * gd_difference(right, left)
        pieces = int(max(turn / 2, (right - left) / 2)) + 1
        # Equal in the sum of the turn and the distance: found by bisection.
        measure = lambda s: sigma * gd_difference(s, left) + (s - left)
        whole = measure(right)
        knots = [left]
        for i in range(1, 2 * pieces):
            lo, hi = knots[-1], right
            if right - left < mpf(10) ** -3:
                knots.append(left + (right - left) * i / (2 * pieces))
                continue
            for _ in range(40):
                mid = (lo + hi) / 2
                if measure(mid) < whole * i / (2 * pieces):
                    lo = mid
                else:
                    hi = mid
            knots.append(lo)
        knots.append(right)
        total += quad(lambda s: tanh(s) * expj(sigma * gd_difference(s, s0)), knots)
    return total


def log_cosh_length(s0, s1):
    """Integral of |tanh| between two points."""
    primitive = lambda s: sign(s) * (abs(s) + mp.log1p(exp(-2 * abs(s))) - log(2))
    return abs(primitive(s1) - primitive(s0))


def state(row):
    m, inertia, a, x0, y0, theta0, u0, omega0, t = [mpf(v) for v in row]
    j = inertia + m * a * a
    k = sqrt(j / m)
    if omega0 == 0:
        z = mpc(x0, y0) + u0 * t * expj(theta0)
        return [z.real, z.imag, theta0, u0, omega0, abs(u0 * t)]
    if a == 0:
        z = mpc(x0, y0) + u0 / omega0 * expj(theta0) * (expj(omega0 * t) - 1) / mpc(0, 1)
        return [z.real, z.imag, theta0 + omega0 * t, u0, omega0, abs(u0 * t)]
    speed = sqrt(u0**2 + (k * omega0) ** 2)
    kappa = a * speed / k**2
    s0 = asinh(u0 / (k * abs(omega0)))
    s = s0 + kappa * t
    sigma = k / abs(a)
    z = path(s0, s, sigma)
    if omega0 * a < 0:
        z = z.conjugate()
    z = mpc(x0, y0) + k**2 / a * expj(theta0) * z
    theta = theta0 + sign(omega0) * k / a * gd_difference(s, s0)
    length = abs(k**2 / a) * log_cosh_length(s0, s)
    return [z.real, z.imag, theta, speed * tanh(s), sign(omega0) * speed / k * sech(s), length]


def check():
    """The quadrature against the hypergeometric function, and everything against the equations of motion."""
    sigma, s0, s1 = sqrt(mpf("5.3")), mpf("-2.5"), mpf("3.25")

    def primitive(phi):
        e = expj(2 * phi)
        return expj(sigma * phi) * (1 / sigma - 2 / (sigma + 2) * e * hyp2f1(1, sigma / 2 + 1, sigma / 2 + 2, -e))

    formula = (primitive(gd(s1)) - primitive(gd(s0))) * expj(-sigma * gd(s0))
    assert abs(path(s0, s1, sigma) - formula) < mpf(10) ** -45, (path(s0, s1, sigma), formula)

    mp.dps = 30
    for a, omega0 in [(0.4, 0.7), (-0.4, 0.7), (0.4, -0.7), (-0.4, -0.7)]:
        row = [1.3, 0.8, a, 0.3, -0.2, 0.5, -0.6, omega0, 3.0]
        m, inertia, a, x0, y0, theta0, u0, omega0, t = [mpf(v) for v in row]
        c = m * a / (inertia + m * a * a)
        field = lambda _, q: [q[3] * cos(q[2]), q[3] * sin(q[2]), q[4], a * q[4] ** 2, -c * q[3] * q[4]]
        flow = odefun(field, 0, [x0, y0, theta0, u0, omega0])(t)
        for ours, theirs in zip(state(row), flow):
            assert abs(ours - theirs) < mpf(10) ** -25, (row, ours, theirs)
    mp.dps = 50


ROWS = [
    # m, I, a, x0, y0, theta0, u0, omega0, t
    # The turning point as the start, sigma = 2: U = 0.8.
    [1, 3, 1, 0, 0, 0, 0, 0.4, 10],
    [1, 3, 1, 0, 0, 0, 0, 0.4, -10],
    [1, 3, 1, 0, 0, 0, 0, 0.4, 0.001],
    # The run whose start is (u, omega) = (1, 0.3) with m = I = 1: the blade starts half a metre behind the centre of mass.
    [1, 1, 0.5, -0.5, 0, 0, 1, 0.3, 10],
    # All signs.
    [1.3, 0.8, 0.4, 0.3, -0.2, 0.5, -0.6, 1.1, 2],
    [1.3, 0.8, 0.4, 0.3, -0.2, 0.5, -0.6, -1.1, 7],
    [1.3, 0.8, -0.4, 0.3, -0.2, 0.5, -0.6, 1.1, 7],
    [1.3, 0.8, -0.4, 0.3, -0.2, 0.5, 0.6, -1.1, 7],
    [1.3, 0.8, -0.4, 0.3, -0.2, 0.5, 0.6, 1.1, -3],
    [1.3, 0.8, 0.4, 0.3, -0.2, 0.5, 0.6, 1.1, -30],
    # Balanced, and straight.
    [2, 0.5, 0, 1, 2, 0.25, 1.5, -0.75, 3],
    [2, 0.5, 0, 1, 2, 0.25, 1.5, -0.75, 1000],
    [2, 0.5, 0.3, 1, 2, 0.25, -1.5, 0, 1000],
    # Nearly balanced.
    [2, 0.5, 1e-9, 1, 2, 0.25, 1.5, -0.75, 3],
    [2, 0.5, 1e-9, 1, 2, 0.25, 1.5, -0.75, 400],
    [2, 0.5, 1e-9, 1, 2, 0.25, 0, -0.75, 40],
    [2, 0.5, -1e-12, 1, 2, 0.25, 1.5, 0.75, 100],
    [1, 1, 1e-3, 0, 0, 0, 0.2, 1, 250],
    [1, 1, 0.01, 0, 0, 0, -1, 0.1, 300],
    [1, 1, 0.01, 0, 0, 0, -1, 0.1, 1000],
    [1, 1, 0.01, 0, 0, 0, -1, 0.001, 2000],
    # The inertia all in the offset: sigma = 1 + 5e-9.
    [1, 1e-8, 1, 0, 0, 0, -1, 0.01, 8],
    # Backwards with hardly a spin: before, at and after the flip.
    [1, 1, 0.5, 0, 0, 0, -1, 1e-8, 20],
    [1, 1, 0.5, 0, 0, 0, -1, 1e-8, 47],
    [1, 1, 0.5, 0, 0, 0, -1, 1e-8, 100],
    [1, 1, 0.5, 0, 0, 0, -1, -1e-20, 100],
    [1, 1, 0.5, 0, 0, 0, -1, -1e-20, 116.5],
    [1, 1, 0.5, 0, 0, 0, -1, -1e-20, 240],
    [1, 1, 0.5, 0, 0, 0, -1, 1e-300, 1000],
    [1, 1, 0.5, 0, 0, 0, -1, 1e-300, 1728.5],
    [1, 1, 0.5, 0, 0, 0, -1, 1e-300, 1730],
    [1, 1, 0.5, 0, 0, 0, -1, 1e-300, 3000],
    [1, 1, 0.5, 0, 0, 0, -1, 1e-300, 1e6],
    [1, 1, -0.7, 0, 0, 1, 1, 1e-300, 1500],
    [3, 1, 0.7, 0, 0, 1, 1, 1e-300, -1000.5],
    [3, 1, 0.7, 0, 0, 1, 1, 1e-100, 300],
    # Long.
    [1, 1, 0.5, 0, 0, 0, -1, 0.1, 1000],
    [1, 1, 0.5, 0, 0, 0, -1, 0.1, 1e6],
    [1, 1, 0.5, 0, 0, 0, -1, 0.1, -1e6],
    [1.3, 0.8, 0.05, 0, 0, 2, 0.3, -1.7, 1e6],
    [1.3, 0.8, 0.05, 0, 0, 2, 0.3, -1.7, 1e3],
    # Other sizes: a coin, a ship.
    [5e-3, 4e-7, 3e-3, 0.01, 0.02, 1, -0.2, 15, 0.4],
    [2e7, 6e10, -25, 1e4, -3e4, 4, 6, 0.004, 900],
]


def main():
    check()
    print("# m I a x0 y0 theta0 u0 omega0 t | x y theta u omega length -- written by exact.py, do not edit")
    for row in ROWS:
        inputs = " ".join(repr(float(v)) for v in row)
        print(inputs, "|", " ".join(nstr(v, 32, min_fixed=1, max_fixed=0) for v in state(row)))
        sys.stdout.flush()


main()
