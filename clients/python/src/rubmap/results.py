"""Jobs of every kind with what they find."""

from __future__ import annotations

import uuid
from collections.abc import Mapping
from typing import Any, cast

import numpy as np
import pandas as pd
import xarray as xr

from .contract import HistoriesRequest
from .download import Arrays
from .jobs import Job
from .tables import RPM, credentials, dataset, plain_name, sensor_unit, sensors, speed_axis, table, units
from .verdict import Verdict


class _Recorded(Job):
    """Jobs that record histories."""

    def histories(self, **query: Any) -> xr.Dataset:
        """Histories of a recorded speed.

        Dimensions: ``sensor``, ``revolution`` (since the start), ``contact_node``, ``sector``. Variables: ``displacement`` and ``velocity`` (sensor,
        revolution) in the units of the model; ``force`` (sector, contact_node, revolution), where contact forces were recorded. Of a sweep ``speed`` is the index of the speed.
        """
        found = self.arrays("histories", **query)
        unit = units(found)
        variables: dict[str, Any] = {
            "displacement": (("sensor", "revolution"), found["displacement"], {"units": sensor_unit(found)}),
        }
        if "velocity" in found:
            attributes = {"units": f"{sensor_unit(found)}/{unit['time']}"}
            variables["velocity"] = (("sensor", "revolution"), found["velocity"], attributes)
        if "force" in found:
            attributes = {"units": unit["force"], "long_name": "contact force"}
            variables["force"] = (("sector", "contact_node", "revolution"), found["force"], attributes)
        coordinates = {
            "sensor": ("sensor", sensors(found)),
            "revolution": (
                "revolution",
                found["revolution"],
                {"units": "1", "long_name": "revolutions since the start"},
            ),
            "speed": ((), float(found["speed_rad_s"]), {"units": "rad/s"}),
        }
        return dataset(variables, coordinates, found)


def _with_response(point: dict[str, Any], sensor: int) -> dict[str, Any]:
    """A point with what one sensor says, in place of all that they say; a speed that was not completed has none."""
    responses = point.pop("responses", [])
    return point | {"response": responses[sensor]} if responses else point


