"""What the service would refuse, found before anything is written or sent."""

from __future__ import annotations

import numpy as np

from .errors import PackageError
from .sector import Integers, Sector

#: Largest asymmetry of a matrix, of its largest entry; largest distance of a cyclic pair, of the model's size; of a normal's length from 1.
_SYMMETRY, _PLACE, _UNIT = 1e-6, 1e-5, 1e-3


def check(sector: Sector) -> None:
    """Refuses a sector with a defect that can be found here; the service looks at more, such as whether the mass is definite.

    Raises:
        PackageError: argument, place, and what to do.
    """
    _numbers(sector)
    _nodes(sector)
    _matrices(sector)
    _cyclic(sector)
    _contact(sector)


def _numbers(sector: Sector) -> None:
    if sector.sectors < 1:
        raise PackageError(f"sectors: {sector.sectors}; a wheel has at least 1")
    if len(sector.stiffness) not in (1, 3) or len(sector.speeds) != len(sector.stiffness):
        raise PackageError(
            f"stiffness, speeds_rad_s: {len(sector.stiffness)} matrices and {len(sector.speeds)} speeds; give one of each, or three"
        )
    if sector.speeds[0] != 0.0 or not np.all(np.diff(sector.speeds) > 0.0):
        raise PackageError(f"speeds_rad_s: {sector.speeds.tolist()} must ascend and begin at 0")
    if sector.direction.shape != (3,) or sector.origin.shape != (3,) or not np.linalg.norm(sector.direction) > 0.0:
        raise PackageError("axis: give an origin and a direction of three numbers each, the direction not zero")
    if sector.frame not in ("cartesian", "cylindrical"):
        raise PackageError(f"frame: {sector.frame!r}; it is 'cartesian' or 'cylindrical'")


def _nodes(sector: Sector) -> None:
    count = len(sector.ids)
    if sector.positions.shape != (count, 3):
        raise PackageError(f"positions: shape {sector.positions.shape}; of {count} nodes it is ({count}, 3)")
    lost = np.flatnonzero(~np.isfinite(sector.positions).all(axis=1))
    if lost.size:
        raise PackageError(f"positions: row {lost[0]} (node {sector.ids[lost[0]]}) is not finite")
    _once("node_ids", sector.ids)
    unknown = np.flatnonzero(~np.isin(sector.dofs[:, 0], sector.ids))
    if unknown.size:
        raise PackageError(f"dofs: row {unknown[0]} names node {sector.dofs[unknown[0], 0]}, which is not in node_ids")
    wrong = np.flatnonzero(~np.isin(sector.dofs[:, 1], (1, 2, 3)))
    if wrong.size:
        raise PackageError(f"dofs: row {wrong[0]} has component {sector.dofs[wrong[0], 1]}; components are 1, 2 and 3")
    _, first, counts = np.unique(sector.dofs, axis=0, return_index=True, return_counts=True)
    if np.any(counts > 1):
        node, component = sector.dofs[first[counts > 1][0]]
        raise PackageError(
            f"dofs: node {node}, component {component} is there twice; every row of the matrices is another"
        )


