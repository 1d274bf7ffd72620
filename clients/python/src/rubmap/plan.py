"""Plans: what a job would do and cost, as an object that prints as a table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from .notebook import rows


class Plan(dict[str, Any]):
    """The plan of a job. Prints as a table; as a dictionary it has everything that the service says, as the contract names it."""

    @property
    def raw(self) -> dict[str, Any]:
        """What the service says, as a plain dictionary."""
        return dict(self)

    def __str__(self) -> str:
        return "\n".join(f"{name:<12}{value}" for name, value in self._rows())

    def __repr__(self) -> str:
        return str(self)

    def _repr_html_(self) -> str:
        return rows(self._rows())

    def _rows(self) -> Iterator[tuple[str, str]]:
        # A campaign says of its scene, and of that of a model that is compared, what other plans say of themselves.
        scenes = [self[name] for name in ("scene", "compared") if isinstance(self.get(name), Mapping)] or [self]
        effects = [effect for effect in scenes[0].get("effects", []) if effect["on"]]
        for effect in effects:
            yield "on", ": ".join(filter(None, (effect["name"], effect.get("adds"))))
        off = [effect["name"] for effect in scenes[0].get("effects", []) if not effect["on"]]
        if off:
            yield "off", ", ".join(off)
        yield from self._extent()
        for scene in scenes:
            if reduction := scene.get("reduction"):
                unknowns = scene.get("reduced_unknowns_at_most")
                stored = f"stored, {unknowns} unknowns"
                yield (
                    "reduction",
                    stored if reduction == "stored" else f"to be computed first, at most {unknowns} unknowns",
                )
        yield from self._cost()
        points = [*self.get("points", []), *self.get("runs", []), *filter(None, [self.get("point")])]
        for point in points:
            if message := point.get("message"):
                yield "not", f"{point['speed_rad_s']:.2f} rad/s: {message}" if "speed_rad_s" in point else message
        for scene in scenes:
            for warning in scene.get("warnings", []):
                yield "warning", warning

    def _extent(self) -> Iterator[tuple[str, str]]:
        """How much would be computed."""
        if "designs" in self:
            most = self.get("designs_at_most", self["designs"])
            more = f", at most {most}" if most > self["designs"] else ""
            yield "designs", f"{self['designs']}{more}: {self['simulations']} simulations"
        elif "simulations" in self:
            yield "runs", f"{self['simulations']} at {self['speeds']} speeds"
        elif "speeds" in self:
            added = self.get("added_speeds_at_most")
            more = f", at most {added} more about peaks" if added is not None else ""
            beside = f", {self['workers']} side by side" if "workers" in self else ""
            yield "speeds", f"{self['speeds']}{more}{beside}"
        if "points_at_least" in self:
            yield (
                "points",
                f"at least {self['points_at_least']}, at most {self['points_at_most']} and those of doubled branches",
            )
        for run in self.get("runs", []):
            rate = f"{run['rate_rad_s2']:.4g} rad/s²: " if "rate_rad_s2" in run else ""
            yield "run", f"{rate}{run['duration_s']:.4g} s, {run['revolutions']:.1f} revolutions"
        for name, words in (("nodes", "nodes"), ("dofs", "unknowns")):
            if name in self:
                yield words, f"{self[name]}"

    def _cost(self) -> Iterator[tuple[str, str]]:
        estimate = self.get("estimate") or {}
        if times := estimate.get("wall_time_s"):
            yield (
                "time",
                f"{_time(times['free'])} if nothing touches, {_time(times['contact'])} if something always does",
            )
        elif (seconds := self.get("computing_time_s")) is not None:
            yield "time", _time(seconds)
        if (curves := self.get("backbones_time_s")) is not None:
            yield "backbones", _time(curves)
        if (memory := estimate.get("memory_bytes", self.get("memory_bytes"))) is not None:
            yield "memory", _size(memory)
        if (steps := estimate.get("steps", self.get("steps"))) is not None:
            yield "steps", f"{steps / 1e6:.3f} million"


def _time(seconds: float) -> str:
    """A time in the unit that people would use."""
    for limit, of, unit in ((99.5, 1.0, "s"), (99.5 * 60.0, 60.0, "min")):
        if seconds < limit:
            return f"{seconds / of:.0f} {unit}"
    return f"{seconds / 3600.0:.0f} h"


def _size(count: float) -> str:
    """A number of bytes in the unit that people would use."""
    for unit in ("B", "kB", "MB"):
        if count < 999.5:
            return f"{count:.3g} {unit}"
        count /= 1000.0
    return f"{count:.3g} GB"