class Sweep(_Recorded):
    """Contact over a range of speeds."""

    kind = "sweep"
    path = "/v1/sweeps"

    def interaction_map(
        self,
        sensor: int | None = None,
        nodal_diameter: int | None = None,
        speeds: str | None = None,
        orders: str | None = None,
    ) -> xr.Dataset:
        """The interaction map of a sensor, also while the job runs.

        Dimensions: ``speed`` (rad/s; also ``speed_rpm`` and ``index`` in the request) and ``engine_order``. Variables: ``amplitude`` (speed, engine_order), in the
        model's unit of length; ``status``, ``utilisation``, ``largest_von_mises`` (the model's unit of stress), ``linear_theory`` (whether it holds) by speed. The coordinate
        ``frequency`` (speed, engine_order) is in Hz, in the rotating frame. Speeds ascend, whatever their order in the request.

        Args:
            speeds: only these, by their indices or in a range, such as ``"0-9,15"`` or ``"24000-28000rpm"``.
            orders: only these engine orders, such as ``"0-8,12"``.
        """
        found = self.arrays(
            "interaction-map", sensor=sensor, nodal_diameter=nodal_diameter, speeds=speeds, orders=orders
        )
        unit = units(found)
        stress = f"{unit['force']}/{unit['length']}^2"
        lines, omega = found["engine_orders"], found["speeds_rad_s"]
        coordinates = speed_axis(omega, found["speed_indices"])
        coordinates["engine_order"] = ("engine_order", lines, {"units": "1", "long_name": "engine order"})
        frequency = np.outer(omega, lines) / (2.0 * np.pi)
        coordinates["frequency"] = (("speed", "engine_order"), frequency, {"units": "Hz", "long_name": "frequency"})
        amplitude = (
            ("speed", "engine_order"),
            found["amplitude"],
            {"units": sensor_unit(found), "long_name": "amplitude"},
        )
        variables: dict[str, Any] = {"amplitude": amplitude, "status": ("speed", found["status"])}
        for name, attributes in (
            ("utilisation", {"units": "1"}),
            ("largest_von_mises", {"units": stress}),
            ("validity", {}),
        ):
            if name in found:
                variables[plain_name(name)] = ("speed", found[name], attributes)
        return dataset(variables, coordinates, found).assign_attrs(sensor=sensors(found)[0]).sortby("speed")

    def points(self, sensor: int | None = None) -> pd.DataFrame:
        """What is known of every speed: response, steady state, whether linear theory holds, errors, energy, contact, wall time; a row a speed, ascending; nested names
        are joined by dots.

        ``response.rms`` and what else begins so is of the sensor, the first if none is said, in the unit of ``attrs["unit"]``.
        """
        found = self.json("interaction-map", sensor=sensor)
        frame = pd.json_normalize([_with_response(point, sensor or 0) for point in found["points"]])
        if frame.empty:
            frame = pd.DataFrame(columns=["index", "speed_rad_s", "status"])
        frame = frame.rename(columns=plain_name)
        frame = frame.sort_values("speed_rad_s", ignore_index=True)
        unit = _unit(found["sensor"], found["units"])
        frame.attrs.update(unit=unit, units=found["units"], version=found["version"])
        frame.insert(2, "speed_rpm", frame["speed_rad_s"] * RPM)
        return frame

    def spectrum(self, index: int) -> xr.Dataset:
        """Spectra of all sensors at one speed.

        Dimensions: ``sensor``, ``engine_order``, ``nodal_diameter``. Variables: ``amplitude`` (sensor, engine_order) and ``of_nodal_diameter`` (sensor,
        nodal_diameter, engine_order), both in the unit that the sensors have: of length, or strain.
        """
        found = self.arrays(f"spectra/{index}")
        said = {"units": sensor_unit(found)}
        orders, speed = found["engine_orders"], float(found["speed_rad_s"])
        coordinates = {
            "sensor": ("sensor", sensors(found)),
            "engine_order": ("engine_order", orders, {"units": "1", "long_name": "engine order"}),
            "frequency": ("engine_order", orders * speed / (2.0 * np.pi), {"units": "Hz", "long_name": "frequency"}),
            "speed": ((), speed, {"units": "rad/s"}),
        }
        variables: dict[str, Any] = {
            "amplitude": (("sensor", "engine_order"), found["amplitude"], said),
            "of_nodal_diameter": (("sensor", "nodal_diameter", "engine_order"), found["nodal_diameters"], said),
        }
        return dataset(variables, coordinates, found)

    def critical_speeds(self, sensor: int | None = None, **query: Any) -> pd.DataFrame:
        """Critical speeds of a sensor beside the linear prediction, by speed; ``rank="utilisation"`` puts the most utilised first. Units end the columns' names."""
        return table(self.arrays("critical-speeds", sensor=sensor, **query), "speed_rad_s")

    def wheel_critical_speeds(self, **query: Any) -> pd.DataFrame:
        """Critical speeds of the wheel as a whole: the worst contact node, component and blade of each."""
        return table(self.arrays("critical-speeds/wheel", **query), "speed_rad_s")

    def verdict(self) -> Verdict:
        """Whether the wheel may run in the operating ranges of the request by its limits, also while the job runs; prints as a table."""
        return Verdict(self.json("verdict"))

    def level(self) -> pd.DataFrame:
        """Tip motion, clearance consumption, utilisation and largest force on a node over speed, over the whole wheel, with errors and standings."""
        return table(self.arrays("level"), "speed_rad_s")

    def casing(self) -> pd.DataFrame:
        """Distance of the casing at rest from the tips: a row per angle of the fixed frame, rad, a column per contact node. ``attrs`` has their
        ``radius``, the number of ``sectors`` and the unit of ``length``."""
        found = self._service.get(f"/v1/models/{self.state['model']}/section", sweep=self.id)
        places = [place for place in found["contact"] if "clearance" in place]
        count = max((len(place.get("heights", [])) for place in places), default=0) or 1
        gaps = {
            k: place["clearance"] - np.array(place.get("heights") or [0.0] * count) for k, place in enumerate(places)
        }
        frame = pd.DataFrame(gaps, index=pd.Index(np.arange(count) * 2.0 * np.pi / count, name="angle_rad"))
        frame.columns.name = "contact_node"
        radius = [place["position"][0] for place in places]
        frame.attrs = {"radius": radius, "sectors": found["sectors"], "length": found["units"]["length"]}
        return frame

    def record(self, request: HistoriesRequest) -> CaseStudy:
        """Has histories recorded of a sweep that has ended: by a case study, which is returned when it is submitted.

        Raises:
            Refusal: the sweep was not successful, or has no such speeds.
        """
        path = f"{self._own()}/histories"
        made = self._service.post(path, cast(Mapping[str, Any], request), str(uuid.uuid4()))
        return CaseStudy(self._service, None, str(made["id"]))

    def forces(self) -> xr.Dataset:
        """Contact over ``speed`` and ``contact_node``, of every node its worst blade: peak force, impulse, share of time, clearance consumed."""
        found = self.arrays("forces")
        unit = units(found)
        shape = found["peak_force"].shape
        of = {
            "peak_force": unit["force"],
            "mean_force": unit["force"],
            "wheel_peak_force": unit["force"],
            "impulse_per_revolution": f"{unit['force']} {unit['time']}",
        }
        variables: dict[str, Any] = {}
        for name, values in found.items():
            if values.shape == shape:
                variables[name] = (("speed", "contact_node"), values, {"units": of.get(name, "1")})
            elif values.shape == shape[:1] and name != "speeds_rad_s":
                variables[name] = ("speed", values, {"units": of.get(name, "1")})
        return dataset(variables, speed_axis(found["speeds_rad_s"]), found).sortby("speed")

    def stress(self) -> pd.DataFrame:
        """Stress at the worst nodes of every speed, where the sweep recorded it: mean and alternating parts, whose unit ends the columns'
        names, and utilisation."""
        return table(self.arrays("stress"), "node")


