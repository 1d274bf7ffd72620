"""Jobs: asked for, planned, submitted, waited for, cancelled."""

from __future__ import annotations

import copy
import json
import os
import time
import uuid
from collections.abc import Iterator, Mapping
from contextlib import suppress
from html import escape
from pathlib import Path
from typing import Any, ClassVar, Self

import httpx

from .download import Arrays, arrays, download
from .errors import JobFailed, Refusal, RubmapError, Unreachable
from .notebook import badge, rows
from .plan import Plan
from .progress import progress as shown
from .service import AGAIN, Service

_ENDED = ("successful", "failed", "dismissed")

#: Seconds between two looks at a job whose events cannot be followed.
_POLL = 1.0

#: Seconds after which events that say nothing, not even that the connection lives (every 15 s), are asked for again.
_SILENCE = 20.0

#: Seconds that a notebook waits for a job that it shows.
_GLANCE = 3.0


class Job:
    """A job, before or after it is submitted.

    Attributes:
        id: of the job once it is submitted, otherwise None.
    """

    #: What the contract calls this kind, and where it is posted.
    kind: ClassVar[str]
    path: ClassVar[str]

    def __init__(self, service: Service, request: Mapping[str, Any] | None, id: str | None = None) -> None:
        self._service = service
        self._request = None if request is None else copy.deepcopy(dict(request))
        self._key = str(uuid.uuid4())
        self.id = id

    @property
    def request(self) -> dict[str, Any]:
        """What is asked for, as the contract's request of this kind; of a job found in a list it is read when it is wanted."""
        if self._request is None:
            self._request = asked_of(self.state, self.path)
        if self._request is None:
            raise ValueError(
                f"{self!r} has no request of its own: it records another job, or an earlier service did not keep it"
            )
        return self._request

    def __repr__(self) -> str:
        return f"<rubmap {self.kind} {self.id or 'not submitted'}>"

    def submit(self) -> Self:
        """Posts it, once, however often a connection breaks, and when this is called again after one that stayed broken.

        Raises:
            Refusal: the service does not take the request; ``errors`` points at what is wrong.
        """
        if self.id is not None:
            raise ValueError(f"{self!r} is submitted already; make another for the same request")
        self.id = str(self._service.post(self.path, self.request, self._key)["id"])
        return self

    def _repr_html_(self) -> str:
        """The job as it is now, for notebooks; its name alone where the service does not answer soon."""
        if self.id is None:
            return escape(repr(self))
        try:
            state = self._service.look(self._own(), _GLANCE)
        except (httpx.TransportError, RubmapError):
            return escape(repr(self))
        told = {
            "kind": self.kind.replace("_", " "),
            "name": state.get("name"),
            "status": f"{state['status']}, {state['progress']} %",
            "phase": state.get("phase"),
            "id": self.id,
        }
        verdict = f"<p>{badge(state['verdict'])}</p>" if "verdict" in state else ""
        page = escape(f"{self._service.url}/#/jobs/{self.id}")
        return f'{verdict}{rows((name, str(value)) for name, value in told.items() if value)}<p><a href="{page}">open in the browser</a></p>'

    def plan(self) -> Plan:
        """What it would do and cost, without starting anything: time, memory, steps, effects on and off, warnings. Prints as a table.

        Raises:
            Refusal: the request is not complete or not possible.
        """
        return Plan(self._service.ask(f"{self.path}/plan", self.request))

    @property
    def state(self) -> dict[str, Any]:
        """The job as the service reports it now: status, progress (%), phase, error, times, links."""
        found: dict[str, Any] = self._service.get(self._own())
        return found

    @property
    def status(self) -> str:
        """``accepted``, ``running``, ``paused``, ``successful``, ``failed`` or ``dismissed`` (cancelled)."""
        return str(self.state["status"])

    def wait(self, progress: bool = True, timeout: float | None = None) -> Self:
        """Waits until it has its result.

        Args:
            progress: whether a bar shows how far it is; where there is no terminal and no notebook, a line for every tenth of the work
                and for every phase.
            timeout: seconds after which waiting ends.

        Raises:
            JobFailed: it failed or was cancelled.
            TimeoutError: it had not ended in time; it goes on.
            Unreachable: the service did not answer within the client's patience.
        """
        self._own()
        end = None if timeout is None else time.monotonic() + timeout
        with shown(self.kind, progress) as bar:
            for state in self._changes(end):
                bar.show(state)
                if state["status"] in _ENDED:
                    if state["status"] != "successful":
                        raise JobFailed(state)
                    return self
        raise TimeoutError(f"job {self.id} had not ended after {timeout} s; it goes on")

    def cancel(self) -> None:
        """Stops it; what it has found so far stays. One that has ended stays as it is."""
        self._service.delete(self._own(), cancel_only="true")

    def pause(self) -> None:
        """Pauses it; what it has found so far stays."""
        self._service.ask(f"{self._own()}/pause", {})

    def go_on(self) -> None:
        """Continues it where it was paused."""
        self._service.ask(f"{self._own()}/continue", {})

    def delete(self) -> None:
        """Deletes it with all that it found; one that has not ended is cancelled first."""
        self.cancel()
        self._service.delete(self._own())

    def label(self, **changes: Any) -> Self:
        """Changes ``name``, ``tags`` and ``notes``: what is not given stays, None takes away."""
        self._service.patch(self._own(), changes)
        return self

    def arrays(self, result: str, **query: Any) -> Arrays:
        """All numbers of a result, such as ``"interaction-map"``, as numpy arrays by the names that the contract gives them."""
        return arrays(self._service, f"{self._own()}/{result}", **query)

    def json(self, result: str, **query: Any) -> Any:
        """A result as JSON, with all that is said about it."""
        return self._service.get(f"{self._own()}/{result}", **query)

    def download(self, result: str, to: str | os.PathLike[str], format: str | None = None, **query: Any) -> Path:
        """Writes a result to a file; ``format`` by default as the file's name ends: json, csv, npz, svg, png, vtu, vtp …"""
        form = format or Path(to).suffix.lstrip(".") or None
        return download(self._service, f"{self._own()}/{result}", to, format=form, **query)

    def report(self, to: str | os.PathLike[str]) -> Path:
        """Writes the report, one HTML file with figures and tables."""
        return download(self._service, f"{self._own()}/report", to)

    def archive(self, to: str | os.PathLike[str]) -> Path:
        """Writes a zip with everything that was found."""
        return download(self._service, f"{self._own()}/archive", to)

    def _own(self) -> str:
        if self.id is None:
            raise ValueError(f"{self!r}: submit() it first")
        return f"/v1/jobs/{self.id}"

    def _changes(self, end: float | None) -> Iterator[dict[str, Any]]:
        """The job as it is, and after every change, until it has ended or it is too late."""
        answered = time.monotonic()
        while end is None or time.monotonic() < end:
            try:
                # What stands between may end the stream, or keep it to itself: then the job is looked at now and then.
                with suppress(httpx.TransportError):
                    for state in self._events(end):
                        answered = time.monotonic()
                        yield state
                        if state["status"] in _ENDED:
                            return
                yield self._service.look(self._own(), _left(end, _SILENCE))
                answered = time.monotonic()
            except (httpx.TransportError, Refusal) as error:
                if isinstance(error, Refusal) and error.status not in AGAIN:
                    raise
                if time.monotonic() - answered > self._service.patience:
                    raise Unreachable(f"{self._service.url} does not answer: {error}") from error
            time.sleep(_left(end, _POLL))

    def _events(self, end: float | None) -> Iterator[dict[str, Any]]:
        silence = _left(end, _SILENCE)
        with self._service.stream(f"{self._own()}/events", accept="text/event-stream", silence=silence) as answer:
            for line in answer.iter_lines():
                if line.startswith("data:"):
                    yield json.loads(line.removeprefix("data:"))
                if end is not None and time.monotonic() > end:
                    return


def asked_of(found: Mapping[str, Any], path: str) -> dict[str, Any] | None:
    """The request of a job as it was posted to the path of its kind.

    None where it is not told (in lists), was not kept (by earlier services), or was posted elsewhere (histories of a sweep).
    """
    posted: dict[str, Any] | None = found.get("posted")
    return posted if found.get("posted_to") == path else None


def _left(end: float | None, most: float) -> float:
    """Seconds until ``end``, ``most`` at most; never none at all, which waits for nothing."""
    return most if end is None else min(most, max(0.01, end - time.monotonic()))


class ModelGeneration(Job):
    """The generation of an impeller from parameters."""

    kind = "model_generation"
    path = "/v1/models"

    @property
    def model(self) -> str:
        """Id of the model, once it is there."""
        state = self.state
        if "model" not in state:
            raise ValueError(f"the model is not there yet: the job is {state['status']}, at {state['progress']} %")
        return str(state["model"])
