"""Critical speeds with and without blades that bend far (docs/method.md).

python blades_that_bend_far.py [COORDINATES …], with rubmap on the PATH or in RUBMAP_BINARY. No coordinates, 0, is linear theory.
"""

import math
import sys

import rubmap
from rubmap.contract import SweepRequest

RPM = 30 / math.pi


def sweep_of(model: str, coordinates: int) -> SweepRequest:
    """The demo's sweep, 50 revolutions at each of 129 speeds, in so many coordinates."""
    sweep: SweepRequest = {
        "model": model,
        "modes_per_speed": 20,
        "speeds": {"from": 12000, "to": 28000, "count": 129, "unit": "rpm"},
        "scene": {
            "centrifugal_stiffening": True,
            "damping": {"modal_ratio": 0.005},
            "casing": {
                "clearance": {"leading": 0.30, "trailing": 0.22},
                "lobes": {"count": 2, "amplitude": 0.24, "width_rad": 0.35},
            },
            "contact": {},
        },
        "integration": {"revolutions": 50, "window_revolutions": 20},
    }
    if coordinates:
        sweep["scene"]["geometric_nonlinearity"] = {"include": "full", "coordinates": coordinates}
    return sweep


def main(numbers: list[int]) -> None:
    """Prints the worst five critical speeds of the wheel."""
    with rubmap.local() as client:
        model = client.generate({"name": "blades that bend far"}).submit().wait().model
        for coordinates in numbers:
            sweep = client.sweep(sweep_of(model, coordinates)).submit().wait()
            print(f"{coordinates} coordinates")
            for found in sweep.json("critical-speeds/wheel")["critical_speeds"][:5]:
                speed, error = (found[key] * RPM for key in ("speed_rad_s", "speed_error_rad_s"))
                print(
                    f"  {speed:,.0f} ± {error:.0f} rpm: tip {found['tip']['half_peak_to_peak']:.2f} mm, "
                    f"clearance consumed {found['clearance_consumption']:.2f}, {found['settling']}"
                )


if __name__ == "__main__":
    main([int(number) for number in sys.argv[1:]] or [0, 4, 6])
