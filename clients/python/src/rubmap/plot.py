"""Figures by matplotlib, with the axes and units of the service's drawings."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib import colormaps, pyplot
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize

from .tables import RPM

__all__ = [
    "backbones",
    "branches",
    "campbell",
    "casing",
    "critical_speeds",
    "envelope",
    "interaction_map",
    "interference",
    "level",
    "spectrogram",
    "spectrum",
    "work_precision",
]

#: Faintest amplitude of a map, of its loudest.
_QUIETEST = 1e-4

#: Colours that colour-blind readers tell apart (Okabe and Ito), those of the page and of the service's drawings.
_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c8c8c")

#: Dashes of nodal diameters, again and again.
_DASHES = ("-", "--", ":", "-.")

#: Marks of nodal diameters where dashes repeat.
_DIAMETER_MARKS = ("o", "s", "^", "D", "v", "h")


def interaction_map(
    found: xr.Dataset,
    ax: Axes | None = None,
    critical: pd.DataFrame | None = None,
    frequency: bool = False,
    log: bool = True,
) -> Axes:
    """Amplitude over speed and engine order, or frequency in Hz; with the critical speeds of :meth:`Sweep.critical_speeds` if they are given.

    Args:
        found: of :meth:`Sweep.interaction_map`.
        critical: speeds to mark.
        frequency: whether the axis upwards is in Hz.
        log: whether colours are logarithmic, from 1e-4 of the loudest on.
    """
    ax = _axes(ax)
    across, orders = _edges(found["speed_rpm"].to_numpy()), _edges(found["engine_order"].to_numpy())
    upwards = np.outer(across / 60.0, orders) if frequency else np.broadcast_to(orders, (len(across), len(orders)))
    corners = np.broadcast_to(across[:, None], upwards.shape)
    _cells(ax, corners, upwards, found["amplitude"].to_numpy(), found["amplitude"].attrs["units"], log)
    if critical is not None:
        for speed in critical["speed_rpm"]:
            ax.axvline(speed, color="white", linewidth=0.8, linestyle="--")
    ax.set_xlabel("speed of rotation, rpm")
    ax.set_ylabel("frequency, Hz" if frequency else "engine order")
    ax.set_title(f"Interaction map: {found.attrs['sensor']}")
    return ax


def level(found: pd.DataFrame | xr.Dataset, ax: Axes | None = None, quantity: str | None = None) -> Axes:
    """Level over speed: of :meth:`Sweep.level` the ``tip_motion`` of the whole wheel or another of its quantities, with its error; of
    :meth:`Sweep.points` the ``rms``, ``half_peak_to_peak`` or another part of the sensor's response; of :meth:`Sweep.interaction_map` the
    ``rms`` of the engine orders that it has, without the mean."""
    ax = _axes(ax)
    of_wheel = {} if isinstance(found, xr.Dataset) else _wheel_quantities(found)
    if of_wheel:
        quantity = quantity or ("tip_motion" if "tip_motion" in of_wheel else next(iter(of_wheel)))
        _one_of(quantity, of_wheel, "the level of the wheel")
        unit = of_wheel[quantity]
        speed, value = found["speed_rpm"], found[f"{quantity}_value{unit}"]
        error = found[f"{quantity}_error{unit}"]
        ax.plot(speed, value, marker=".", color=_COLOURS[0])
        ax.fill_between(speed, value - error, value + error, color=_COLOURS[0], alpha=0.2, linewidth=0.0)
        ax.set_ylabel(", ".join(filter(None, (quantity.replace("_", " "), unit.removeprefix("_")))))
    else:
        quantity = quantity or "rms"
        points = _level_of_map(found, quantity) if isinstance(found, xr.Dataset) else found
        there = [column.removeprefix("response.") for column in points.columns if column.startswith("response.")]
        if there:
            _one_of(quantity, there, "a response")
            ax.plot(points["speed_rpm"], points[f"response.{quantity}"], marker=".", color=_COLOURS[0])
        ax.set_ylabel(f"level, {points.attrs['unit']} {quantity.replace('_', ' ')}")
    ax.set_xlabel("speed of rotation, rpm")
    ax.set_ylim(bottom=0.0)
    return ax


def _wheel_quantities(level: pd.DataFrame) -> dict[str, str]:
    """Quantities of the level of the wheel, each with the end of its columns' names: the unit behind an underscore, or nothing."""
    parts = [column.partition("_value") for column in level.columns]
    return {quantity: unit for quantity, value, unit in parts if value and f"{quantity}_error{unit}" in level}