class ModalAnalysis(Job):
    """Natural frequencies over speed, and where the lobes meet them."""

    kind = "modal_analysis"
    path = "/v1/modal-analyses"

    def campbell(self) -> xr.Dataset:
        """Natural frequencies.

        Dimensions: ``speed`` (rad/s), ``nodal_diameter``, ``family`` (from 1). Variables: ``frequency``, Hz, in the rotating frame; of families that are
        followed by their shapes ``rank`` and ``assurance``, below 0.75 in the middle of a veering.
        """
        found = self.arrays("campbell")
        shape = found["frequencies_hz"].shape
        coordinates = speed_axis(found["speeds_rad_s"])
        coordinates["nodal_diameter"] = ("nodal_diameter", np.arange(shape[1]), {"units": "1"})
        coordinates["family"] = ("family", np.arange(1, shape[2] + 1), {"units": "1"})
        attributes = {"units": "Hz", "long_name": "natural frequency"}
        axes = ("speed", "nodal_diameter", "family")
        variables: dict[str, Any] = {"frequency": (axes, found["frequencies_hz"], attributes)}
        if "ranks" in found:
            variables["rank"] = (axes, found["ranks"], {"units": "1", "long_name": "rank of the mode, from 1"})
            variables["assurance"] = (axes, found["assurance"], {"units": "1", "long_name": "modal assurance"})
        return dataset(variables, coordinates, found)

    def veerings(self) -> pd.DataFrame:
        """Where followed families cross or veer: speed, least distance, and whether they exchange their shapes."""
        return _crossings(self.arrays("campbell"), "veerings_")

    def interference(
        self,
        speed_rpm: float | None = None,
        lobes: int | None = None,
        max_engine_order: int | None = None,
        range_rpm: tuple[float, float] | None = None,
    ) -> pd.DataFrame:
        """Modes of all nodal diameters at a speed, by default the highest of the analysis, each with the nearest engine order of the lobes.

        ``margin_percent`` is the distance of a mode from that order: positive above it. ``met_in_range`` says whether an order meets the mode within
        the operating range ``range_rpm``. ``attrs["engine_orders"]`` has the zig-zag: engine orders and the nodal diameters that they drive.
        """
        first, last = range_rpm if range_rpm is not None else (None, None)
        asked = {"speed": speed_rpm, "from": first, "to": last, "lobes": lobes, "max_engine_order": max_engine_order}
        given = {name: value for name, value in asked.items() if value is not None}
        found = self.arrays("interference", unit="rpm", **given)
        of_modes = {name: values for name, values in found.items() if not name.startswith("orders_")}
        frame = table(of_modes, "nodal_diameter")
        frame.attrs["speed_rpm"] = float(found["speed_rad_s"]) * RPM
        orders = {name.removeprefix("orders_"): of for name, of in found.items() if name.startswith("orders_")}
        frame.attrs["engine_orders"] = pd.DataFrame(orders).to_dict("list")
        return frame

    def backbones(self) -> pd.DataFrame:
        """Backbone curves, a row for each point: frequency of free vibration over the amplitude at the contact node that moves most, in the unit that
        ends its column's name.

        Requests with ``backbones`` have them. ``attrs["ends"]`` says of every curve whether it reached the largest amplitude, or why not.
        """
        found = self.arrays("backbones")
        of_points = {name: values for name, values in found.items() if not name.startswith("curves_")}
        frame = table(of_points, "nodal_diameter")
        ends = {name.removeprefix("curves_"): of for name, of in found.items() if name.startswith("curves_")}
        frame.attrs["ends"] = pd.DataFrame(ends).to_dict("list")
        return frame

    def crossings(self) -> pd.DataFrame:
        """Where superharmonics of the lobes cross natural frequencies: the linear criterion's critical speeds."""
        found = self.arrays("campbell")
        return _crossings(found, "crossings_")

    def driven_crossings(self) -> pd.DataFrame:
        """Where engine orders of the lobes meet natural frequencies of the nodal diameter that they drive."""
        return _crossings(self.arrays("campbell"), "driven_crossings_")


