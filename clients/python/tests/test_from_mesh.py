"""Models from meshes: of the generator's elements in several forms, and of STEP files."""

from __future__ import annotations

import csv
import io
import json
import re
import sys
import textwrap
import zipfile
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import httpx
import numpy as np
import numpy.typing as npt
import pytest
from test_jobs import mocked

import rubmap
from rubmap.gmsh_text import write_mesh
from rubmap.mesh import optional

TITANIUM = (114000.0, 0.32, 4.43e-9)

DOCS = Path(__file__).parents[3] / "docs" / "python.md"


def needed(name: str) -> Any:
    """A package without which a test is skipped."""
    try:
        return optional(name, "for this test")
    except ImportError as error:
        pytest.skip(str(error))


@pytest.fixture(scope="session")
def bare(zipped: Path) -> Any:
    """The generator's points, its hexahedra and its contact nodes as meshio has them."""
    archive = zipfile.ZipFile(zipped)

    def rows(name: str) -> list[list[str]]:
        return [row for row in csv.reader(io.TextIOWrapper(archive.open(name))) if row[0].isdigit()]

    points = np.array([[float(x) for x in row[1:]] for row in rows("nodes.csv")])
    elements = np.array([[int(node) - 1 for node in row[3:]] for row in rows("elements.csv")])
    tip = [each["node"] - 1 for each in json.loads(archive.read("sector.json"))["contact"]]
    return SimpleNamespace(points=points, elements=elements, tip=tip)


def deck(bare: Any) -> str:
    """Nodes and elements for CalculiX, and nothing else."""
    nodes = [f"{k}, {x!r}, {y!r}, {z!r}\n" for k, (x, y, z) in enumerate(bare.points.tolist(), 1)]
    elements = [f"{k}, {', '.join(map(str, row))}\n" for k, row in enumerate((bare.elements + 1).tolist(), 1)]
    return "".join(["*NODE\n", *nodes, "*ELEMENT, TYPE=C3D8I, ELSET=WHEEL\n", *elements])


@pytest.fixture(scope="session")
def from_deck(client: rubmap.Client, bare: Any, tmp_path_factory: pytest.TempPathFactory) -> rubmap.Model:
    path = tmp_path_factory.mktemp("mesh") / "mine.inp"
    path.write_text(deck(bare))
    return client.model_from_mesh(path, top_speed_rad_s=4000.0, material=TITANIUM, tags=["deck", "small"])


def frequencies(client: rubmap.Client, model: rubmap.Model, modes: int = 4) -> npt.NDArray[np.float64]:
    speeds: Any = {"values": [0.0], "unit": "rad_s"}
    request: Any = {"model": model.id, "modes_per_speed": modes, "speeds": speeds}
    client.modal_analysis(request).submit().wait(progress=False)
    return model.modes(0.0, modes).to_numpy()


def test_a_deck_becomes_the_model_of_its_generator(
    client: rubmap.Client, model: rubmap.Model, from_deck: rubmap.Model
) -> None:
    assert from_deck.facts["name"] == "mine" and from_deck.facts["tags"] == ["deck", "small"]
    for name in ("sectors", "own_dofs", "contact_nodes", "contact_radius", "contact_spacing", "speeds_rad_s"):
        assert from_deck.facts[name] == model.facts[name], name
    assert any(line.startswith("sectors: 10 (found)") for line in from_deck.found) and model.found == []
    assert client.model(from_deck.id).found == from_deck.found
    # The generator's elements are of another kind with 8 nodes.
    np.testing.assert_allclose(frequencies(client, from_deck), frequencies(client, model), rtol=0.01)


