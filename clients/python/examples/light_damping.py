"""How many speeds have a periodic response where damping is light (docs/performance.md).

python light_damping.py [DAMPING …], with rubmap on the PATH or in RUBMAP_BINARY.
"""

import sys
from collections import Counter

import rubmap
from rubmap.contract import SweepRequest


def sweep_of(model: str, damping: float) -> SweepRequest:
    """The demo's sweep with this damping, solved for."""
    return {
        "model": model,
        "modes_per_speed": 20,
        "speeds": {"from": 12000, "to": 36000, "count": 120, "unit": "rpm"},
        "scene": {
            "centrifugal_stiffening": True,
            "damping": {"modal_ratio": damping},
            "casing": {
                "clearance": {"leading": 0.30, "trailing": 0.22},
                "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35},
            },
            "contact": {},
        },
        "integration": {"revolutions": 50, "steady": "periodic"},
    }


def main(dampings: list[float]) -> None:
    """Prints how many responses of each kind were found."""
    with rubmap.local() as client:
        model = client.generate({"name": "light damping"}).submit().wait().model
        for damping in dampings:
            sweep = client.sweep(sweep_of(model, damping)).submit().wait()
            found = [point["steady"] for point in sweep.json("interaction-map")["points"]]
            kinds = Counter(steady.get("stability", "none found") for steady in found)
            followed = sum("followed_from_damping" in steady for steady in found)
            print(f"{damping}: {dict(kinds)}, {followed} followed from heavier damping")


if __name__ == "__main__":
    main([float(damping) for damping in sys.argv[1:]] or [1e-3, 5e-4])
