"""The paper's area E from multipliers: periodic responses beside what marches do (docs/reading-results.md).

python area_e.py [PICTURE], with rubmap on the PATH or in RUBMAP_BINARY.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np

import rubmap
from rubmap.contract import LabelledSweepRequest

DOUBLED = {"from": 22700, "to": 22900, "count": 9, "unit": "rpm"}
SPLIT = {"from": 31850, "to": 32100, "count": 11, "unit": "rpm"}


def sweep_of(model: str, steady: str) -> LabelledSweepRequest:
    """The sweep of area E, solved for or marched."""
    return {
        "model": model,
        "modes_per_speed": 20,
        "speeds": [DOUBLED, SPLIT],
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


def main(picture: str) -> None:
    """Runs both sweeps, prints a table and draws it."""
    with rubmap.local() as client:
        model = client.generate({"name": "area E"}).submit().wait().model
        solved, marched = (
            client.sweep(sweep_of(model, steady)).submit().wait().json("interaction-map")["points"]
            for steady in ("periodic", "march")
        )
    figure, (plane, lines) = plt.subplots(1, 2, figsize=(10, 4.5), layout="constrained")
    angle = np.linspace(0, 2 * np.pi, 400)
    plane.plot(np.cos(angle), np.sin(angle), color="0.6", lw=1)
    speeds, predicted, measured = [], [], []
    for periodic, march in zip(solved, marched, strict=True):
        rpm = periodic["speed_rad_s"] * 30 / np.pi
        steady, settling = periodic["steady"], march["settling"]
        leading = steady["multipliers"][0]
        offset = leading["order_offset"]
        print(
            f"{rpm:8.0f}  {steady['stability']:15}  |μ| {leading['modulus']:.4f}  nodal diameter {leading['nodal_diameter']}  δ {abs(offset - round(offset)):.4f}"
            f"   march: {settling['verdict']:11} {settling.get('lobe_passages', '')} {settling.get('side_band_spacing', '')}"
        )
        for multiplier in steady["multipliers"][:2]:
            plane.plot(
                multiplier["real"], multiplier["imaginary"], "o", color=plt.cm.viridis((rpm - 22700) / 9400), ms=4
            )
        if "side_band_spacing" in settling:
            speeds.append(rpm)
            predicted.append(abs(offset - round(offset)))
            measured.append(settling["side_band_spacing"])
    plane.set(xlabel="Re μ", ylabel="Im μ", title="Leading multipliers over a lobe", aspect="equal")
    lines.plot(speeds, predicted, "o-", label="predicted by the leading pair")
    lines.plot(speeds, measured, "x", label="measured in marches of 150 revolutions")
    lines.set(xlabel="rpm", ylabel="δ, engine orders", title="Distance of the split lines", ylim=(0, None))
    lines.legend()
    figure.savefig(picture, metadata={"Date": None})


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "area-e.svg")
