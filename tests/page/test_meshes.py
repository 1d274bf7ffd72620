"""A mesh of one sector becomes a model: chosen, described in a form, assembled by the service."""

import re
import socket
import threading
import zipfile
from math import pi

import pytest
from conftest import WINDOWS, judged

MATERIAL = "*MATERIAL, NAME=TITANIUM\n*ELASTIC\n113800, 0.342\n*DENSITY\n4.43E-9\n*SOLID SECTION, ELSET=WHEEL, MATERIAL=TITANIUM\n"
FORM = "Model from a mesh"


def deck(package, material=MATERIAL):
    """Nodes and elements of a package as an input deck, with its material and nothing else."""
    with zipfile.ZipFile(package) as files:
        nodes, elements = (files.read(name).decode().split() for name in ("nodes.csv", "elements.csv"))
    numbers, kinds, _, corners = zip(*(line.split(",", 3) for line in elements), strict=True)
    assert set(kinds) == {"QM6"}
    lines = ["*NODE", *nodes, "*ELEMENT, TYPE=C3D8I, ELSET=WHEEL", *map(",".join, zip(numbers, corners, strict=True)), material]
    return "\n".join(lines)


@pytest.fixture(scope="session")
def decks(zipped, tmp_path_factory):
    """A whole deck, and one without a material."""
    folder = tmp_path_factory.mktemp("decks")
    files = {"blade.v2.inp": MATERIAL, "bare.inp": ""}
    for name, material in files.items():
        (folder / name).write_text(deck(zipped, material))
    return [folder / name for name in files]


def choose(page, file):
    """Chooses a mesh; its form."""
    page.get_by_label("or a mesh of one sector").set_input_files(file)
    form = page.get_by_role("region", name=FORM)
    form.get_by_role("heading", name=file.name).wait_for()
    return form


def posted(page, act):
    """What the page sends when `act` is called: the parameters."""
    with page.expect_request(lambda request: request.method == "POST" and "/v1/models?" in request.url) as sent:
        act()
    request = sent.value
    assert request.headers["content-type"] == "application/octet-stream"
    return page.evaluate("address => Object.fromEntries(new URL(address).searchParams)", request.url)


# Chromium does not keep the answer to a request whose body is a file.
KEEPS_LOOKS = """
window.looks = [];
const asked = window.fetch;
window.fetch = async (path, options) => {
  const answer = await asked(path, options);
  if (String(path).includes('/v1/meshes/look') && answer.ok) window.looks.push(await answer.clone().json());
  return answer;
};
null;
"""


def looked(page, act):
    """What the service sees when `act` is called and the page looks at the mesh."""
    before = page.evaluate("window.looks.length")
    act()
    page.wait_for_function("before => window.looks.length > before", arg=before)
    return page.evaluate("window.looks.at(-1)")


def ready(form):
    """Waits until a look is shown; the price."""
    form.get_by_role("status").get_by_text("of sharp edges").wait_for()
    return form.get_by_text(re.compile("unknowns: about")).inner_text()


def pointed(page, canvas, wanted):
    """A place of the picture under which there is such a part, the last words about it; found from left to right through the middle."""
    box = canvas.bounding_box()
    words = page.locator("fieldset p[aria-hidden]")
    for height in (0.5, 0.4, 0.6, 0.3, 0.7):
        for x in range(0, int(box["width"]), 3):
            page.mouse.move(box["x"] + x, box["y"] + height * box["height"])
            found = re.search(wanted, words.inner_text())
            if found:
                return found
    raise AssertionError(f"nothing of the picture is {wanted}")


def swallow(silent):
    """Reads what the first client sends."""
    with silent.accept()[0] as client:
        while client.recv(1 << 16):
            pass


def settings(page, asked):
    return page.evaluate("text => JSON.parse(text)", asked["settings"])


def test_a_mesh_becomes_a_model(service, decks, new_page, pictures):
    whole, _ = decks
    page = new_page(f"{service.url}/#/models")
    form = choose(page, whole)
    assert form.get_by_label("Top speed", exact=True).evaluate("(one) => one === document.activeElement")
    assert form.get_by_label("Name", exact=True).input_value() == "blade.v2"
    page.keyboard.type("36000")
    asked = posted(page, lambda: page.keyboard.press("Enter"))
    sent = settings(page, asked)
    assert abs(sent.pop("top_speed_rad_s") / (36000 * pi / 30) - 1) < 1e-12
    assert asked["name"] == "blade.v2" and sent == {"units": {"length": "mm", "force": "N", "time": "s", "mass": "t"}, "contact_nodes": 10}
    page.get_by_role("heading", name="blade.v2", level=1).wait_for(timeout=120_000)
    model = service.call("GET", f"/v1/models/{page.url.split('/models/')[1]}")
    shown = page.get_by_role("region", name="Found in the mesh").get_by_role("listitem").all_inner_texts()
    assert shown == model["found"] and len(shown) > 4
    for part in ("C3D8I", "material of WHEEL: E = 113800", "axis: through", "sectors: 10 (found)", "clamp: ", "contact: "):
        assert any(part in line for line in shown), (part, shown)
    page.locator("canvas.stage").wait_for()
    judged(page, pictures / "mesh-model.png")