def test_settings_are_those_of_the_service(
    client: rubmap.Client, bare: Any, from_deck: rubmap.Model, tmp_path: Path
) -> None:
    path = tmp_path / "other.inp"
    path.write_text(deck(bare))
    constants = dict(zip(("youngs_modulus", "poissons_ratio", "density"), TITANIUM, strict=True))
    named = client.model_from_mesh(
        str(path),
        top_speed_rpm=4000.0 * 30.0 / np.pi,
        materials={"WHEEL": constants},
        sectors=10,
        axis=([0, 0, 0], np.array([0.0, 0.0, 2.0])),
        contact_nodes=5,
        units={"length": "mm", "force": "N", "time": "s", "mass": "t"},
        gyroscopic=False,
        mass="as_stiffness",
        name="named",
    )
    assert named.facts["contact_nodes"] == 5 and named.facts["name"] == "named" and not named.facts["gyroscopic"]
    assert "sectors: 10 (as stated)" in "".join(named.found) and from_deck.facts["gyroscopic"]
    np.testing.assert_allclose(named.facts["speeds_rad_s"], from_deck.facts["speeds_rad_s"], rtol=1e-12)


def test_patches_that_a_look_lists_are_chosen_by_their_nodes(
    client: rubmap.Client, bare: Any, from_deck: rubmap.Model, tmp_path: Path
) -> None:
    path = tmp_path / "mine.inp"
    path.write_text(deck(bare))
    # Neither material nor top speed.
    look = client.look_at_mesh(path)
    assert [refusal["step"] for refusal in look["refusals"]] == ["materials"]
    assert look.get("sectors") == 10 and len(look["positions"]) == 3 * len(look["node_ids"])
    named = {role: patch["at"] for patch in look["patches"] if (role := patch.get("role"))}
    assert set(named) == {"low", "high", "clamp", "contact"}
    chosen = client.model_from_mesh(
        path, top_speed_rad_s=4000.0, material=TITANIUM, clamp_at=named["clamp"], contact_at=named["contact"][0]
    )
    assert chosen.id == from_deck.id
    # One of the long edges of the tip.
    edge = look["chains"][0]["nodes"]
    ends = (look["node_ids"][edge[0]], look["node_ids"][edge[-1]])
    between = client.look_at_mesh(path, contact_between=ends, material=TITANIUM)
    assert any(f"along the edge from node {ends[0]} to node {ends[1]}" in line for line in between["found"])
    # The contact line itself as the shroud.
    x, y, z = np.array(look["positions"]).reshape(-1, 3)[look["contact_line"]].T
    shroud = np.column_stack((np.hypot(x, y), z)).tolist()
    seen = client.look_at_mesh(path, material=TITANIUM, shroud=shroud)
    assert any("along the shroud curve" in line for line in seen["found"]) and seen["contact"] == look["contact"]
    along = client.model_from_mesh(path, top_speed_rad_s=4000.0, material=TITANIUM, shroud=shroud)
    assert along.id == from_deck.id
    with pytest.raises(rubmap.Refusal, match="`clamp_set` and `clamp_at` both say"):
        client.look_at_mesh(path, clamp_set="BORE", clamp_at=1)


def test_what_a_mesh_lacks_is_refused(client: rubmap.Client, bare: Any, tmp_path: Path) -> None:
    path = tmp_path / "mine.inp"
    path.write_text(deck(bare))
    with pytest.raises(rubmap.Refusal, match="material") as refused:
        client.model_from_mesh(path, top_speed_rpm=30000)
    assert refused.value.status == 422
    with pytest.raises(rubmap.Refusal, match='no nodes in a set "BORE"'):
        client.model_from_mesh(path, top_speed_rpm=30000, material=TITANIUM, clamp_set="BORE")
    path.write_text(deck(bare).replace("C3D8I", "C3D9"))
    with pytest.raises(rubmap.Refusal) as refused:
        client.model_from_mesh(path, top_speed_rpm=30000, material=TITANIUM)
    assert refused.value.errors[0]["line"] == len(bare.points) + 2
    with pytest.raises(FileNotFoundError):
        client.model_from_mesh(tmp_path / "nothing.inp", top_speed_rpm=30000)


