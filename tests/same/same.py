"""Compares two programs bit by bit: the same requests of every kind, and every document and drawing of their results.

Usage: same.py BEFORE AFTER FOLDER. Numbers of this machine (times, ids, versions) are left out.
"""

import hashlib
import itertools
import json
import re
import subprocess
import sys
import time
import urllib.error
import urllib.request
from pathlib import Path

MODEL = {
    "preset": "small",
    "gyroscopic": True,
    "contact_nodes": 3,
    "mesh": {"between_contact_nodes": 1, "blade_height": 2, "blade_thickness": 1, "half_passage": 1, "disk": 1},
}

CASING = {
    "clearance": {"leading": 0.30, "trailing": 0.22},
    "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35},
}

BASE = {"centrifugal_stiffening": True, "damping": {"modal_ratio": 0.01}, "casing": CASING, "contact": {}}

# Changes of a scene, each alone and in pairs that can be had together.
EFFECTS = {
    "coriolis": {"coriolis": True},
    "friction": {"friction": {"coefficient": 0.05}},
    "disc": {"friction": {"coefficient": 0.05, "law": "disc"}},
    "abradable": {
        "abradable": {"modulus": 2e4, "yield_stress": 20.0, "hardening": 500.0, "thickness": 2.0, "rods_around": 400}
    },
    "elastic": {
        "flexible_casing": {"modes": [{"nodal_diameter": 2, "frequency_hz": 700, "modal_mass": 1e-3}]}
    },
    "mistuning": {"mistuning": {"spread": 0.03, "seed": 7}},
    "force": {
        "engine_order_excitation": [{"order": 3, "contact_nodes": [0], "component": "axial", "amplitude": 5.0}]
    },
    "orbit": {"orbit": {"radius": 0.05, "whirl_ratio": 0.5}},
    "initial": {"initial": {"nodal_diameter": 2, "family": 1, "amplitude": 0.05, "wave": "forward"}},
    "exact": {"symmetry": "exact"},
    "probe": {"symmetry": "probe"},
    "free": {"contact": None},
    "waves": {"casing": CASING | {"waves": [{"order": 3, "amplitude": 0.02, "phase_rad": 0.1}]}},
}

SCHEMES = ["exact_modal", "central_differences", "massless_boundary", "auto"]

# Names of numbers and words that a second run need not repeat.
TIMES = re.compile(
    r"(wall_time_s|computing_time_s|_at|wall_time|cpu_time_s|version|id|progress|stored_bytes|machine|seconds_per_.*|"
    r"estimate|reduction_s|took_s|.*_time_s|time_s)$"
)
ID = re.compile(r"[0-9a-f]{8}-[0-9a-f]{4}-7[0-9a-f]{3}-[0-9a-f]{4}-[0-9a-f]{12}")


def scene(*changes):
    made = dict(BASE)
    for change in changes:
        made |= change
    return {name: value for name, value in made.items() if value is not None}


def requests(model):
    """Paths and bodies, each with a name."""
    integration = {"revolutions": 10, "ramp_revolutions": 1.0, "window_revolutions": 2}
    common = {"model": model, "modes_per_speed": 3, "max_engine_order": 8}
    speeds = {"from": 20000, "to": 26000, "count": 3, "unit": "rpm"}
    one = {"value": 24000.0, "unit": "rpm"}
    singles = [(name, scene(change)) for name, change in EFFECTS.items()]
    pairs = [
        (f"{a}+{b}", scene(EFFECTS[a], EFFECTS[b]))
        for a, b in itertools.combinations(EFFECTS, 2)
        if not EFFECTS[a].keys() & EFFECTS[b].keys()
    ]
    scenes = [("base", scene()), *singles]
    for (name, what), scheme in itertools.product(scenes, SCHEMES):
        yield f"sweep {name} {scheme}", "sweeps", common | {
            "scene": what, "speeds": speeds, "integration": integration | {"scheme": scheme},
        }  # fmt: skip
    for name, what in pairs:
        yield f"sweep {name}", "sweeps", common | {"scene": what, "speeds": speeds, "integration": integration}
    for change in [
        {"sweep": "up"}, {"sweep": "down"}, {"integration": {}}, {"integration": {"steady": "auto"}},
        {"refine": True}, {"accuracy": {"target": 0.1}, "modes_per_speed": "auto"}, {"record": {"stress": {"excluded_radius": 1.0}}},
        {"record": {"histories": {"speeds": [1]}}}, {"fields": False}, {"sensors": [{"contact_node": 1, "sector": 2, "component": "radial"}]},
    ]:  # fmt: skip
        yield f"sweep {json.dumps(change)}", "sweeps", common | {
            "scene": scene(), "speeds": speeds, "integration": integration,
        } | change  # fmt: skip
    for coriolis in [True, False]:
        yield f"modal analysis {coriolis}", "modal-analyses", {
            "model": model, "modes_per_speed": 3, "families": 2, "superharmonics": [1, 2], "lobes": 2, "coriolis": coriolis,
            "speeds": {"from": 0, "to": 30000, "count": 5, "unit": "rpm"},
        }  # fmt: skip
    for name, what in scenes:
        yield f"case study {name}", "case-studies", common | {
            "scene": what, "speed": one, "integration": integration,
            "record": {"revolutions": [0, 3], "quantities": ["displacement", "velocity", "contact_force", "contact", "energy"]},
        }  # fmt: skip
        yield f"run-ups {name}", "run-ups", common | {
            "scene": what, "speed": {"unit": "rpm", "from": 22000, "to": 23000, "rates": [20000.0, 50000.0]}, "limit": 0.5,
        }  # fmt: skip
        yield f"branches {name}", "branches", common | {
            "scene": what, "speed": one, "along": {"parameter": "speed", "from": 23500, "to": 24500}, "most_points": 6,
        }  # fmt: skip
        yield f"campaign {name}", "campaigns", common | {
            "scene": what, "speeds": speeds, "integration": integration,
            "parameters": [
                {"name": "clearance", "at": ["/scene/casing/clearance/leading"], "change": "add", "from": -0.05, "to": 0.05}
            ],
            "design": {"kind": "latin_hypercube", "size": 4, "seed": 1},
        }  # fmt: skip
    for scheme in SCHEMES[:3]:
        yield f"study {scheme}", "studies", {
            "model": model, "scene": scene(), "speeds": {"values": [24000], "unit": "rpm"}, "max_engine_order": 8,
            "grid": {"modes_per_speed": [2, 3], "steps_per_revolution": [600, 1200], "schemes": [scheme]},
            "integration": {"revolutions": 6, "ramp_revolutions": 1, "window_revolutions": 2},
        }  # fmt: skip


