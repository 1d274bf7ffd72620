"""Files and arrays of results."""

from __future__ import annotations

import io
import os
import time
import uuid
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import numpy.typing as npt

from .errors import Refusal, Unreachable
from .service import AGAIN, Service

Arrays = dict[str, npt.NDArray[Any]]


def arrays(service: Service, path: str, **query: Any) -> Arrays:
    """All numbers of a result by name, with the shapes that the contract gives them."""
    answer = service.read(path, format="npz", **query)
    with np.load(io.BytesIO(answer.content), allow_pickle=False) as file:
        return {name: file[name] for name in file.files}


def download(service: Service, path: str, to: str | os.PathLike[str], **query: Any) -> Path:
    """Writes a result to a file, which is there when it is whole and not before; a download that breaks off begins anew."""
    # Of a link what it leads to is written.
    target = Path(to).expanduser().resolve()
    if not target.parent.is_dir():
        raise FileNotFoundError(f"there is no folder {target.parent} for {target.name}")
    part = target.with_name(f".{target.name}.{uuid.uuid4().hex[:8]}")
    last = time.monotonic()
    try:
        while True:
            try:
                with service.stream(path, **query) as answer, part.open("wb") as file:
                    for piece in answer.iter_bytes():
                        file.write(piece)
                        last = time.monotonic()
                return part.replace(target)
            except httpx.TransportError as error:
                failure: Exception = Unreachable(f"{service.url} does not answer: {error}")
            except Refusal as refusal:
                if refusal.status not in AGAIN:
                    raise
                failure = refusal
            if time.monotonic() > last + service.patience:
                raise failure
            time.sleep(0.5)
    finally:
        part.unlink(missing_ok=True)