def _one_of(quantity: str, there: Iterable[str], what: str) -> None:
    """Raises unless a quantity is among those that are there."""
    if quantity not in there:
        raise ValueError(f"{what} has no {quantity}; it has {', '.join(there)}")


def _of_family(family: int, count: int) -> Any:
    """Colour of one of so many families, counted from 1, as the service has it."""
    if count < len(_COLOURS):
        return _COLOURS[family - 1]
    return colormaps["viridis"](0.2 + 0.7 * (family - 1) / (count - 1))


def _level_of_map(found: xr.Dataset, quantity: str) -> pd.DataFrame:
    """Root mean square of the lines of a map, which are amplitudes of single-sided spectra, as points have it."""
    if quantity != "rms":
        raise ValueError(f"an interaction map has no {quantity}, only rms; Sweep.points() has it")
    amplitude = found["amplitude"].transpose("speed", "engine_order").to_numpy()
    moving = amplitude[:, found["engine_order"].to_numpy() > 0.0]
    rms = np.sqrt(np.sum(moving**2, axis=1) / 2.0)
    points = pd.DataFrame({"speed_rpm": found["speed_rpm"].to_numpy(), "response.rms": rms})
    points.attrs["unit"] = found["amplitude"].attrs["units"]
    return points


def _of_diameter(diameter: int) -> dict[str, Any]:
    """Dashes and marks of a nodal diameter."""
    turn, dashes = divmod(diameter, len(_DASHES))
    mark = _DIAMETER_MARKS[(turn - 1) % len(_DIAMETER_MARKS)] if turn > 0 else ""
    return {"linestyle": _DASHES[dashes], "marker": mark, "markersize": 4.0}


def campbell(
    found: xr.Dataset, ax: Axes | None = None, lobes: int | None = None, crossings: pd.DataFrame | None = None
) -> Axes:
    """Natural frequencies over speed, of :meth:`ModalAnalysis.campbell`: families in colours, nodal diameters by dashes.

    Args:
        found: the frequencies.
        ax: axes to draw on.
        lobes: number of lobes whose engine orders are drawn.
        crossings: marks, of :meth:`ModalAnalysis.crossings` or :meth:`ModalAnalysis.driven_crossings`.
    """
    ax = _axes(ax)
    rpm = found["speed_rpm"].to_numpy()
    families, diameters = (found[name].to_numpy().tolist() for name in ("family", "nodal_diameter"))
    for family in families:
        colour = _of_family(family, len(families))
        for diameter in diameters:
            frequency = found["frequency"].sel(family=family, nodal_diameter=diameter).to_numpy()
            ax.plot(rpm, frequency, color=colour, linestyle=_DASHES[diameter % len(_DASHES)])
        ax.plot([], [], color=colour, label=f"family {family}")
    for first, dashes in enumerate(_DASHES[: len(diameters)]):
        alike = ", ".join(str(diameter) for diameter in diameters[first :: len(_DASHES)])
        ax.plot([], [], color="grey", linestyle=dashes, label=f"nodal diameter {alike}")
    if lobes is not None:
        for order in range(lobes, 4 * lobes, lobes):
            ax.plot(rpm, order * rpm / 60.0, color="grey", linewidth=0.8, linestyle=":")
    if crossings is not None:
        ax.plot(
            crossings["speed_rpm"],
            crossings["frequency_hz"],
            "o",
            markerfacecolor="none",
            color="black",
            linestyle="none",
        )
    ax.set_xlabel("speed of rotation, rpm")
    ax.set_ylabel("frequency, Hz")
    ax.legend(fontsize="small")
    return ax


