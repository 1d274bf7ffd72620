"""The client: models and jobs of a service."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import Any, Self, cast
from urllib.parse import quote

from .contract import (
    BranchesRequest,
    CampaignRequest,
    CaseStudyRequest,
    ImpellerRequest,
    MeasuredCasing,
    ModalAnalysisRequest,
    RunUpRequest,
    StudyRequest,
    SweepRequest,
)
from .jobs import Job, ModelGeneration, asked_of
from .models import Model
from .results import Branches, Campaign, CaseStudy, ModalAnalysis, RunUps, Study, Sweep
from .service import Service

_KINDS: dict[str, type[Job]] = {
    kind.kind: kind for kind in (Sweep, ModalAnalysis, Study, CaseStudy, Branches, RunUps, Campaign, ModelGeneration)
}


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
        words = tags if isinstance(tags, str) else ",".join(tags or ())
        query = {"name": name, "tags": words or None, "notes": notes}
        if isinstance(package, bytes):
            return Model(self.service, self.service.upload("/v1/models", lambda: package, query))
        path = Path(package).expanduser()
        path.stat()
        return Model(self.service, self.service.upload("/v1/models", lambda: _pieces(path), query))

    def generate(self, request: ImpellerRequest) -> ModelGeneration:
        """A parametric impeller: a job whose ``model`` is the id of the model."""
        return ModelGeneration(self.service, cast(Mapping[str, Any], request))

    def model(self, id: str) -> Model:
        """A model by its id."""
        return Model(self.service, self.service.get(f"/v1/models/{quote(id, safe='')}"))

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
        """A job by its id, as :class:`Sweep`, :class:`ModalAnalysis`, :class:`Study`, :class:`CaseStudy`, :class:`Branches`, :class:`RunUps`, :class:`Campaign` or :class:`ModelGeneration`."""
        return self._job(self.service.get(f"/v1/jobs/{quote(id, safe='')}"))

    def jobs(self, limit: int | None = None, **query: Any) -> list[Job]:
        """Jobs, newest first, ``limit`` at most; ``kind``, ``status``, ``model``, ``name`` and ``tag`` choose among them."""
        return [self._job(found) for found in islice(self._all("jobs", query), limit)]

    def _job(self, found: Mapping[str, Any]) -> Job:
        # A later service may have kinds that this client does not know.
        kind = _KINDS.get(found["kind"]) or type("Job", (Job,), {"kind": found["kind"], "path": found.get("posted_to", "")})
        return kind(self.service, asked_of(found, kind.path), found["id"])

    def _all(self, what: str, query: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
        page = self.service.get(f"/v1/{what}", limit=500, **query)
        while True:
            yield from page[what]
            if not page.get("next"):
                return
            page = self.service.get(page["next"])


def _pieces(path: Path) -> Iterator[bytes]:
    with path.open("rb") as file:
        while piece := file.read(1 << 20):
            yield piece
