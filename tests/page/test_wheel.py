"""The wheel in section and in 3D, and histories before their casing."""

import re
from math import hypot

import pytest
from conftest import sweep_of

# Figures of the page as Plotly has them.
FIGURES = "[...document.querySelectorAll('.js-plotly-plot')].map((one) => ({names: one.data.map((trace) => trace.name), y: [one.layout.yaxis, one.layout.yaxis2].map((axis) => axis?.title.text)}))"


@pytest.fixture(scope="module")
def recorded(service, model):
    """Id of a sweep of one speed with energy, states and a yield strength that its stress passes."""
    histories = {"speeds": [0], "quantities": ["displacement", "energy", "state"]}
    stress = {"strengths": {"WHEEL": {"yield_strength": 150}}}
    sweep = sweep_of(model, speeds={"values": [22667], "unit": "rpm"}, record={"histories": histories, "stress": stress})
    job = service.call("POST", "/v1/sweeps", sweep)["id"]
    assert service.finish(job)["status"] == "successful"
    return job


def stage(page):
    """The picture in 3D, in the window and at rest."""
    canvas = page.locator("canvas.stage")
    canvas.wait_for()
    canvas.scroll_into_view_if_needed()
    page.wait_for_timeout(600)
    return canvas


def test_a_section_is_a_silhouette_from_end_to_end(service, model, swept, new_page):
    page = new_page(f"{service.url}/#/models/{model}?sweep={swept}")
    page.locator(".js-plotly-plot").wait_for()
    ring = page.evaluate("(({x, y}) => [x, y])(document.querySelector('.js-plotly-plot').data.find((trace) => trace.name === 'wheel'))")
    nodes = service.call("GET", f"/v1/models/{model}/section")["nodes"]
    for drawn, axis in zip(ring, (2, 0), strict=True):
        places = [node["position"][axis] for node in nodes]
        drawn = [value for value in drawn if value is not None]
        assert abs(min(drawn) - min(places)) < 0.1 and abs(max(drawn) - max(places)) < 0.1


def test_a_node_is_read_where_the_pointer_is(service, model, new_page):
    page = new_page(f"{service.url}/#/models/{model}")
    canvas = stage(page)
    over = page.locator(".overlay").text_content()
    assert "z, axis" in over and " mm" in over
    box = canvas.bounding_box()
    page.mouse.move(box["x"] + 0.4 * box["width"], box["y"] + 0.6 * box["height"])
    page.get_by_text(re.compile(r"^Node \d")).wait_for()
    words = page.locator(".probed").inner_text().replace(",", "")
    number, *place = re.match(r"Node (\d+).*: x (\S+) y (\S+) z (\S+) mm", words).groups()
    x, y, z = map(float, place)
    nodes = service.call("GET", f"/v1/models/{model}/section")["nodes"]
    r, _, along = next(node["position"] for node in nodes if node["id"] == int(number))
    assert abs(hypot(x, y) - r) < 0.02 and abs(z - along) < 0.02


def test_half_of_a_wheel_is_taken_away_and_put_back(service, model, new_page):
    page = new_page(f"{service.url}/#/models/{model}")
    canvas = stage(page)
    pictures = [canvas.screenshot()]
    for _ in range(2):
        page.get_by_label("Half the wheel").click()
        page.wait_for_timeout(600)
        pictures.append(canvas.screenshot())
    assert pictures[0] == pictures[2] != pictures[1]


def test_a_revolution_is_played_before_the_casing_with_marks_of_yield(service, recorded, new_page):
    page = new_page(f"{service.url}/#/jobs/{recorded}?view=fields&speed=0&colour=total")
    stage(page)
    page.get_by_text("striped: above the yield strength, 150 N/mm²").wait_for()
    assert page.get_by_label("Casing", exact=True).is_checked()
    page.get_by_role("button", name="Play a revolution").click()
    page.get_by_role("button", name="Pause").or_(page.get_by_role("button", name="Play", exact=True)).wait_for(timeout=120_000)
    instant = page.get_by_text(re.compile(r"^after [\d.]+ revolutions"))
    before = instant.inner_text()
    page.wait_for_function("before => ![...document.querySelectorAll('li')].some((one) => one.textContent === before)", arg=before)


def test_histories_have_the_casing_and_two_axes_of_energy(service, recorded, new_page):
    page = new_page(f"{service.url}/#/jobs/{recorded}?view=point&speed=0")
    page.wait_for_function(f"() => {FIGURES}.some((one) => one.names.includes('casing: contact begins'))")
    page.get_by_label("Quantity").select_option("energy")
    page.wait_for_function(f"() => {FIGURES}.some(({{y}}) => y[0]?.startsWith('stored') && y[1]?.startsWith('added up'))")
