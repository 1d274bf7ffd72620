"""A service with a finished sweep, a browser, and pages that fail a test for any error in the console and any request elsewhere."""

import json
import os
from pathlib import Path

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import sync_playwright
from service import Service, package

WINDOWS = ((1280, "light"), (390, "dark"))
FLAGS = [
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-component-update",
]


@pytest.fixture(scope="session")
def pictures():
    folder = Path(os.environ["PAGE_PICTURES"])
    folder.mkdir(parents=True, exist_ok=True)
    return folder


@pytest.fixture(scope="session")
def zipped(tmp_path_factory):
    """A small package."""
    return package(tmp_path_factory.mktemp("package") / "impeller.zip")


@pytest.fixture(scope="session")
def service(tmp_path_factory):
    running = Service(tmp_path_factory.mktemp("service"))
    yield running
    running.stop()


def sweep_of(model, **changes):
    """A sweep with contact, ten speeds."""
    request = {
        "model": model,
        "speeds": {"from": 12000, "to": 36000, "count": 10, "unit": "rpm"},
        "scene": {
            "centrifugal_stiffening": True,
            "damping": {"modal_ratio": 0.005},
            "casing": {
                "clearance": {"leading": 0.30, "trailing": 0.22},
                "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35},
            },
            "contact": {},
        },
        "record": {"histories": {"speeds": [4], "quantities": ["displacement", "contact_force", "state"]}, "stress": {}},
    }
    return request | changes


def damped():
    """The scene of `sweep_of`, damped so well that its responses are periodic."""
    return sweep_of("")["scene"] | {"damping": {"modal_ratio": 0.05}}


def branches_of(model):
    """Branches over a few speeds."""
    return {
        "model": model,
        "modes_per_speed": 3,
        "speed": {"value": 20000, "unit": "rpm"},
        "along": {"parameter": "speed", "from": 19900, "to": 20100},
        "scene": damped(),
        "integration": {"revolutions": 30},
    }


def run_ups_of(model):
    """Two rates through a few speeds."""
    return {
        "model": model,
        "modes_per_speed": 3,
        "speed": {"unit": "rpm", "from": 19000, "to": 21000, "rates": [10000, 40000], "hold_s": 0.05},
        "scene": sweep_of("")["scene"],
        "limit": 0.5,
    }


@pytest.fixture(scope="session")
def model(service, zipped):
    return service.call("POST", "/v1/models", zipped.read_bytes())["id"]


@pytest.fixture(scope="session")
def swept(service, model):
    """Id of a finished sweep."""
    job = service.call("POST", "/v1/sweeps", sweep_of(model))["id"]
    assert service.finish(job)["status"] == "successful"
    return job


@pytest.fixture(scope="session")
def browser():
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=FLAGS)
        yield browser
        browser.close()


def judged(page, picture):
    """A picture of a page, which is not wider than its window and in which axe finds nothing serious."""
    page.screenshot(path=picture, full_page=True)
    overflow = page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
    assert overflow <= 0, f"{overflow} pixels wider than the window"
    # Rules of WCAG 2.2 AA and below.
    rules = {"runOnly": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"]}
    found = Axe().run(page, options=rules).response["violations"]
    serious = [v for v in found if v["impact"] in ("serious", "critical")]
    told = [f"{v['id']}: {v['help']}: {n['target']} {n.get('failureSummary', '')}" for v in serious for n in v["nodes"]]
    assert told == []


class Watch:
    """What a page said and asked for."""

    def __init__(self, page):
        self.errors, self.elsewhere, self.expected = [], [], []
        page.on("console", lambda message: self.heard(message.type, message.text))
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("request", self.asked)
        self.hosts = set()

    def heard(self, kind, text):
        if kind in ("error", "warning") and not any(part in text for part in self.expected):
            self.errors.append(f"{kind}: {text}")

    def asked(self, request):
        if request.url.startswith(("data:", "blob:")):
            return
        if not request.url.startswith(tuple(self.hosts)):
            self.elsewhere.append(request.url)


# Playwright answers whole or not at all.
BREAKS_OFF = """
const asked = window.fetch;
let left = 1;
window.fetch = async (path, options) => {
  const answer = await asked(path, options);
  if (!String(path).includes(broken) || left-- <= 0) return answer;
  document.documentElement.dataset.brokenOff = 'yes';
  return new Response(new ReadableStream({ start: (body) => body.error(new TypeError('network error')) }), answer);
};
"""


@pytest.fixture
def new_page(browser):
    """Opens a page that is watched; all are judged at the end of the test. The first request like `lost` fails; the first answer to a path
    with `broken` in it breaks off, and `html` has `data-broken-off` from then on."""
    watches, contexts = [], []

    def opened(url, width=1280, theme="light", expected=(), lost=None, broken=None):
        context = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=theme, accept_downloads=True)
        context.set_default_timeout(20_000)
        page = context.new_page()
        watch = Watch(page)
        watch.hosts.add(url.split("/#")[0].rstrip("/"))
        watch.expected += expected
        if lost:
            page.route(lost, lambda route: route.abort("connectionrefused"), times=1)
        if broken:
            page.add_init_script(f"const broken = {json.dumps(broken)};" + BREAKS_OFF)
        page.goto(url)
        watches.append(watch)
        contexts.append(context)
        return page

    yield opened
    for context in contexts:
        context.close()
    for watch in watches:
        assert watch.errors == [] and watch.elsewhere == []