def test_arguments_that_cannot_be_are_refused_before_anything_is_sent(tmp_path: Path) -> None:
    def answer(request: httpx.Request) -> httpx.Response:
        raise AssertionError(request)

    client = mocked(answer)
    for ending in (".inp", ".zip", ".step", ".odd"):
        (tmp_path / f"mine{ending}").touch()

    def refused(match: str, ending: str = ".inp", **given: Any) -> None:
        with pytest.raises(ValueError, match=match):
            client.model_from_mesh(tmp_path / f"mine{ending}", **{"top_speed_rpm": 30000} | given)

    refused("top speed once", top_speed_rad_s=3000)
    refused("top speed once", top_speed_rpm=None)
    refused("all elements once", material=TITANIUM, materials={"*": {}})
    refused("Young's modulus, Poisson's ratio and density", material=TITANIUM[:2])
    refused('give "x", "y", "z", or an origin', axis="r")
    refused('give "x", "y", "z", or an origin', axis=(0, 0, 1))
    refused("no number that a request can have", top_speed_rpm=np.inf)
    refused("Client.upload", ".zip")
    refused("rubmap.mesh_step", ".step")
    with pytest.raises(TypeError, match="not list"):
        client.model_from_mesh([], top_speed_rpm=30000)  # type: ignore[arg-type]
    needed("meshio")
    refused("none of the ways that meshes do", ".odd")
    (tmp_path / "mine.vtk").write_text("no mesh\n")
    refused("meshio cannot read mine.vtk", ".vtk")


def test_without_meshio_a_file_for_it_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "meshio", None)
    (tmp_path / "mine.med").touch()
    with pytest.raises(ImportError, match=r"meshio is needed to read mine\.med \(the service reads \.inp"):
        mocked(lambda _: httpx.Response(500)).model_from_mesh(tmp_path / "mine.med", top_speed_rpm=30000)


def test_a_mesh_is_sent_whole_by_one_key_until_it_is_answered(tmp_path: Path) -> None:
    sent: list[httpx.Request] = []
    bodies: list[bytes] = []

    def answer(request: httpx.Request) -> httpx.Response:
        sent.append(request)
        bodies.append(request.read())
        if len(sent) == 1:
            return httpx.Response(503, headers={"retry-after": "0"}, json={"title": "no room"})
        return httpx.Response(201, json={"id": "1", "name": "mine", "found": ["one"]})

    path = tmp_path / "mine.MSH"
    path.write_bytes(b"$MeshFormat\n" * 200_000)
    found = mocked(answer).model_from_mesh(path, top_speed_rad_s=np.float64(3000.0), notes="of the test")
    assert found.found == ["one"] and bodies == [path.read_bytes()] * 2
    assert len({request.headers["idempotency-key"] for request in sent}) == 1
    assert {request.headers["content-type"] for request in sent} == {"application/octet-stream"}
    query = dict(sent[1].url.params)
    assert json.loads(query.pop("settings")) == {"top_speed_rad_s": 3000.0}
    assert query == {"name": "mine", "notes": "of the test"}


def test_a_mesh_of_meshio_keeps_its_digits_and_sets(
    client: rubmap.Client, bare: Any, from_deck: rubmap.Model, tmp_path: Path
) -> None:
    meshio = needed("meshio")
    half = len(bare.elements) // 2
    radius = np.hypot(bare.points[:, 0], bare.points[:, 1])
    mesh = meshio.Mesh(
        bare.points,
        [("hexahedron", bare.elements[:half]), ("quad", bare.elements[:2, :4]), ("hexahedron", bare.elements[half:])],
        point_sets={"my tip": bare.tip, "BORE": np.flatnonzero(radius < radius.min() * 1.0001)},
        cell_sets={
            "first": [np.arange(half), [], []],
            "all": [np.arange(half), [], np.arange(len(bare.elements) - half)],
            "skin": [[], [0, 1], []],
        },
    )
    constants = dict(zip(("youngs_modulus", "poissons_ratio", "density"), TITANIUM, strict=True))
    arguments: dict[str, Any] = {"top_speed_rad_s": 4000.0, "clamp_set": "BORE", "contact_set": "my tip"}
    again = client.model_from_mesh(mesh, materials={"first": constants, "all": constants}, **arguments)
    assert [line for line in again.found if "set my tip" in line] and [
        line for line in again.found if "set BORE" in line
    ]
    for name in ("own_dofs", "contact_nodes", "contact_radius"):
        assert again.facts[name] == from_deck.facts[name], name
    np.testing.assert_allclose(frequencies(client, again), frequencies(client, from_deck), rtol=1e-9)
    with pytest.raises(rubmap.Refusal, match="it has BORE, all, first, my tip, skin"):
        client.model_from_mesh(mesh, material=TITANIUM, **arguments | {"clamp_set": "none"})
    mesh.point_sets["first"] = bare.tip
    with pytest.raises(ValueError, match="rename one of them"):
        client.model_from_mesh(mesh, material=TITANIUM, **arguments | {"contact_set": "first"})
    # A format that the service does not read.
    mesh.point_sets, mesh.cell_sets = {}, {}
    meshio.write(tmp_path / "mine.vtk", mesh)
    read = client.model_from_mesh(tmp_path / "mine.vtk", top_speed_rad_s=4000.0, material=TITANIUM)
    assert read.facts["name"] == "mine" and read.facts["own_dofs"] == from_deck.facts["own_dofs"]


