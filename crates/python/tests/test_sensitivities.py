"""Derivatives of runs, against closed forms and against extrapolated differences of the runs themselves."""

import re
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import least_squares, minimize

import noslip

METHODS = ["dla", "dla-trapezoid", "dla4", "gauss4", "gauss16", "rk4"]


def extrapolated(scene: noslip.Scene, key: str, value: float, columns: list[str], **settings: Any) -> Any:
    """The derivative in a key by central differences of `run` with four steps, extrapolated to the step zero."""

    def at(moved: float) -> NDArray[np.float64]:
        run = scene.varied({key: moved}).run(**settings)
        return np.array([run[column] for column in columns]).T.ravel()

    first = 0.02 * (abs(value) or 0.5)
    steps = [first / 2**level for level in range(4)]
    row = [(at(value + step) - at(value - step)) / (2 * step) for step in steps]
    for order in range(1, 4):
        row = [(4**order * fine - coarse) / (4**order - 1) for coarse, fine in zip(row, row[1:], strict=False)]
    return row[0]


def agrees(
    scene: noslip.Scene, keys: dict[str, float], columns: list[str], tolerance: float = 1e-8, **settings: Any
) -> noslip.Sensitivities:
    """Compares all derivatives with differences, and the numbers with those of the run, bit for bit."""
    made = scene.sensitivities(list(keys), columns=columns, **settings)
    run = scene.run(**settings)
    for column in columns:
        values = run[column] if "t_eval" in settings else run[column][-1:]
        np.testing.assert_array_equal(made[column], values, err_msg=column)
    for k, (key, value) in enumerate(keys.items()):
        expected = extrapolated(scene, key, value, columns, **settings)
        expected = expected if "t_eval" in settings else expected[-len(columns) :]
        off = np.abs(made.jacobian[:, k] - expected).max() / (1.0 + np.abs(expected).max())
        assert off < tolerance, f"{key}: {off:.1e}"
    return made


SLEIGH = {"mass": 1.2, "inertia": 0.8, "offset": 0.4, "x": 0.3, "y": -0.2, "heading": 0.5, "speed": 0.9, "turn_rate": 0.3}


def sleigh(**settings: Any) -> noslip.Sleigh:
    return noslip.Sleigh(**{**SLEIGH, **settings})


EFFECTS: dict[str, list[dict[str, Any]]] = {
    "free": [],
    "bowl": [{"kind": "bowl", "stiffness": [0.5, 0.3], "center": [0.2, 0.1]}],
    "slope": [{"kind": "slope", "gravity": [0.3, -0.2]}],
    "egg_crate": [{"kind": "egg_crate", "height": 0.2, "wave_number": [1.0, 1.5]}],
    "hills": [{"kind": "hills", "hills": [{"height": 0.4, "x": 0.5, "y": 0.2, "width": 0.8}]}],
    "pushed": [{"kind": "drag", "along": 0.2, "turning": 0.1}, {"kind": "thrust", "force": 0.3}, {"kind": "torque", "torque": 0.1}],
    "moving": [{"kind": "moving_mass", "mass": 0.3, "x": 0.2, "y": 0.1}],
    "rotor": [{"kind": "flywheel", "inertia": 0.3, "rotor_rate": 2.0, "torque": 0.1}],
}


@pytest.mark.parametrize("effects", EFFECTS)
def test_a_sleigh_has_derivatives_in_its_figures_and_its_start(effects: str) -> None:
    pushed = sleigh(effects=EFFECTS[effects], duration=2.0)
    columns = ["x", "y", "heading", "speed", "turn_rate", "energy", "center_x", "center_y"]
    agrees(pushed, SLEIGH, columns, step=0.1, method="dla4")


@pytest.mark.parametrize("method", METHODS)
def test_methods_have_derivatives_at_nodes_and_between(method: str) -> None:
    bowl = sleigh(effects=EFFECTS["bowl"], duration=1.0)
    keys = {key: SLEIGH[key] for key in ("offset", "speed")}
    agrees(bowl, keys, ["x", "heading", "speed"], method=method, step=0.1, t_eval=[0.0, 0.1, 0.25, 0.7321, 1.0])


