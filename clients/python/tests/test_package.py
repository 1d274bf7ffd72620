"""Packages from matrices: the generator's sector, taken apart and put together again."""

from __future__ import annotations

import csv
import io
import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import sparse

import rubmap

Parts = dict[str, Any]


@pytest.fixture
def parts(zipped: Path) -> Parts:
    """Arguments of ``write_package`` that make the same sector."""
    archive = zipfile.ZipFile(zipped)
    sector = json.loads(archive.read("sector.json"))

    def rows(name: str) -> list[list[str]]:
        return list(csv.reader(io.TextIOWrapper(archive.open(name))))

    def matrix(name: str) -> Any:
        found = sparse.load_npz(io.BytesIO(archive.read(name))).tocsc()
        return found + sparse.tril(found, -1).T if sparse.triu(found, 1).nnz == 0 else found + sparse.triu(found, 1).T

    nodes = [row for row in rows("nodes.csv") if row[0].isdigit()]
    elements = [row for row in rows(sector["mesh"]["elements"]) if row[0].isdigit()]
    return {
        "sectors": sector["sectors"],
        "units": sector["units"],
        "frame": sector["frame"],
        "axis": (sector["axis"]["origin"], sector["axis"]["direction"]),
        "mass": matrix(sector["mass"]),
        "stiffness": [matrix(name) for name in sector["stiffness"]],
        "speeds_rad_s": sector["speeds_rad_s"],
        "node_ids": [int(row[0]) for row in nodes],
        "positions": np.array([[float(value) for value in row[1:]] for row in nodes]),
        "dofs": np.array([[int(value) for value in row] for row in rows("dofs.csv") if row[0].isdigit()]),
        "cyclic": np.array(sector["cyclic"]),
        "contact": [node["node"] for node in sector["contact"]],
        "normals": np.array([node["normal"] for node in sector["contact"]]),
        "mesh": {
            "sets": sector["mesh"]["sets"],
            "elements": [(int(row[0]), row[1], row[2], [int(node) for node in row[3:]]) for row in elements],
        },
    }


def test_the_same_sector_has_the_same_frequencies(
    client: rubmap.Client, model: rubmap.Model, parts: Parts, tmp_path: Path
) -> None:
    path = rubmap.write_package(tmp_path / "again.zip", name="put together again", **parts)
    again = client.upload(path)
    assert again.facts["name"] == "put together again" and again.id != model.id
    for name in ("sectors", "own_dofs", "contact_nodes", "contact_radius", "contact_spacing", "mesh"):
        assert again.facts[name] == model.facts[name], name
    speeds: Any = {"values": [0.0, 2000.0], "unit": "rad_s"}
    for each in (model, again):
        client.modal_analysis({"model": each.id, "modes_per_speed": 2, "speeds": speeds}).submit().wait(progress=False)
    for speed in (0.0, 2000.0):
        np.testing.assert_allclose(again.modes(speed, 2), model.modes(speed, 2), rtol=1e-9)


def damaged(parts: Parts, what: str) -> str:
    """Damages a part; returns what the error must say."""
    if what == "asymmetric":
        matrix = parts["stiffness"][1].tolil()
        matrix[7, 3] += 1e-3 * abs(matrix).max()
        parts["stiffness"][1] = matrix.tocsc()
        return r"stiffness\[1\]: not symmetric at row (3, column 7|7, column 3)"
    if what == "size":
        parts["mass"] = parts["mass"][:-1, :-1]
        return "mass: shape .* dofs has"
    if what == "infinite":
        parts["positions"][5, 1] = np.inf
        return r"positions: row 5 \(node \d+\) is not finite"
    if what == "not a number":
        parts["mass"].data[0] = np.nan
        return "mass: row 0, column 0 .* is not finite"
    if what == "complex":
        parts["stiffness"][0] = parts["stiffness"][0] * (1 + 0.01j)
        return r"stiffness\[0\]: complex"
    if what == "half a sector":
        parts["sectors"] += 0.5
        return r"sectors: \d+.5 is no whole number"
    if what == "not a list":
        parts["stiffness"] = parts["stiffness"][0]
        return "stiffness: give a list"
    if what == "units":
        parts["units"] = {"length": "mm"}
        return "units: .* one each of length, force, time, mass"
    if what == "massless":
        matrix = parts["mass"].tolil()
        row = int(np.flatnonzero(parts["dofs"][:, 0] == parts["contact"][0])[0])
        matrix[row, row] = 0.0
        parts["mass"] = matrix.tocsc()
        return f"mass: the diagonal of row {row} "
    if what == "turned the other way":
        parts["cyclic"] = parts["cyclic"][:, ::-1]
        return "cyclic: row .* the low node comes first"
    if what == "contact twice":
        parts["contact"][1] = parts["contact"][0]
        return "contact: node .* is there twice"
    if what == "contact on a face":
        parts["contact"][2] = int(parts["cyclic"][0, 0])
        return "contact: entry 2: node .* cyclic face"
    if what == "normal":
        parts["normals"][3] *= 1.01
        return "normals: row 3 has length 1.01"
    if what == "speeds":
        parts["speeds_rad_s"] = [0.0, 3000.0, 2000.0]
        return "speeds_rad_s: .* must ascend"
    if what == "two stiffnesses":
        parts["stiffness"] = parts["stiffness"][:2]
        return "2 matrices and 3 speeds"
    if what == "row twice":
        parts["dofs"][4] = parts["dofs"][3]
        return "dofs: node .* is there twice"
    if what == "unknown node":
        parts["dofs"][4, 0] = 10**6
        return "dofs: row 4 names node 1000000"
    raise AssertionError(what)


@pytest.mark.parametrize(
    "what",
    [
        "asymmetric", "size", "infinite", "massless", "turned the other way", "contact twice", "contact on a face",
        "normal", "not a number", "complex", "half a sector", "not a list", "units", "speeds", "two stiffnesses", "row twice", "unknown node",
    ],
)  # fmt: skip
def test_a_defect_is_found_before_anything_is_written(parts: Parts, what: str, tmp_path: Path) -> None:
    expected = damaged(parts, what)
    with pytest.raises(rubmap.PackageError, match=expected):
        rubmap.write_package(tmp_path / "bad.zip", **parts)
    assert not (tmp_path / "bad.zip").exists()


def test_a_table_becomes_a_measured_casing(client: rubmap.Client, tmp_path: Path) -> None:
    table = tmp_path / "casing.csv"
    angles = np.arange(0, 360, 3)
    rows = [
        f"{angle};{height}".replace(".", ",")
        for angle, height in zip(angles, np.cos(np.radians(2 * angles)), strict=True)
    ]
    table.write_text("\ufeffangle_deg;0,5\n" + "\n".join(rows), encoding="utf-8")
    found = client.measured_casing(table)
    np.testing.assert_allclose(found["measured"]["angles_rad"], np.radians(angles))
    np.testing.assert_allclose(found["measured"]["heights"], [np.cos(np.radians(2 * angles))])
    assert found["measured"]["chord"] == [0.5] and found["survey"]["outlier_count"] == 0
    table.write_text("angle_deg,0\n1,much\n", encoding="utf-8")
    with pytest.raises(rubmap.Refusal) as refused:
        client.measured_casing(table)
    assert refused.value.errors[0]["line"] == 2
