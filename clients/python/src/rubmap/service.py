"""Requests that are sent until they are answered."""

from __future__ import annotations

import math
import time
import uuid
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from email.utils import parsedate_to_datetime
from typing import Any

import httpx
import numpy as np

from .errors import Refusal, RubmapError, Unreachable

#: Answers after which the same request may be sent again: of the service, and of a gateway that does not reach it.
AGAIN = (408, 429, 502, 503, 504)

#: Seconds before the second try, and at most before a later one.
_PAUSES = (0.25, 10.0)

#: Seconds without a byte and without a connection: an answer may be minutes of computing away, a connection not.
_SILENCE = 300.0
_CONNECT = 10.0


class Service:
    """The service at ``url``.

    Args:
        url: its address, such as ``http://127.0.0.1:8080``.
        token: of a service that wants one.
        patience: seconds for which a request is repeated while the service cannot be reached or has no room.

    Raises:
        ValueError: an address or a token that can be none.
    """

    def __init__(self, url: str, token: str | None = None, patience: float = 60.0) -> None:
        address = httpx.URL(url)
        if address.scheme not in ("http", "https") or not address.host:
            raise ValueError(f"{url!r} is no address of a service: expected one such as http://127.0.0.1:8080")
        token = token.strip() if token else None
        if token and not (token.isascii() and token.isprintable()):
            raise ValueError("the token has letters that no token has")
        headers = {"authorization": f"Bearer {token}"} if token else {}
        self.url = url.rstrip("/")
        self.patience = patience
        self._http = httpx.Client(
            base_url=self.url,
            headers=headers,
            timeout=httpx.Timeout(_SILENCE, connect=_CONNECT),
            # No proxy has a way to this machine's own addresses.
            trust_env=address.host not in ("localhost", "127.0.0.1", "::1"),
        )

    def close(self) -> None:
        """Closes the connections."""
        self._http.close()

    def get(self, path: str, **query: Any) -> Any:
        """JSON of a path."""
        return _json(self.read(path, accept="application/json", **query))

    def look(self, path: str, seconds: float) -> Any:
        """JSON of a path that is asked for once, and waited for no longer.

        Raises:
            httpx.TransportError: no answer.
        """
        timeout = httpx.Timeout(seconds, connect=min(seconds, _CONNECT))
        answer = self._http.get(path, headers={"accept": "application/json"}, timeout=timeout)
        if answer.is_error:
            raise _refusal(answer)
        return _json(answer)

    def read(self, path: str, accept: str = "*/*", **query: Any) -> httpx.Response:
        """The answer of a path; parameters that are None are left out."""
        return self._patiently(lambda: self._http.get(path, params=_given(query), headers={"accept": accept}))

    def post(self, path: str, body: Mapping[str, Any], key: str) -> Any:
        """Sends JSON that makes something: with one key for all tries, so that it is made once."""
        headers = {"idempotency-key": key}
        sent = plain(body)
        return _json(self._patiently(lambda: self._http.post(path, json=sent, headers=headers)))

    def ask(self, path: str, body: Mapping[str, Any]) -> Any:
        """Sends JSON that makes nothing, such as for a plan: sent twice it does no harm."""
        sent = plain(body)
        return _json(self._patiently(lambda: self._http.post(path, json=sent)))

    def upload(
        self, path: str, content: Callable[[], Any], query: Mapping[str, Any], media_type: str = "application/zip"
    ) -> Any:
        """Sends a file; ``content`` opens it anew for every try."""
        headers = {"content-type": media_type, "idempotency-key": str(uuid.uuid4())}
        return _json(
            self._patiently(lambda: self._http.post(path, content=content(), params=_given(query), headers=headers))
        )

    def read_text(self, path: str, text: str, media_type: str) -> Any:
        """Sends text that makes nothing, such as a table to be read."""
        headers = {"content-type": media_type}
        return _json(self._patiently(lambda: self._http.post(path, content=text.encode(), headers=headers)))

    def patch(self, path: str, body: Mapping[str, Any]) -> Any:
        """Changes what something is called."""
        headers = {"content-type": "application/merge-patch+json"}
        return _json(self._patiently(lambda: self._http.patch(path, json=body, headers=headers)))

    def delete(self, path: str, **query: Any) -> None:
        """Deletes what is there; that it is gone once an answer was lost is as well."""
        tries = 0

        def attempt() -> httpx.Response:
            nonlocal tries
            tries += 1
            answer = self._http.delete(path, params=_given(query))
            return httpx.Response(204) if tries > 1 and answer.status_code == 404 else answer

        self._patiently(attempt)

    @contextmanager
    def stream(
        self, path: str, accept: str = "*/*", silence: float = _SILENCE, **query: Any
    ) -> Iterator[httpx.Response]:
        """An answer that is read piece by piece, ``silence`` seconds apart at most; what breaks off is the caller's to begin anew."""
        timeout = httpx.Timeout(silence, connect=_CONNECT)
        headers = {"accept": accept}
        with self._http.stream("GET", path, params=_given(query), headers=headers, timeout=timeout) as answer:
            if answer.is_error:
                answer.read()
                raise _refusal(answer)
            yield answer

    def _patiently(self, attempt: Callable[[], httpx.Response]) -> httpx.Response:
        end = time.monotonic() + self.patience
        pause, most = _PAUSES
        while True:
            wait = pause
            try:
                answer = attempt()
                if not answer.is_error:
                    return answer
                refusal = _refusal(answer)
                if answer.status_code not in AGAIN:
                    raise refusal
                wait = max(wait, _seconds(answer.headers.get("retry-after", "0")))
                failure: Exception = refusal
            except httpx.TransportError as error:
                failure = Unreachable(f"{self.url} does not answer: {error}")
                failure.__cause__ = error
            if time.monotonic() + wait > end:
                raise failure
            time.sleep(wait)
            pause = min(2 * pause, most)


def plain(value: Any, pointer: str = "") -> Any:
    """A request as JSON has it: arrays and numbers of numpy are lists and numbers."""
    if isinstance(value, Mapping):
        return {name: plain(part, f"{pointer}/{name}") for name, part in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, list | tuple):
        return [plain(part, f"{pointer}/{index}") for index, part in enumerate(value)]
    if isinstance(value, float) and not math.isfinite(value):
        raise ValueError(f"{pointer}: {value} is no number that a request can have")
    return value


def _given(query: Mapping[str, Any]) -> dict[str, Any] | None:
    # No parameters are none: an empty mapping would take away those that a link has.
    return {name: value for name, value in query.items() if value is not None} or None


def _seconds(retry_after: str) -> float:
    """Seconds until another try, which RFC 9110 allows to be said as a date."""
    if retry_after.isdigit():
        return float(retry_after)
    try:
        return parsedate_to_datetime(retry_after).timestamp() - time.time()
    except ValueError:
        return 0.0


def _json(answer: httpx.Response) -> Any:
    try:
        return answer.json()
    except ValueError:
        kind = answer.headers.get("content-type", "nothing")
        raise RubmapError(f"{answer.url} answers with {kind}, not with JSON: this is no rubmap service") from None


def _refusal(answer: httpx.Response) -> Refusal:
    try:
        problem = answer.json()
    except ValueError:
        problem = {"title": f"the service answered {answer.status_code} {answer.reason_phrase}"}
    return Refusal(answer.status_code, problem if isinstance(problem, dict) else {})
