"""The verdict on a sweep: whether the wheel may run in its operating ranges, as an object that prints as a table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from html import escape
from typing import Any

from .notebook import badge, table
from .tables import RPM

#: Names of limits in words, and which of the model's units they have.
_LIMITS = {
    "clearance_consumption": ("clearance consumption", None),
    "tip_motion": ("tip motion", "length"),
    "utilisation": ("utilisation", None),
    "node_force": ("contact force on a node", "force"),
}
_HEAD = ("worst (rpm)", "where", "value", "against its limit")
_POSITIONS = {"inside": "in", "within_separation": "near", "outside": "outside"}


class Verdict:
    """The verdict on a sweep by the operating ranges and limits of its request.

    Attributes:
        word: ``clear``, ``watch``, ``undecided`` or ``act``.
        sentence: which range, which speed, which limit, by how much.
        ranges: a dictionary per range: verdict, speeds, worst value per limit, critical speeds.
        critical_speeds: critical speeds of the wheel against ranges and limits, the most severe first.
        worst: the three worst speeds.
        would_decide: what is open, and what would decide it.
        units: of the model.
        settings: the whole request as resolved.
        version: of the code.
    """

    def __init__(self, found: Mapping[str, Any]) -> None:
        self.word: str = found["verdict"]
        self.sentence: str = found["sentence"]
        self.ranges: list[dict[str, Any]] = found["ranges"]
        self.critical_speeds: list[dict[str, Any]] = found["critical_speeds"]
        self.worst: list[dict[str, Any]] = found["worst"]
        self.would_decide: list[dict[str, Any]] = found["would_decide"]
        self.units: dict[str, str] = found["units"]
        self.settings: dict[str, Any] = found["settings"]
        self.version: str = found["version"]

    def __repr__(self) -> str:
        return str(self)

    def __str__(self) -> str:
        lines = [self.sentence]
        rows = [row for speed in self.worst for row in self._rows(speed)]
        if rows:
            rows.insert(0, _HEAD)
        lines += [f"{rpm:>12}  {place:<28}  {value:<56}  {limit}".rstrip() for rpm, place, value, limit in rows]
        return "\n".join(lines + self._remedies())

    def _repr_html_(self) -> str:
        rows = [row for speed in self.worst for row in self._rows(speed)]
        worst = table(_HEAD, rows) if rows else ""
        remedies = "".join(f"<li>{escape(words)}</li>" for words in self._remedies())
        return f"<p>{badge(self.word)} {escape(self.sentence)}</p>{worst}" + (
            f"<ul>{remedies}</ul>" if remedies else ""
        )

    def _remedies(self) -> list[str]:
        """What would decide an undecided verdict."""
        if self.word != "undecided":
            return []
        return [f"to decide: {open['remedy']} ({open['finding']})" for open in self.would_decide]

    def _rows(self, speed: Mapping[str, Any]) -> Iterator[tuple[str, str, str, str]]:
        """A row per limit of a speed."""
        rpm, place = f"{speed['speed_rad_s'] * RPM:.0f}", ""
        near = [of for of in speed["ranges"] if of["position"] != "outside"] or speed["ranges"]
        if near:
            place = f"{_POSITIONS[near[0]['position']]} {near[0]['range']}, {near[0]['distance_percent']:+.1f} %"
        for judged in speed["limits"]:
            words, of = _LIMITS[judged["limit"]]
            unit = "" if of is None else f" {self.units[of]}"
            value = f"{words} {_known(judged)} of {judged['allowed']:.3g}{unit}"
            yield rpm, place, value, _standing(judged)
            rpm, place = "", ""
        if not speed["limits"]:
            tip = speed.get("tip")
            motion = tip.get("largest_half_peak_to_peak", tip["half_peak_to_peak"]) if tip else None
            value = "" if motion is None else f"tip motion {motion:.3g} {self.units['length']}"
            yield rpm, place, value, "no limit"


def _known(judged: Mapping[str, Any]) -> str:
    """A value with the bounds that its error leaves it: an error e, given as v e, leaves v/(1 + e) to v (1 + e)."""
    value, error = judged["value"], judged.get("error")
    if error is None or value <= 0:
        return f"{value:.3g}"
    factor = 1 + error / value
    shown, below, above = (f"{each:.3g}" for each in (value, value / factor, value * factor))
    return shown if shown == below == above else f"{shown} ({below} to {above})"


def _standing(judged: Mapping[str, Any]) -> str:
    """Standing of a value against its limit: ``kept, 20 % left``, ``passed by 36 %``."""
    above = judged["above_percent"]
    by = f"{abs(above):.1f} %" if abs(above) < 10 else f"{abs(above):,.0f} %"
    if judged["standing"] == "passed":
        return f"passed by {by}"
    words = "kept"
    if judged["standing"] == "open":
        words = "within the error" if "error" in judged else "error not known"
    return f"{words}, {by} {'above' if above > 0 else 'left'}"