def _crossings(found: Arrays, begin: str) -> pd.DataFrame:
    columns = {name.removeprefix(begin): values for name, values in found.items() if name.startswith(begin)}
    frame = pd.DataFrame(columns)
    frame.insert(1, "speed_rpm", frame["speed_rad_s"] * RPM)
    frame.attrs.update(credentials(found))
    return frame


class CaseStudy(_Recorded):
    """One speed in detail."""

    kind = "case_study"
    path = "/v1/case-studies"


class Branches(Job):
    """Periodic responses, followed while a number of their scene changes."""

    kind = "branches"
    path = "/v1/branches"

    def points(self, sensor: int = 0) -> pd.DataFrame:
        """Points of all branches, a row each, in the order of each branch; also while the job runs, once there is one.

        ``value`` is what changes along the branches: rad/s of a speed, which stands beside it as ``speed_rpm``, otherwise a multiple of
        what the scene says. ``half_peak_to_peak`` is of the sensor, in the unit of ``attrs["unit"]``; ``stability`` and the leading
        multiplier say whether the response lasts.
        """
        found = self._found(sensor)
        rows = [
            {"branch": branch["branch"]}
            | {name: point[name] for name in ("value", "speed_rad_s")}
            | {"half_peak_to_peak": point["half_peak_to_peak"][sensor], "stability": point["stability"]}
            | _leading(point["multipliers"][:1])
            | {name: point[name] for name in ("lobe_passages", "residual", "newton_steps", "revolutions")}
            for branch in found["branches"]
            for point in branch["points"]
        ]
        return _branch_table(found, rows, sensor, ["branch", "value", "speed_rad_s", "half_peak_to_peak", "stability"])

    def bifurcations(self, sensor: int = 0) -> pd.DataFrame:
        """Where branches turn back (``fold``) or change their stability (``flip``, ``neimark_sacker``, ``branching``), with how far off that
        may be: ``error``, in the unit of ``value``. Where lines split, ``order_offset`` is their distance in engine orders."""
        found = self._found(sensor)
        rows = [
            {"branch": branch["branch"]}
            | {name: one[name] for name in ("kind", "value", "speed_rad_s", "error")}
            | {"half_peak_to_peak": one["half_peak_to_peak"][sensor]}
            | _leading([one["multiplier"]] if one.get("multiplier") else [])
            | {"stable_modulus": one.get("stable_modulus")}
            for branch in found["branches"]
            for one in branch["bifurcations"]
        ]
        columns = ["branch", "kind", "value", "speed_rad_s", "error", "half_peak_to_peak"]
        return _branch_table(found, rows, sensor, columns)

    def maxima(self, sensor: int = 0) -> pd.DataFrame:
        """Critical values: maxima of the sensor's amplitude along the branches, with how far off they may be."""
        found = self._found(sensor)
        columns = ["branch", "value", "speed_rad_s", "error", "half_peak_to_peak", "stability"]
        rows = [
            {"branch": branch["branch"]} | {name: one[name] for name in columns[1:]}
            for branch in found["branches"]
            for one in branch["maxima"]
            if one["sensor"] == sensor
        ]
        return _branch_table(found, rows, sensor, columns)

    def _found(self, sensor: int) -> Any:
        return _with_sensor(self.json("branches"), sensor)


