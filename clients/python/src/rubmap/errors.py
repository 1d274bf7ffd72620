"""What can go wrong between a script and the service."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


class RubmapError(Exception):
    """All errors of this package."""


class Refusal(RubmapError):
    """A request that the service refused, in the words of RFC 9457.

    Attributes:
        status: of the answer, 4xx or 5xx.
        kind: the last word of the problem's type, such as ``invalid-request``.
        title: what is wrong, in a few words.
        detail: what is wrong, and what to do.
        problem: the whole answer.
        errors: one mapping per defect, with ``detail`` and where it is: ``pointer`` (RFC 6901) into the body, ``parameter`` of the
            query, or ``file`` and ``row`` of a package.
    """

    def __init__(self, status: int, problem: Mapping[str, Any]) -> None:
        self.status = status
        self.problem = dict(problem)
        self.kind = str(problem.get("type", "")).rsplit(":", 1)[-1]
        self.title = str(problem.get("title", f"the service answered {status}"))
        self.detail = str(problem.get("detail", ""))
        self.errors: list[Mapping[str, Any]] = list(problem.get("errors", []))
        # The detail joins the errors in one line.
        said = [f"  {_where(error)}{error.get('detail', '')}" for error in self.errors] or [f"  {self.detail}"]
        super().__init__("\n".join([f"{self.title} ({status})", *said]).rstrip())

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.status, self.problem)


def _where(error: Mapping[str, Any]) -> str:
    row = error.get("row", error.get("line"))
    parts = [error.get("file"), f"row {row}" if row is not None else None, error.get("pointer"), error.get("parameter")]
    named = [str(part) for part in parts if part]
    return f"{', '.join(named)}: " if named else ""


class Unreachable(RubmapError):
    """The service did not answer for as long as the client's patience lasts."""


class JobFailed(RubmapError):
    """A job that ended without its result: it failed, or was cancelled.

    Attributes:
        status: ``failed`` or ``dismissed``.
        job: the whole job, as the service tells of it.
    """

    def __init__(self, job: Mapping[str, Any]) -> None:
        self.status = str(job["status"])
        self.job = job
        error = job.get("error") or {}
        why = f": {error.get('title', '')} {error.get('detail', '')}".rstrip(": ") if error else ""
        super().__init__(f"job {job['id']} {'was cancelled' if self.status == 'dismissed' else 'failed'}{why}")

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.job,)


class PackageError(RubmapError, ValueError):
    """An argument of :func:`rubmap.write_package` that the service would refuse: which, where, and what to do."""
