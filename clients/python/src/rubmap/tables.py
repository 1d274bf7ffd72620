"""Arrays of results as labelled arrays and tables."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import xarray as xr

from .download import Arrays

#: rad/s in revolutions a minute.
RPM = 60.0 / (2.0 * np.pi)

#: Arrays that say where numbers come from: attributes of tables, not columns.
_CREDENTIALS = ("settings", "units", "version", "point", "strengths")


#: Words of the contract, and the names of columns in their place.
_PLAIN = {"validity": "linear_theory", "settling": "steady_state"}


def plain_name(name: str) -> str:
    """The name of a column in plain words: ``validity`` of the contract, and what begins so, is ``linear_theory``, ``settling`` is
    ``steady_state``; the verdict of both stands under the word itself."""
    for word, plain in _PLAIN.items():
        rest = name.removeprefix(word)
        if rest != name and rest[:1] in ("", ".", "_"):
            return plain if rest == ".verdict" else plain + rest
    return name


def credentials(found: Arrays) -> dict[str, Any]:
    """Settings, units and version of the code, as attributes: texts, as files of numpy and netCDF take them."""
    return {name: str(found[name]) for name in _CREDENTIALS if name in found}


def units(found: Arrays) -> dict[str, str]:
    """Units of the model: length, force, time, mass."""
    return dict(json.loads(str(found["units"])))


def speed_axis(speeds_rad_s: npt.NDArray[Any], indices: npt.NDArray[Any] | None = None) -> dict[str, Any]:
    """Coordinates of the dimension ``speed``: rad/s, rpm, and its index in the request."""
    axis: dict[str, Any] = {
        "speed": ("speed", speeds_rad_s, {"units": "rad/s", "long_name": "speed of rotation"}),
        "speed_rpm": ("speed", speeds_rad_s * RPM, {"units": "rpm", "long_name": "speed of rotation"}),
    }
    if indices is not None:
        axis["index"] = ("speed", indices, {"long_name": "index of the speed in the request"})
    return axis


def table(found: Arrays, length_of: str) -> pd.DataFrame:
    """The columns as long as the one named so, one row an entry; credentials are in ``attrs``."""
    length = len(found[length_of])
    columns = {plain_name(name): values for name, values in found.items() if values.ndim == 1 and len(values) == length}
    # An empty table has its columns, too, but for those of another dimension that is empty as well.
    for other in ("missing", "sensors", "speeds_rad_s", "speed_indices"):
        columns.pop(other, None)
    frame = pd.DataFrame(columns)
    if "speed_rad_s" in frame:
        frame.insert(list(frame.columns).index("speed_rad_s") + 1, "speed_rpm", frame["speed_rad_s"] * RPM)
    frame.attrs.update(credentials(found))
    return frame


def sensors(found: Arrays) -> list[str]:
    """Sensors in words: component, contact node or node, sector."""
    words = []
    for text in found["sensors"].tolist():
        sensor = json.loads(text)
        place = next(
            (f"{name} {sensor[name]}" for name in ("contact_node", "node", "gauge", "nearest") if name in sensor), ""
        )
        words.append(
            f"{sensor.get('component', 'direction')}, {place}, sector {sensor.get('sector', 0)}".replace("_", " ")
        )
    return words


def sensor_unit(found: Arrays) -> str:
    """The unit of what the sensors say, of length or, of strain gauges, ``strain``; both where they differ."""
    length = units(found)["length"]
    return " or ".join(
        dict.fromkeys("strain" if json.loads(text).get("gauge") else length for text in found["sensors"].tolist())
    )


def dataset(variables: dict[str, Any], coordinates: dict[str, Any], found: Arrays) -> xr.Dataset:
    """A dataset with credentials as attributes."""
    return xr.Dataset(variables, coords=coordinates, attrs=credentials(found))