def casing(found: pd.DataFrame, ax: Axes | None = None) -> Axes:
    """Casing around the circumference where it comes closest to the tips, of :meth:`Sweep.casing`; its distance is drawn larger, as the title says."""
    ax = _axes(ax)
    node = int(np.argmin(found.min().to_numpy()))
    gap, radius, length = found.iloc[:, node].to_numpy(), found.attrs["radius"][node], found.attrs["length"]
    largest = float(np.abs(gap).max())
    times = float(f"{max(1.0, 0.1 * radius / largest):.0e}") if largest > 0.0 else 1.0
    around = np.linspace(0.0, 2.0 * np.pi, 721)
    wall = radius + times * np.interp(around, found.index.to_numpy(), gap, period=2.0 * np.pi)
    tips = np.arange(found.attrs["sectors"]) * 2.0 * np.pi / found.attrs["sectors"]
    ax.plot(radius * np.cos(around), radius * np.sin(around), color="grey", linewidth=0.8, linestyle=":")
    ax.plot(radius * np.cos(tips), radius * np.sin(tips), "o", markersize=4, color=_COLOURS[0], label="tips")
    ax.plot(wall * np.cos(around), wall * np.sin(around), color="#444444", linewidth=2.5, label="casing at rest")
    inward = np.where(wall < radius, wall, np.nan)
    if np.isfinite(inward).any():
        label = "casing farther in than the tips"
        ax.plot(inward * np.cos(around), inward * np.sin(around), color="#b01f20", linewidth=3.5, label=label)
    ax.set_aspect("equal")
    ax.set_xlabel(f"x, {length}")
    ax.set_ylabel(f"y, {length}")
    ax.set_title(f"contact node {found.columns[node]}, distance drawn {times:,.0f} times as large")
    ax.legend(fontsize="small")
    return ax


def backbones(found: pd.DataFrame, ax: Axes | None = None) -> Axes:
    """Amplitude over the change of the frequency, of :meth:`ModalAnalysis.backbones`: families in colours, nodal diameters by dashes and marks."""
    ax = _axes(ax)
    column = next(name for name in found.columns if name.startswith("amplitude_"))
    families = sorted({int(family) for family in found["family"]})
    for _, curve in found.groupby(["nodal_diameter", "family"]):
        diameter, family = (int(curve[name].iloc[0]) for name in ("nodal_diameter", "family"))
        colour = _of_family(family, families[-1])
        ax.plot(curve["change_percent"], curve[column], color=colour, markevery=8, **_of_diameter(diameter))
    for family in families:
        ax.plot([], [], color=_of_family(family, families[-1]), label=f"family {family}")
    for diameter in sorted({int(diameter) for diameter in found["nodal_diameter"]}):
        ax.plot([], [], color="grey", label=f"nodal diameter {diameter}", **_of_diameter(diameter))
    ax.set_xlabel("change of the natural frequency, %")
    ax.set_ylabel(f"amplitude, {column.removeprefix('amplitude_')}")
    ax.legend(fontsize="small")
    return ax


def interference(found: pd.DataFrame, ax: Axes | None = None) -> Axes:
    """Modes over the nodal diameter at one speed and the zig-zag of engine orders, of :meth:`ModalAnalysis.interference`."""
    ax = _axes(ax)
    orders = found.attrs["engine_orders"]
    ax.plot([0, *orders["nodal_diameter"]], [0.0, *orders["frequency_hz"]], color="grey", linewidth=0.8)
    driven = pd.DataFrame(orders).query("of_lobes")
    ax.plot(driven["nodal_diameter"], driven["frequency_hz"], "D", color="#d62728", label="engine orders of the lobes")
    for family in range(1, int(found["family"].max()) + 1):
        modes = found[found["family"] == family]
        colour = _of_family(family, int(found["family"].max()))
        ax.plot(modes["nodal_diameter"], modes["frequency_hz"], "o", color=colour, label=f"family {family}")
    ax.set_ylim(0.0, 1.08 * float(found["frequency_hz"].max()))
    ax.set_xlabel("nodal diameter")
    ax.set_ylabel("frequency, Hz")
    ax.set_title(f"{found.attrs['speed_rpm']:,.0f} rpm")
    ax.legend(fontsize="small")
    return ax


def spectrum(found: xr.Dataset, ax: Axes | None = None, sensor: int = 0) -> Axes:
    """Amplitude over engine orders of one speed, of :meth:`Sweep.spectrum`."""
    ax = _axes(ax)
    one = found.isel(sensor=sensor)
    ax.semilogy(one["engine_order"], one["amplitude"], color=_COLOURS[0], linewidth=0.9)
    ax.set_xlabel("engine order")
    ax.set_ylabel(f"amplitude, {found['amplitude'].attrs['units']}")
    ax.set_title(f"{float(found['speed']) * RPM:,.0f} rpm: {one['sensor'].item()}")
    return ax