def test_what_a_mesh_lacks_is_asked_for_at_its_form(service, decks, new_page):
    whole, bare = decks
    page = new_page(f"{service.url}/#/models", expected=["422"])
    form = choose(page, bare)
    make = form.get_by_role("button", name="Make the model")
    # Nothing is sent before the form is right.
    make.click()
    form.get_by_text("The top speed is needed.").wait_for()
    form.get_by_label("Top speed", exact=True).fill("3000")
    form.get_by_label("Unit of the top speed").select_option("rad/s")
    form.get_by_label("Density").fill("4,43")
    make.click()
    form.get_by_text("A number above 0.").wait_for()
    assert form.get_by_text("Give all three, or none.").count() == 2
    form.get_by_label("Density").fill("")
    # The service finds no material, and says so in the words of the form, which stays as it is.
    make.click()
    alert = form.get_by_role("alert")
    alert.get_by_text(re.compile("has no material; give one under “Material”")).wait_for()
    assert form.get_by_label("Top speed", exact=True).input_value() == "3000"
    assert make.evaluate("(one) => one === document.activeElement")
    form.get_by_label("Units of the file").select_option("m, N, s, kg")
    assert "kg/m³" in form.get_by_label("Density").locator("..").inner_text()
    form.get_by_label("Units of the file").select_option("mm, N, s, t")
    for name, value, unit in (("Young’s modulus", "113800", "N/mm²"), ("Poisson’s ratio", "0.342", "no unit"), ("Density", "4.43e-9", "t/mm³")):
        form.get_by_label(name).fill(value)
        assert unit in form.get_by_label(name).locator("..").inner_text()
    # A fatigue strength is worth what its source is.
    form.get_by_label("Yield strength").fill("828")
    form.get_by_label("Fatigue strength", exact=True).fill("500")
    make.click()
    form.get_by_text("A fatigue strength names its source.").wait_for()
    form.get_by_label("Source of the fatigue strength").fill("a test")
    form.get_by_label("Number of sectors").fill("10")
    form.get_by_label("Number of contact nodes").fill("7")
    form.get_by_label("Name", exact=True).fill("of a bare mesh")
    asked = posted(page, make.click)
    page.get_by_role("heading", name="of a bare mesh", level=1).wait_for(timeout=120_000)
    assert settings(page, asked)["materials"] == {
        "*": {"youngs_modulus": 113800, "poissons_ratio": 0.342, "density": 4.43e-9, "yield_strength": 828, "fatigue_strength": {"amplitude": 500, "source": "a test"}}
    }
    model = service.call("GET", f"/v1/models/{page.url.split('/models/')[1]}")
    assert model["contact_nodes"] == 7 and model["speeds_rad_s"][-1] == 3000
    assert page.get_by_role("region", name="Found in the mesh").get_by_text("sectors: 10 (as stated)").count() == 1


def test_another_mesh_takes_the_place_of_the_first(service, decks, new_page):
    whole, bare = decks
    page = new_page(f"{service.url}/#/models", expected=["422"])
    form = choose(page, bare)
    form.get_by_label("Top speed", exact=True).fill("36000")
    form.get_by_label("Node set of the clamp").fill("BORE")
    choose(page, whole)
    assert form.get_by_label("Top speed", exact=True).input_value() == "36000" and form.get_by_label("Name", exact=True).input_value() == "blade.v2"
    # What the file does not have is refused.
    form.get_by_role("button", name="Make the model").click()
    form.get_by_role("alert").get_by_text('no nodes in a set "BORE"').wait_for()
    form.get_by_role("button", name="Cancel").click()
    assert form.count() == 0
    assert page.get_by_label("or a mesh of one sector").evaluate("(one) => one === document.activeElement")
    assert choose(page, whole).get_by_label("Top speed", exact=True).input_value() == ""


def test_a_mesh_that_is_sent_is_being_assembled(service, decks, new_page):
    page = new_page(f"{service.url}/#/models")
    form = choose(page, decks[0])
    form.get_by_label("Top speed", exact=True).fill("36000")
    # A service that takes everything and does not answer.
    with socket.create_server(("127.0.0.1", 0)) as silent:
        threading.Thread(target=swallow, args=(silent,), daemon=True).start()
        page.route("**/v1/models?*", lambda route: route.continue_(url=f"http://127.0.0.1:{silent.getsockname()[1]}/"))
        form.get_by_role("button", name="Make the model").click()
        form.get_by_text("assembling matrices …").wait_for()
        assert form.get_by_role("button", name="Make the model").is_disabled()
        form.get_by_role("button", name="Stop").click()
        form.get_by_text("The upload was stopped.").wait_for()
        assert form.get_by_role("button", name="Make the model").is_enabled()