def _with_sensor(found: Any, sensor: int) -> Any:
    """What was found, if there is this sensor."""
    if not 0 <= sensor < len(found["sensors"]):
        raise IndexError(f"there is no sensor {sensor}; there are {len(found['sensors'])}")
    return found


def _unit(sensor: Mapping[str, Any], units: Mapping[str, str]) -> str:
    """The unit of what a sensor says."""
    return "strain" if sensor.get("gauge") else units["length"]


def _leading(multipliers: list[dict[str, Any]]) -> dict[str, Any]:
    """The leading one of a point's multipliers, if it has any."""
    names = ("modulus", "order_offset", "nodal_diameter")
    return {name: one[name] for one in multipliers for name in names}


def _branch_table(
    found: Mapping[str, Any], rows: list[dict[str, Any]], sensor: int, columns: list[str]
) -> pd.DataFrame:
    frame = _sensor_table(found, rows, sensor, columns)
    frame.attrs.update(parameter=found["parameter"])
    return frame


def _sensor_table(
    found: Mapping[str, Any], rows: list[dict[str, Any]], sensor: int, columns: list[str]
) -> pd.DataFrame:
    """Rows, which have a speed, of one sensor; without any there are at least these columns."""
    frame = pd.DataFrame(rows) if rows else pd.DataFrame(columns=columns)
    frame.insert(list(frame.columns).index("speed_rad_s") + 1, "speed_rpm", frame["speed_rad_s"] * RPM)
    frame.attrs.update(
        unit=_unit(found["sensors"][sensor], found["units"]),
        complete=found["complete"],
        units=found["units"],
        settings=found["settings"],
        version=found["version"],
    )
    return frame