def critical_speeds(table: pd.DataFrame, ax: Axes | None = None) -> Axes:
    """Critical speeds by their largest vibration, with the uncertainty of the speed, of :meth:`Sweep.wheel_critical_speeds` or :meth:`Sweep.critical_speeds`."""
    ax = _axes(ax)
    name = next(column for column in table.columns if column.startswith("half_peak_to_peak_"))
    error = table["speed_error_rad_s"] * RPM
    ax.errorbar(table["speed_rpm"], table[name], xerr=error, fmt="o", capsize=3, color=_COLOURS[1])
    ax.set_xlabel("speed of rotation, rpm")
    ax.set_ylabel(f"half peak to peak, {name.removeprefix('half_peak_to_peak_')}")
    ax.set_ylim(bottom=0.0)
    return ax


def work_precision(table: pd.DataFrame, ax: Axes | None = None, error: str = "amplitude") -> Axes:
    """Error over CPU time by scheme, of :meth:`Study.work_precision`."""
    ax = _axes(ax)
    column = next(name for name in table.columns if name.startswith(error))
    for number, (scheme, runs) in enumerate(table.groupby("scheme")):
        ordered = runs.sort_values("time_s")
        ax.loglog(
            ordered["time_s"], ordered[column], marker="o", color=_COLOURS[number % len(_COLOURS)], label=str(scheme)
        )
    ax.set_xlabel("CPU time, s")
    ax.set_ylabel(f"error of {error.replace('_', ' ')}")
    ax.legend(fontsize="small")
    return ax


#: What changes along branches, as an axis.
_ALONG = {
    "speed": "speed of rotation, rpm",
    "clearance": "clearance / that of the scene",
    "lobe_amplitude": "height of the lobes / that of the scene",
    "damping": "damping / that of the scene",
}

#: Marks of bifurcations.
_MARKS = {"fold": "^", "flip": "D", "neimark_sacker": "o", "branching": "s"}


def branches(points: pd.DataFrame, ax: Axes | None = None, bifurcations: pd.DataFrame | None = None) -> Axes:
    """Amplitude along branches, of :meth:`Branches.points`: solid where it is stable, dashed where it is not, dotted where that is not known.

    Args:
        bifurcations: of :meth:`Branches.bifurcations`, to be marked.
    """
    ax = _axes(ax)
    along = "speed_rpm" if points.attrs["parameter"] == "speed" else "value"
    for branch, own in points.groupby("branch"):
        colour = _COLOURS[int(str(branch)) % len(_COLOURS)]
        known = np.where(own["stability"] == "stable", 0, np.where(own["stability"] == "undecided", 2, 1))
        # Between two points of different kinds a line is of the worse one.
        kinds = np.maximum(known[:-1], known[1:])
        across, upwards = own[along].to_numpy(float), own["half_peak_to_peak"].to_numpy(float)
        begins = np.flatnonzero(np.diff(kinds, prepend=-1))
        for begin, end in zip(begins, [*begins[1:], len(kinds)], strict=True):
            part = slice(begin, end + 1)
            ax.plot(across[part], upwards[part], color=colour, linestyle=("-", "--", ":")[kinds[begin]])
        ax.plot([], [], color=colour, label=f"branch {int(str(branch)) + 1}")
    if bifurcations is not None:
        for kind, some in bifurcations.groupby("kind"):
            words = str(kind).replace("_", "–")
            mark = _MARKS[str(kind)]
            ax.plot(some[along], some["half_peak_to_peak"], mark, color="black", zorder=3.0, label=words)
    ax.set_xlabel(_ALONG[points.attrs["parameter"]])
    ax.set_ylabel(f"half peak to peak, {points.attrs['unit']}")
    ax.set_ylim(bottom=0.0)
    if not points.empty:
        ax.legend(fontsize="small")
    return ax


#: What is told of frames, as an axis.
_OF_FRAMES = {"half_peak_to_peak": "half peak to peak", "largest": "largest displacement at any sector"}


