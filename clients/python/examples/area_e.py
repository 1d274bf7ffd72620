"""The paper's area E from multipliers: periodic responses beside what marches do (docs/reading-results.md).

python area_e.py [PICTURE [PACKAGE FROM TO COUNT]], with rubmap on the PATH or in RUBMAP_BINARY: of the generated impeller, or of a package
between two speeds in rad/s.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np

import rubmap
from rubmap.contract import SweepRequest, Speeds, SteadyChoice

GENERATED: Speeds = [
    {"from": 22700, "to": 22900, "count": 9, "unit": "rpm"},
    {"from": 31850, "to": 32100, "count": 11, "unit": "rpm"},
]


def sweep_of(model: str, speeds: Speeds, steady: SteadyChoice) -> SweepRequest:
    """The sweep of area E, solved for or marched."""
    return {
        "model": model,
        "modes_per_speed": 20,
        "speeds": speeds,
        "scene": {
            "centrifugal_stiffening": True,
            "damping": {"modal_ratio": 0.005},
            "casing": {
                "clearance": {"leading": 0.30, "trailing": 0.22},
                "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35},
            },
            "contact": {},
        },
        "integration": {"revolutions": 150, "window_revolutions": 60, "steady": steady},
        "sensors": [{"contact_node": 9, "sector": 0, "component": "radial"}],
        "max_engine_order": 24,
    }


def main(picture: str, package: str | None, speeds: Speeds) -> None:
    """Runs both sweeps, prints a table and draws it."""
    with rubmap.local() as client:
        generated = package is None
        model = client.generate({"name": "area E"}).submit().wait().model if generated else client.upload(package).id
        solved, marched = (
            client.sweep(sweep_of(model, speeds, steady)).submit().wait().json("interaction-map")["points"]
            for steady in ("periodic", "march")
        )
    rpms = [point["speed_rad_s"] * 30 / np.pi for point in solved]
    figure, (plane, lines) = plt.subplots(1, 2, figsize=(10, 4.5), layout="constrained")
    colour = plt.cm.ScalarMappable(plt.Normalize(min(rpms), max(rpms))).to_rgba
    angle = np.linspace(0, 2 * np.pi, 400)
    plane.plot(np.cos(angle), np.sin(angle), color="0.6", lw=1)
    split, predicted, measured = [], [], []
    for rpm, periodic, march in zip(rpms, solved, marched, strict=True):
        steady, settling = periodic["steady"], march["settling"]
        if "stability" not in steady:
            print(f"{rpm:8.0f}  {steady['reason']}")
            continue
        leading = steady["multipliers"][0]
        offset = leading["order_offset"]
        print(
            f"{rpm:8.0f}  {steady['stability']:15}  |μ| {leading['modulus']:.4f}  nodal diameter {leading['nodal_diameter']}  δ {abs(offset - round(offset)):.4f}"
            f"   march: {settling['verdict']:11} {settling.get('lobe_passages', '')} {settling.get('side_band_spacing', '')}"
        )
        for multiplier in steady["multipliers"][:2]:
            plane.plot(multiplier["real"], multiplier["imaginary"], "o", color=colour(rpm), ms=4)
        if "side_band_spacing" in settling:
            split.append(rpm)
            predicted.append(abs(offset - round(offset)))
            measured.append(settling["side_band_spacing"])
    plane.set(xlabel="Re μ", ylabel="Im μ", title="Leading multipliers over a lobe", aspect="equal")
    lines.plot(split, predicted, "o-", label="predicted by the leading pair")
    lines.plot(split, measured, "x", label="measured in marches of 150 revolutions")
    lines.set(xlabel="rpm", ylabel="δ, engine orders", title="Distance of the split lines", ylim=(0, None))
    lines.legend()
    figure.savefig(picture, metadata={"Date": None})


if __name__ == "__main__":
    match sys.argv[1:]:
        case [picture, package, low, high, count]:
            window: Speeds = {"from": float(low), "to": float(high), "count": int(count), "unit": "rad_s"}
            main(picture, package, window)
        case arguments:
            main(*arguments[:1] or ["area-e.svg"], None, GENERATED)
