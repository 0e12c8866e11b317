"""The commands of the program as methods of a scene."""

import numpy as np
import pytest

import noslip


def test_compare_has_a_row_for_each_method() -> None:
    told = noslip.scene("turnaround").compare(methods=["dla", "rk4"], duration=4.0)
    assert [row["method"] for row in told["rows"]] == ["dla", "rk4"]
    dla, rk4 = (row["constraint"]["max"] for row in told["rows"])
    assert dla < 1e-14 < rk4


def test_precision_measures_points() -> None:
    told = noslip.scene("turnaround").precision(methods="dla4", duration=1.0)
    errors = [point["error"] for point in told["points"] if point["error"] is not None]
    assert min(errors) < 1e-8 < max(errors)


def test_equilibria_finds_the_straight_motion() -> None:
    told = noslip.scene("straight").equilibria()
    assert told["equilibria"] if "equilibria" in told else told


def test_lyapunov_and_section() -> None:
    exponents = noslip.scene("circle").lyapunov(duration=50.0)["exponents"]
    assert all(np.isfinite(exponents))
    assert noslip.scene("bowl").section(plane="speed=0", duration=50.0, starts=2)


def test_an_ensemble_has_a_row_for_each_member() -> None:
    sweep = {
        "scene": "turnaround",
        "grid": {"start.turn_rate": [0.1, 0.2, 0.3]},
    }
    members = noslip.ensemble(sweep)
    np.testing.assert_array_equal(members["start.turn_rate"], [0.1, 0.2, 0.3])
    assert len(members["member"]) == 3 and members.summary
    speed = members.summary["columns"]["speed"]
    assert speed["mean"] == pytest.approx(np.mean(members["speed"]), rel=1e-14)
    assert speed["deviation"] == pytest.approx(np.std(members["speed"], ddof=1), rel=1e-12)
    np.testing.assert_array_equal(members.quantiles(0.0, 0.5)["start.turn_rate"], [0.1, 0.2])
    pytest.importorskip("pandas")
    assert members.to_pandas()["start.turn_rate"][1] == 0.2
    alone = noslip.ensemble({**sweep, "grid": {"start.turn_rate": [0.1]}})
    assert alone.summary["columns"]["speed"]["deviation"] is None


def test_methods_are_told() -> None:
    methods = noslip.methods()
    assert methods["dla"]["order"] == 2 and "constraint" in methods["dla"]["keeps"]


@pytest.mark.parametrize("command", ["cost"])
def test_other_commands(command: str) -> None:
    assert getattr(noslip.scene("bowl"), command)()


def test_equations_are_formulas_of_the_motion() -> None:
    found = noslip.scene("rolling-disk").equations()
    assert found["unknowns"] == ["x", "y", "phi", "theta", "xi1", "xi2"]
    assert found["rates"][0] == "0.5*xi1*cos(theta)"
    with pytest.raises(noslip.RequestError):
        noslip.scene("turnaround").equations()
