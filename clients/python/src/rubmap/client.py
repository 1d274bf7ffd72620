"""The client: models and jobs of a service."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import Any, Self, cast

from .contract import (
    BranchesRequest,
    CampaignRequest,
    CaseStudyRequest,
    ImpellerRequest,
    MassRule,
    MeasuredCasing,
    MeshLook,
    ModalAnalysisRequest,
    RunUpRequest,
    StudyRequest,
    SweepRequest,
    Units,
)
from .gmsh_text import Mesh
from .jobs import Job, ModelGeneration, asked_of
from .mesh import file_of, nodes_of, settings_of
from .models import Model
from .results import Branches, Campaign, CaseStudy, ModalAnalysis, RunUps, Study, Sweep
from .service import Service, plain

_KINDS: dict[str, type[Job]] = {
    kind.kind: kind for kind in (Sweep, ModalAnalysis, Study, CaseStudy, Branches, RunUps, Campaign, ModelGeneration)
}

#: Whole ids of models and jobs.
_MODEL_ID = re.compile(r"[0-9a-f]{64}")
_JOB_ID = re.compile(r"[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}")


class Client:
    """A service by its address.

    Args:
        url: such as ``http://127.0.0.1:8080``.
        token: of a service that wants one; by default ``RUBMAP_TOKEN`` of the environment.
        patience: seconds for which requests are repeated while the service cannot be reached or has no room.
    """

    def __init__(self, url: str, token: str | None = None, patience: float = 60.0) -> None:
        self.service = Service(url, os.environ.get("RUBMAP_TOKEN") if token is None else token, patience)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<rubmap client of {self.service.url}>"

    def close(self) -> None:
        """Closes the connections."""
        self.service.close()

    def version(self) -> dict[str, Any]:
        """Version of the service and of its numerics."""
        return cast(dict[str, Any], self.service.get("/v1/version"))

    def upload(
        self,
        package: str | os.PathLike[str] | bytes,
        name: str | None = None,
        tags: Sequence[str] | None = None,
        notes: str | None = None,
    ) -> Model:
        """Uploads a model package: a zip by its path, or its bytes. A model that is known is not kept twice.

        Raises:
            Refusal: something is wrong with the package; ``errors`` says in which file and row.
        """
        query = _labels(name, tags, notes)
        if isinstance(package, bytes):
            return Model(self.service, self.service.upload("/v1/models", lambda: package, query))
        path = Path(package).expanduser()
        path.stat()
        return Model(self.service, self.service.upload("/v1/models", lambda: _pieces(path), query))

    def model_from_mesh(
        self,
        mesh: str | os.PathLike[str] | Mesh,
        *,
        top_speed_rad_s: float | None = None,
        top_speed_rpm: float | None = None,
        sectors: int | None = None,
        axis: Any = None,
        materials: Mapping[str, Any] | None = None,
        material: Sequence[float] | None = None,
        units: Units | None = None,
        clamp_set: str | None = None,
        clamp_at: int | Sequence[int] | None = None,
        contact_set: str | None = None,
        contact_at: int | Sequence[int] | None = None,
        contact_between: tuple[int, int] | None = None,
        shroud: Sequence[Sequence[float]] | None = None,
        contact_nodes: int | None = None,
        gyroscopic: bool | None = None,
        mass: MassRule | None = None,
        temperatures: Mapping[str, float] | None = None,
        name: str | None = None,
        tags: Sequence[str] | None = None,
        notes: str | None = None,
    ) -> Model:
        """Uploads a mesh of one sector; the service assembles its matrices. ``found`` of the model says what was found in the mesh.

        What is left out is read from the file, or found from its geometry.

        Args:
            mesh: a file: a deck of CalculiX or Abaqus (.inp), Gmsh (.msh), Nastran (.bdf, .nas, .fem, .dat), Ansys (.cdb), VTK (.vtu), or one
                that meshio reads if it is installed; or a ``meshio.Mesh``, whose points and cells count from 1, with its sets.
            top_speed_rad_s: highest speed of the stiffness matrices; this, or
            top_speed_rpm: the same in rev/min.
            sectors: N, the number of identical sectors of the wheel; 1 for a single blade.
            axis: of rotation: ``"x"``, ``"y"`` or ``"z"`` through the origin, or an origin and a direction.
            materials: by element set or material of the file: ``{"BLADE": {"youngs_modulus": …, "poissons_ratio": …, "density": …}}``.
            material: Young's modulus, Poisson's ratio and density of all other elements.
            units: of length, force, time, mass, consistent; mm, N, s, t if nothing is said.
            clamp_set: node set of the clamp; by default the nodes that the file holds, or else the bore.
            clamp_at: instead of a set: nodes of the smooth patches of the skin that are clamped; :meth:`look_at_mesh` has their numbers.
            contact_set: node set along the blade's tip; by default the longest tip that is found.
            contact_at: instead of a set: the node of the smooth patch of the skin that is the tip.
            contact_between: instead of a set: two nodes between which the contact line runs along sharp edges.
            shroud: instead of a set: curve of the shroud as points r, z from the axis, to which the tip is nearest.
            contact_nodes: how many nodes along it may touch, at most.
            gyroscopic: whether Coriolis forces can be considered; by default they can.
            mass: rule by which mass is integrated.
            temperatures: by element set or material, ``"*"`` for all, where the file tabulates a material.
            name: of the model; by default that of the file without its ending.
            tags: words to group it by.
            notes: anything worth remembering.

        Raises:
            Refusal: something is wrong with the mesh or a setting; ``errors`` says what, and in which line.
            ValueError: arguments that contradict each other, or a mesh that cannot be sent.
            ImportError: meshio would have to read the file, and is not installed.
        """
        settings = settings_of(
            top_speed_rad_s=top_speed_rad_s,
            top_speed_rpm=top_speed_rpm,
            sectors=sectors,
            axis=axis,
            materials=materials,
            material=material,
            units=units,
            clamp_set=clamp_set,
            clamp_at=nodes_of(clamp_at),
            contact_set=contact_set,
            contact_at=nodes_of(contact_at),
            contact_between=nodes_of(contact_between),
            shroud=shroud,
            contact_nodes=contact_nodes,
            gyroscopic=gyroscopic,
            mass=mass,
            temperatures=temperatures,
        )
        if name is None and isinstance(mesh, str | os.PathLike):
            name = Path(mesh).stem
        query = _labels(name, tags, notes) | {"settings": json.dumps(plain(settings), allow_nan=False)}
        with file_of(mesh, (clamp_set, contact_set)) as path:
            facts = self.service.upload("/v1/models", lambda: _pieces(path), query, "application/octet-stream")
        return Model(self.service, facts)

    def look_at_mesh(
        self,
        mesh: str | os.PathLike[str] | Mesh,
        *,
        sectors: int | None = None,
        axis: Any = None,
        clamp_set: str | None = None,
        clamp_at: int | Sequence[int] | None = None,
        contact_set: str | None = None,
        contact_at: int | Sequence[int] | None = None,
        contact_between: tuple[int, int] | None = None,
        shroud: Sequence[Sequence[float]] | None = None,
        contact_nodes: int | None = None,
        **others: Any,
    ) -> MeshLook:
        """A mesh before a model is made of it: the smooth patches and sharp edges of its skin, the cyclic faces, clamp and contact line as far as
        they are found, and what making the model costs. Nothing is stored, and neither material nor top speed is needed.

        ``patches`` have in ``at`` the nodes that name them in ``clamp_at`` and ``contact_at``; ``refusals`` says what could not be found.

        Args:
            mesh: a file, or a ``meshio.Mesh``, as for :meth:`model_from_mesh`, where the other arguments are described, too.
            sectors: N, the number of identical sectors of the wheel.
            axis: of rotation.
            clamp_set: node set of the clamp.
            clamp_at: nodes of the patches that are clamped.
            contact_set: node set along the blade's tip.
            contact_at: the node of the patch that is the tip.
            contact_between: two nodes between which the contact line runs.
            shroud: curve of the shroud, to which the tip is nearest.
            contact_nodes: how many nodes along it may touch, at most.
            others: other arguments of :meth:`model_from_mesh`, such as ``material``.

        Raises:
            Refusal: the mesh cannot be read, or arguments contradict each other.
        """
        given = {"top_speed_rad_s": None, "top_speed_rpm": None, "material": None, "materials": None} | others
        settings = settings_of(
            needs_speed=False,
            sectors=sectors,
            axis=axis,
            clamp_set=clamp_set,
            clamp_at=nodes_of(clamp_at),
            contact_set=contact_set,
            contact_at=nodes_of(contact_at),
            contact_between=nodes_of(contact_between),
            shroud=shroud,
            contact_nodes=contact_nodes,
            **given,
        )
        query = {"settings": json.dumps(plain(settings), allow_nan=False)}
        with file_of(mesh, (clamp_set, contact_set)) as path:
            look = self.service.upload("/v1/meshes/look", lambda: _pieces(path), query, "application/octet-stream")
        return cast(MeshLook, look)

    def generate(self, request: ImpellerRequest) -> ModelGeneration:
        """A parametric impeller: a job whose ``model`` is the id of the model."""
        return ModelGeneration(self.service, cast(Mapping[str, Any], request))

    def model(self, id: str) -> Model:
        """A model by its id, the beginning of its id, or its name.

        Raises:
            LookupError: no model is called so, or several are.
        """
        whole = id if _MODEL_ID.fullmatch(id) else self._find("models", id)
        return Model(self.service, self.service.get(f"/v1/models/{whole}"))

    def models(self, limit: int | None = None, **query: Any) -> list[Model]:
        """Models, newest first, ``limit`` at most; ``name`` and ``tag`` choose among them."""
        return [Model(self.service, facts) for facts in islice(self._all("models", query), limit)]

    def measured_casing(self, table: str | os.PathLike[str]) -> MeasuredCasing:
        """A measured casing from a table in CSV: ``measured`` is for ``scene.casing.measured`` of a request, ``survey`` and ``filled``
        say what stands out.

        Raises:
            Refusal: something is wrong with the table; ``errors`` says in which line.
        """
        text = Path(table).expanduser().read_text(encoding="utf-8-sig")
        return cast(MeasuredCasing, self.service.read_text("/v1/casing-tables", text, "text/csv"))

    def sweep(self, request: SweepRequest) -> Sweep:
        """A sweep over a range of speeds, not submitted yet."""
        return Sweep(self.service, cast(Mapping[str, Any], request))

    def modal_analysis(self, request: ModalAnalysisRequest) -> ModalAnalysis:
        """A modal analysis, not submitted yet."""
        return ModalAnalysis(self.service, cast(Mapping[str, Any], request))

    def study(self, request: StudyRequest) -> Study:
        """A study of what accuracy costs, not submitted yet."""
        return Study(self.service, cast(Mapping[str, Any], request))

    def case_study(self, request: CaseStudyRequest) -> CaseStudy:
        """One speed in detail, not submitted yet."""
        return CaseStudy(self.service, cast(Mapping[str, Any], request))

    def branches(self, request: BranchesRequest) -> Branches:
        """Periodic responses followed over speed, clearance, height of the lobes or damping, not submitted yet."""
        return Branches(self.service, cast(Mapping[str, Any], request))

    def run_ups(self, request: RunUpRequest) -> RunUps:
        """Run-ups or run-downs, whose speed changes, not submitted yet."""
        return RunUps(self.service, cast(Mapping[str, Any], request))

    def campaign(self, request: CampaignRequest) -> Campaign:
        """Many designs of a scene over speeds, not submitted yet."""
        return Campaign(self.service, cast(Mapping[str, Any], request))

    def job(self, id: str) -> Job:
        """A job by its id, the beginning of its id, or its name, as :class:`Sweep`, :class:`ModalAnalysis`, :class:`Study`, :class:`CaseStudy`, :class:`Branches`, :class:`RunUps`, :class:`Campaign` or :class:`ModelGeneration`.

        Raises:
            LookupError: no job is called so, or several are.
        """
        whole = id if _JOB_ID.fullmatch(id) else self._find("jobs", id)
        return self._job(self.service.get(f"/v1/jobs/{whole}"))

    def jobs(self, limit: int | None = None, **query: Any) -> list[Job]:
        """Jobs, newest first, ``limit`` at most; ``kind``, ``status``, ``model``, ``name`` and ``tag`` choose among them."""
        return [self._job(found) for found in islice(self._all("jobs", query), limit)]

    def _job(self, found: Mapping[str, Any]) -> Job:
        kind = _KINDS.get(found["kind"]) or _later_kind(found)
        return kind(self.service, asked_of(found, kind.path), found["id"])

    def _find(self, what: str, called: str) -> str:
        """Id of the one model or job whose id begins so, or which has this name."""
        matches = [
            found["id"]
            for found in self._all(what, {})
            if called and (found["id"].startswith(called) or found.get("name") == called)
        ]
        if len(matches) == 1:
            return str(matches[0])
        if not matches:
            raise LookupError(f"none of the {what} has an id that begins with {called!r}, or this name")
        raise LookupError(f"{called!r} may be {len(matches)} of the {what}: {', '.join(matches[:5])}")

    def _all(self, what: str, query: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
        page = self.service.get(f"/v1/{what}", limit=500, **query)
        while True:
            yield from page[what]
            if not page.get("next"):
                return
            page = self.service.get(page["next"])


def _later_kind(found: Mapping[str, Any]) -> type[Job]:
    """A kind of job that a later service has and this client does not know."""

    class Later(Job):
        kind = found["kind"]
        path = found.get("posted_to", "")

    return Later


def _labels(name: str | None, tags: Sequence[str] | None, notes: str | None) -> dict[str, str | None]:
    words = tags if isinstance(tags, str) else ",".join(tags or ())
    return {"name": name, "tags": words or None, "notes": notes}


def _pieces(path: Path) -> Iterator[bytes]:
    with path.open("rb") as file:
        while piece := file.read(1 << 20):
            yield piece
