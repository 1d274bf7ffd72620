"""Words and tables for notebooks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

#: Colours of verdicts, which colour-blind readers tell apart (Okabe and Ito); the word stands beside them.
_COLOURS = {"clear": "#009e73", "watch": "#e69f00", "undecided": "#8c8c8c", "act": "#d55e00"}


def badge(word: str) -> str:
    """A verdict in its colour."""
    colour = _COLOURS.get(word, "#8c8c8c")
    style = f"border-left: 0.4em solid {colour}; padding: 0 0.4em; font-weight: bold"
    return f'<span style="{style}">{escape(word)}</span>'


def rows(pairs: Iterable[tuple[str, str]]) -> str:
    """A table of names and their values."""
    lines = "".join(
        f'<tr><th style="text-align: left">{escape(name)}</th><td style="text-align: left">{escape(value)}</td></tr>'
        for name, value in pairs
    )
    return f"<table>{lines}</table>"


def table(head: Sequence[str], lines: Iterable[Sequence[str]]) -> str:
    """A table with a head."""
    top = "".join(f"<th>{escape(cell)}</th>" for cell in head)
    body = "".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in line) + "</tr>" for line in lines)
    return f"<table><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table>"
