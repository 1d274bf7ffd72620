"""A service of the real program with a finished sweep. ``RUBMAP_BINARY`` names the program."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import rubmap

SCENE: Any = {
    "centrifugal_stiffening": True,
    "damping": {"modal_ratio": 0.005},
    "casing": {
        "clearance": {"leading": 0.30, "trailing": 0.22},
        "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35},
    },
    "contact": {},
}


def sweep_of(model: str, **changes: Any) -> Any:
    """A quick sweep: few modes, six speeds, with histories of one."""
    request = {
        "model": model,
        "modes_per_speed": 3,
        "speeds": {"from": 16000, "to": 26000, "count": 6, "unit": "rpm"},
        "scene": SCENE,
        "integration": {"revolutions": 30, "window_revolutions": 10},
        "record": {"histories": {"speeds": [2], "quantities": ["displacement", "contact_force"]}, "stress": {}},
    }
    return request | changes


@pytest.fixture(scope="session")
def client() -> Iterator[rubmap.Client]:
    with rubmap.local() as found:
        yield found


@pytest.fixture(scope="session")
def zipped(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("package") / "impeller.zip"
    subprocess.run([os.environ["RUBMAP_BINARY"], "generate", "--out", path], check=True, capture_output=True)
    return path


@pytest.fixture(scope="session")
def model(client: rubmap.Client) -> rubmap.Model:
    job = client.generate({"preset": "small", "name": "for tests"}).submit().wait(progress=False)
    return client.model(job.model)


@pytest.fixture(scope="session")
def swept(client: rubmap.Client, model: rubmap.Model) -> rubmap.Sweep:
    return client.sweep(sweep_of(model.id)).submit().wait(progress=False)
