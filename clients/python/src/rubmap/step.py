"""One meshed sector of a STEP file, by Gmsh."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from .mesh import axis_of, optional
from .sector import Reals

#: Planes through the axis that are tried for the cut, within a pitch.
_PLANES = 16

#: Largest relative differences: of places, areas and volumes of bodies that are the same, and of sections with as little of a blade.
_SAME = 1e-5
_NO_BLADE = 1e-3

#: Least part around the axis of the normal of a blade's flank.
_FLANK = 0.1
_FLANK_CUT = "the planes cut a blade or a hole; if blades overlap around the axis, take one sector out in the CAD, with the cyclic faces between blades"


def mesh_step(
    path: str | os.PathLike[str],
    *,
    sectors: int,
    size: float,
    axis: Any = "z",
    order: int = 2,
    to: str | os.PathLike[str] | None = None,
) -> Path:
    """Meshes one sector of a wheel with tetrahedra, the same on both cyclic faces, for :meth:`rubmap.Client.model_from_mesh`.

    A whole wheel is cut by two planes through the axis, where their section is smallest: between the blades. It needs Gmsh (``pip install gmsh``).
    What it cannot do: cut along curved faces between blades that overlap around the axis (take one sector out in the CAD then; the cyclic faces of that may be
    curved), unite the parts of an assembly, or refine some places more than others.

    Args:
        path: STEP file of one solid: a whole wheel, or one sector of it.
        sectors: N, the number of identical sectors of the wheel, at least 2.
        size: length of the edges of elements, mm; a STEP file in other units is converted to mm.
        axis: of rotation: ``"x"``, ``"y"`` or ``"z"`` through the origin, or an origin and a direction.
        order: 2 for quadratic elements; linear ones are far too stiff.
        to: ``.msh`` file to write; by default beside the STEP file, with its name.

    Returns:
        The path of the mesh.

    Raises:
        ImportError: there is no Gmsh here.
        ValueError: no sector of this solid can be meshed, and why.
    """
    source = Path(path).expanduser()
    source.stat()
    target = Path(to).expanduser() if to else source.with_suffix(".msh")
    if sectors < 2 or order not in (1, 2) or not size > 0.0:
        raise ValueError("a wheel has at least 2 sectors, elements have order 1 or 2 and a size above 0")
    if target.suffix != ".msh" or not target.resolve().parent.is_dir():
        raise ValueError(f"{target} is no .msh file in a folder that there is")
    with _model(source, size, order) as gmsh:
        wheel = _Wheel(gmsh, source.name, sectors, axis)
        is_cut = wheel.cut()
        cuts = wheel.make_periodic()
        if is_cut and wheel.cuts_a_flank(cuts):
            warnings.warn(f"{source.name}: {_FLANK_CUT}", stacklevel=2)
        try:
            gmsh.model.mesh.generate(3)
        except Exception as error:  # noqa: BLE001 - Gmsh raises no other
            raise ValueError(f"{source.name}: Gmsh cannot mesh the sector: {error}; try another size") from None
        _, elements, _ = gmsh.model.mesh.getElements(3)
        if np.min(gmsh.model.mesh.getElementQualities(elements[0], "minSJ")) <= 0.0:
            raise ValueError(f"{source.name}: elements along curved faces are turned inside out; give a smaller size")
        gmsh.write(os.fspath(target))
    return target


@contextmanager
def _model(source: Path, size: float, order: int) -> Iterator[Any]:
    """Gmsh with the solids of a file, beside what else it has; its options are put back."""
    gmsh = optional("gmsh", "to mesh STEP files")
    if own := not gmsh.isInitialized():
        gmsh.initialize(readConfigFiles=False, interruptible=False)
    options = {
        "General.Terminal": 0, "Mesh.MeshSizeMin": 0, "Mesh.MeshSizeMax": size, "Mesh.ElementOrder": order,
        # Nodes on faces stay, so that those of cyclic faces fit each other.
        "Mesh.HighOrderOptimize": order - 1, "Mesh.HighOrderFixBoundaryNodes": 1, "Mesh.MshFileVersion": 4.1, "Mesh.SaveAll": 0,
    }  # fmt: skip
    before = {name: gmsh.option.getNumber(name) for name in options}
    current, unit = gmsh.model.getCurrent(), gmsh.option.getString("Geometry.OCCTargetUnit")
    for name, value in options.items():
        gmsh.option.setNumber(name, value)
    gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
    gmsh.model.add(source.name)
    try:
        try:
            gmsh.model.occ.importShapes(os.fspath(source), format="step")
        except Exception as error:  # noqa: BLE001 - Gmsh raises no other
            raise ValueError(f"{source.name} cannot be read as STEP: {error}") from None
        gmsh.model.occ.synchronize()
        yield gmsh
    finally:
        gmsh.model.remove()
        if own:
            gmsh.finalize()
        else:
            gmsh.model.setCurrent(current)
            gmsh.option.setString("Geometry.OCCTargetUnit", unit)
            for name, value in before.items():
                gmsh.option.setNumber(name, value)


class _Wheel:
    """The one solid of Gmsh's model, about its axis."""

    def __init__(self, gmsh: Any, name: str, sectors: int, axis: Any) -> None:
        self.gmsh, self.occ, self.name, self.sectors = gmsh, gmsh.model.occ, name, sectors
        solids = self.occ.getEntities(3)
        if len(solids) != 1:
            raise ValueError(f"{name} has {len(solids)} solids; give one, its parts united in the CAD")
        self.solid = solids[0][1]
        given = axis_of(axis)
        self.origin, along = np.array(given["origin"]), np.array(given["direction"])
        self.along: Reals = along / np.linalg.norm(along)
        across = np.cross(self.along, np.eye(3)[np.argmin(abs(self.along))])
        self.across: Reals = across / np.linalg.norm(across)
        corners = np.reshape(gmsh.model.getBoundingBox(3, self.solid), (2, 3)) - self.origin
        #: No point of the solid is that far from the origin.
        self.reach = 1.1 * float(np.linalg.norm(abs(corners).max(axis=0)))

    def cut(self) -> bool:
        """Cuts one sector out of a whole wheel; a body beside the axis is one already. Whether it was cut."""
        centre = np.array(self.occ.getCenterOfMass(3, self.solid)) - self.origin
        if np.linalg.norm(centre - centre @ self.along * self.along) > 1e-3 * self.reach:
            return False
        volume = self.occ.getMass(3, self.solid)
        pitch = 2.0 * np.pi / self.sectors
        wedge = self.occ.revolve([(2, self._half_plane(self._gap()))], *self.origin, *self.along, pitch)
        found, _ = self.occ.intersect([(3, self.solid)], [each for each in wedge if each[0] == 3])
        self.occ.synchronize()
        if len(found) != 1:
            raise ValueError(
                f"{self.name}: planes through the axis cut {len(found)} pieces out of it: its blades overlap around the axis; "
                "take one sector out in the CAD"
            )
        self.solid = found[0][1]
        if abs(self.sectors * self.occ.getMass(3, self.solid) - volume) > _SAME * volume:
            raise ValueError(
                f"{self.name}: a sector has not the {self.sectors}th part of its volume: check sectors and axis"
            )
        return True

    def _gap(self) -> float:
        """Angle at which a plane cuts least of the wheel: the middle of the widest gap between blades."""
        angles = 2.0 * np.pi / self.sectors * np.arange(_PLANES) / _PLANES
        areas = np.array([self._section(angle) for angle in angles])
        clear = areas <= areas.min() * (1.0 + _NO_BLADE)
        if clear.all():
            return 0.0
        runs = [next(n for n in range(_PLANES) if not clear[(k + n) % _PLANES]) for k in range(_PLANES)]
        return float(angles[(int(np.argmax(runs)) + max(runs) // 2) % _PLANES])

    def _section(self, angle: float) -> float:
        faces, _ = self.occ.intersect([(3, self.solid)], [(2, self._half_plane(angle))], removeObject=False)
        area = sum(self.occ.getMass(dim, tag) for dim, tag in faces if dim == 2)
        self.occ.remove(faces, recursive=True)
        return float(area)

    def _half_plane(self, angle: float) -> int:
        """Rectangle beside the axis, as far as the solid reaches."""
        out = np.cos(angle) * self.across + np.sin(angle) * np.cross(self.along, self.across)
        corners = [self.origin + self.reach * (a * self.along + b * out) for a, b in ((-1, 0), (-1, 1), (1, 1), (1, 0))]
        points = [self.occ.addPoint(*corner) for corner in corners]
        lines = [self.occ.addLine(points[k - 1], points[k]) for k in range(4)]
        return int(self.occ.addPlaneSurface([self.occ.addCurveLoop(lines)]))

    def make_periodic(self) -> list[int]:
        """Gives each face onto which a turn by a pitch carries another the mesh of that one. Those others."""
        cos, sin = np.cos(2.0 * np.pi / self.sectors), np.sin(2.0 * np.pi / self.sectors)
        turn = cos * np.eye(3) + (1.0 - cos) * np.outer(self.along, self.along) + sin * np.cross(np.eye(3), -self.along)
        whole = np.block([[turn, (self.origin - turn @ self.origin)[:, None]], [np.zeros(3), 1.0]])
        faces = [tag for _, tag in self.gmsh.model.getBoundary([(3, self.solid)], oriented=False)]
        area = {face: self.occ.getMass(2, face) for face in faces}
        centre = {face: np.array(self.occ.getCenterOfMass(2, face)) - self.origin for face in faces}

        def fit(low: int, high: int) -> bool:
            near = np.linalg.norm(turn @ centre[low] - centre[high]) < _SAME * self.reach
            return low != high and bool(near) and abs(area[low] - area[high]) < _SAME * area[low]

        # Half a turn carries both onto each other.
        pairs = [(low, high) for low in faces for high in faces if fit(low, high) and (low < high or self.sectors > 2)]
        if not pairs:
            raise ValueError(
                f"{self.name}: no face of it turned by a {self.sectors}th of a turn about the axis meets another: check sectors and axis; "
                "cyclic faces of a sector are divided alike"
            )
        for low, high in pairs:
            self.gmsh.model.mesh.setPeriodic(2, [high], [low], whole.ravel())
        self.gmsh.model.addPhysicalGroup(3, [self.solid], name="SOLID")
        return [low for low, _ in pairs]

    def cuts_a_flank(self, cuts: list[int]) -> bool:
        """Whether a face beside these looks around the axis where it meets them: hub and bore do not, blades do."""
        model = self.gmsh.model
        for _, curve in model.getBoundary([(2, cut) for cut in cuts], combined=False, oriented=False):
            (begin,), (end,) = model.getParametrizationBounds(1, curve)
            at = model.getValue(1, curve, [0.5 * (begin + end)])
            around = np.cross(self.along, at - self.origin)
            for face in set(model.getAdjacencies(1, curve)[0].tolist()) - set(cuts):
                normal = model.getNormal(face, model.getParametrization(2, face, at))
                if abs(normal @ around) > _FLANK * np.linalg.norm(around):
                    return True
        return False
