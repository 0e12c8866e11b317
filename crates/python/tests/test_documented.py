"""The systems of the documentation of `sympy.physics.mechanics`, run as they stand there, against SciPy on SymPy's own equations."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from sympy.physics.mechanics import (
    LagrangesMethod,
    Lagrangian,
    Particle,
    Point,
    ReferenceFrame,
    RigidBody,
    dynamicsymbols,
    inertia,
)

import noslip

t = dynamicsymbols._t


class Documented(NamedTuple):
    """A system as SymPy has it, numbers for its symbols, and a start."""

    method: Any
    values: dict[Any, float]
    q: list[float]
    v: list[float]


def symbols(names: str) -> Any:
    return sp.symbols(names, positive=True)


def mass_spring_damper() -> Documented:
    """`LagrangesMethod` and the introduction: a mass, a spring and a damper."""
    q = dynamicsymbols("q")
    m, k, b = symbols("m k b")
    frame, point = ReferenceFrame("N"), Point("P")
    point.set_vel(frame, q.diff(t) * frame.x)
    mass = Particle("mass", point, m)
    mass.potential_energy = k * q**2 / 2
    forces = [(point, -b * q.diff(t) * frame.x)]
    method = LagrangesMethod(Lagrangian(frame, mass), [q], forcelist=forces, frame=frame)
    return Documented(method, {m: 1.0, k: 4.0, b: 0.3}, [0.5], [0.2])


def duffing() -> Documented:
    """The Duffing oscillator with a pendulum on it."""
    x, theta = dynamicsymbols("x theta")
    m, mass, length, g, alpha, beta, delta = symbols("m M l g alpha beta delta")
    frame, block, bob = ReferenceFrame("N"), Point("B"), Point("P")
    block.set_vel(frame, x.diff(t) * frame.x)
    velocity = (x.diff(t) + length * theta.diff(t) * sp.cos(theta)) * frame.x + length * theta.diff(t) * sp.sin(theta) * frame.y
    bob.set_vel(frame, velocity)
    first, second = Particle("block", block, mass), Particle("bob", bob, m)
    first.potential_energy = alpha * x**2 / 2 + beta * x**4 / 4
    second.potential_energy = -m * g * length * sp.cos(theta)
    forces = [(block, -delta * x.diff(t) * frame.x)]
    method = LagrangesMethod(Lagrangian(frame, first, second), [x, theta], forcelist=forces, frame=frame)
    values = {m: 0.4, mass: 1.0, length: 0.6, g: 9.81, alpha: 2.0, beta: 5.0, delta: 0.1}
    return Documented(method, values, [0.4, 0.7], [0.0, 0.3])


def pendulum() -> Documented:
    """A simple pendulum in one angle."""
    q = dynamicsymbols("q")
    m, length, g = symbols("m l g")
    lagrangian = m * length**2 * q.diff(t) ** 2 / 2 + m * g * length * sp.cos(q)
    return Documented(LagrangesMethod(lagrangian, [q]), {m: 1.0, length: 0.8, g: 9.81}, [1.9], [0.4])


def nonminimal_pendulum() -> Documented:
    """Nonminimal coordinates pendulum: two coordinates of the bob, and the length of the rod as a constraint."""
    q1, q2 = dynamicsymbols("q1:3")
    m, length, g = symbols("m L g")
    frame, bob = ReferenceFrame("N"), Point("P")
    bob.set_vel(frame, q1.diff(t) * frame.x + q2.diff(t) * frame.y)
    mass = Particle("bob", bob, m)
    held = [q1**2 + q2**2 - length**2]
    forces = [(bob, m * g * frame.x)]
    method = LagrangesMethod(Lagrangian(frame, mass), [q1, q2], hol_coneqs=held, forcelist=forces, frame=frame)
    return Documented(method, {m: 1.0, length: 1.0, g: 9.81}, [0.8, 0.6], [-0.3, 0.4])


def double_pendulum() -> Documented:
    """Two rods of particles, as in the examples of `LagrangesMethod`."""
    q1, q2 = dynamicsymbols("q1 q2")
    m, length, g = symbols("m l g")
    frame = ReferenceFrame("N")
    first, second = frame.orientnew("A", "Axis", [q1, frame.z]), frame.orientnew("B", "Axis", [q2, frame.z])
    origin = Point("O")
    origin.set_vel(frame, 0)
    p = origin.locatenew("P", length * first.x)
    r = p.locatenew("R", length * second.x)
    p.v2pt_theory(origin, frame, first)
    r.v2pt_theory(p, frame, second)
    particles = [Particle("p", p, m), Particle("r", r, m)]
    particles[0].potential_energy = -m * g * length * sp.cos(q1)
    particles[1].potential_energy = -m * g * length * (sp.cos(q1) + sp.cos(q2))
    return Documented(LagrangesMethod(Lagrangian(frame, *particles), [q1, q2]), {m: 1.0, length: 0.5, g: 9.81}, [0.6, -0.3], [0.0, 1.0])


def multi_degree_holonomic() -> Documented:
    """Multi degree of freedom holonomic system: a bar on a spring and a damper, a particle that slides on it, and a driving torque."""
    q1, q2, q3 = dynamicsymbols("q1 q2 q3")
    k, c, length, m, mass, g = symbols("k c L m M g")
    frame = ReferenceFrame("N")
    bar = frame.orientnew("A", "Axis", [q2, frame.z])
    arm = frame.orientnew("B", "Axis", [q3, frame.z])
    origin = Point("O")
    origin.set_vel(frame, 0)
    slider = origin.locatenew("S", q1 * frame.x)
    slider.set_vel(frame, q1.diff(t) * frame.x)
    centre = slider.locatenew("G", length / 2 * bar.y)
    centre.v2pt_theory(slider, frame, bar)
    joint = slider.locatenew("J", length * bar.y)
    joint.v2pt_theory(slider, frame, bar)
    end = joint.locatenew("E", length * arm.y)
    end.v2pt_theory(joint, frame, arm)
    body = RigidBody("bar", centre, bar, mass, (inertia(bar, 0, 0, mass * length**2 / 12), centre))
    block, bob = Particle("block", slider, m), Particle("bob", end, m)
    block.potential_energy = k * q1**2 / 2
    body.potential_energy = mass * g * length / 2 * sp.cos(q2)
    bob.potential_energy = m * g * length * (sp.cos(q2) + sp.cos(q3))
    forces = [(slider, -c * q1.diff(t) * frame.x), (bar, sp.cos(t) * frame.z)]
    method = LagrangesMethod(Lagrangian(frame, block, body, bob), [q1, q2, q3], forcelist=forces, frame=frame)
    return Documented(method, {k: 6.0, c: 0.4, length: 0.7, m: 0.5, mass: 1.2, g: 9.81}, [0.1, 2.8, 3.3], [0.0, 0.4, -0.2])


def rolling_disc() -> Documented:
    """A rolling disc: yaw, lean and spin, and the contact's place on the ground, where it does not slip."""
    q1, q2, q3, x, y = dynamicsymbols("q1 q2 q3 x y")
    m, r, g = symbols("m r g")
    frame = ReferenceFrame("N")
    yaw = frame.orientnew("Y", "Axis", [q1, frame.z])
    lean = yaw.orientnew("L", "Axis", [q2, yaw.x])
    disc = lean.orientnew("R", "Axis", [q3, lean.y])
    centre = Point("Dmc")
    contact = x * frame.x + y * frame.y
    centre.set_vel(frame, (contact + r * lean.z).dt(frame))
    body = RigidBody("disc", centre, disc, m, (inertia(lean, m * r**2 / 4, m * r**2 / 2, m * r**2 / 4), centre))
    body.potential_energy = m * g * r * sp.cos(q2)
    # The rim's lowest point is at rest.
    velocity = centre.vel(frame) + disc.ang_vel_in(frame).cross(-r * lean.z)
    rows = [sp.trigsimp(velocity.dot(frame.x)), sp.trigsimp(velocity.dot(frame.y))]
    method = LagrangesMethod(Lagrangian(frame, body), [q1, q2, q3, x, y], nonhol_coneqs=rows)
    heading, tilt, turning, spin = 0.2, 0.1, 0.4, 3.0
    # Upright it would roll ahead at r spin; leaning, the contact moves by what the rows leave for it.
    moving = sp.Matrix(rows).jacobian([q1.diff(t), q2.diff(t), q3.diff(t), x.diff(t), y.diff(t)])
    numbers = np.array(moving.subs({q1: heading, q2: tilt, r: 0.4}), float)
    end = -np.linalg.solve(numbers[:, 3:], numbers[:, :3] @ [turning, 0.0, spin])
    return Documented(method, {m: 1.0, r: 0.4, g: 9.81}, [heading, tilt, 0.0, 0.0, 0.0], [turning, 0.0, spin, *end])