def written(mesh: Any) -> str:
    file = io.BytesIO()
    write_mesh(mesh, file)
    return file.getvalue().decode()


def test_physical_groups_are_sets() -> None:
    mesh = SimpleNamespace(
        points=np.vstack([np.zeros(3), np.eye(3)]),
        cells=[
            SimpleNamespace(type=kind, data=[row]) for kind, row in (("tetra", [0, 1, 2, 3]), ("triangle", [0, 1, 2]))
        ],
        cell_data={"gmsh:physical": [np.array([1]), np.array([1])], "gmsh:geometrical": [np.array([7]), np.array([7])]},
        field_data={"SOLID": np.array([1, 3])},
        cell_sets={"gmsh:bounding_entities": [[], []]},
    )
    text = written(mesh)
    assert re.findall(r'^\d \d ".*"$', text, re.MULTILINE) == ['0 1 "1"', '3 1 "SOLID"']
    assert text.endswith("$Elements\n4\n1 4 2 1 1 1 2 3 4\n3 15 2 1 1 1\n4 15 2 1 1 2\n5 15 2 1 1 3\n$EndElements\n")
    mesh.cells[0] = SimpleNamespace(type="tetra20", data=[list(range(20))])
    with pytest.raises(ValueError, match="tetra20 elements cannot be carried over; solid elements are tetra, "):
        written(mesh)
    mesh.cells[0] = SimpleNamespace(type="tetra", data=[[0, 1, 2, 4]])
    with pytest.raises(ValueError, match="nodes that there are not"):
        written(mesh)
    del mesh.cells[0]
    with pytest.raises(ValueError, match="no solid element"):
        written(mesh)


#: Corners of elements, and the edges on which VTK's quadratic ones have a node, in its order.
RING = [[0, 1], [1, 2], [2, 3], [3, 0]]
ELEMENTS: dict[str, tuple[list[list[float]], list[list[int]]]] = {
    "tetra10": ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]]),
    "wedge15": (
        [[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (0, 1))],
        [[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]],
    ),
    "pyramid13": (
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 1]],
        [*RING, [0, 4], [1, 4], [2, 4], [3, 4]],
    ),
    "hexahedron20": (
        [[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))],
        [*RING, *([a + 4, b + 4] for a, b in RING), *([k, k + 4] for k in range(4))],
    ),
}


