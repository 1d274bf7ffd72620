"""Meshes as Gmsh's text, version 2.2: solid elements and sets, with all digits."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import IO, Any, Protocol

import numpy as np
import numpy.typing as npt

Indices = npt.NDArray[np.int64]
#: Indices of points by the name of their set, and indices of elements, block by block.
PointSets = dict[str, Indices]
CellSets = dict[str, list[Indices]]

#: Solid elements in the words of meshio: Gmsh's number, number of nodes, and the order of the nodes in Gmsh where it differs from that of VTK.
_SOLIDS: dict[str, tuple[int, int, list[int]]] = {
    "tetra": (4, 4, []),
    "hexahedron": (5, 8, []),
    "wedge": (6, 6, []),
    "pyramid": (7, 5, []),
    "tetra10": (11, 10, [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]),
    "hexahedron20": (17, 20, [0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14]),
    "wedge15": (18, 15, [0, 1, 2, 3, 4, 5, 6, 8, 12, 7, 13, 14, 9, 11, 10]),
    "pyramid13": (19, 13, [0, 1, 2, 3, 4, 5, 8, 9, 6, 10, 7, 11, 12]),
}

#: Nodes of a wedge that is seen from the other side, as VTK's own files have it.
_TURNED = [0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13]

#: Cells that are no solids, by the beginnings of their names; sets of them are sets of their nodes.
_FLAT = ("vertex", "line", "triangle", "quad", "polygon")

#: Integers of cells whose values are sets, of which the first found is taken, as the service does with those of a .vtu.
_TAGS = ("material", "set", "PhysicalIds", "CellEntityIds", "medit:ref")


class Mesh(Protocol):
    """What is taken of a ``meshio.Mesh``, beside its sets and tags."""

    points: Any
    cells: Any


def write_mesh(mesh: Mesh, file: IO[bytes], chosen: Iterable[str | None] = ()) -> None:
    """Writes the solid elements of a mesh with their nodes and its sets; numbers of nodes and elements are indices in it, from 1.

    Args:
        mesh: a ``meshio.Mesh``.
        file: to write to.
        chosen: names of sets that are asked for as sets of nodes.

    Raises:
        ValueError: something that cannot be carried over: what, and what to do.
    """
    points = np.asarray(mesh.points, dtype=float)
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"points have the shape {points.shape}; give three coordinates each")
    blocks = [(str(block.type), np.array(block.data, dtype=np.int64)) for block in mesh.cells]
    for kind, nodes in blocks:
        if kind not in _SOLIDS and not kind.startswith(_FLAT):
            raise ValueError(f"{kind} elements cannot be carried over; solid elements are {', '.join(_SOLIDS)}")
        if kind in _SOLIDS and nodes.shape[1] != _SOLIDS[kind][1]:
            raise ValueError(f"{kind} elements have {_SOLIDS[kind][1]} nodes, not {nodes.shape[1]}")
        if nodes.size and not 0 <= nodes.min() <= nodes.max() < len(points):
            raise ValueError(f"{kind} elements have nodes that there are not: there are {len(points)} points")
        if kind.startswith("wedge"):
            a, b, c, d = (points[nodes[:, corner]] for corner in (0, 1, 2, 3))
            seen = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0.0
            nodes[seen] = nodes[seen][:, [place for place in _TURNED if place < nodes.shape[1]]]
    if not any(kind in _SOLIDS and len(nodes) for kind, nodes in blocks):
        raise ValueError("the mesh has no solid element")
    point_sets, cell_sets = _sets(mesh, blocks)
    for name in {name for name in chosen if name in point_sets and name in cell_sets}:
        beside = _nodes_of(blocks, cell_sets[name], solid=True)
        if np.setdiff1d(beside, point_sets[name]).size:
            raise ValueError(f"{name!r} is a set of points and, with other nodes, one of elements: rename one of them")
    for piece in _text(points, blocks, point_sets, cell_sets):
        file.write(piece.encode())


def _sets(mesh: Mesh, blocks: Sequence[tuple[str, Indices]]) -> tuple[PointSets, CellSets]:
    """Sets of a mesh and those that its tags make: physical groups of Gmsh, families of MED, references of others."""
    data = getattr(mesh, "cell_data", {})
    points = {name: np.asarray(of, dtype=np.int64).ravel() for name, of in getattr(mesh, "point_sets", {}).items()}
    cells: CellSets = {}
    for name, parts in getattr(mesh, "cell_sets", {}).items():
        if not name.startswith("gmsh:"):
            cells[name] = [_indices(part) for part in parts]

    def add(name: str, parts: list[Indices]) -> None:
        if any(part.size for part in parts):
            known = cells.get(name, [np.empty(0, np.int64)] * len(blocks))
            cells[name] = [np.union1d(one, other) for one, other in zip(known, parts, strict=True)]

    def tagged(values: Sequence[Any], tag: int) -> list[Indices]:
        return [np.flatnonzero(np.asarray(of) == tag) for of in values]

    names = {(int(tag), int(dim)): name for name, (tag, dim) in getattr(mesh, "field_data", {}).items()}
    physical = data.get("gmsh:physical", [])
    for tag in {int(tag) for of in physical for tag in np.unique(of) if tag}:
        for dim in range(4):
            parts = tagged(physical, tag)
            parts = [
                part[: None if _dimension(kind) == dim else 0] for part, (kind, _) in zip(parts, blocks, strict=True)
            ]
            add(names.get((tag, dim), str(tag)), parts)
    families = getattr(mesh, "cell_tags", {})
    for tag, of in families.items():
        for name in of:
            add(name, tagged(data["cell_tags"], tag))
    for tag, of in getattr(mesh, "point_tags", {}).items():
        here = np.flatnonzero(np.asarray(mesh.point_data["point_tags"]) == tag)  # type: ignore[attr-defined]
        for name in of:
            points[name] = np.union1d(points.get(name, here), here)
    for key in [key for key in _TAGS if key in data and np.issubdtype(np.asarray(data[key][0]).dtype, np.integer)][:1]:
        for tag in {int(tag) for of in data[key] for tag in np.unique(of)}:
            add(f"{key} {tag}", tagged(data[key], tag))
    return {name: of for name, of in points.items() if of.size}, cells


def _indices(part: Any) -> Indices:
    found = np.asarray([] if part is None else part).ravel()
    return np.flatnonzero(found) if found.dtype == bool else found.astype(np.int64)


def _dimension(kind: str) -> int:
    return 3 if kind in _SOLIDS else 0 if kind.startswith("vertex") else 1 if kind.startswith("line") else 2


def _nodes_of(blocks: Sequence[tuple[str, Indices]], parts: Sequence[Indices], solid: bool) -> Indices:
    found = [
        nodes[part].ravel() for (kind, nodes), part in zip(blocks, parts, strict=True) if (kind in _SOLIDS) == solid
    ]
    return np.unique(np.concatenate([np.empty(0, np.int64), *found]))


def _text(
    points: Any, blocks: Sequence[tuple[str, Indices]], of_points: PointSets, of_cells: CellSets
) -> Iterator[str]:
    """The file: sets of elements are groups of volumes, those of points and of what is no solid groups of points. Elements stand there once for each group, by one number."""
    of_nodes = dict(of_points)
    volumes: dict[str, int] = {}
    for name, parts in of_cells.items():
        flat = _nodes_of(blocks, parts, solid=False)
        if flat.size:
            of_nodes[name] = np.union1d(of_nodes.get(name, flat), flat)
        if any(part.size for part, (kind, _) in zip(parts, blocks, strict=True) if kind in _SOLIDS):
            volumes[name] = len(volumes) + 1
    names = [(0, group, name) for group, name in enumerate(of_nodes, 1)]
    names += [(3, group, name) for name, group in volumes.items()]
    yield "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    yield f"$PhysicalNames\n{len(names)}\n"
    for dim, group, name in names:
        yield f'{dim} {group} "{" ".join(name.split())}"\n'
    yield f"$EndPhysicalNames\n$Nodes\n{len(points)}\n"
    for number, (x, y, z) in enumerate(points.tolist(), 1):
        yield f"{number} {x!r} {y!r} {z!r}\n"
    rows: list[str] = []
    first = 1
    for place, (kind, nodes) in enumerate(blocks):
        if kind in _SOLIDS:
            number_of, _, order = _SOLIDS[kind]
            groups: list[list[int]] = [[] for _ in nodes]
            for name, group in volumes.items():
                for cell in np.unique(of_cells[name][place]).tolist():
                    groups[cell].append(group)
            ordered = (nodes[:, order] if order else nodes) + 1
            for number, (of, row) in enumerate(zip(groups, ordered.tolist(), strict=True), first):
                text = " ".join(map(str, row))
                rows += [f"{number} {number_of} 2 {group} 1 {text}\n" for group in of or [0]]
        first += len(nodes)
    for group, members in enumerate(of_nodes.values(), 1):
        rows += [f"{number} 15 2 {group} 1 {node}\n" for number, node in enumerate((members + 1).tolist(), first)]
        first += len(members)
    yield f"$EndNodes\n$Elements\n{len(rows)}\n"
    yield from rows
    yield "$EndElements\n"
