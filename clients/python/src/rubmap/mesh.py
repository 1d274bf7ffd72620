"""What a model is made of beside matrices: a mesh and its settings."""

from __future__ import annotations

import importlib
import io
import math
import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, redirect_stdout
from pathlib import Path
from typing import Any

from .gmsh_text import Mesh, write_mesh

#: Endings of files that the service reads itself.
_READ = (".inp", ".msh", ".bdf", ".nas", ".fem", ".dat", ".cdb", ".vtu", ".gz")

#: Endings of files that are no meshes, and what to do with them.
_OTHERS = {
    ".zip": "a package: give it to Client.upload",
    ".step": "geometry: mesh it with rubmap.mesh_step",
    ".stp": "geometry: mesh it with rubmap.mesh_step",
}


def settings_of(
    *,
    top_speed_rad_s: float | None,
    top_speed_rpm: float | None,
    needs_speed: bool = True,
    axis: Any,
    material: Sequence[float] | None,
    materials: Mapping[str, Any] | None,
    **others: Any,
) -> dict[str, Any]:
    """Settings of a model as the service takes them; what is None is left out.

    Raises:
        ValueError: arguments that contradict each other, or that are not what they are to be.
    """
    if needs_speed and (top_speed_rad_s is None) == (top_speed_rpm is None):
        raise ValueError("give the top speed once: top_speed_rad_s or top_speed_rpm")
    top = top_speed_rad_s if top_speed_rpm is None else top_speed_rpm * math.tau / 60.0
    of_sets = dict(materials or {})
    if material is not None:
        if "*" in of_sets:
            raise ValueError('give the material of all elements once: material or materials["*"]')
        if isinstance(material, str | Mapping) or len(material) != 3:
            raise ValueError("material: give Young's modulus, Poisson's ratio and density")
        of_sets["*"] = dict(zip(("youngs_modulus", "poissons_ratio", "density"), material, strict=True))
    given = {"top_speed_rad_s": top, "axis": None if axis is None else axis_of(axis), "materials": of_sets or None}
    return {name: value for name, value in (given | others).items() if value is not None}


def nodes_of(nodes: int | Sequence[int] | None) -> list[int] | None:
    """Numbers of nodes as a list, from a list or a single number."""
    return nodes if nodes is None else [int(node) for node in ([nodes] if isinstance(nodes, int) else nodes)]


def axis_of(axis: Any) -> dict[str, list[float]]:
    """Origin and direction of an axis: ``"x"``, ``"y"`` or ``"z"``, or both as a pair or a mapping.

    Raises:
        ValueError: something else.
    """
    if isinstance(axis, str) and axis in ("x", "y", "z"):
        return {"origin": [0.0] * 3, "direction": [float(axis == each) for each in "xyz"]}
    try:
        origin, direction = (axis["origin"], axis["direction"]) if isinstance(axis, Mapping) else axis
        made = {"origin": [float(x) for x in origin], "direction": [float(x) for x in direction]}
    except (KeyError, TypeError, ValueError):
        made = {"origin": [], "direction": []}
    if [len(made["origin"]), len(made["direction"])] != [3, 3] or not any(made["direction"]):
        raise ValueError('axis: give "x", "y", "z", or an origin and a direction of three numbers each')
    return made


@contextmanager
def file_of(mesh: str | os.PathLike[str] | Mesh, chosen: Sequence[str | None] = ()) -> Iterator[Path]:
    """A file of a mesh in a format that the service reads, for as long as the block lasts.

    Args:
        mesh: a file, or a ``meshio.Mesh``.
        chosen: names of sets that are asked for as sets of nodes.

    Raises:
        ImportError: meshio would have to read the file, and is not installed.
        ValueError: a file that meshio cannot read, either, or something in a mesh that cannot be carried over.
    """
    if isinstance(mesh, str | os.PathLike):
        path = Path(mesh).expanduser()
        path.stat()
        if path.suffix.lower() in _READ:
            yield path
            return
        mesh = _read(path)
    elif not hasattr(mesh, "points") or not hasattr(mesh, "cells"):
        raise TypeError(f"a mesh is a file by its path, or a meshio.Mesh, not {type(mesh).__name__}")
    with tempfile.TemporaryDirectory(prefix="rubmap-") as folder:
        path = Path(folder) / "mesh.msh"
        with path.open("wb") as file:
            write_mesh(mesh, file, chosen)
        yield path


def optional(name: str, purpose: str) -> Any:
    """A package that is needed for this alone.

    Raises:
        ImportError: it is not installed, or does not run here.
    """
    try:
        return importlib.import_module(name)
    except (ImportError, OSError) as error:
        raise ImportError(f"the package {name} is needed {purpose}: pip install {name} ({error})", name=name) from None


def _read(path: Path) -> Mesh:
    ending = path.suffix.lower()
    if ending in _OTHERS:
        raise ValueError(f"{path.name} is {_OTHERS[ending]}")
    known = f"the service reads {', '.join(_READ)}"
    meshio = optional("meshio", f"to read {path.name} ({known})")
    if ending not in meshio.extension_to_filetypes:
        raise ValueError(f"{path.name} ends in none of the ways that meshes do: {known}, and meshio others")
    said = io.StringIO()
    try:
        # Of a file that it cannot read it prints why, and exits.
        with redirect_stdout(said):
            read: Mesh = meshio.read(path)
    except ImportError as error:
        raise ImportError(f"meshio needs another package to read {path.name}: {error}", name=error.name) from None
    except (SystemExit, Exception) as error:  # noqa: BLE001 - as its readers and their libraries do
        why = " ".join(said.getvalue().split()) or f"{type(error).__name__}: {error}"
        raise ValueError(f"meshio cannot read {path.name}: {why}") from None
    return read
