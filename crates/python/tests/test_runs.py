"""Runs in memory: the numbers of the command line, to the last bit."""

import json
import pickle
import subprocess
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

import noslip

METHODS = ["dla", "dla4", "gauss8", "energy4", "rk4"]


def program() -> list[str]:
    """The program of this checkout, which `.ci/run` has built before."""
    root = Path(__file__).parents[3]
    import os

    target = Path(os.environ.get("CARGO_TARGET_DIR", root / "target"))
    for profile in ("debug", "release"):
        if (target / profile / "noslip").exists():
            return [str(target / profile / "noslip")]
    pytest.skip("the program is not built: cargo build")


# One of each kind of system, for longer than the others.
KINDS = ["turnaround", "bowl", "flywheel", "turntable", "knife-edge"]


@pytest.mark.parametrize("name", [pytest.param(name, marks=[] if name in KINDS else [pytest.mark.slow]) for name in noslip.scenes()])
def test_columns_are_those_of_the_files_of_the_program(name: str, tmp_path: Path) -> None:
    duration = 2.0 if name in KINDS else 0.2
    for method in METHODS:
        file = tmp_path / f"{method}.npz"
        arguments = ["run", name, "--method", method, "--duration", str(duration), "--out", str(file), "--json"]
        made = subprocess.run([*program(), *arguments], capture_output=True, text=True)
        if made.returncode != 0:
            with pytest.raises(noslip.NoslipError):
                noslip.scene(name).run(method=method, duration=duration)
            continue
        run = noslip.scene(name).run(method=method, duration=duration)
        with np.load(file) as archive:
            for column in run:
                np.testing.assert_array_equal(run[column], archive[column], err_msg=f"{name} {method} {column}")
        told = json.loads(made.stdout)
        for key in ("final", "energy", "constraint", "steps"):
            assert told[key] == run.object[key]


def test_a_run_at_given_times_is_the_motion_there() -> None:
    scene = noslip.scene("bowl")
    nodes = scene.run(method="gauss8", step=0.05, duration=2.0)
    times = nodes["t"][::4]
    sampled = scene.run(method="gauss8", step=0.05, duration=2.0, t_eval=times)
    np.testing.assert_array_equal(sampled["t"], times)
    np.testing.assert_array_equal(sampled["x"], nodes["x"][::4])
    between = scene.run(method="gauss8", step=0.05, duration=2.0, t_eval=[0.025, 1.234])
    fine = scene.run(method="gauss8", step=0.0005, duration=2.0, t_eval=[0.025, 1.234])
    np.testing.assert_allclose(between["x"], fine["x"], atol=1e-10)


def train(*effects: Mapping[str, object]) -> noslip.Scene:
    trailers = {"kind": "trailers", "count": 2, "mass": 0.5, "inertia": 0.1, "bar": 0.8, "headings": [0.2]}
    return noslip.scene(
        {
            "sleigh": {"mass": 1.0, "inertia": 1.0, "offset": 0.2},
            "start": {"speed": 1.0, "turn_rate": 0.3},
            "run": {"method": "dla4", "step": 0.05, "duration": 2.0},
            "effects": [trailers, *effects],
        }
    )


def test_trains_are_runs_like_others(tmp_path: Path) -> None:
    push = {"kind": "thrust", "force": {"times": [0.0, 0.73], "values": [0.5, -0.2]}}
    rotor = {"kind": "flywheel", "inertia": 0.5, "rotor_rate": 1.0, "torque": 0.2}
    scene, file = train(push, rotor), tmp_path / "run.npz"
    run = scene.run(events="x=0.5")
    (tmp_path / "train.toml").write_text(scene.text)
    arguments = ["run", str(tmp_path / "train.toml"), "--out", str(file), "--json"]
    made = subprocess.run([*program(), *arguments], capture_output=True, text=True, check=True)
    with np.load(file) as archive:
        assert list(run) == [name for name in archive.files if name in list(run)]
        for column in run:
            np.testing.assert_array_equal(run[column], archive[column], err_msg=column)
    assert json.loads(made.stdout)["last"] == run.object["last"]
    assert run.events and abs(run.events[0]["x"] - 0.5) < 1e-12
    assert run["rotor_rate"].size == run["heading_2"].size
    # At times between nodes the motion is that of shorter steps; before and after the jump at 0.73 s.
    times = [0.0, 0.31, 0.73, 1.234, 2.0]
    sampled, fine = (scene.run(step=step, t_eval=times) for step in (0.05, 0.001))
    np.testing.assert_allclose(sampled["heading_2"], fine["heading_2"], atol=1e-6)
    np.testing.assert_array_equal(sampled["t"], times)
    assert sampled["x"][-1] == run["x"][-1]


def test_every_keeps_every_so_many_nodes() -> None:
    scene = noslip.scene("turnaround")
    whole, some = scene.run(), scene.run(every=7)
    np.testing.assert_array_equal(some["speed"][:-1], whole["speed"][:-1:7])
    assert some["t"][-1] == whole["t"][-1]


def test_a_run_names_its_columns() -> None:
    run = noslip.scene("turnaround").run()
    assert run.units["speed"] == "m/s"
    assert run.x is run["x"]
    assert run.final["x"] == run["x"][-1]
    assert run.energy_error < 1e-2
    with pytest.raises(KeyError, match="the columns are t, x, y"):
        run["place"]
    with pytest.raises(AttributeError, match="no attribute or column"):
        run.place
    assert "turnaround" in repr(run)
    assert "<svg" in run._repr_html_()


