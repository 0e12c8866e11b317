"""Systems of one's own, as text and as SymPy expressions, against SciPy on SymPy's own equations."""

import copy
import pickle
from typing import Any

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from sympy.physics.mechanics import LagrangesMethod, dynamicsymbols

import noslip

t = dynamicsymbols._t


def oracle(coordinates: list[Any], lagrangian: Any, rows: list[Any], forces: dict[Any, Any], values: dict[Any, float]) -> Any:
    """The equations of motion with multipliers, from SymPy, as a function of SciPy's."""
    q = sp.Matrix(coordinates)
    v = q.diff(t)
    n, m = len(q), len(rows)
    a = sp.Matrix(rows).jacobian(v) if m else sp.zeros(0, n)
    rest = sp.Matrix(rows).subs(dict(zip(v, [0] * n))) if m else sp.zeros(0, 1)
    mass = sp.Matrix([lagrangian]).jacobian(v).T.jacobian(v)
    momentum = sp.Matrix([lagrangian]).jacobian(v).T
    qs, vs = sp.symbols(f"q0:{n}"), sp.symbols(f"v0:{n}")
    names = dict(zip(list(v) + list(q), vs + qs, strict=True))

    def plain(matrix: Any) -> Any:
        return matrix.subs(dict(list(names.items())[:n])).subs(dict(list(names.items())[n:])).subs(values)

    force = sp.Matrix([forces.get(x, 0) for x in coordinates])
    right = plain(sp.Matrix([lagrangian]).jacobian(q).T + force)
    p = plain(momentum)
    right -= p.jacobian(sp.Matrix(qs)) * sp.Matrix(vs) + p.diff(t)
    a, rest = plain(a), plain(rest)
    bias = sp.zeros(m, 1)
    if m:
        row = a * sp.Matrix(vs) + rest
        bias = row.jacobian(sp.Matrix(qs)) * sp.Matrix(vs) + row.diff(t)
    saddle = sp.Matrix(sp.BlockMatrix([[plain(mass), a.T], [a, sp.zeros(m, m)]])) if m else plain(mass)
    system = sp.lambdify((t, qs, vs), (saddle, sp.Matrix([*right, *(-bias)])), "numpy")

    def slope(time: float, state: Any) -> Any:
        matrix, vector = system(time, state[:n], state[n:])
        solution = np.linalg.solve(np.array(matrix, float), np.array(vector, float).ravel())
        return np.concatenate([state[n:], solution[:n]])

    return slope


