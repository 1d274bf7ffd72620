"""A sector as arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

Reals = npt.NDArray[np.float64]
Integers = npt.NDArray[Any]


@dataclass
class Sector:
    """What a package is made of; shapes as in :func:`rubmap.write_package`."""

    sectors: int
    mass: Any
    stiffness: list[Any]
    speeds: Reals
    ids: Integers
    positions: Reals
    dofs: Integers
    cyclic: Integers
    contact: Integers
    normals: Reals
    origin: Reals
    direction: Reals
    frame: str
    gyroscopic: Any

    def turned(self, positions: Reals) -> Reals:
        """Positions (m, 3) turned by +2π/N about the axis (Rodrigues' formula)."""
        axis = self.direction / np.linalg.norm(self.direction)
        angle = 2.0 * np.pi / self.sectors
        at = positions - self.origin
        along = np.outer(at @ axis, axis)
        return np.asarray(self.origin + along + np.cos(angle) * (at - along) + np.sin(angle) * np.cross(axis, at))