def envelope(frames: pd.DataFrame, ax: Axes | None = None, quantity: str = "half_peak_to_peak") -> Axes:
    """Envelopes of run-ups over the speed, a line per run, of :meth:`RunUps.envelope`: broad where something touches, with a ring where it is highest.

    Args:
        quantity: ``half_peak_to_peak`` at the sensor's own sector, or ``largest`` at any sector, with the limit if there is one.
    """
    ax = _axes(ax)
    runs = frames[["run", "rate_rad_s2"]].drop_duplicates().sort_values("rate_rad_s2", kind="stable")
    for rank, (number, rate) in enumerate(zip(runs["run"], runs["rate_rad_s2"], strict=True)):
        # Slow runs are dark; yellow is too pale for a line.
        colour = _COLOURS[0] if len(runs) == 1 else colormaps["viridis"](0.9 * rank / (len(runs) - 1))
        own = frames[frames["run"] == number]
        across, upwards = own["speed_rpm"].to_numpy(float), own[quantity].to_numpy(float)
        ax.plot(across, upwards, color=colour, label="run" if np.isnan(rate) else f"{rate:.4g} rad/s²")
        touching = np.where(own["contact_share"].to_numpy(float) > 0.0, upwards, np.nan)
        ax.plot(across, touching, color=colour, linewidth=3.0)
        highest = int(np.argmax(upwards))
        ax.plot(across[highest], upwards[highest], "o", markerfacecolor="none", color=colour)
    limit = frames.attrs["settings"].get("limit") if quantity == "largest" else None
    if limit is not None:
        ax.axhline(limit, color="grey", linewidth=0.8, linestyle="--", label="limit")
    ax.set_xlabel("speed of rotation, rpm")
    ax.set_ylabel(f"{_OF_FRAMES[quantity]}, {frames.attrs['unit']}")
    ax.set_ylim(bottom=0.0)
    if not frames.empty:
        ax.legend(fontsize="small")
    return ax


def spectrogram(found: pd.DataFrame, ax: Axes | None = None) -> Axes:
    """Amplitude over engine order and speed, of :meth:`RunUps.spectrogram`; over time where the speed turns back or never changes. The mean is left out."""
    ax = _axes(ax)
    rpm, times = (found.index.get_level_values(name).to_numpy(float) for name in ("speed_rpm", "time_s"))
    orders = found.columns.to_numpy(float)
    # Under a Hann window the mean is in the line next to it as well; without a frame there are no orders.
    shown = orders >= np.minimum(1.0, 2.0 * orders[1:2].sum())
    # Frames in which the speed is held have no width over it.
    steps, same = np.diff(rpm), 1e-9 * rpm.max(initial=0.0)
    over_speed = bool(np.any(abs(steps) > same) and (np.all(steps >= -same) or np.all(steps <= same)))
    if not found.empty:
        across, upwards = np.meshgrid(_edges(rpm if over_speed else times), _edges(orders[shown]), indexing="ij")
        _cells(ax, across, upwards, found.to_numpy()[:, shown], found.attrs["unit"])
    ax.set_xlabel("speed of rotation, rpm" if over_speed else "time, s")
    ax.set_ylabel("engine order")
    rate = found.attrs["rate_rad_s2"]
    ax.set_title("Spectrogram" if rate is None else f"Spectrogram at {rate:.4g} rad/s²")
    return ax


def _cells(ax: Axes, across: Any, upwards: Any, amplitude: Any, unit: str, log: bool = True) -> None:
    """Amplitudes as cells between corners, with a bar of their colours."""
    loudest = float(np.nanmax(amplitude, initial=0.0))
    logarithmic = log and loudest > 0.0
    # Where nothing moves, all is as quiet as the colours go.
    norm = LogNorm(_QUIETEST * loudest, loudest) if logarithmic else Normalize(0.0, loudest or 1.0)
    shown = np.maximum(amplitude, _QUIETEST * loudest) if logarithmic else amplitude
    cells = ax.pcolormesh(across, upwards, shown, norm=norm, cmap="inferno", shading="flat", rasterized=True)
    _figure(ax).colorbar(cells, ax=ax, label=f"amplitude, {unit}")


def _edges(centres: Any) -> Any:
    """Edges of cells: half way between their centres, and as far beyond the outer ones."""
    if len(centres) == 1:
        return np.array([centres[0] - 0.5, centres[0] + 0.5])
    inner = (centres[1:] + centres[:-1]) / 2.0
    return np.concatenate([[2.0 * centres[0] - inner[0]], inner, [2.0 * centres[-1] - inner[-1]]])


def _axes(ax: Axes | None) -> Axes:
    return ax if ax is not None else pyplot.subplots(layout="constrained")[1]


def _figure(ax: Axes) -> Any:
    return ax.get_figure()