def chaos_pendulum() -> Documented:
    """The chaos pendulum of the joints' tutorial: a plate that turns about a rod that swings."""
    theta, phi = dynamicsymbols("theta phi")
    m_a, m_b, rod, plate, wide, g = symbols("mA mB lA lB w g")
    frame = ReferenceFrame("N")
    swing = frame.orientnew("A", "Axis", [theta, frame.y])
    turn = swing.orientnew("B", "Axis", [phi, swing.z])
    origin = Point("O")
    origin.set_vel(frame, 0)
    first, second = origin.locatenew("Ao", rod / 2 * swing.z), origin.locatenew("Bo", plate * swing.z)
    first.v2pt_theory(origin, frame, swing)
    second.v2pt_theory(origin, frame, swing)
    i_a, height = m_a * rod**2 / 12, rod
    figures = (m_b * height**2 / 12, m_b * (wide**2 + height**2) / 12, m_b * wide**2 / 12)
    bar = RigidBody("rod", first, swing, m_a, (inertia(swing, i_a, i_a, 0), first))
    sheet = RigidBody("plate", second, turn, m_b, (inertia(turn, *figures), second))
    bar.potential_energy = -m_a * g * rod / 2 * sp.cos(theta)
    sheet.potential_energy = -m_b * g * plate * sp.cos(theta)
    method = LagrangesMethod(Lagrangian(frame, bar, sheet), [theta, phi])
    return Documented(method, {m_a: 0.01, m_b: 0.1, rod: 0.075, plate: 0.1375, wide: 0.2, g: 9.81}, [1.57, 0.0087], [0.0, 0.0])