def test_clamp_and_contact_line_are_chosen_by_clicks(service, decks, new_page):
    page = new_page(f"{service.url}/#/models")
    page.evaluate(KEEPS_LOOKS)
    form = page.get_by_role("region", name=FORM)
    seen = looked(page, lambda: choose(page, decks[0]))
    price = ready(form)
    assert f"{seen['price']['unknowns']:,} unknowns" in price and "a package of" in price
    canvas = form.locator("canvas.stage")
    canvas.scroll_into_view_if_needed()
    clamp, tip, between = (form.get_by_label(name) for name in ("Clamped patches", "Patch of the tip", "Ends of the contact line"))
    undo = form.get_by_role("button", name="Undo")
    # What is pointed at is named; a click takes nothing before it is asked to.
    patch = int(pointed(page, canvas, r"^Patch (\d+): area")[1]) - 1
    page.mouse.down()
    page.mouse.up()
    assert clamp.input_value() == "" and undo.is_disabled()
    form.get_by_label("Clamp", exact=True).check()
    canvas.scroll_into_view_if_needed()
    patch = int(pointed(page, canvas, r"^Patch (\d+): area")[1]) - 1

    def click():
        page.mouse.down()
        page.mouse.up()

    node = seen["patches"][patch]["at"]
    again = looked(page, click)
    assert clamp.input_value() == ", ".join(map(str, node))
    assert again["patches"][patch]["role"] == "clamp" and any(f"patches at node {node[0]}" in line for line in again["found"])
    # Turned with the pointer it takes nothing, too.
    page.mouse.down()
    page.mouse.move(*(place + 40 for place in (canvas.bounding_box()["x"] + 200, canvas.bounding_box()["y"] + 100)))
    page.mouse.up()
    assert clamp.input_value() == ", ".join(map(str, node))
    looked(page, undo.click)
    assert clamp.input_value() == "" and undo.is_disabled()
    # A chain of edges.
    form.get_by_label("Contact line", exact=True).check()
    canvas.scroll_into_view_if_needed()
    ends = pointed(page, canvas, r"^Chain of sharp edges, (\d+) to (\d+),").groups()
    again = looked(page, click)
    assert between.input_value() == ", ".join(ends)
    assert {str(again["node_ids"][again["contact_line"][k]]) for k in (0, -1)} == set(ends)
    # The tables, by keyboard: the tip as it was found, which takes the place of the edge.
    found = next(k for k, patch in enumerate(seen["patches"]) if patch.get("role") == "contact")
    button = form.get_by_role("button", name=f"Patch {found + 1} is the tip")
    button.focus()
    again = looked(page, lambda: page.keyboard.press("Enter"))
    assert (tip.input_value(), between.input_value()) == (str(seen["patches"][found]["at"][0]), "")
    assert again["contact"] == seen["contact"]
    page.wait_for_function("() => document.activeElement.dataset.choice !== undefined")
    bore = next(k for k, patch in enumerate(seen["patches"]) if patch.get("role") == "clamp")
    looked(page, form.get_by_role("button", name=f"Clamp patch {bore + 1}", exact=True).click)
    form.get_by_label("Top speed", exact=True).fill("36000")
    asked = settings(page, posted(page, form.get_by_role("button", name="Make the model").click))
    assert (asked["clamp_at"], asked["contact_at"]) == (seen["patches"][bore]["at"], seen["patches"][found]["at"])
    page.get_by_role("heading", name="blade.v2", level=1).wait_for(timeout=120_000)


def test_a_mesh_that_cannot_be_read_is_not_shown(service, new_page, tmp_path):
    broken = tmp_path / "broken.inp"
    broken.write_text("*NODE\n1, 0, 0\n")
    page = new_page(f"{service.url}/#/models", expected=["422"])
    form = choose(page, broken)
    form.get_by_text("The mesh cannot be shown.").wait_for()
    assert form.locator("canvas").count() == 0 and form.get_by_role("button", name="Make the model").is_enabled()


@pytest.mark.parametrize(("width", "theme"), WINDOWS)
def test_the_form_can_be_read_by_everybody(service, decks, new_page, pictures, width, theme):
    page = new_page(f"{service.url}/#/models", width=width, theme=theme)
    form = choose(page, decks[1])
    form.get_by_label("Units of the file").select_option("others")
    form.get_by_text("Axis of rotation, temperature").click()
    form.get_by_label("Point on the axis").fill("1, 2")
    form.get_by_label("Young’s modulus").fill("-1")
    form.get_by_role("button", name="Make the model").click()
    form.get_by_text("Correct the marked fields.").wait_for()
    ready(form)
    form.get_by_text(re.compile("has no material; give one under “Material”")).wait_for()
    form.get_by_text(re.compile(r"^Sharp edges")).click()
    judged(page, pictures / f"mesh-form-{width}-{theme}.png")
