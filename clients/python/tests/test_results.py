"""Results against the JSON of the same service, and figures that can be drawn."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import matplotlib
import numpy as np
import pytest
from conftest import SCENE, sweep_of
from matplotlib import pyplot

import rubmap
from rubmap import plot
from rubmap.download import download
from rubmap.service import Service

matplotlib.use("Agg")


@pytest.fixture(autouse=True)
def no_figures_are_left() -> Iterator[None]:
    yield
    pyplot.close("all")


def test_a_map_is_the_one_of_the_json(swept: rubmap.Sweep) -> None:
    found, json = swept.interaction_map(), swept.json("interaction-map")
    assert found["amplitude"].dims == ("speed", "engine_order")
    assert found["amplitude"].attrs["units"] == json["units"]["length"] == "mm"
    np.testing.assert_array_equal(found["amplitude"], np.array(json["amplitude"]))
    np.testing.assert_allclose(found["speed_rpm"], np.linspace(16000, 26000, 6), rtol=1e-12)
    # One revolution a second per engine order is the speed in Hz.
    np.testing.assert_allclose(found["frequency"].sel(engine_order=1.0), found["speed_rpm"] / 60.0, rtol=1e-12)
    axes = plot.interaction_map(found, critical=swept.critical_speeds())
    assert axes.get_xlabel() == "speed of rotation, rpm"
    plot.interaction_map(found, frequency=True, log=False)


def test_speeds_ascend_whatever_their_order_in_the_request(client: rubmap.Client, model: rubmap.Model) -> None:
    speeds: Any = {"values": [22000, 16000, 19000], "unit": "rpm"}
    sweep = client.sweep(sweep_of(model.id, speeds=speeds, record={})).submit().wait(progress=False)
    found = sweep.interaction_map()
    assert found["index"].values.tolist() == [1, 2, 0] == sweep.points()["index"].tolist()
    nearest = found.sel(speed=19000 * np.pi / 30.0, method="nearest")
    np.testing.assert_array_equal(nearest["amplitude"], sweep.spectrum(2)["amplitude"][0])
    recorded = sweep.record({"speeds": [1], "quantities": ["displacement", "velocity"]}).wait(progress=False)
    with pytest.raises(ValueError, match="no request of its own"):
        recorded.plan()
    assert recorded.histories(speed=1)["velocity"].attrs["units"] == "mm/s"


def test_tables_are_those_of_the_json(swept: rubmap.Sweep) -> None:
    wheel, json = swept.wheel_critical_speeds(), swept.json("critical-speeds/wheel")["critical_speeds"]
    assert len(wheel) == len(json) > 0
    np.testing.assert_allclose(wheel["speed_rad_s"], [row["speed_rad_s"] for row in json])
    np.testing.assert_allclose(wheel["speed_rpm"], wheel["speed_rad_s"] * 30.0 / np.pi)
    assert "settings" in wheel.attrs and "version" in wheel.attrs
    assert list(swept.critical_speeds(sensor=0).columns[:3]) == ["index", "speed_rad_s", "speed_rpm"]
    points = swept.points()
    assert len(points) == 6 and "steady_state" in points and "linear_theory" in points
    plot.critical_speeds(wheel)
    for sensor in (0, 1):
        said = [point["responses"][sensor]["rms"] for point in swept.json("interaction-map")["points"]]
        np.testing.assert_array_equal(swept.points(sensor)["response.rms"], said)
    assert plot.level(points).get_ylabel() == "level, mm rms"
    with pytest.raises(ValueError, match="half_peak_to_peak"):
        plot.level(points, quantity="peak")
    # The level of the wheel by itself, in the unit of its columns.
    wheel = swept.level()
    for quantity, label in (("tip_motion", "tip motion, mm"), ("clearance_consumption", "clearance consumption")):
        axes = plot.level(wheel, quantity=quantity)
        column = next(column for column in wheel.columns if column.startswith(f"{quantity}_value"))
        np.testing.assert_array_equal(np.asarray(axes.lines[0].get_ydata()), wheel[column])
        assert axes.get_ylabel() == label
    assert plot.level(wheel).get_ylabel() == "tip motion, mm"
    with pytest.raises(ValueError, match="tip_motion"):
        plot.level(wheel, quantity="rms")
    # The orders of a map are most of what moves, and no more.
    of_map = np.asarray(plot.level(swept.interaction_map()).lines[0].get_ydata())
    assert np.all(of_map <= points["response.rms"] * (1 + 1e-9)) and np.all(of_map > 0.9 * points["response.rms"])
    with pytest.raises(ValueError, match=r"points\(\)"):
        plot.level(swept.interaction_map(), quantity="half_peak_to_peak")


def test_a_verdict_prints_as_a_table(client: rubmap.Client, model: rubmap.Model) -> None:
    operation = {"ranges": [{"name": "cruise", "from": 18000, "to": 24000, "unit": "rpm"}]}
    request = sweep_of(model.id, record={}, operation=operation, limits={"tip_motion": 1e-6})
    found = client.sweep(request).submit().wait(progress=False).verdict()
    assert found.word == "act" and found.sentence.startswith('Act: in range "cruise" (18,000 to 24,000 rpm) at ')
    lines = str(found).splitlines()
    assert lines[0] == found.sentence
    assert " ".join(lines[1].split()) == "worst (rpm) where value against its limit"
    assert len(lines) == 2 + len(found.worst) and " of 1e-06 mm " in lines[2] and "in cruise, -" in lines[2]
    assert " passed by " in lines[2]
    assert found.settings["operation"] == operation and found.ranges[0]["name"] == "cruise"
    shown = found._repr_html_()
    assert ">act</span>" in shown and "(18,000 to 24,000 rpm)" in shown and shown.count("<tr>") == 1 + len(found.worst)


def test_a_sweep_without_limits_is_undecided(swept: rubmap.Sweep) -> None:
    found = swept.verdict()
    assert found.word == "undecided" and found.would_decide[0]["what"] == "no_limit"
    assert "no limit" in str(found) and "to decide: give `limits`" in str(found)


def test_spectra_histories_forces_and_stress_have_their_dimensions(swept: rubmap.Sweep) -> None:
    spectrum = swept.spectrum(2)
    assert spectrum["of_nodal_diameter"].dims == ("sensor", "nodal_diameter", "engine_order")
    np.testing.assert_allclose(spectrum["amplitude"][0], swept.interaction_map()["amplitude"][2])
    histories = swept.histories(speed=2)
    assert histories["displacement"].sizes["revolution"] == histories["force"].sizes["revolution"]
    assert histories["force"].sizes["sector"] == 10 and histories["force"].sizes["contact_node"] == 10
    assert float(histories["force"].min()) >= 0.0
    forces = swept.forces()
    assert forces["peak_force"].sizes == {"speed": 6, "contact_node": 10} and forces["peak_force"].attrs["units"] == "N"
    # The peaks are over the whole window, the histories within it.
    assert float(histories["force"].max()) <= float(forces["peak_force"][2].max()) * (1 + 1e-9)
    stress = swept.stress()
    assert {"node", "mean_MPa", "alternating_MPa"} <= set(stress.columns) and len(stress) > 0
    plot.spectrum(spectrum)


def test_a_casing_stands_where_its_lobes_say(swept: rubmap.Sweep) -> None:
    casing = swept.casing()
    asked = swept.json("interaction-map")["settings"]["scene"]["casing"]
    lobes = asked["lobes"]
    angle = casing.index.to_numpy()
    height = sum(
        lobes["amplitude"]
        * np.exp(
            -((((angle - k * 2 * np.pi / lobes["count"] + np.pi) % (2 * np.pi) - np.pi) / lobes["width_rad"]) ** 2)
        )
        for k in range(lobes["count"])
    )
    np.testing.assert_allclose(casing[0], asked["clearance"]["leading"] - height, atol=1e-3 * lobes["amplitude"])
    assert casing.attrs["length"] == "mm" and len(casing.attrs["radius"]) == casing.shape[1]
    assert "times as large" in plot.casing(casing).get_title()


def test_files_are_whole(swept: rubmap.Sweep, model: rubmap.Model, tmp_path: Path) -> None:
    assert swept.download("interaction-map", tmp_path / "map.svg").read_bytes().startswith(b"<?xml")
    lines = swept.download("critical-speeds", tmp_path / "table.txt", format="csv").read_text().splitlines()
    assert any("speed_rpm" in line for line in lines)
    assert b"<html" in swept.report(tmp_path / "report.html").read_bytes()[:200]
    assert zipfile.ZipFile(swept.archive(tmp_path / "all.zip")).testzip() is None
    assert b"PolyData" in model.download("mesh", tmp_path / "mesh.vtp").read_bytes()[:400]
    with pytest.raises(rubmap.Refusal) as refused:
        swept.download("interaction-map", tmp_path / "map.vtu")
    assert refused.value.status == 400
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "all.zip",
        "map.svg",
        "mesh.vtp",
        "report.html",
        "table.txt",
    ]


def test_modes_and_campbell_agree(client: rubmap.Client, swept: rubmap.Sweep, model: rubmap.Model) -> None:
    request = {
        "model": model.id,
        "modes_per_speed": 3,
        "speeds": {"from": 0, "to": 26000, "count": 5, "unit": "rpm"},
        "lobes": 2,
        "backbones": {"nodal_diameters": [1]},
    }
    analysis = client.modal_analysis(request).submit().wait(progress=False)  # type: ignore[arg-type]
    campbell = analysis.campbell()
    modes = model.modes(0.0, modes_per_speed=3)
    np.testing.assert_allclose(campbell["frequency"].sel(speed=0.0, family=1), modes[1], rtol=1e-9)
    assert campbell["frequency"].attrs["units"] == "Hz"
    crossings = analysis.crossings()
    assert {"speed_rad_s", "frequency_hz", "nodal_diameter"} <= set(crossings.columns)
    plot.campbell(campbell, lobes=2, crossings=crossings)
    assert (campbell["rank"].sel(speed=0.0) == campbell["family"]).all() and (campbell["assurance"] > 0.0).all()
    assert {"speed_rpm", "distance_hz", "course"} <= set(analysis.veerings().columns)
    interference = analysis.interference(speed_rpm=26000, range_rpm=(20000, 22000))
    top = campbell["frequency"].isel(speed=-1)
    places = zip(interference["nodal_diameter"], interference["family"], strict=True)
    expected = [float(top.sel(nodal_diameter=diameter, family=family)) for diameter, family in places]
    np.testing.assert_allclose(interference["frequency_hz"], expected, rtol=1e-12)
    np.testing.assert_allclose(interference.attrs["speed_rpm"], 26000)
    assert interference.attrs["engine_orders"]["nodal_diameter"][:2] == [1, 2]
    plot.interference(interference)
    backbones = analysis.backbones()
    assert set(backbones["family"]) == {1, 2} and set(backbones["nodal_diameter"]) == {1}
    begin = backbones[backbones["amplitude_mm"] == 0.0]["frequency_hz"]
    np.testing.assert_allclose(begin, top.sel(nodal_diameter=1), rtol=1e-9)
    assert len(backbones.attrs["ends"]["end"]) == 2
    plot.backbones(backbones)
    assert 3 in {reduction["modes_per_speed"] for reduction in model.reductions}
    mesh = model.mesh(sector=0)
    assert mesh["position"].shape == (len(mesh["node"]), 3) and (mesh["contact"] > 0).sum() == 10


def test_a_case_study_and_a_study(client: rubmap.Client, model: rubmap.Model) -> None:
    case = sweep_of(model.id)
    for name in ("speeds", "record"):
        case.pop(name)
    case |= {"speed": {"value": 20000, "unit": "rpm"}, "record": {"revolutions": [28, 30]}}
    histories = client.case_study(case).submit().wait(progress=False).histories()
    np.testing.assert_allclose(histories["speed"], 20000 * np.pi / 30, rtol=1e-12)
    grid: Any = {
        "kept_modes": [5],
        "modes_per_speed": [3],
        "steps_per_revolution": [2000, 4000],
        "schemes": ["central_differences"],
    }
    study = client.study(
        {
            "model": model.id,
            "speeds": {"values": [20000], "unit": "rpm"},
            "scene": SCENE,
            "integration": {"revolutions": 30, "window_revolutions": 10},
            "grid": grid,
        }
    )
    table = study.submit().wait(progress=False).work_precision()
    assert len(table) > 0 and "time_s" in table
    plot.work_precision(table)


def test_a_campaign_compares_two_models(client: rubmap.Client, model: rubmap.Model) -> None:
    made = client.generate({"preset": "small", "name": "another", "tip_thickness": 0.5}).submit().wait(progress=False)
    request: Any = sweep_of(model.id, speeds={"values": [18000, 22000], "unit": "rpm"}, record={})
    del request["record"]
    parameters = [{"name": "damping", "at": ["/scene/damping/modal_ratio"], "from": 0.004, "to": 0.01, "levels": 3}]
    request |= {"compared_model": made.model, "parameters": parameters, "design": {"kind": "grid"}}
    plan = client.campaign(request).plan()
    assert plan["simulations"] == 12 and "3: 12 simulations" in str(plan) and str(plan).count("reduction") == 2
    job = client.campaign(request).submit().wait(progress=False)
    designs, differences = job.designs(), job.differences()
    np.testing.assert_allclose(designs["damping"], [0.004, 0.007, 0.01])
    assert differences.index.tolist() == pytest.approx([18000, 22000])
    severity = differences.attrs["severity"]
    assert severity["mean"] == pytest.approx((designs["compared_severity"] - designs["severity"]).mean())
    assert job.severities().shape == (3, 2)
    assert job.sensitivities().empty


def test_branches_are_those_of_the_json(client: rubmap.Client, model: rubmap.Model) -> None:
    """A wheel that is damped well has a periodic response, which is followed a little."""
    request: Any = {
        "model": model.id,
        "modes_per_speed": 3,
        "speed": {"value": 20000, "unit": "rpm"},
        "along": {"parameter": "speed", "from": 19900, "to": 20100},
        "scene": SCENE | {"damping": {"modal_ratio": 0.05}},
        "integration": {"revolutions": 30},
    }
    job = client.branches(request).submit().wait(progress=False)
    plan = job.plan()
    assert plan["points_at_least"] <= len(job.points(0)) <= plan["points_at_most"] and plan["estimate"]["workers"] == 1
    assert f"points      at least {plan['points_at_least']}, at most {plan['points_at_most']}" in str(plan)
    assert job.id is not None and isinstance(client.job(job.id), rubmap.Branches)
    points, json = job.points(), job.json("branches")
    assert json["complete"] and points.attrs["parameter"] == "speed" and points.attrs["unit"] == "mm"
    for sensor in range(len(json["sensors"])):
        said = [point["half_peak_to_peak"][sensor] for one in json["branches"] for point in one["points"]]
        np.testing.assert_array_equal(job.points(sensor)["half_peak_to_peak"], said)
    first = points[points["branch"] == 0]
    np.testing.assert_allclose(first["speed_rpm"].iloc[[0, -1]], [19900, 20100], rtol=1e-9)
    assert len(job.bifurcations()) == sum(len(one["bifurcations"]) for one in json["branches"])
    assert {"value", "error", "half_peak_to_peak", "speed_rpm"} <= set(job.maxima())
    axes = plot.branches(points, bifurcations=job.bifurcations())
    assert axes.get_xlabel() == "speed of rotation, rpm" and axes.get_ylabel() == "half peak to peak, mm"
    with pytest.raises(IndexError, match="no sensor 9"):
        job.points(9)


#: Branches as the service tells of them: one that turns back, and one of doubled period that is lost at its first point.
_TOLD = {
    "parameter": "clearance",
    "sensors": [{"contact_node": 0}],
    "units": {"length": "mm"},
    "complete": False,
    "settings": {},
    "version": "0",
    "branches": [
        {
            "branch": 0,
            "points": [
                {
                    "value": value,
                    "speed_rad_s": 2000.0,
                    "half_peak_to_peak": [amplitude],
                    "stability": stability,
                    "multipliers": [{"modulus": 0.9, "order_offset": 0.0, "nodal_diameter": 2}][
                        : stability != "undecided"
                    ],
                    "lobe_passages": 1,
                    "residual": 1e-9,
                    "newton_steps": 2,
                    "revolutions": 1.5,
                }
                for value, amplitude, stability in (
                    (1.0, 0.1, "stable"),
                    (1.2, 0.2, "stable"),
                    (1.1, 0.3, "fold"),
                    (1.0, 0.4, "undecided"),
                )
            ],
            "bifurcations": [
                {"kind": "fold", "value": 1.21, "speed_rad_s": 2000.0, "error": 1e-6, "half_peak_to_peak": [0.22]}
            ],
            "maxima": [],
            "ends": [],
        },
        {"branch": 1, "points": [], "bifurcations": [], "maxima": [], "ends": [{"why": "lost", "reason": "…"}]},
    ],
}


def test_branches_that_are_not_complete_are_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    job = rubmap.Branches(Service("http://nowhere"), {}, "id")
    monkeypatch.setattr(job, "json", lambda _: _TOLD)
    points, bifurcations = job.points(), job.bifurcations()
    assert len(points) == 4 and not points.attrs["complete"] and points["modulus"].isna().sum() == 1
    assert bifurcations["kind"].tolist() == ["fold"] and job.maxima().empty
    axes = plot.branches(points, bifurcations=bifurcations)
    drawn = [line for line in axes.get_lines() if len(line.get_xdata()) > 1]  # type: ignore[arg-type]
    assert [line.get_linestyle() for line in drawn] == ["-", "--", ":"]
    assert axes.get_xlabel() == "clearance / that of the scene"
    monkeypatch.setattr(job, "json", lambda _: _TOLD | {"branches": []})
    plot.branches(job.points(), bifurcations=job.bifurcations())


def test_run_ups_are_those_of_the_json(client: rubmap.Client, model: rubmap.Model) -> None:
    request: Any = {
        "model": model.id,
        "modes_per_speed": 3,
        "speed": {"unit": "rpm", "from": 19000, "to": 21000, "rates": [80000, 20000]},
        "scene": SCENE,
        "sensors": [{"contact_node": node, "sector": 3, "component": "radial"} for node in (0, 9)],
        "max_engine_order": 8,
        "frame_revolutions": 2,
        "limit": 1e-3,
    }
    job = client.run_ups(request).submit().wait(progress=False)
    plan = job.plan()
    assert [line.split()[1:3] for line in str(plan).splitlines() if line.startswith("run ")] == [
        [f"{run['rate_rad_s2']:.4g}", "rad/s²:"] for run in plan["runs"]
    ]
    assert job.id is not None and isinstance(client.job(job.id), rubmap.RunUps)
    json, frames, runs = job.json("run-ups"), job.envelope(), job.runs()
    assert json["complete"] and frames.attrs["complete"] and frames.attrs["unit"] == "mm"
    assert runs["status"].tolist() == ["completed", "completed"]
    np.testing.assert_allclose(runs["rate_rad_s2"], np.array([80000, 20000]) * np.pi / 30.0, rtol=1e-12)
    # A run ends at the last sample that it reaches, of 520 in a revolution.
    missing = np.array([planned["revolutions"] for planned in plan["runs"]]) - runs["revolutions"]
    assert missing.between(0.0, 1.0 / 520.0).all()
    assert plan["estimate"]["steps"] == runs["steps"].sum() and runs["energy_residual"].max() < 1e-9
    for sensor in (0, 1):
        own = job.envelope(sensor)
        for name in ("largest", "half_peak_to_peak"):
            said = [frame[name][sensor] for run in json["runs"] for frame in run["frames"]]
            np.testing.assert_array_equal(own[name], said)
        np.testing.assert_array_equal(own.groupby("run")["largest"].max(), job.runs(sensor)["largest"])
    assert frames["speed_rpm"].between(19000, 21000).all()
    np.testing.assert_allclose(frames["speed_rpm"], frames["speed_rad_s"] * 30.0 / np.pi)
    assert frames["revolution"].iloc[:3].tolist() == [0, 2, 4]
    spectrogram, arrays = job.spectrogram(run=1, sensor=1), job.arrays("spectrogram", run=1, sensor=1)
    assert spectrogram.shape == (runs["revolutions"].iloc[1] // 2, 8 * 2 + 1)
    np.testing.assert_array_equal(spectrogram.to_numpy(), arrays["amplitudes"])
    np.testing.assert_array_equal(spectrogram.columns, arrays["engine_orders"])
    passing = job.passing()
    assert passing is not None and "enough_rad_s2" not in passing and "no rate keeps" in passing["message"]
    axes = plot.envelope(frames)
    assert axes.get_xlabel() == "speed of rotation, rpm" and axes.get_ylabel() == "half peak to peak, mm"
    assert plot.spectrogram(spectrogram).get_xlabel() == "speed of rotation, rpm"
    with pytest.raises(IndexError, match="no sensor 2"):
        job.envelope(2)
    with pytest.raises(rubmap.Refusal) as refused:
        job.spectrogram(run=2)
    assert refused.value.status == 400


#: Run-ups as the service tells of them: one that has ended, and one that goes on.
_MARCHED: dict[str, Any] = {
    "sensors": [{"contact_node": 0}, {"gauge": {"nodes": [1, 2]}}],
    "units": {"length": "mm"},
    "complete": False,
    "settings": {"limit": 0.3},
    "version": "0",
    "runs": [
        {
            "run": run,
            "rate_rad_s2": rate,
            "order_step": 0.125,
            "frames": [
                {
                    "revolution": 8 * place,
                    "times_s": [0.1 * place, 0.1 * (place + 1)],
                    "speeds_rad_s": [100.0 + 10.0 * place, 110.0 + 10.0 * place],
                    "largest": [2.0 * amplitude, 1e-4],
                    "half_peak_to_peak": [amplitude, 1e-5],
                    "contact_share": 0.5 * (amplitude > 0.1),
                }
                for place, amplitude in enumerate((0.1, 0.2, 0.15))
            ],
        }
        for run, rate in ((0, 1000.0), (1, 100.0))
    ],
}
_MARCHED["runs"][0]["end"] = {
    "status": "diverged",
    "message": "…",
    "largest": [
        {"displacement": 0.4, "time_s": 0.15, "speed_rad_s": 115.0},
        {"displacement": 1e-4, "time_s": 0.2, "speed_rad_s": 120.0},
    ],
    "steps": 1000,
    "euler_share": 0.1,
}

#: A spectrogram of a run through points: the speed is held, then rises.
_SEEN: dict[str, Any] = {
    "run": 0,
    "sensor": {"contact_node": 0},
    "units": {"length": "mm"},
    "engine_orders": [0.0, 0.5, 1.0, 1.5],
    "times_s": [0.1, 0.2, 0.3],
    "speeds_rad_s": [[100.0, 100.0], [100.0, 100.0], [100.0, 120.0]],
    "amplitudes": [[9.0, 5.0, 1.0, 0.0], [9.0, 5.0, 2.0, 0.0], [9.0, 5.0, 3.0, 0.5]],
    "settings": {},
    "version": "0",
}


def test_run_ups_that_are_not_complete_are_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    job = rubmap.RunUps(Service("http://nowhere"), {}, "id")
    monkeypatch.setattr(job, "json", lambda _: _MARCHED)
    frames, runs = job.envelope(), job.runs()
    assert frames["speed_rad_s"].tolist() == [105.0, 115.0, 125.0] * 2 and not frames.attrs["complete"]
    assert job.passing() is None and job.envelope(1).attrs["unit"] == "strain"
    for name, value in {
        "status": "diverged",
        "steps": 1000,
        "largest": 0.4,
        "speed_rad_s": 115.0,
        "time_s": 0.15,
    }.items():
        assert runs[name].iloc[0] == value and runs[name].isna().tolist() == [False, True]
    axes = plot.envelope(frames, quantity="largest")
    # The slow run comes first; each is a line, a broad one and a ring, and then there is the limit.
    lines = axes.get_lines()
    assert [line.get_label() for line in lines[::3]] == ["100 rad/s²", "1000 rad/s²", "limit"]
    assert np.isnan(np.asarray(lines[1].get_ydata())).tolist() == [True, False, False]
    assert lines[2].get_ydata() == [0.4] and axes.get_ylabel() == "largest displacement at any sector, mm"
    points = _MARCHED | {"runs": [{k: v for k, v in _MARCHED["runs"][0].items() if k != "rate_rad_s2"}]}
    monkeypatch.setattr(job, "json", lambda _: points)
    assert job.runs()["rate_rad_s2"].isna().all()
    assert plot.envelope(job.envelope()).get_lines()[0].get_label() == "run"
    monkeypatch.setattr(job, "json", lambda _: _MARCHED | {"runs": []})
    plot.envelope(job.envelope())
    assert job.runs().empty


def test_a_spectrogram_is_over_speed_or_time(monkeypatch: pytest.MonkeyPatch) -> None:
    job = rubmap.RunUps(Service("http://nowhere"), {}, "id")
    told = _SEEN
    monkeypatch.setattr(job, "json", lambda *_, **__: told)
    found = job.spectrogram()
    assert found.attrs["unit"] == "mm" and found.attrs["rate_rad_s2"] is None
    assert found[1.0].tolist() == [1.0, 2.0, 3.0]
    np.testing.assert_allclose(found.index.get_level_values("speed_rpm"), np.array([100, 100, 110]) * 30.0 / np.pi)
    axes = plot.spectrogram(found)
    # The mean is not among the colours.
    assert axes.get_xlabel() == "speed of rotation, rpm" and axes.collections[0].get_clim()[1] == 3.0
    for speeds in ([[100.0, 100.0]] * 3, [[100.0, 120.0], [120.0, 110.0], [110.0, 100.0]]):
        told = _SEEN | {"speeds_rad_s": speeds}
        assert plot.spectrogram(job.spectrogram()).get_xlabel() == "time, s"
    told = _SEEN | {name: [] for name in ("engine_orders", "times_s", "speeds_rad_s", "amplitudes")}
    assert plot.spectrogram(job.spectrogram()).get_ylabel() == "engine order"


def test_a_download_is_asked_for_again_and_keeps_what_a_file_is(tmp_path: Path) -> None:
    """The first answer is of a gateway that does not reach the service, the second breaks off."""

    def broken() -> Iterator[bytes]:
        yield b"half"
        raise httpx.ReadError("lost")

    answers = [httpx.Response(502), httpx.Response(200, content=broken()), httpx.Response(200, content=b"whole")]
    service = Service("http://nowhere", patience=5.0)
    service._http = httpx.Client(base_url="http://nowhere", transport=httpx.MockTransport(lambda _: answers.pop(0)))
    (tmp_path / "link").symlink_to(tmp_path / "file")
    assert download(service, "/v1", tmp_path / "link").read_bytes() == b"whole"
    assert (tmp_path / "link").is_symlink() and not answers
    (tmp_path / "another").touch()
    assert (tmp_path / "file").stat().st_mode == (tmp_path / "another").stat().st_mode
    assert sorted(path.name for path in tmp_path.iterdir()) == ["another", "file", "link"]