def test_no_velocity_is_admissible_but_the_given_one() -> None:
    # A skate, whose centre of mass is above its blade, goes round a circle: x = u/w (sin(w t + h) - sin h).
    u, w, h, t = 0.8, 0.6, 0.3, 3.0
    skate = noslip.Sleigh(offset=0.0, heading=h, speed=u, turn_rate=w, duration=t)
    made = skate.sensitivities(["speed", "turn_rate", "heading"], columns=["x", "heading"], method="gauss16", step=0.1)
    end = w * t + h
    slope = u / w * t * np.cos(end) - u / w**2 * (np.sin(end) - np.sin(h))
    expected = [[(np.sin(end) - np.sin(h)) / w, slope, u / w * (np.cos(end) - np.cos(h))], [0.0, t, 1.0]]
    np.testing.assert_allclose(made.jacobian, expected, atol=1e-12)


def test_an_oscillator_has_the_derivatives_of_its_closed_form() -> None:
    k, m, x, v, t = 3.0, 0.7, 0.4, -0.2, 2.0
    system = noslip.System(["x"], "m/2*x'^2 - k/2*x^2", parameters={"k": k, "m": m}, q=[x], v=[v], duration=t)
    w = np.sqrt(k / m)
    cos, sin = np.cos(w * t), np.sin(w * t)
    in_w = -x * t * sin + v * (t * cos / w - sin / w**2)
    expected = [cos, sin / w, in_w * w / (2 * k), -in_w * w / (2 * m)]
    for keys in (["x", "x'", "k", "m"], ["start.x", "start.x'", "parameters.k", "system.parameters.m"]):
        made = system.sensitivities(keys, columns="x", method="gauss16", step=0.1)
        np.testing.assert_allclose(made.jacobian[0], expected, atol=1e-12)


def skate(**start: Any) -> noslip.System:
    return noslip.System(
        {"x": "m", "y": "m", "th": "angle"},
        "m/2*(x'^2 + y'^2) + J/2*th'^2 - m*g*x",
        ["y'*cos(th) - x'*sin(th) - c*th'"],
        parameters={"m": 1.3, "J": 0.4, "g": 0.5, "c": 0.2},
        forces={"th": "-d*th'" if "d" in start else "-0.1*th'"},
        outputs={"ahead": "c + x'*cos(th) + y'*sin(th)"},
        duration=1.5,
        step=0.05,
        **start,
    )


@pytest.mark.parametrize("method", ["dla", "gauss8"])
def test_a_start_that_is_completed_moves_with_what_is_given(method: str) -> None:
    # The rate y' is what the constraint leaves of it.
    system = skate(q=[0.1, 0.2, 0.4], v={"x": 0.7, "th": 0.5})
    keys = {"x": 0.1, "th": 0.4, "x'": 0.7, "th'": 0.5, "m": 1.3, "J": 0.4, "g": 0.5, "c": 0.2}
    agrees(system, keys, ["x", "y", "th", "x'", "th'", "energy", "ahead"], method=method)


def test_rates_that_are_left_out_are_the_smallest() -> None:
    # Two rates are left out, and one constraint is to be met.
    system = skate(q=[0.1, 0.2, 0.4], v={"th": 0.5})
    agrees(system, {"th": 0.4, "th'": 0.5, "m": 1.3, "J": 0.4, "c": 0.2}, ["x", "y", "th", "x'", "y'"], method="dla")


@pytest.mark.parametrize(
    ("name", "columns"),
    [
        ("rolling-disk", ["x", "y"]),
        ("chaplygin-ball", ["x", "y"]),
        ("two-wheeled-robot", ["x", "y"]),
        ("bicycle", ["phi", "delta", "speed"]),
    ],
)
def test_bundled_systems_have_derivatives_in_each_parameter(name: str, columns: list[str]) -> None:
    scene = noslip.scene(name)
    block = re.search(r"(?:\[system.parameters\]|\nparameters = \{)(.*?)(?:\n\n|\}|\Z)", scene.text, re.S)
    assert block is not None
    found = re.findall(r"(\w+) = ([-+.\deE]+)", block.group(1))
    keys = {key: float(value) for key, value in found[:3]}
    assert len(keys) == 3
    agrees(scene, keys, columns, duration=0.2, step=0.02, method="dla", tolerance=1e-7)