@pytest.mark.parametrize("kind", ELEMENTS)
def test_the_order_of_nodes_is_that_of_gmsh(kind: str, tmp_path: Path) -> None:
    gmsh = needed("gmsh")
    corners, edges = (np.array(part) for part in ELEMENTS[kind])
    points = np.vstack([corners, corners[edges].mean(axis=1)])
    rows = [np.arange(len(points))]
    if kind == "wedge15":
        # As VTK's own files have it.
        rows.append(np.array([0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13]))
    path = tmp_path / "one.msh"
    path.write_text(written(SimpleNamespace(points=points, cells=[SimpleNamespace(type=kind, data=rows)])))
    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        types, elements, nodes = gmsh.model.mesh.getElements(3)
        _, determinants, _ = gmsh.model.mesh.getJacobians(
            types[0], gmsh.model.mesh.getIntegrationPoints(types[0], "Gauss4")[0]
        )
        _, dimension, _, count, local, _ = gmsh.model.mesh.getElementProperties(types[0])
        assert (dimension, count, len(elements[0])) == (3, len(points), len(rows))
        assert determinants.min() > 0.0
        # Places of nodes in Gmsh's own element, by the way that its corners are moved.
        local = np.reshape(local, (-1, 3))
        for row in np.reshape(nodes[0], (-1, count)).astype(int) - 1:
            middle = points[row[: len(corners)]]
            for k in range(len(corners), count):
                ends = [
                    (a, b)
                    for a in range(len(corners))
                    for b in range(a)
                    if np.allclose(local[[a, b]].mean(axis=0), local[k])
                    and sorted((row[a], row[b])) in np.sort(edges).tolist()
                ]
                assert any(np.allclose(middle[[a, b]].mean(axis=0), points[row[k]]) for a, b in ends), (k, ends)
    finally:
        gmsh.finalize()


def step_file(
    gmsh: Any, path: Path, sectors: int, sweep: float = 0.0, thickness: float = 4.0, holes: float = 0.0
) -> None:
    """A disk with a bore and blades, as one solid: straight ones, or such as run back by an angle; with a hole between blades."""
    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        occ = gmsh.model.occ
        disk, _ = occ.cut([(3, occ.addCylinder(0, 0, 0, 0, 0, 20, 60))], [(3, occ.addCylinder(0, 0, 0, 0, 0, 20, 20))])
        blades = []
        for k in range(sectors):
            flanks = []
            for off in (-0.5 * thickness, 0.5 * thickness):
                r = np.linspace(55.0, 90.0, 6)
                angle = 2.0 * np.pi * k / sectors + sweep * (r - 55.0) / 35.0 + off / r
                flanks.append(
                    [occ.addPoint(x, y, 0) for x, y in zip(r * np.cos(angle), r * np.sin(angle), strict=True)]
                )
            one, other = flanks
            outline = [occ.addSpline(one), occ.addLine(one[-1], other[-1])]
            outline += [occ.addSpline(other), occ.addLine(other[0], one[0])]
            surface = occ.addPlaneSurface([occ.addCurveLoop(outline)])
            blades += [part for part in occ.extrude([(2, surface)], 0, 0, 20) if part[0] == 3]
        wheel, _ = occ.fuse(disk, blades)
        angles = 2.0 * np.pi * np.arange(sectors if holes else 0) / sectors + 0.3
        drills = [(3, occ.addCylinder(45 * np.cos(at), 45 * np.sin(at), 0, 0, 0, 20, holes)) for at in angles]
        if drills:
            occ.cut(wheel, drills)
        occ.synchronize()
        gmsh.write(str(path))
    finally:
        gmsh.finalize()


def section(title: str) -> str:
    """The Python of a section of the documentation."""
    text = DOCS.read_text(encoding="utf-8").split(f"\n## {title}\n")[1].split("\n## ")[0]
    return "".join(textwrap.dedent(code) for code in re.findall(r"```python\n(.*?)```", text, re.DOTALL))