def agrees(system: noslip.System, slope: Any, duration: float) -> None:
    run = system.run(method="gauss16", step=0.05, duration=duration)
    names = system.coordinates
    start = np.array([run[name][0] for name in names] + [run[f"{name}'"][0] for name in names])
    end = solve_ivp(slope, (0.0, duration), start, method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    made = np.array([run[name][-1] for name in names] + [run[f"{name}'"][-1] for name in names])
    np.testing.assert_allclose(made, end, atol=1e-9)


def skate() -> dict[str, Any]:
    x, y, th = dynamicsymbols("x y theta")
    m, inertia, g = sp.symbols("m J g")
    return {
        "coordinates": [x, y, th],
        "lagrangian": m / 2 * (x.diff(t) ** 2 + y.diff(t) ** 2) + inertia / 2 * th.diff(t) ** 2 - m * g * sp.sin(0.1) * x,
        "constraints": [-x.diff(t) * sp.sin(th) + y.diff(t) * sp.cos(th)],
        "parameters": {m: 1.0, inertia: 0.5, g: 9.81},
        "q": [0.0, 0.0, 0.3],
        "v": {x: 1.0, th: 0.5},
    }


def pendulum_cart() -> dict[str, Any]:
    x, th = dynamicsymbols("x theta")
    m1, m2, length, g, k = sp.symbols("m1 m2 l g k")
    kinetic = (m1 + m2) / 2 * x.diff(t) ** 2 + m2 * length * x.diff(t) * th.diff(t) * sp.cos(th)
    kinetic += m2 * length**2 / 2 * th.diff(t) ** 2
    return {
        "coordinates": [x, th],
        "lagrangian": kinetic + m2 * g * length * sp.cos(th) - k * x**2 / 2,
        "parameters": {m1: 1.0, m2: 0.5, length: 0.7, g: 9.81, k: 3.0},
        "q": [0.1, 0.8],
        "v": [0.0, 0.2],
    }


def particle() -> dict[str, Any]:
    x, y, z = dynamicsymbols("x y z")
    return {
        "coordinates": [x, y, z],
        "lagrangian": sp.Rational(1, 2) * (x.diff(t) ** 2 + y.diff(t) ** 2 + z.diff(t) ** 2) - (x**2 + y**2) / 3,
        "constraints": [z.diff(t) - y * x.diff(t)],
        "q": [1.0, 0.2, 0.0],
        "v": [0.3, 0.7, 0.06],
    }


def driven() -> dict[str, Any]:
    x, y, th = dynamicsymbols("x y theta")
    m, inertia, c = sp.symbols("m J c")
    return {
        **skate(),
        "lagrangian": m / 2 * (x.diff(t) ** 2 + y.diff(t) ** 2) + inertia / 2 * th.diff(t) ** 2,
        "forces": {th: sp.sin(2 * t) - c * th.diff(t), x: sp.Abs(sp.cos(th)) / 3},
        "parameters": {m: 1.0, inertia: 0.5, c: 0.1},
    }


def disk() -> dict[str, Any]:
    x, y, phi, roll = dynamicsymbols("x y phi roll")
    m, r = sp.symbols("m r")
    kinetic = m / 2 * (x.diff(t) ** 2 + y.diff(t) ** 2) + m * r**2 / 4 * roll.diff(t) ** 2 + m * r**2 / 8 * phi.diff(t) ** 2
    return {
        "coordinates": [x, y, phi, roll],
        "lagrangian": kinetic - sp.exp(-(x**2)) / 5,
        "constraints": [x.diff(t) - r * roll.diff(t) * sp.cos(phi), y.diff(t) - r * roll.diff(t) * sp.sin(phi)],
        "parameters": {m: 1.0, r: 0.5},
        "q": [0.3, 0.0, 0.2, 0.0],
        "v": {roll: 2.0, phi: 0.3},
    }


@pytest.mark.parametrize("make", [skate, pendulum_cart, particle, driven, disk])
def test_sympy_against_scipy(make: Any) -> None:
    parts = make()
    system = noslip.System(**parts)
    values = parts.get("parameters", {})
    slope = oracle(
        parts["coordinates"], parts["lagrangian"], parts.get("constraints", []), parts.get("forces", {}), values
    )
    agrees(system, slope, 2.0)


def test_an_angle_has_the_period_of_a_turn_or_is_refused() -> None:
    def spring(unit: str) -> noslip.System:
        return noslip.System({"d": unit}, "d'^2/2 - 4*d^2/2", v=[30.0])

    with pytest.raises(noslip.RequestError, match=r"angle `d`.*unit `rad`"):
        spring("angle").run(duration=1.0)
    # Quarter of a period: the amplitude is v/2.
    run = spring("rad").run(method="gauss16", step=0.1, duration=np.pi / 4)
    assert abs(run["d"][-1] - 15.0) < 1e-12


def test_text_and_sympy_are_one_system() -> None:
    text = noslip.System(
        {"x": "m", "y": "m", "theta": "angle"},
        "m/2*(x'^2 + y'^2) + J/2*theta'^2 - m*g*sin(0.1)*x",
        ["-x'*sin(theta) + y'*cos(theta)"],
        parameters={"m": 1.0, "J": 0.5, "g": 9.81},
        q=[0.0, 0.0, 0.3],
        v={"x": 1.0, "theta": 0.5},
    )
    symbols = noslip.System(**skate())
    a, b = text.run(duration=2.0), symbols.run(duration=2.0)
    for name in text.coordinates:
        np.testing.assert_allclose(a[name], b[name], atol=1e-12)
    assert a.constraint < 1e-12
    moved = text.run(q=[1.0, 2.0, 0.3], duration=1.0)
    assert moved["x"][0] == 1.0


def test_a_lagranges_method_is_a_system() -> None:
    x, th = dynamicsymbols("x theta")
    parts = pendulum_cart()
    method = LagrangesMethod(parts["lagrangian"], [x, th])
    system = noslip.System.from_lagranges(method, parameters=parts["parameters"], q=parts["q"], v=parts["v"])
    np.testing.assert_array_equal(system.run(duration=1.0)["x"], noslip.System(**parts).run(duration=1.0)["x"])


def test_events_and_analyses_take_a_system() -> None:
    # The skate turns evenly, from 0.3 rad at 0.5 rad/s.
    system = noslip.System(**skate())
    run = system.run(method="gauss16", step=0.05, duration=2.0, events=["theta=1", "theta_dot=2"])
    assert [event["t"] for event in run.events] == [pytest.approx(1.4, abs=1e-9)]
    ended = system.run(method="gauss16", step=0.05, duration=2.0, until="theta=1")
    assert ended.final["theta"] == pytest.approx(1.0, abs=1e-9)
    with pytest.raises(noslip.RequestError, match="no quantity `speed`"):
        system.run(events="speed=0")
    found = system.lyapunov(step=0.05, duration=20.0, settle=2.0)
    assert len(found["exponents"]) == 5 and abs(found["sum"] - found["divergence_mean"]) < 1e-2
    section = system.section(plane="theta=1", axes="x,y", step=0.05, duration=20.0)
    assert section["starts"][0]["points"][0][0] == pytest.approx(1.4, abs=1e-9)
    assert system.cost(step=0.05, duration=1.0)["operations"]["forces"] == 0
    rows = noslip.ensemble({"scene": "knife-edge", "duration": 2.0, "grid": {"parameters.slope": [0.1, 0.2]}})
    assert rows["speed"][0] < rows["speed"][1]


def test_what_a_scene_has_no_text_for_is_refused() -> None:
    x = dynamicsymbols("x")
    for wrong in [sp.besselj(0, x), x.diff(t, 2), sp.Integral(x, x)]:
        with pytest.raises(noslip.RequestError):
            noslip.System([x], x.diff(t) ** 2 / 2 - wrong)
    with pytest.raises(noslip.RequestError, match="no coordinate"):
        noslip.System(["x"], "x'^2/2", q={"y": 1.0})
    with pytest.raises(noslip.RequestError, match="2 numbers for 1"):
        noslip.System(["x"], "x'^2/2", q=[1.0, 2.0])
    with pytest.raises(noslip.RequestError):
        noslip.System(["x"], "x'^2/2 - unknown*x")


def test_forces_and_constraints_of_a_lagranges_method_count() -> None:
    from sympy.physics.mechanics import Point, ReferenceFrame

    x, y = dynamicsymbols("x y")
    frame, origin = ReferenceFrame("N"), Point("O")
    mass = origin.locatenew("P", x * frame.x + y * frame.y)
    origin.set_vel(frame, 0)
    mass.set_vel(frame, x.diff(t) * frame.x + y.diff(t) * frame.y)
    lagrangian = (x.diff(t) ** 2 + y.diff(t) ** 2) / 2
    pulled = LagrangesMethod(
        lagrangian, [x, y], forcelist=[(mass, 0.5 * frame.x)], frame=frame, nonhol_coneqs=[x.diff(t) - y.diff(t)]
    )
    # A force of 0.5 N on the line x' = y': an acceleration of a quarter.
    run = noslip.System.from_lagranges(pulled).run(duration=2.0)
    assert run["x"][-1] == pytest.approx(0.5, abs=1e-12) and run["y"][-1] == pytest.approx(0.5, abs=1e-12)
    held = LagrangesMethod(lagrangian - 9.81 * y, [x, y], hol_coneqs=[x**2 + y**2 - 1])
    swing = noslip.System.from_lagranges(held, q=[1.0, 0.0]).run(duration=1.0)
    np.testing.assert_allclose(swing["x"] ** 2 + swing["y"] ** 2, 1.0, atol=1e-10)


def test_names_of_latex_are_names() -> None:
    x, k, m = dynamicsymbols("x_{1}"), sp.Symbol("k_{1}"), sp.Symbol(r"\mu")
    lagrangian = m * x.diff(t) ** 2 / 2 - k * x**2 / 2
    written = noslip.System([x], lagrangian, parameters={k: 4.0, m: 1.0}, q=[1.0])
    assert written.coordinates == ["x_1"]
    np.testing.assert_allclose(written.run(method="gauss16", duration=1.0)["x_1"][-1], np.cos(2.0), rtol=1e-13)
    assert noslip.System(["x"], "x'^2/2 - k_1*x^2/2", parameters={"k_{1}": 4.0}).run(duration=0.1)


@pytest.mark.parametrize("other", [sp.Symbol("k_1"), dynamicsymbols("k_{1}")])
def test_two_symbols_are_not_one_name(other: Any) -> None:
    x = dynamicsymbols("x")
    with pytest.raises(noslip.RequestError, match=r"would have one name, k_1: rename one of them"):
        noslip.System([x], x.diff(t) ** 2 / 2 - sp.Symbol("k_{1}") * x**2 + other)


def test_numbers_of_numpy_are_numbers() -> None:
    plain = noslip.System(["x"], "x'^2/2", forces={"x": 2.5})
    for number in (np.float64(2.5), np.float32(2.5), sp.Rational(5, 2)):
        made = noslip.System(["x"], "x'^2/2", forces={"x": number}, q=np.array([0.0]))
        assert made.run(duration=1.0)["x"][-1] == plain.run(duration=1.0)["x"][-1]
    bowl = [{"kind": "bowl", "stiffness": np.array([0.1, 0.2])}]
    assert noslip.Sleigh(effects=bowl) == noslip.Sleigh(effects=[{"kind": "bowl", "stiffness": [0.1, 0.2]}])


def test_systems_stay_systems() -> None:
    system = noslip.System(["x"], "x'^2/2 - 2*x^2", q=[1.0])
    for other in (pickle.loads(pickle.dumps(system)), copy.deepcopy(system), system.started(q=[1.0])):
        assert other == system and other.run(q=[0.5], duration=1.0)["x"][0] == 0.5


def test_constraints_have_names_forces_and_equations() -> None:
    x, y, th = dynamicsymbols("x y th")
    system = noslip.System(
        {"x": "m", "y": "m", "th": "angle"},
        "(x'^2 + y'^2)/2 + 0.3*th'^2/2",
        {"edge": sp.Eq(y.diff(t) * sp.cos(th), x.diff(t) * sp.sin(th))},
        outputs={"grip": ("lambda_edge", "N"), "other": "2*lambda_edge"},
        v=[1.0, 0.0, 0.5],
    )
    run = system.run(method="gauss8", duration=1.0)
    np.testing.assert_allclose(run["grip"], 0.5, rtol=1e-12)
    np.testing.assert_allclose(run["other"], 1.0, rtol=1e-12)
    listed = noslip.System(["x", "y"], "(x'^2 + y'^2)/2", ["x' = y'"], outputs={"pull": "lambda1"}, v=[1.0, 1.0])
    assert (listed.run(duration=0.1)["pull"] == 0.0).all()


def test_pieces_are_choices() -> None:
    x = dynamicsymbols("x")
    push = sp.Piecewise((1, t < sp.Rational(1, 2)), (2 * t, t <= 1), (0, True)) + sp.Heaviside(t - 2) + sp.Mod(t, 2)
    system = noslip.System([x], x.diff(t) ** 2 / 2, forces={x: push}, duration=3.0, step=0.7, method="gauss8")
    np.testing.assert_allclose(system.run()["x'"][-1], 0.5 + 0.75 + 1.0 + 2.0 + 0.5, rtol=1e-14)
    with pytest.raises(noslip.RequestError, match="for all other cases"):
        noslip.System([x], x.diff(t) ** 2 / 2, forces={x: sp.Piecewise((1, t < 1))})
    with pytest.raises(noslip.RequestError, match="conditions are comparisons"):
        noslip.System([x], x.diff(t) ** 2 / 2, forces={x: sp.Piecewise((1, (t > 1) & (x > 0)), (0, True))})