def four_bar() -> Documented:
    """The four bar linkage: three rods with a torsion spring, and a loop that two constraints on positions close."""
    q1, q2, q3 = dynamicsymbols("q1:4")
    m, k = symbols("m k")
    lengths = [0.4, 1.0, 0.7, 1.1]
    frame = ReferenceFrame("N")
    place = Point("O")
    place.set_vel(frame, 0)
    bodies, angle = [], sp.Integer(0)
    for index, (q, length) in enumerate(zip((q1, q2, q3), lengths, strict=False)):
        angle = angle + q
        axes = frame.orientnew(f"A{index}", "Axis", [angle, frame.z])
        centre = place.locatenew(f"G{index}", length / 2 * axes.x)
        centre.v2pt_theory(place, frame, axes)
        bodies.append(RigidBody(f"rod{index}", centre, axes, m, (inertia(axes, 0, 0, m * length**2 / 12), centre)))
        following = place.locatenew(f"J{index}", length * axes.x)
        following.v2pt_theory(place, frame, axes)
        place = following
    bodies[0].potential_energy = k * q2**2 / 2
    end = [sum(length * f(a) for length, a in zip(lengths, (q1, q1 + q2, q1 + q2 + q3), strict=False)) for f in (sp.cos, sp.sin)]
    held = [end[0] - lengths[3], end[1]]
    numbers = sp.nsolve([row.subs(q1, 0.9) for row in held], [q2, q3], [-0.6, -1.6])
    method = LagrangesMethod(Lagrangian(frame, *bodies), [q1, q2, q3], hol_coneqs=held)
    q = [0.9, *(float(number) for number in numbers)]
    rows = sp.Matrix(held).jacobian([q1, q2, q3]).subs(dict(zip([q1, q2, q3], q, strict=True)))
    others = -np.linalg.solve(np.array(rows[:, 1:], float), np.array(rows[:, 0], float).ravel() * 0.8)
    return Documented(method, {m: 1.0, k: 2.0}, q, [0.8, *others])


