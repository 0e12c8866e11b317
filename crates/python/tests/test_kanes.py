"""Systems of `KanesMethod`, against SciPy on SymPy's own equations."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from sympy.physics.mechanics import KanesMethod, Particle, Point, ReferenceFrame, RigidBody, dynamicsymbols, inertia

import noslip

t = dynamicsymbols._t


class Kane(NamedTuple):
    """A system as SymPy has it, numbers for its symbols, and a start in coordinates and speeds."""

    method: Any
    values: dict[Any, float]
    q: list[float]
    u: list[float]


def pendulum_cart() -> Kane:
    """A cart on a spring with a damper, and a pendulum on it."""
    x, theta, u1, u2 = dynamicsymbols("x theta u1 u2")
    m1, m2, length, g, k, c = sp.symbols("m1 m2 l g k c", positive=True)
    frame, cart = ReferenceFrame("N"), Point("C")
    swing = frame.orientnew("A", "Axis", [theta, frame.z])
    swing.set_ang_vel(frame, u2 * frame.z)
    cart.set_vel(frame, u1 * frame.x)
    bob = cart.locatenew("B", -length * swing.y)
    bob.v2pt_theory(cart, frame, swing)
    loads = [
        (cart, (-k * x - c * u1) * frame.x),
        (bob, -m2 * g * frame.y),
        (swing, -c * u2 * frame.z),
    ]
    bodies = [Particle("cart", cart, m1), Particle("bob", bob, m2)]
    method = KanesMethod(frame, [x, theta], [u1, u2], [x.diff(t) - u1, theta.diff(t) - u2], bodies=bodies, forcelist=loads)
    return Kane(method, {m1: 1.0, m2: 0.4, length: 0.6, g: 9.81, k: 5.0, c: 0.2}, [0.1, 0.7], [0.3, -0.2])


def nonminimal_pendulum() -> Kane:
    """Two coordinates of a bob, the second one dependent by the length of the rod."""
    q1, q2, u1, u2 = dynamicsymbols("q1 q2 u1 u2")
    m, length, g = sp.symbols("m L g", positive=True)
    frame, bob = ReferenceFrame("N"), Point("P")
    bob.set_vel(frame, u1 * frame.x + u2 * frame.y)
    held = q1**2 + q2**2 - length**2
    method = KanesMethod(
        frame,
        q_ind=[q2],
        q_dependent=[q1],
        u_ind=[u2],
        u_dependent=[u1],
        kd_eqs=[q2.diff(t) - u2, q1.diff(t) - u1],
        configuration_constraints=[held],
        velocity_constraints=[q1 * u1 + q2 * u2],
        bodies=[Particle("bob", bob, m)],
        forcelist=[(bob, m * g * frame.x)],
    )
    return Kane(method, {m: 1.0, length: 1.0, g: 9.81}, [0.6, 0.8], [0.4, -0.3])


def disc(placed: bool) -> Kane:
    """A rolling disc, its speeds those about axes that lean with it; with the place of its contact, or without."""
    q1, q2, q3, x, y = dynamicsymbols("q1 q2 q3 x y")
    u1, u2, u3, u4, u5 = dynamicsymbols("u1:6")
    m, r, g = sp.symbols("m r g", positive=True)
    frame = ReferenceFrame("N")
    yaw = frame.orientnew("Y", "Axis", [q1, frame.z])
    lean = yaw.orientnew("L", "Axis", [q2, yaw.x])
    turned = lean.orientnew("R", "Axis", [q3, lean.y])
    turning = turned.ang_vel_in(frame)
    speeds = u1 * lean.x + u2 * lean.y + u3 * lean.z
    turned.set_ang_vel(frame, speeds)
    kinematics = [turning.dot(axis) - u for axis, u in zip(lean, (u1, u2, u3), strict=True)]
    centre = Point("Dmc")
    body = RigidBody("disc", centre, turned, m, (inertia(lean, m * r**2 / 4, m * r**2 / 2, m * r**2 / 4), centre))
    loads = [(centre, -m * g * frame.z)]
    values = {m: 1.0, r: 0.4, g: 9.81}
    if not placed:
        contact = Point("C")
        contact.set_vel(frame, 0)
        centre.set_pos(contact, r * lean.z)
        centre.v2pt_theory(contact, frame, turned)
        method = KanesMethod(frame, [q1, q2, q3], [u1, u2, u3], kinematics, bodies=[body], forcelist=loads)
        return Kane(method, values, [0.2, 0.1, 0.0], [0.0, 3.0, 0.4])
    centre.set_vel(frame, u4 * frame.x + u5 * frame.y + (r * lean.z).dt(frame))
    rim = centre.vel(frame) + speeds.cross(-r * lean.z)
    method = KanesMethod(
        frame,
        [q1, q2, q3, x, y],
        u_ind=[u1, u2, u3],
        u_dependent=[u4, u5],
        kd_eqs=[*kinematics, x.diff(t) - u4, y.diff(t) - u5],
        velocity_constraints=[rim.dot(frame.x), rim.dot(frame.y)],
        bodies=[body],
        forcelist=loads,
    )
    rows, q = method._k_nh.subs(values), [0.2, 0.1, 0.0, 0.0, 0.0]
    numbers = np.array(rows.subs(dict(zip([q1, q2, q3, x, y], q, strict=True))), float)
    free = [0.0, 3.0, 0.4]
    return Kane(method, values, q, [*free, *-np.linalg.solve(numbers[:, 3:], numbers[:, :3] @ free)])


def placed_disc() -> Kane:
    """A rolling disc with the place of its contact on the ground."""
    return disc(placed=True)


def bead() -> Kane:
    """A bead in a bowl, by its place, that also obeys a row which is no rate of a position; the time comes before its coordinates."""
    x, y, z, u1, u2, u3 = dynamicsymbols("x y z u1 u2 u3")
    m, g = sp.symbols("m g", positive=True)
    frame, place = ReferenceFrame("N"), Point("P")
    place.set_vel(frame, u1 * frame.x + u2 * frame.y + u3 * frame.z)
    method = KanesMethod(
        frame,
        q_ind=[x, y],
        q_dependent=[z],
        u_ind=[u1],
        u_dependent=[u2, u3],
        kd_eqs=[x.diff(t) - u1, y.diff(t) - u2, z.diff(t) - u3],
        configuration_constraints=[z - x**4 / 4 - y**2 / 2],
        velocity_constraints=[u3 - x**3 * u1 - y * u2, u2 - sp.sin(x) * u1 / 2],
        bodies=[Particle("bead", place, m)],
        forcelist=[(place, -m * g * frame.z)],
    )
    return Kane(method, {m: 1.0, g: 10.0}, [1.0, 0.3, 0.295], [0.2, 0.1 * np.sin(1.0), 0.2 + 0.03 * np.sin(1.0)])


def sleigh(names: str, **settings: Any) -> Kane:
    """A sleigh, whose blade is the dependent speed."""
    x, y, theta, u, v, w = dynamicsymbols(f"{names} u v w")
    m, inertia_, offset = sp.symbols("m J a", positive=True)
    frame = ReferenceFrame("N")
    body = frame.orientnew("A", "Axis", [theta, frame.z])
    body.set_ang_vel(frame, w * frame.z)
    origin, blade = Point("O"), Point("P")
    origin.set_vel(frame, 0)
    blade.set_vel(frame, u * body.x + v * body.y)
    centre = blade.locatenew("C", offset * body.x)
    centre.v2pt_theory(blade, frame, body)
    rates = [x.diff(t) - u * sp.cos(theta) + v * sp.sin(theta), y.diff(t) - u * sp.sin(theta) - v * sp.cos(theta)]
    method = KanesMethod(
        frame,
        [x, y, theta],
        [u, w],
        u_dependent=[v],
        kd_eqs=[*rates, theta.diff(t) - w],
        velocity_constraints=[v],
        bodies=[RigidBody("sleigh", centre, body, m, (inertia(body, 0, 0, inertia_), centre))],
        **settings,
    )
    return Kane(method, {m: 1.0, inertia_: 1.0, offset: 0.5}, [0.0, 0.0, 0.3], [-1.0, 0.1, 0.0])


def late_sleigh() -> Kane:
    """A sleigh whose coordinates have names after that of the time."""
    return sleigh("x y theta")


def ball(rolling: bool) -> Any:
    """A ball on a turntable: its angular velocity that of rolling, or about the vertical, of an angle."""
    x, y, phi, u1, u2, u3 = dynamicsymbols("p q phi u1 u2 u3")
    m, r, turning = sp.symbols("m r W")
    frame, turned, centre = ReferenceFrame("N"), ReferenceFrame("B"), Point("C")
    centre.set_vel(frame, u1 * frame.x + u2 * frame.y)
    rolled = (turning * x - u2) / r * frame.x + (u1 + turning * y) / r * frame.y
    turned.set_ang_vel(frame, rolled if rolling else u3 * frame.z)
    moment = m * r**2 * 2 / 5
    body = RigidBody("ball", centre, turned, m, (inertia(frame, moment, moment, moment), centre))
    rates = [x.diff(t) - u1, y.diff(t) - u2, phi.diff(t) - u3]
    return KanesMethod(frame, [x, y, phi], [u1, u2, u3], rates, bodies=[body])


@pytest.mark.parametrize(
    "make", [pendulum_cart, nonminimal_pendulum, placed_disc, bead, late_sleigh], ids=lambda make: str(make.__name__)
)
def test_kanes_method_agrees_with_scipy(make: Callable[[], Kane]) -> None:
    method, values, q, u = make()
    method.kanes_equations()
    names = [*method.q, *method.u]
    equations = sp.lambdify([t, names], [matrix.subs(values) for matrix in (method.mass_matrix_full, method.forcing_full)], "numpy")

    def rate(time: float, state: Any) -> Any:
        matrix, vector = equations(time, state)
        return np.linalg.solve(np.array(matrix, float), np.array(vector, float).ravel())

    start = [*q, *u]
    end = solve_ivp(rate, (0.0, 1.0), start, method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    moving = sp.lambdify([names], [method.kindiffdict()[x.diff(t)].subs(values) for x in method.q], "numpy")
    rates = dict(zip(method.q, moving(start), strict=True))
    system = noslip.System.from_kanes(method, values, q=q, v=rates)
    run = system.run(method="gauss16", step=0.01, duration=1.0)
    made = [run[name][-1] for name in system.coordinates] + [run[f"{name}'"][-1] for name in system.coordinates]
    np.testing.assert_allclose(made, [*end[: len(q)], *moving(end)], atol=1e-9, rtol=1e-9)


def test_velocities_with_constraints_put_into_them_are_refused() -> None:
    with pytest.raises(noslip.RequestError, match="velocity of Dmc is not that of a place.*velocity_constraints"):
        noslip.System.from_kanes(disc(placed=False).method, {})


def test_angular_velocities_with_constraints_put_into_them_are_refused() -> None:
    with pytest.raises(noslip.RequestError, match="angular velocity of B is not that of an attitude in the coordinates"):
        noslip.System.from_kanes(ball(rolling=True))
    # About an axis that stays, any rate is that of an angle.
    assert noslip.System.from_kanes(ball(rolling=False), {"m": 1.0, "r": 0.2}).coordinates == ["p", "q", "phi"]


def test_positions_are_kept_beside_further_rows() -> None:
    method, values, q, _ = bead()
    system = noslip.System.from_kanes(method, values, q=q, outputs={"miss": "z - x^4/4 - y^2/2"})
    assert system.text.count("positions") == 1
    # Rates alone would leave the bowl by 4e-5 m.
    assert np.abs(system.run(step=0.01, duration=2.0)["miss"]).max() < 1e-13


def test_constraints_on_accelerations_are_refused_unless_they_are_those_on_velocities() -> None:
    v = dynamicsymbols("v")
    assert noslip.System.from_kanes(sleigh("x y b", acceleration_constraints=[v.diff(t)]).method, late_sleigh().values)
    with pytest.raises(noslip.RequestError, match="constraint on accelerations"):
        noslip.System.from_kanes(sleigh("x y b", acceleration_constraints=[v.diff(t) - 1]).method)


@pytest.mark.parametrize("make", [noslip.System.from_kanes, noslip.System.from_lagranges])
@pytest.mark.parametrize("wrong", [5, None, "x'^2"])
def test_what_is_no_method_of_sympy_is_refused(make: Callable[[Any], Any], wrong: object) -> None:
    with pytest.raises(noslip.RequestError, match="accepted is a sympy.physics.mechanics") as caught:
        make(wrong)
    assert isinstance(caught.value, TypeError)
