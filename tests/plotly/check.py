"""Reads figures as plotly does, which knows every attribute of every trace, and the version of Plotly.js that it speaks."""

import json
import pathlib
import sys

import plotly.graph_objects as go
from plotly.offline import get_plotlyjs_version

PLOTLY_JS = "3.0.1"


def texts(value):
    """All texts of a figure."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for inner in value.values():
            yield from texts(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from texts(inner)


def check(path):
    document = json.loads(path.read_text(), parse_constant=lambda name: sys.exit(f"{path}: {name} is no JSON"))
    assert set(document) == {"data", "layout"}, path
    figure = go.Figure(document)
    assert figure.layout.meta["kind"], path
    # A style of its own is what a page without unsafe-inline forbids.
    for text in texts(document):
        left = text.replace("<br>", "").replace("<extra></extra>", "")
        assert "<" not in left, f"{path}: {text}"
    return len(document["data"])


def main():
    assert get_plotlyjs_version() == PLOTLY_JS, get_plotlyjs_version()
    paths = [pathlib.Path(name) for name in sys.argv[1:]]
    traces = sum(check(path) for path in paths)
    print(f"{len(paths)} figures with {traces} traces are as Plotly {PLOTLY_JS} has them")


main()