def test_the_documentation_goes_from_a_mesh_to_frequencies(
    client: rubmap.Client, bare: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("impeller.inp").write_text(deck(bare))
    found: dict[str, Any] = {"client": client, "rubmap": rubmap}
    exec(section("From a mesh"), found)  # noqa: S102 - our own documentation
    assert found["model"].facts["sectors"] == 10


def test_the_documentation_goes_from_a_step_file_to_frequencies(
    client: rubmap.Client, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    gmsh = needed("gmsh")
    monkeypatch.chdir(tmp_path)
    step_file(gmsh, Path("wheel.step"), 7)
    found: dict[str, Any] = {"client": client, "rubmap": rubmap}
    exec(section("From a STEP file"), found)  # noqa: S102 - our own documentation
    model = found["model"]
    assert model.facts["sectors"] == 7 and any("bore found at r = 20.0" in line for line in model.found)
    assert found["mesh"] == Path("wheel.msh") and not gmsh.isInitialized()
    # The blade as a beam of 30 mm, 4 mm thick, on a disk that gives a little.
    beam = 1.875104**2 / (2.0 * np.pi) * 4.0 / np.sqrt(12.0) / 30.0**2 * np.sqrt(114000 / 4.43e-9)
    first = model.modes()[1]
    assert (first < beam).all() and (first > 0.8 * beam).all(), (first, beam)
    mesh = needed("meshio").read("wheel.msh")
    again = client.model_from_mesh(mesh, top_speed_rpm=30000, material=TITANIUM)
    np.testing.assert_allclose(frequencies(client, again, 10), model.modes(), rtol=1e-6)


def test_a_wheel_of_which_no_sector_can_be_cut_is_refused(tmp_path: Path) -> None:
    gmsh = needed("gmsh")
    path = tmp_path / "wheel.step"
    step_file(gmsh, path, 7)
    for match, given in (
        ("not the 5th part of its volume", {"sectors": 5}),
        ("check sectors and axis", {"sectors": 7, "axis": "x"}),
        ("at least 2 sectors", {"sectors": 1}),
        ("is no .msh file", {"sectors": 7, "to": tmp_path / "wheel.vtu"}),
    ):
        with pytest.raises(ValueError, match=match):
            rubmap.mesh_step(path, size=8, **given)
    step_file(gmsh, path, 7, sweep=1.2, thickness=8.0)
    with pytest.raises(ValueError, match="overlap around the axis"):
        rubmap.mesh_step(path, sectors=7, size=8)
    path.write_text("ISO-10303-21;\n")
    with pytest.raises(ValueError, match="cannot be read as STEP"):
        rubmap.mesh_step(path, sectors=7, size=8)
    assert not gmsh.isInitialized() and not path.with_suffix(".msh").exists()


def test_a_cut_through_holes_is_told_and_has_the_same_mesh_on_both_sides(client: rubmap.Client, tmp_path: Path) -> None:
    path = tmp_path / "wheel.step"
    step_file(needed("gmsh"), path, 7, holes=4.0)
    with pytest.warns(UserWarning, match="cut a blade or a hole"):
        mesh = rubmap.mesh_step(path, sectors=7, size=8)
    model = client.model_from_mesh(mesh, top_speed_rpm=30000, material=TITANIUM)
    assert any(line.startswith("sectors: 7 (found)") for line in model.found)


def test_a_sector_with_curved_faces_is_meshed_as_it_is(client: rubmap.Client, tmp_path: Path) -> None:
    gmsh = needed("gmsh")
    path = tmp_path / "sector.step"
    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        occ = gmsh.model.occ
        centre = occ.addPoint(0, 0, 0)
        sides, ends = [], []
        for k in (0, 1):
            r = np.linspace(20.0, 60.0, 5)
            angle = 2.0 * np.pi * k / 7 + 0.6 * (r - 20.0) / 40.0 + 0.15 * np.sin(0.075 * (r - 20.0))
            points = [occ.addPoint(x, y, 0) for x, y in zip(r * np.cos(angle), r * np.sin(angle), strict=True)]
            sides.append(occ.addSpline(points))
            ends.append((points[0], points[-1]))
        outer, inner = (occ.addCircleArc(ends[0][k], centre, ends[1][k]) for k in (1, 0))
        surface = occ.addPlaneSurface([occ.addCurveLoop([sides[0], outer, sides[1], inner])])
        solid = [part for part in occ.extrude([(2, surface)], 0, 0, 20) if part[0] == 3]
        blade = (3, occ.addBox(55, -2, 0, 35, 4, 20))
        occ.rotate([blade], 0, 0, 0, 0, 0, 1, 0.7 + np.pi / 7)
        occ.fuse(solid, [blade])
        occ.synchronize()
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
    mesh = rubmap.mesh_step(path, sectors=7, size=8, to=tmp_path / "mine.msh")
    model = client.model_from_mesh(mesh, top_speed_rpm=30000, material=TITANIUM)
    assert any(line.startswith("sectors: 7 (found)") for line in model.found)
