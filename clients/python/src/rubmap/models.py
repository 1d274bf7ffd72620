"""Models of the service."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from .download import Arrays, arrays, download
from .notebook import rows
from .service import Service


class Model:
    """A model by its id.

    Attributes:
        id: digest of its content.
        facts: what the service tells of it: ``name``, ``sectors``, ``own_dofs``, ``contact_nodes``, ``contact_radius``, ``speeds_rad_s``,
            ``units``, ``mesh``, ``stiffening``, ``reductions`` …
    """

    def __init__(self, service: Service, facts: Mapping[str, Any]) -> None:
        self._service = service
        self.id = str(facts["id"])
        self.facts = dict(facts)

    def __repr__(self) -> str:
        return f"<rubmap model {self.id[:12]} {self.facts['name']!r}, {self.facts['sectors']} sectors>"

    def _repr_html_(self) -> str:
        told = {
            "model": self.facts["name"],
            "sectors": self.facts["sectors"],
            "contact nodes": self.facts["contact_nodes"],
            "units": ", ".join(self.units.values()),
            "id": self.id,
        }
        return rows((name, str(value)) for name, value in told.items())

    @property
    def units(self) -> dict[str, str]:
        """Units of length, force, time and mass."""
        return dict(self.facts["units"])

    @property
    def found(self) -> list[str]:
        """What was found in the mesh that it was made from, a sentence or fact each: axis, sectors, clamp, contact line, notes. Empty for others."""
        return list(self.facts.get("found", []))

    def refresh(self) -> Model:
        """Reads it again: after the first sweep it has a reduction."""
        self.facts = self._service.get(f"/v1/models/{self.id}")
        return self

    def label(self, **changes: Any) -> Model:
        """Changes ``name``, ``tags`` and ``notes``: what is not given stays, None takes away."""
        self.facts = self._service.patch(f"/v1/models/{self.id}", changes)
        return self

    @property
    def reductions(self) -> list[dict[str, Any]]:
        """What its reductions found, with their certificates."""
        return list(self.refresh().facts["reductions"])

    def modes(self, speed_rad_s: float = 0.0, modes_per_speed: int | None = None) -> pd.DataFrame:
        """Natural frequencies in the rotating frame, Hz: a row per nodal diameter, a column per mode. It must have been reduced."""
        query = {"speed_rad_s": speed_rad_s, "modes_per_speed": modes_per_speed}
        found = self._service.get(f"/v1/models/{self.id}/modes", **query)
        rows = {row["nodal_diameter"]: row["frequencies_hz"] for row in found["nodal_diameters"]}
        frame = pd.DataFrame.from_dict(rows, orient="index")
        frame.index.name = "nodal_diameter"
        frame.columns = pd.RangeIndex(1, frame.shape[1] + 1, name="mode_hz")
        return frame

    def mesh(self, sector: int | None = None) -> Arrays:
        """Nodes and elements: ``position`` (points × 3), ``node``, ``sector``, ``contact``, and elements as in VTK."""
        return arrays(self._service, f"/v1/models/{self.id}/mesh", sector=sector)

    def download(self, result: str, to: str | os.PathLike[str], format: str | None = None, **query: Any) -> Path:
        """Writes ``"mesh"``, ``"section"`` or ``"modes"`` to a file, in the form that its name ends with."""
        form = format or Path(to).suffix.lstrip(".") or None
        return download(self._service, f"/v1/models/{self.id}/{result}", to, format=form, **query)

    def delete(self) -> None:
        """Deletes it; jobs keep what they found."""
        self._service.delete(f"/v1/models/{self.id}")
