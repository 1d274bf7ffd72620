"""Files and arrays of results."""

from __future__ import annotations

import io
import os
import tempfile
import time
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import numpy.typing as npt

from .errors import Unreachable
from .service import Service

Arrays = dict[str, npt.NDArray[Any]]


def arrays(service: Service, path: str, **query: Any) -> Arrays:
    """All numbers of a result by name, with the shapes that the contract gives them."""
    answer = service.read(path, format="npz", **query)
    with np.load(io.BytesIO(answer.content), allow_pickle=False) as file:
        return {name: file[name] for name in file.files}


def download(service: Service, path: str, to: str | os.PathLike[str], **query: Any) -> Path:
    """Writes a result to a file, which is there when it is whole and not before; a download that breaks off begins anew."""
    target = Path(to).expanduser()
    if not target.parent.is_dir():
        raise FileNotFoundError(f"there is no folder {target.parent} for {target.name}")
    end = time.monotonic() + service.patience
    while True:
        try:
            return _written(service, path, target, query)
        except httpx.TransportError as error:
            if time.monotonic() > end:
                raise Unreachable(f"{service.url} does not answer: {error}") from error
            time.sleep(0.5)


def _written(service: Service, path: str, target: Path, query: dict[str, Any]) -> Path:
    with service.stream(path, **query) as answer:
        handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
        try:
            with os.fdopen(handle, "wb") as file:
                for piece in answer.iter_bytes():
                    file.write(piece)
            os.replace(name, target)
        except BaseException:
            Path(name).unlink(missing_ok=True)
            raise
    return target