class RunUps(Job):
    """Run-ups or run-downs: a scene whose speed changes, at one rate after the other or through points."""

    kind = "run_up"
    path = "/v1/run-ups"

    def envelope(self, sensor: int = 0) -> pd.DataFrame:
        """How far a sensor moves, a row per frame of every run; also while the job runs, once there is a frame.

        ``largest`` is the largest displacement at any sector, ``half_peak_to_peak`` that at the sensor's own sector, which a sweep tells of a
        speed; both in the unit of ``attrs["unit"]``. ``speed_rad_s`` is the mean of the speeds at the frame's ends, ``contact_share`` the share of
        the steps in which something touches. A run through points has no rate: NaN.
        """
        found = _with_sensor(self.json("run-ups"), sensor)
        columns = ["run", "rate_rad_s2", "revolution", "start_s", "end_s", "speed_rad_s"]
        columns += ["largest", "half_peak_to_peak", "contact_share"]
        rows = [
            _run(run)
            | {"revolution": frame["revolution"], "start_s": frame["times_s"][0], "end_s": frame["times_s"][1]}
            | {"speed_rad_s": sum(frame["speeds_rad_s"]) / 2.0}
            | {name: frame[name][sensor] for name in ("largest", "half_peak_to_peak")}
            | {"contact_share": frame["contact_share"]}
            for run in found["runs"]
            for frame in run["frames"]
        ]
        return _sensor_table(found, rows, sensor, columns)

    def runs(self, sensor: int = 0) -> pd.DataFrame:
        """How runs ended, a row each: ``status`` (missing while a run goes on), ``message``, the ``largest`` displacement of a sensor at any
        sector, in the unit of ``attrs["unit"]``, with the speed and the time at which it is, and credentials."""
        found = _with_sensor(self.json("run-ups"), sensor)
        rows = [_run(run) | _ended(run.get("end"), sensor) for run in found["runs"]]
        return _sensor_table(found, rows, sensor, ["run", "rate_rad_s2", *_ended(None, sensor)])

    def spectrogram(self, run: int = 0, sensor: int = 0) -> pd.DataFrame:
        """Amplitudes of a sensor at its own sector, a row per frame, a column per engine order, in the unit of ``attrs["unit"]``.

        The index has ``time_s``, ``speed_rad_s`` and ``speed_rpm`` of the middle of every frame. A line has the frequency of its order times the
        speed over 2π. The last frame of a run is left out where it is shorter than the others.
        """
        found = self.json("spectrogram", run=run, sensor=sensor)
        orders = found["engine_orders"]
        speeds = np.array(found["speeds_rad_s"], dtype=float).reshape(-1, 2).mean(axis=1)
        index = pd.MultiIndex.from_arrays(
            [found["times_s"], speeds, speeds * RPM], names=["time_s", "speed_rad_s", "speed_rpm"]
        )
        frame = pd.DataFrame(
            np.array(found["amplitudes"], dtype=float).reshape(len(index), len(orders)),
            index=index,
            columns=pd.Index(orders, name="engine_order", dtype=float),
        )
        frame.attrs.update(
            run=found["run"],
            rate_rad_s2=found.get("rate_rad_s2"),
            unit=_unit(found["sensor"], found["units"]),
            units=found["units"],
            settings=found["settings"],
            version=found["version"],
        )
        return frame

    def passing(self) -> dict[str, Any] | None:
        """How fast one must pass to stay below the ``limit`` of the request: ``enough_rad_s2``, ``too_slow_rad_s2``, ``about_rad_s2`` between the
        two, and ``message``; None without a limit, without rates, and until all runs have ended."""
        found: dict[str, Any] | None = self.json("run-ups").get("passing")
        return found


def _run(run: Mapping[str, Any]) -> dict[str, Any]:
    return {"run": run["run"], "rate_rad_s2": run.get("rate_rad_s2", np.nan)}


#: Numbers that are told of a run that has ended.
_CREDENTIALS_OF_RUN = (
    "revolutions",
    "steps",
    "segments",
    "contact_share",
    "largest_angle_error_rad",
    "largest_energy",
    "energy_residual",
    "stiffening_work",
    "transfer_loss",
    "largest_penetration",
    "euler_share",
    "wall_time_s",
)


