"""Model packages from matrices."""

from __future__ import annotations

import io
import json
import os
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, cast

import numpy as np
import numpy.typing as npt
from scipy import sparse

from .checks import check
from .errors import PackageError
from .sector import Sector

#: Consistent units that need not be given.
MILLIMETRES = {"length": "mm", "force": "N", "time": "s", "mass": "t"}


def write_package(
    path: str | os.PathLike[str],
    *,
    sectors: int,
    mass: Any,
    stiffness: Sequence[Any],
    speeds_rad_s: npt.ArrayLike,
    node_ids: npt.ArrayLike,
    positions: npt.ArrayLike,
    dofs: npt.ArrayLike,
    cyclic: npt.ArrayLike,
    contact: npt.ArrayLike,
    normals: npt.ArrayLike,
    name: str = "impeller",
    units: Mapping[str, str] | None = None,
    axis: tuple[npt.ArrayLike, npt.ArrayLike] = ((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    frame: Literal["cartesian", "cylindrical"] = "cartesian",
    gyroscopic: Any = None,
    mesh: Mapping[str, Any] | None = None,
) -> Path:
    """Writes one sector as a model package, after the checks that can be made here.

    Args:
        path: zip to write.
        sectors: N, the number of identical sectors of the wheel.
        mass: n × n, symmetric, a scipy sparse matrix or what becomes one.
        stiffness: K(Ω) on the undeformed geometry, n × n each: a list of one, or of three for (0, Ω1/2, Ω1).
        speeds_rad_s: their speeds in rad/s, ascending, beginning at 0.
        node_ids: (m,), integers.
        positions: (m, 3), Cartesian, length.
        dofs: (n, 2): node id and component 1, 2 or 3 of every row of the matrices; clamped ones are absent.
        cyclic: (p, 2): ids of low and high nodes; the high one is the low one turned by +2π/N. Empty for a single blade.
        contact: ids of the nodes that may touch, from the leading to the trailing edge.
        normals: (len(contact), 3): unit normals out of the blade into the casing, in ``frame``.
        name: free text.
        units: of length, force, time, mass, consistent; mm, N, s, t if nothing is said.
        axis: origin and direction of rotation, positive about the direction.
        frame: of components and normals: ``"cartesian"``, or ``"cylindrical"`` (r, θ, z about the axis).
        gyroscopic: G, n × n, skew-symmetric, for Coriolis forces.
        mesh: ``{"elements": [(id, type, set, [nodes …]), …], "sets": {set: {"youngs_modulus": …, …}}}``, for stress.

    Returns:
        The path.

    Raises:
        PackageError: an argument that the service would refuse: which, where, and what to do.
    """
    if sparse.issparse(stiffness) or any(np.ndim(matrix) != 2 for matrix in stiffness):
        raise PackageError("stiffness: give a list of matrices, of one if there is one")
    try:
        origin, direction = axis
    except (TypeError, ValueError):
        raise PackageError("axis: give an origin and a direction of three numbers each") from None
    sector = Sector(
        sectors=int(_whole("sectors", sectors)),
        mass=_sparse("mass", mass),
        stiffness=[_sparse(f"stiffness[{k}]", matrix) for k, matrix in enumerate(stiffness)],
        speeds=np.atleast_1d(_real("speeds_rad_s", speeds_rad_s)),
        ids=_whole("node_ids", node_ids),
        positions=_real("positions", positions),
        dofs=_pairs("dofs", dofs),
        cyclic=_pairs("cyclic", cyclic),
        contact=_whole("contact", contact),
        normals=_real("normals", normals),
        origin=_real("axis", origin),
        direction=_real("axis", direction),
        frame=frame,
        gyroscopic=None if gyroscopic is None else _sparse("gyroscopic", gyroscopic),
    )
    check(sector)
    units = MILLIMETRES if units is None else units
    if set(units) != set(MILLIMETRES):
        raise PackageError(f"units: {dict(units)}; give one each of {', '.join(MILLIMETRES)}")
    files = {f"k{k}.npz": _npz(matrix) for k, matrix in enumerate(sector.stiffness)}
    files["m.npz"] = _npz(sector.mass)
    manifest: dict[str, Any] = {
        "name": name,
        "sectors": sector.sectors,
        "units": dict(units),
        "axis": {"origin": sector.origin.tolist(), "direction": sector.direction.tolist()},
        "speeds_rad_s": sector.speeds.tolist(),
        "frame": frame,
        "mass": "m.npz",
        "stiffness": [f"k{k}.npz" for k in range(len(sector.stiffness))],
        "nodes": "nodes.csv",
        "dofs": "dofs.csv",
        "cyclic": sector.cyclic.tolist(),
        "contact": [
            {"node": int(node), "normal": normal}
            for node, normal in zip(sector.contact, sector.normals.tolist(), strict=True)
        ],
    }
    if sector.gyroscopic is not None:
        manifest["gyroscopic"] = "g.npz"
        files["g.npz"] = _npz(sector.gyroscopic)
    if mesh is not None:
        manifest["mesh"] = {"elements": "elements.csv", "sets": dict(mesh["sets"])}
        files["elements.csv"] = _lines((id, kind, of, *nodes) for id, kind, of, nodes in mesh["elements"])
    files["nodes.csv"] = _lines(
        (int(id), *map(repr, xyz)) for id, xyz in zip(sector.ids, sector.positions.tolist(), strict=True)
    )
    files["dofs.csv"] = _lines(map(int, row) for row in sector.dofs)
    files["sector.json"] = json.dumps(manifest).encode()
    path = Path(path).expanduser()
    with zipfile.ZipFile(path, "w") as archive:
        for file, content in sorted(files.items()):
            # Arrays are compressed already.
            archive.writestr(file, content, zipfile.ZIP_STORED if file.endswith(".npz") else zipfile.ZIP_DEFLATED)
    return path


def _sparse(name: str, matrix: Any) -> sparse.csc_array:
    try:
        made = sparse.csc_array(matrix)
    except (TypeError, ValueError) as error:
        raise PackageError(f"{name}: no matrix: {error}") from None
    if np.iscomplexobj(made):
        raise PackageError(f"{name}: complex; a matrix is real (damping is given as modal_ratio)")
    made = cast(sparse.csc_array, made.astype(float))
    made.sum_duplicates()
    return made


def _real(name: str, values: Any) -> npt.NDArray[np.float64]:
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError) as error:
        raise PackageError(f"{name}: no numbers: {error}") from None


def _pairs(name: str, values: Any) -> npt.NDArray[np.int64]:
    made = _whole(name, values)
    if made.size and (made.ndim != 2 or made.shape[1] != 2):
        raise PackageError(f"{name}: shape {made.shape}; it is (rows, 2)")
    return made.reshape(-1, 2)


def _whole(name: str, values: Any) -> npt.NDArray[np.int64]:
    given = _real(name, values)
    if not np.isfinite(given).all():
        raise PackageError(f"{name}: not finite")
    made: npt.NDArray[np.int64] = given.astype(np.int64)
    if not np.array_equal(made, given):
        raise PackageError(f"{name}: {given[made != given].flat[0]} is no whole number")
    return made


def _npz(matrix: sparse.csc_array) -> bytes:
    out = io.BytesIO()
    sparse.save_npz(out, matrix)
    return out.getvalue()


def _lines(rows: Any) -> bytes:
    return "".join(",".join(map(str, row)) + "\n" for row in rows).encode()