# Documents of a job beside its links.
MORE = {
    "interaction-map": ["", "?format=csv", "?format=svg", "?format=plotly", "?sensor=1&format=svg"],
    "spectra/{index}": ["", "?format=svg"],
    "run-ups": ["", "?format=csv", "?format=svg", "?format=plotly"],
    "spectrogram": ["", "?format=csv", "?format=svg", "?format=plotly"],
    "histories": ["?speed={index}", "?speed={index}&format=svg"],
    "stress": ["", "?format=svg"],
}
FORMS = ["", "?format=csv", "?format=svg", "?format=plotly"]


class Service:
    """A program that serves from a folder of its own."""

    def __init__(self, program, folder):
        folder.mkdir(parents=True)
        log = folder / "log"
        self.process = subprocess.Popen(
            [program, "serve", "--addr", "127.0.0.1:0", "--data", folder / "data"],
            stderr=log.open("w"), stdout=subprocess.DEVNULL, env={"RUST_LOG": "info", "PATH": "/usr/bin:/bin"},
        )  # fmt: skip
        while not (found := re.search(r"listening on (http:\S+)", log.read_text())):
            time.sleep(0.1)
        self.base = found[1]

    def ask(self, method, path, body=None):
        request = urllib.request.Request(self.base + path, method=method)
        data = None
        if body is not None:
            request.add_header("Content-Type", "application/json")
            data = json.dumps(body).encode()
        try:
            with urllib.request.urlopen(request, data) as answer:
                return answer.status, answer.read()
        except urllib.error.HTTPError as error:
            return error.code, error.read()

    def finish(self, job):
        while (found := json.loads(self.ask("GET", f"/v1/jobs/{job}")[1]))["status"] in ("accepted", "running"):
            time.sleep(0.02)
        return found


def lasting(value):
    """A document without what a second run need not repeat."""
    if isinstance(value, dict):
        return {name: lasting(part) for name, part in value.items() if not TIMES.fullmatch(name)}
    if isinstance(value, list):
        return [lasting(part) for part in value]
    return ID.sub("ID", value) if isinstance(value, str) else value


def digest(body):
    try:
        body = json.dumps(lasting(json.loads(body))).encode()
    except ValueError:
        text = body.decode("utf-8", "replace")
        # Drawings tell times and versions in their metadata.
        body = ID.sub("ID", re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.S)).encode()
    return hashlib.sha256(body).hexdigest()[:16]


def documents(service, job):
    """Digests of a job and of all that it links to."""
    found = {"job": digest(json.dumps({name: job.get(name) for name in ("status", "speeds", "error", "reduction")}))}
    for link in job["links"]:
        path = link["href"].removeprefix(f"/v1/jobs/{job['id']}")
        # A study tells times.
        if link["rel"] in ("self", "model", "report", "archive", "fields", "work-precision"):
            continue
        for form in MORE.get(path.strip("/"), FORMS):
            place = (link["href"] + form).replace("{index}", "1")
            status, body = service.ask("GET", place)
            found[path + form] = f"{status} {digest(body)}"
    return found


def run(program, folder):
    """Digests of everything that a program makes of the requests."""
    service = Service(program, folder)
    try:
        made = json.loads(service.ask("POST", "/v1/models", MODEL)[1])
        model = service.finish(made["id"])["model"]
        found = {}
        for name, path, body in requests(model):
            status, answer = service.ask("POST", f"/v1/{path}", body)
            if status != 202:
                found[name] = {"refused": f"{status} {digest(answer)}"}
                continue
            found[name] = documents(service, service.finish(json.loads(answer)["id"]))
        return found
    finally:
        service.process.terminate()
        service.process.wait()


if __name__ == "__main__":
    before, after, folder = sys.argv[1:]
    kept = Path(folder) / "before.json"
    if before != "-":
        kept.parent.mkdir(parents=True, exist_ok=True)
        kept.write_text(json.dumps(run(before, Path(folder) / "before"), indent=1))
    old = json.loads(kept.read_text())
    new = run(after, Path(folder) / "after")
    (Path(folder) / "after.json").write_text(json.dumps(new, indent=1))
    differ = [
        f"{name}: {part}: {old.get(name, {}).get(part)} {new.get(name, {}).get(part)}"
        for name in old | new
        for part in old.get(name, {}) | new.get(name, {})
        if old.get(name, {}).get(part) != new.get(name, {}).get(part)
    ]
    refused = sum("refused" in found for found in old.values())
    parts = sum(map(len, old.values()))
    print(f"{len(old)} requests, {refused} of them refused, {parts} documents: {len(differ)} differ")
    print("\n".join(differ[:50]))
    sys.exit(bool(differ))
