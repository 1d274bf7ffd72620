"""Reads rubmap's VTK files by meshio and pyvista: every element type alone, and a whole wheel. Usage: check.py RUBMAP FOLDER"""

import json
import subprocess
import sys
import zipfile
from pathlib import Path

import meshio
import numpy as np
import pyvista

PROGRAM, FOLDER = sys.argv[1], Path(sys.argv[2])

HEXAHEDRON = [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)]
WEDGE = [(0, 0, -1), (1, 0, -1), (0, 1, -1), (0, 0, 1), (1, 0, 1), (0, 1, 1)]
TETRAHEDRON = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
# Edges in CalculiX's order.
HEXAHEDRON_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
WEDGE_EDGES = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]
TETRAHEDRON_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
# Corners, edges with a node in the middle, volume.
ELEMENTS = {
    "C3D8": (HEXAHEDRON, [], 8),
    "C3D8I": (HEXAHEDRON, [], 8),
    "QM6": (HEXAHEDRON, [], 8),
    "C3D20": (HEXAHEDRON, HEXAHEDRON_EDGES, 8),
    "C3D20R": (HEXAHEDRON, HEXAHEDRON_EDGES, 8),
    "C3D6": (WEDGE, [], 1),
    "C3D15": (WEDGE, WEDGE_EDGES, 1),
    "C3D4": (TETRAHEDRON, [], 1 / 6),
    "C3D10": (TETRAHEDRON, TETRAHEDRON_EDGES, 1 / 6),
}


def package(kind, path):
    """One element on springs to the ground, which know nothing of its type."""
    corners, edges, _ = ELEMENTS[kind]
    corners = np.array(corners, float) + [5, 0, 0]
    nodes = np.vstack([corners, [(corners[a] + corners[b]) / 2 for a, b in edges]]) if edges else corners
    # The last node is held, so that nobody holds these matrices, which are no solid's, against the elements.
    rows = 3 * (len(nodes) - 1)
    material = {"youngs_modulus": 1e5, "poissons_ratio": 0.3, "density": 1e-9}
    sector = {
        "name": kind, "sectors": 1, "units": {"length": "mm", "force": "N", "time": "s", "mass": "t"},
        "axis": {"origin": [0, 0, 0], "direction": [0, 0, 1]}, "speeds_rad_s": [0], "frame": "cartesian",
        "mass": "m.mtx", "stiffness": ["k.mtx"], "nodes": "nodes.csv", "dofs": "dofs.csv", "cyclic": [],
        "contact": [{"node": 1, "normal": [1, 0, 0]}],
        "mesh": {"elements": "elements.csv", "sets": {"ALL": material}},
    }

    def diagonal(values):
        head = f"%%MatrixMarket matrix coordinate real symmetric\n{rows} {rows} {rows}\n"
        return head + "".join(f"{k + 1} {k + 1} {v}\n" for k, v in enumerate(values))

    ids = ",".join(str(k + 1) for k in range(len(nodes)))
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("sector.json", json.dumps(sector))
        file.writestr("nodes.csv", "".join(f"{k + 1},{x},{y},{z}\n" for k, (x, y, z) in enumerate(nodes)))
        file.writestr("dofs.csv", "".join(f"{k + 1},{c}\n" for k in range(len(nodes) - 1) for c in (1, 2, 3)))
        file.writestr("elements.csv", f"1,{kind},ALL,{ids}\n")
        file.writestr("m.mtx", diagonal([1e-9] * rows))
        file.writestr("k.mtx", diagonal([1.0 + k for k in range(rows)]))


def rubmap(*arguments):
    subprocess.run([PROGRAM, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def close(found, expected, tolerance, what):
    assert abs(found / expected - 1) <= tolerance, f"{what}: {found}, not {expected}"


def volumes(grid):
    return grid.compute_cell_sizes(length=False, area=False)["Volume"]


for kind, (_, edges, volume) in ELEMENTS.items():
    model, out = FOLDER / f"{kind}.zip", FOLDER / f"{kind}.vtu"
    package(kind, model)
    rubmap("modes", model, "--modes-per-speed", 2, "--out", out, "--stress")
    grid = pyvista.read(out)
    assert grid.n_cells == 1 and "von_mises" in grid.point_data, kind
    close(volumes(grid)[0], volume, 1e-9, kind)
    # meshio 5.3.5 has a name for this cell, and no dimension.
    if kind != "C3D15":
        mesh = meshio.read(out)
        assert len(mesh.points) == grid.n_points and "von_mises" in mesh.point_data, kind
    # A node in the middle of an edge lies in the middle of those corners that VTK takes for its ends.
    if edges:
        skin = grid.get_cell(0).edges
        for edge in skin:
            a, b, middle = edge.points
            assert np.allclose((a + b) / 2, middle), f"{kind}: {edge.points}"
    print(f"{kind}: volume {volumes(grid)[0]:.6f}")

wheel = FOLDER / "wheel.json"
for preset, kind in [("linear", "hexahedra"), ("quadratic", "quadratic hexahedra")]:
    wheel.write_text(json.dumps({"element_order": preset, "sectors": 7}))
    model = FOLDER / f"{preset}.zip"
    rubmap("generate", "--parameters", wheel, "--out", model)
    arguments = ["modes", model, "--modes-per-speed", 4, "--nodal-diameter", 2, "--stress"]
    for suffix in ["vtu", "vtp", "npz"]:
        rubmap(*arguments, "--out", FOLDER / f"{preset}.{suffix}")
    rubmap(*arguments, "--sector", 0, "--out", FOLDER / f"{preset}-sector.vtu")
    grid, one = pyvista.read(FOLDER / f"{preset}.vtu"), pyvista.read(FOLDER / f"{preset}-sector.vtu")
    skin, arrays = pyvista.read(FOLDER / f"{preset}.vtp"), np.load(FOLDER / f"{preset}.npz")
    assert len(meshio.read(FOLDER / f"{preset}.vtu").points) == grid.n_points
    assert (volumes(grid) > 0).all() and grid.n_cells == 7 * one.n_cells
    close(volumes(grid).sum(), 7 * volumes(one).sum(), 1e-9, preset)
    # Faces are not plane, and are cut into triangles in two ways.
    close(skin.triangulate().volume, volumes(grid).sum(), 1e-2, f"skin of {preset}")
    # Closed: no edge of the skin belongs to one face alone, and what is inside is one piece.
    rims = skin.triangulate().clean().extract_feature_edges(
        boundary_edges=True, non_manifold_edges=False, feature_edges=False, manifold_edges=False
    )
    assert rims.n_cells == 0, f"{preset}: {rims.n_cells} open edges"
    assert grid.connectivity()["RegionId"].max() == 0
    assert np.array_equal(arrays["displacement"].reshape(-1, 3), grid["displacement"])
    largest = np.linalg.norm(grid["displacement"], axis=1).max()
    assert 0.5 < largest <= 1 + 1e-12, largest
    print(f"{preset}: {grid.n_points} points, {grid.n_cells} {kind}, volume {volumes(grid).sum():.1f}")