def test_events_are_found_and_end_runs() -> None:
    scene = noslip.scene("turnaround")
    run = scene.run(events="speed=0")
    assert run.events and abs(run.events[0]["speed"]) < 1e-9
    ended = scene.run(until=["speed=0"])
    assert ended["t"][-1] <= run.events[0]["t"] + 1e-9 < run["t"][-1]


def test_a_tolerance_chooses_the_step() -> None:
    coarse, fine = (noslip.scene("bowl").run(tolerance=tol, duration=5.0) for tol in (1e-2, 1e-5))
    assert fine.step < coarse.step


def test_scenes_can_be_made_pickled_and_compared() -> None:
    sleigh = noslip.Sleigh(speed=-1.0, turn_rate=0.1, duration=2.0)
    again = pickle.loads(pickle.dumps(sleigh))
    assert again == sleigh and hash(again) == hash(sleigh)
    np.testing.assert_array_equal(again.run()["x"], sleigh.run()["x"])
    tables = {
        "sleigh": {"mass": 1.0, "inertia": 1.0, "offset": 0.5},
        "start": {"speed": -1.0, "turn_rate": 0.1},
        "run": {"method": "dla", "step": 0.05, "duration": 2.0},
    }
    np.testing.assert_array_equal(noslip.scene(tables).run()["x"], sleigh.run()["x"])


def test_results_become_frames_and_figures() -> None:
    run = noslip.scene("turnaround").run(duration=2.0)
    pytest.importorskip("pandas")
    frame = run.to_pandas()
    assert frame["x"].iloc[-1] == run["x"][-1] and frame.index.name == "t"
    pytest.importorskip("xarray")
    assert run.to_xarray()["speed"].attrs["units"] == "m/s"
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    assert len(run.plot().axes) == 4


def test_a_saved_run_goes_on_to_the_same_bits(tmp_path: Path) -> None:
    scene, save = noslip.scene("bowl"), tmp_path / "run.save"
    whole = scene.run(method="gauss8", step=0.05, duration=20.0, every=3)
    first = scene.run(method="gauss8", step=0.05, duration=8.0, every=3, checkpoint=save, checkpoint_every=50)
    assert first["t"][-1] == pytest.approx(8.0) and save.exists()
    gone_on = scene.run(method="gauss8", step=0.05, duration=20.0, every=3, checkpoint=save)
    assert list(gone_on) == list(whole) and gone_on.units == whole.units
    for column in whole:
        np.testing.assert_array_equal(gone_on[column], whole[column], err_msg=column)
    assert gone_on.final == whole.final and gone_on.steps == whole.steps
    with pytest.raises(noslip.RequestError, match="another"):
        scene.run(method="dla", duration=20.0, checkpoint=save)
    with pytest.raises(noslip.RequestError, match="a run that is saved"):
        scene.run(checkpoint=save, t_eval=[1.0])


def test_a_saved_run_has_its_events(tmp_path: Path) -> None:
    scene, save = noslip.scene("turnaround"), tmp_path / "run.save"
    events = ["speed=0:rising", "heading=1.5"]
    whole = scene.run(method="gauss8", duration=40.0, events=events)
    scene.run(method="gauss8", duration=20.0, events=events, checkpoint=save, checkpoint_every=50)
    gone_on = scene.run(method="gauss8", duration=40.0, events=events, checkpoint=save)
    assert [event["t"] for event in gone_on.events] == [event["t"] for event in whole.events]
    assert len(whole.events) == 2


def test_backward_in_time() -> None:
    scene = noslip.scene("bowl")
    back = scene.run(method="gauss16", duration=-10.0)
    forth = scene.varied({"start.speed": 1.0, "start.turn_rate": -0.1}).run(method="gauss16", duration=10.0)
    assert back["t"][-1] == -10.0
    np.testing.assert_allclose(back["x"], forth["x"], atol=1e-12)
    np.testing.assert_allclose(back["speed"], -forth["speed"], atol=1e-12)
    with pytest.raises(noslip.RequestError, match="leave t_eval out"):
        scene.run(duration=-1.0, t_eval=[-0.5])


def test_a_saved_run_that_progress_stopped_goes_on(tmp_path: Path) -> None:
    scene, save = noslip.scene("bowl"), tmp_path / "run.save"

    def stop(label: str, done: int, of: int) -> None:
        raise RuntimeError("enough")

    settings = {"method": "rk4", "step": 1e-4, "duration": 20.0, "every": 1000, "checkpoint": save}
    with pytest.raises(RuntimeError, match="enough"):
        scene.run(progress=stop, **settings)  # type: ignore[arg-type]
    made = scene.run(**settings)  # type: ignore[arg-type]
    np.testing.assert_array_equal(made["x"], scene.run(**{**settings, "checkpoint": None})["x"])  # type: ignore[arg-type]


def test_a_saved_run_that_fails_keeps_what_was_made(tmp_path: Path) -> None:
    sleigh = noslip.Sleigh(speed=1.0, turn_rate=255.0, step=0.05, duration=2.0)
    with pytest.raises(noslip.RunError) as caught:
        sleigh.run(method="dla", checkpoint=tmp_path / "run.save")
    assert caught.value.step == caught.value.result.steps + 1 and caught.value.reason
