"""Progress of a job: a bar on a terminal and in a notebook, otherwise a line now and then."""

from __future__ import annotations

import re
import sys
import time
from collections.abc import Mapping
from typing import Any, Protocol, Self

from tqdm.auto import tqdm
from tqdm.std import tqdm as plain_bar

#: Per cent between two lines.
_STEP = 10


class Progress(Protocol):
    """What shows how far a job is."""

    def __enter__(self) -> Self: ...

    def __exit__(self, *_: object) -> None: ...

    def show(self, state: Mapping[str, Any]) -> None:
        """Shows a job as it is now."""


def progress(kind: str, shown: bool) -> Progress:
    """Progress of a job of this kind: a bar, lines where nobody watches a terminal, or nothing."""
    # In a notebook with widgets tqdm.auto takes a bar of its own kind.
    watched = not shown or sys.stderr.isatty() or tqdm.__mro__[1] is not plain_bar
    return _Bar(kind, shown) if watched else _Lines(kind)


class _Bar:
    def __init__(self, kind: str, shown: bool) -> None:
        bars = "{desc}: {percentage:3.0f} %|{bar}| {elapsed}{postfix}"
        self._bar = tqdm(total=100, bar_format=bars, disable=not shown, desc=kind)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._bar.close()

    def show(self, state: Mapping[str, Any]) -> None:
        self._bar.set_postfix_str(str(state.get("phase") or state["status"]))
        self._bar.update(state["progress"] - self._bar.n)


class _Lines:
    """A line at the start, after every tenth of the work, when another phase begins, and at the end."""

    def __init__(self, kind: str) -> None:
        self._kind = kind
        self._begin = time.monotonic()
        self._next = 0
        self._phases: set[str] = set()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def show(self, state: Mapping[str, Any]) -> None:
        done, status = int(state["progress"]), state["status"]
        ended = status in ("successful", "failed", "dismissed")
        # A phase counts on before its first comma, and says behind it what follows.
        phase = re.sub(r"\d+", "", re.split("[,;]", str(state.get("phase") or ""))[0])
        if done < self._next and phase in self._phases and not ended:
            return
        self._phases.add(phase)
        self._next = _STEP * (done // _STEP + 1)
        took = time.monotonic() - self._begin
        print(f"{self._kind}: {done:3} %, {state.get('phase') or status}, {took:.0f} s", file=sys.stderr, flush=True)
