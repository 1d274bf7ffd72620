"""A service that is killed and comes back while a script waits."""

from __future__ import annotations

import os
import re
import subprocess
import time
from pathlib import Path

from conftest import sweep_of

import rubmap


def started(folder: Path, address: str) -> tuple[subprocess.Popen[bytes], str]:
    log = folder / f"{time.monotonic_ns()}.log"
    command = [os.environ["RUBMAP_BINARY"], "serve", "--addr", address, "--data", str(folder / "data")]
    with log.open("wb") as out:
        process = subprocess.Popen(command, stdout=out, stderr=out)
    for _ in range(600):
        if found := re.search(r"listening on http://(\S+)", log.read_text()):
            return process, found[1]
        time.sleep(0.05)
    raise AssertionError(log.read_text())


def test_a_script_outlives_the_service(tmp_path: Path) -> None:
    process, address = started(tmp_path, "127.0.0.1:0")
    try:
        with rubmap.Client(f"http://{address}") as client:
            model = client.generate({"preset": "small"}).submit().wait(progress=False).model
            sweep = client.sweep(sweep_of(model, integration={"revolutions": 400, "window_revolutions": 10})).submit()
            process.kill()
            process.wait()
            process, _ = started(tmp_path, address)
            assert sweep.wait(progress=False).status == "successful"
            assert len(client.jobs(kind="sweep")) == 1
    finally:
        process.kill()
        process.wait()