def _matrices(sector: Sector) -> None:
    rows = len(sector.dofs)
    named = [
        ("mass", sector.mass, 1.0),
        *((f"stiffness[{k}]", matrix, 1.0) for k, matrix in enumerate(sector.stiffness)),
    ]
    if sector.gyroscopic is not None:
        named.append(("gyroscopic", sector.gyroscopic, -1.0))
    for name, matrix, sign in named:
        if matrix.shape != (rows, rows):
            raise PackageError(f"{name}: shape {matrix.shape}; dofs has {rows} rows, so it is ({rows}, {rows})")
        wrong = np.flatnonzero(~np.isfinite(matrix.data))
        if wrong.size:
            entries = matrix.tocoo()
            row, column = entries.row[wrong[0]], entries.col[wrong[0]]
            raise PackageError(f"{name}: row {row}, column {column} (counted from 0) is not finite")
        apart = abs(matrix - sign * matrix.T).tocoo()
        most = abs(matrix).max() if matrix.nnz else 0.0
        if apart.nnz and apart.data.max() > _SYMMETRY * most:
            at = int(apart.data.argmax())
            kind = "symmetric" if sign > 0 else "skew-symmetric"
            raise PackageError(
                f"{name}: not {kind} at row {apart.row[at]}, column {apart.col[at]} (counted from 0), by {apart.data[at]:.3g}; "
                "give both triangles"
            )
    diagonal = sector.mass.diagonal()
    # Rows of the high face may be assembled on the low one.
    light = np.flatnonzero((diagonal <= 0.0) & ~np.isin(sector.dofs[:, 0], sector.cyclic[:, 1]))
    if light.size:
        node, component = sector.dofs[light[0]]
        raise PackageError(f"mass: the diagonal of row {light[0]} (node {node}, component {component}) is not positive")


def _cyclic(sector: Sector) -> None:
    if sector.cyclic.size == 0:
        if sector.sectors > 1:
            raise PackageError(
                f"cyclic: empty, and the wheel has {sector.sectors} sectors; name the pairs of low and high nodes"
            )
        return
    for row, pair in enumerate(sector.cyclic):
        for node in pair:
            if node not in sector.ids:
                raise PackageError(f"cyclic: row {row} names node {node}, which is not in node_ids")
    _once("cyclic (low)", sector.cyclic[:, 0])
    _once("cyclic (high)", sector.cyclic[:, 1])
    place = {int(id): k for k, id in enumerate(sector.ids)}
    low, high = ([place[int(id)] for id in sector.cyclic[:, side]] for side in (0, 1))
    distance = np.linalg.norm(sector.turned(sector.positions[low]) - sector.positions[high], axis=1)
    size = float(np.ptp(sector.positions, axis=0).max())
    worst = int(distance.argmax())
    if distance[worst] > _PLACE * size:
        a, b = sector.cyclic[worst]
        raise PackageError(
            f"cyclic: row {worst}: node {a} turned by +2π/{sector.sectors} lies {distance[worst]:.3g} away from node {b}; the low node comes first"
        )
    components = {int(id): set[int]() for id in sector.ids}
    for node, component in sector.dofs:
        components[int(node)].add(int(component))
    for row, (a, b) in enumerate(sector.cyclic):
        if components[int(a)] != components[int(b)]:
            raise PackageError(f"cyclic: row {row}: nodes {a} and {b} have other components in dofs; clamp both alike")


def _contact(sector: Sector) -> None:
    if len(sector.contact) == 0:
        raise PackageError("contact: empty; name the nodes at the blade's tip from the leading to the trailing edge")
    if sector.normals.shape != (len(sector.contact), 3):
        raise PackageError(
            f"normals: shape {sector.normals.shape}; of {len(sector.contact)} contact nodes it is ({len(sector.contact)}, 3)"
        )
    _once("contact", sector.contact)
    for row, node in enumerate(sector.contact):
        if node not in sector.ids:
            raise PackageError(f"contact: entry {row} names node {node}, which is not in node_ids")
        if node in sector.cyclic:
            raise PackageError(
                f"contact: entry {row}: node {node} lies on a cyclic face; contact nodes are within the sector"
            )
        if node not in sector.dofs[:, 0]:
            raise PackageError(f"contact: entry {row}: node {node} is clamped; it has no row in dofs")
    length = np.linalg.norm(sector.normals, axis=1)
    wrong = np.flatnonzero(~(np.abs(length - 1.0) <= _UNIT))
    if wrong.size:
        raise PackageError(f"normals: row {wrong[0]} has length {length[wrong[0]]:.6g}; divide it by that")


def _once(name: str, ids: Integers) -> None:
    found, counts = np.unique(ids, return_counts=True)
    if np.any(counts > 1):
        raise PackageError(f"{name}: node {found[counts > 1][0]} is there twice")