def quarter_car() -> Documented:
    """Two masses on springs and dampers over a road: a car and its wheel."""
    x, z = dynamicsymbols("x z")
    m, mu, k, c, tyre = symbols("m mu k c kt")
    road = sp.sin(3 * t) / 20
    lagrangian = m * x.diff(t) ** 2 / 2 + mu * z.diff(t) ** 2 / 2 - k * (x - z) ** 2 / 2 - tyre * (z - road) ** 2 / 2
    frame, body, wheel = ReferenceFrame("N"), Point("B"), Point("W")
    body.set_vel(frame, x.diff(t) * frame.x)
    wheel.set_vel(frame, z.diff(t) * frame.x)
    damper = c * (x.diff(t) - z.diff(t)) * frame.x
    method = LagrangesMethod(lagrangian, [x, z], forcelist=[(body, -damper), (wheel, damper)], frame=frame)
    return Documented(method, {m: 2.0, mu: 0.3, k: 15.0, c: 0.8, tyre: 90.0}, [0.05, 0.0], [0.0, 0.1])


SYSTEMS: list[Callable[[], Documented]] = [
    mass_spring_damper,
    duffing,
    pendulum,
    nonminimal_pendulum,
    double_pendulum,
    multi_degree_holonomic,
    rolling_disc,
    chaos_pendulum,
    four_bar,
    quarter_car,
]


def slope(method: Any, values: dict[Any, float]) -> Any:
    """SymPy's own equations of motion, with its multipliers, as a function of SciPy's."""
    method.form_lagranges_equations()
    q, v = list(method.q), list(method.q.diff(t))
    n = len(q)
    named = sp.symbols(f"_q0:{n} _v0:{n}")
    plain = {**dict(zip(v, named[n:], strict=True)), **dict(zip(q, named[:n], strict=True))}
    both = [matrix.xreplace(plain).subs(values) for matrix in (method.mass_matrix_full, method.forcing_full)]
    equations = sp.lambdify((t, named), both, "numpy", cse=True)

    def rate(time: float, state: Any) -> Any:
        matrix, vector = equations(time, state)
        return np.linalg.solve(np.array(matrix, float), np.array(vector, float).ravel())[: 2 * n]

    return rate


@pytest.mark.parametrize("make", SYSTEMS, ids=lambda make: str(make.__name__))
def test_a_documented_system_agrees_with_scipy(make: Callable[[], Documented]) -> None:
    method, values, q, v = make()
    rate = slope(method, values)
    system = noslip.System.from_lagranges(method, values, q=q, v=v)
    duration = 1.0
    run = system.run(method="gauss16", step=0.01, duration=duration)
    end = solve_ivp(rate, (0.0, duration), [*q, *v], method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    made = [run[name][-1] for name in system.coordinates] + [run[f"{name}'"][-1] for name in system.coordinates]
    np.testing.assert_allclose(made, end, atol=1e-9, rtol=1e-9)