def test_more_keys_than_a_number_carries_directions() -> None:
    system = skate(q=[0.1, 0.2, 0.4], v={"x": 0.7, "th": 0.5})
    keys = ["x", "y", "th", "x'", "th'", "m", "J", "g", "c"]
    whole = system.sensitivities(keys)
    assert whole.jacobian.shape == (6, 9) and whole.columns == ("x", "y", "th", "x'", "y'", "th'")
    for k, key in enumerate(keys):
        np.testing.assert_array_equal(whole.jacobian[:, k], system.sensitivities(key).jacobian[:, 0])


def test_a_wrong_derivative_is_seen() -> None:
    bowl = sleigh(effects=EFFECTS["bowl"], duration=1.0)
    right = noslip.Scene.sensitivities

    class Wrong(noslip.Scene):
        def sensitivities(self, *keys: Any, **settings: Any) -> noslip.Sensitivities:
            made = right(self, *keys, **settings)
            made.jacobian = made.jacobian * (1.0 + 1e-6)
            return made

    agrees(bowl, {"offset": 0.4}, ["x"], method="dla", step=0.1)
    with pytest.raises(AssertionError, match="offset"):
        agrees(Wrong(bowl.text), {"offset": 0.4}, ["x"], method="dla", step=0.1)


def test_scipy_fits_and_minimises_with_them() -> None:
    times = np.linspace(0.1, 4.0, 30)
    truth = noslip.Sleigh(offset=0.37, speed=1.1, turn_rate=0.4, duration=4.0)
    data = truth.sensitivities("offset", columns=["x", "y"], t_eval=times).values
    predicted = truth.prediction(["offset", "speed"], columns=["x", "y"], t_eval=times)
    fit = least_squares(lambda p: predicted(p) - data, [0.5, 1.0], jac=predicted.jacobian, xtol=1e-14, gtol=1e-14)
    np.testing.assert_allclose(fit.x, [0.37, 1.1], atol=1e-10)

    def cost(p: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
        off = predicted(p) - data
        return float(off @ off), 2 * off @ predicted.jacobian(p)

    least = minimize(cost, [0.5, 1.0], jac=True, method="BFGS", options={"gtol": 1e-9})
    np.testing.assert_allclose(least.x, [0.37, 1.1], atol=1e-7)


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ({"keys": ["speed"], "method": "dop853"}, "dop853 has no derivatives.*the methods that have derivatives are dla, .*gauss16"),
        ({"keys": ["speed"], "method": "gni"}, "multiplier"),
        ({"keys": ["colour"]}, "start.speed.*sleigh.mass"),
        ({"keys": []}, "no keys"),
        ({"keys": ["speed"], "columns": ["constraint"]}, "no derivative of `constraint`"),
        ({"keys": ["speed"], "t_eval": [1.0, 0.5]}, "must increase"),
        ({"keys": ["speed"], "t_eval": [1e9]}, "within the run"),
        ({"keys": ["speed"], "t_eval": [float("nan")]}, "must increase"),
    ],
)
def test_what_has_no_derivative_is_refused(asked: dict[str, Any], told: str) -> None:
    with pytest.raises(noslip.RequestError, match=told):
        noslip.scene("turnaround").sensitivities(**asked)


def test_scenes_without_derivatives_are_refused() -> None:
    for name, told in [("planimeter", "impose"), ("turntable", "impose")]:
        with pytest.raises(noslip.RequestError, match=told):
            noslip.scene(name).sensitivities("speed")
    with pytest.raises(noslip.RequestError, match="no derivative with respect to `q` is available; the keys are x, x', k"):
        noslip.System(["x"], "x'^2/2 - k*x^2", parameters={"k": 1.0}).sensitivities("q")


def test_varied_scenes_have_other_numbers() -> None:
    pushed = noslip.Sleigh(speed=-1.0, turn_rate=0.1, effects=[{"kind": "bowl", "stiffness": [0.1, 0.1]}])
    other = pushed.varied({"speed": 0.5, "sleigh.mass": 2, "effects.0.stiffness.1": 0.3})
    assert other.run(duration=0.1)["speed"][0] == 0.5
    assert "mass = 2.0" in other.text and "0.3" in other.text
    with pytest.raises(noslip.RequestError):
        pushed.varied({"nonsense.at.all": 1.0}).run()
    assert skate(v={"x": 0.7}).varied({"th'": 0.3}).run(duration=0.1)["th'"][0] == 0.3
