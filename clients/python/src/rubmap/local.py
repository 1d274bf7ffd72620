"""A service of one's own, for as long as a script or a notebook needs it."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import metadata
from pathlib import Path

from .client import Client
from .errors import RubmapError

#: Seconds within which a service listens.
_START = 60.0


@contextmanager
def local(binary: str | os.PathLike[str] | None = None, data: str | os.PathLike[str] | None = None) -> Iterator[Client]:
    """Starts the program on a free port of this machine, and stops it at the end of the block.

    Args:
        binary: the program; by default ``RUBMAP_BINARY`` of the environment, the one that was installed with this client, or ``rubmap`` of the
            PATH.
        data: folder that keeps models and results; by default a temporary one, which is deleted.

    Raises:
        RubmapError: there is no such program, or it did not start; its log says why.
    """
    named = os.path.expanduser(binary or os.environ.get("RUBMAP_BINARY") or _installed() or "rubmap")
    program = shutil.which(named)
    if program is None:
        raise RubmapError(
            f"there is no program {named} that can be run: name it, set RUBMAP_BINARY (cargo build --release makes target/release/rubmap), "
            "or install a wheel that carries it (clients/python/wheel makes one)"
        )
    with tempfile.TemporaryDirectory(prefix="rubmap-") as folder:
        log = Path(folder) / "service.log"
        with log.open("wb") as out:
            kept = Path(data).expanduser() if data else Path(folder) / "data"
            command = [program, "serve", "--until-eof", "--addr", "127.0.0.1:0", "--data", os.fspath(kept)]
            # It ends with this process, however that ends, and is not what the environment says of others.
            surrounding = {name: value for name, value in os.environ.items() if not name.startswith("RUBMAP_")}
            process = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=out, stderr=out, env=surrounding | {"RUST_LOG": "info"}
            )
        try:
            with Client(_address(process, log), token="") as client:
                yield client
        finally:
            process.terminate()
            if process.stdin:
                process.stdin.close()
            try:
                process.wait(30)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def _installed() -> Path | None:
    """The program that the wheel of this client carried, wherever it was installed."""
    try:
        files = metadata.files("rubmap") or []
    except metadata.PackageNotFoundError:
        return None
    programs = (Path(str(file.locate())) for file in files if file.name in ("rubmap", "rubmap.exe"))
    return next((program for program in programs if program.is_file()), None)


def _address(process: subprocess.Popen[bytes], log: Path) -> str:
    end = time.monotonic() + _START
    while time.monotonic() < end and process.poll() is None:
        if found := re.search(r"listening on (http://\S+)", log.read_text(errors="replace")):
            return found[1]
        time.sleep(0.05)
    raise RubmapError(f"the service did not start:\n{log.read_text(errors='replace')}")