def _ended(end: Mapping[str, Any] | None, sensor: int) -> dict[str, Any]:
    """The end of a run as part of a row."""
    told = end or {}
    largest = told["largest"][sensor] if told else {}
    return (
        {"status": told.get("status"), "message": told.get("message"), "largest": largest.get("displacement", np.nan)}
        | {name: largest.get(name, np.nan) for name in ("speed_rad_s", "time_s")}
        | {"scheme": told.get("scheme", {}).get("name")}
        | {name: told.get(name, np.nan) for name in _CREDENTIALS_OF_RUN}
    )


class Campaign(Job):
    """Many designs of a scene, each over the same speeds."""

    kind = "campaign"
    path = "/v1/campaigns"

    def designs(self) -> pd.DataFrame:
        """A row per design: the values of its parameters, its severity once all speeds are known, the speed where it is, and whether it
        meets the limit, with ``compared_`` before the same of a model that is compared; also while the job runs. ``attrs`` has the settings
        and, if asked for, the ``threshold``."""
        found = self.json("campaign")
        names = [parameter["name"] for parameter in found["settings"]["parameters"]]
        told = ("severity", "worst_speed_rad_s", "meets_limit", "finished", "diverged", "failed", "not_settled")
        rows = [
            {"design": design["index"]}
            | dict(zip(names, design["values"], strict=True))
            | {name: design.get(name) for name in told}
            | {f"compared_{name}": design["compared"].get(name) for name in told if "compared" in design}
            for design in found["designs"]
        ]
        others = [f"compared_{name}" for name in told if "comparison" in found]
        frame = pd.DataFrame(rows, columns=["design", *names, *told, *others]).set_index("design")
        frame.attrs.update(
            threshold=found.get("threshold"), units=found["units"], settings=found["settings"], version=found["version"]
        )
        return frame

    def severities(self) -> xr.DataArray:
        """Severity by ``design`` and ``speed_rpm``, with the value of every parameter beside the design; NaN where it is not known."""
        found = self.json("campaign")
        values = np.array([design["by_speed"] for design in found["designs"]], dtype=float)
        coordinates: dict[str, Any] = {"speed_rpm": ("speed_rpm", np.array(found["speeds_rad_s"]) * RPM)}
        for place, parameter in enumerate(found["settings"]["parameters"]):
            coordinates[parameter["name"]] = ("design", [design["values"][place] for design in found["designs"]])
        return xr.DataArray(
            values, dims=("design", "speed_rpm"), coords=coordinates, name=found["settings"]["severity"]
        )

    def differences(self) -> pd.DataFrame:
        """How the model that is compared differs, a row per speed: mean difference of the severity, its standard error and interval, how many
        pairs it rests on and the verdict; empty where none is compared. ``attrs["severity"]`` has the same of the largest of all speeds."""
        found = self.json("campaign")
        comparison = found.get("comparison") or {"by_speed": []}
        speeds = np.array(found["speeds_rad_s"]) * RPM
        columns = ["speed_rpm", "pairs", "mean", "standard_error", "from", "to", "resolution", "verdict"]
        rows = [{"speed_rpm": speed} | of for speed, of in zip(speeds, comparison["by_speed"], strict=False) if of]
        frame = pd.DataFrame(rows, columns=columns).set_index("speed_rpm")
        frame.attrs.update(severity=comparison.get("severity"), message=comparison.get("message"), units=found["units"])
        return frame

    def sensitivities(self) -> pd.DataFrame:
        """First-order and total index of every parameter with their standard errors; empty where the design is not ``indices``."""
        found = self.json("campaign").get("sensitivities")
        columns = ["parameter", "first_order", "first_order_error", "total", "total_error"]
        return pd.DataFrame(found["parameters"] if found else [], columns=columns).set_index("parameter")


class Study(Job):
    """What accuracy costs: schemes and settings against a reference."""

    kind = "study"
    path = "/v1/studies"

    def work_precision(self) -> pd.DataFrame:
        """Every run of the study, a row each: speed, scheme, settings, CPU time, errors; units end the columns' names."""
        return table(self.arrays("work-precision"), "speed_rad_s")
