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
    with page.expect_request(lambda request: request.method == "POST") as sent:
        act()
    request = sent.value
    assert request.headers["content-type"] == "application/octet-stream"
    return page.evaluate("address => Object.fromEntries(new URL(address).searchParams)", request.url)


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
    form.get_by_label("Number of sectors").fill("10")
    form.get_by_label("Number of contact nodes").fill("7")
    form.get_by_label("Name", exact=True).fill("of a bare mesh")
    asked = posted(page, make.click)
    page.get_by_role("heading", name="of a bare mesh", level=1).wait_for(timeout=120_000)
    assert settings(page, asked)["materials"] == {"*": {"youngs_modulus": 113800, "poissons_ratio": 0.342, "density": 4.43e-9}}
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
    judged(page, pictures / f"mesh-form-{width}-{theme}.png")
