"""What people do on the page, from a package to a comparison, as they do it: by labels, names and keys."""

import json
import re

from conftest import branches_of, damped, run_ups_of, sweep_of
from playwright.sync_api import expect
from service import Service, package


def open_job(page):
    """The page of a job, whose id is in the address."""
    page.wait_for_url(re.compile(r"#/jobs/[0-9a-f-]+"))
    return re.search(r"#/jobs/([0-9a-f-]+)", page.url)[1]


def test_a_package_is_chosen_dropped_and_deleted(service, zipped, tmp_path, new_page):
    other = package(tmp_path / "other.zip", "--sectors", "7")
    page = new_page(f"{service.url}/#/models")
    page.get_by_label("Drop a model package").set_input_files(other)
    page.get_by_role("heading", name="7 sectors", level=1).wait_for()
    page.get_by_role("link", name="Models").click()
    # The same once more, dropped: it is known.
    data = other.read_bytes()
    handle = page.evaluate_handle(
        """bytes => { const data = new DataTransfer(); data.items.add(new File([new Uint8Array(bytes)], 'wheel.zip')); return data; }""",
        list(data),
    )
    page.locator(".drop").dispatch_event("drop", {"dataTransfer": handle})
    page.get_by_role("heading", name="7 sectors", level=1).wait_for()
    page.get_by_role("button", name="Delete").click()
    page.get_by_role("dialog").get_by_role("button", name="Delete it").click()
    page.wait_for_url("**/#/models")
    page.get_by_role("heading", name="Models").wait_for()
    page.locator("main:not([aria-busy])").wait_for()
    assert page.get_by_role("link", name="7 sectors").count() == 0


def test_the_first_page_leads_to_a_model_and_to_jobs_with_their_verdicts(service, zipped, swept, new_page):
    page = new_page(service.url)
    page.get_by_role("heading", name="Latest jobs").wait_for()
    assert page.get_by_role("link", name="Generate an impeller").get_attribute("href") == "#/generate"
    # Of sweeps only, and as the service has them.
    jobs = service.call("GET", "/v1/jobs?limit=8")["jobs"]
    sweeps = [job["id"] for job in jobs if job["kind"] == "sweep" and job["status"] == "successful"]
    assert swept in sweeps
    page.wait_for_function(f"() => document.querySelectorAll('.jobs [data-verdict]').length === {len(sweeps)}")
    for job in sweeps:
        said = page.locator(".jobs li", has=page.locator(f"a[href='#/jobs/{job}']")).locator("[data-verdict]")
        assert said.inner_text() == service.call("GET", f"/v1/jobs/{job}/verdict")["verdict"]
    page.get_by_label("Drop a package here").set_input_files(zipped)
    page.get_by_text("The service already has a model with this content").wait_for()


def test_an_example_opens_with_a_result_and_only_once(service, new_page):
    page = new_page(service.url)
    page.get_by_role("button", name="Open an example").click()
    job = open_job(page)
    asked = service.finish(job)
    assert asked["status"] == "successful" and asked["request"]["operation"]["ranges"][0]["name"] == "Cruise"
    assert service.call("GET", f"/v1/jobs/{job}/verdict")["verdict"] in ("act", "watch", "clear")
    page.get_by_role("link", name="rubmap", exact=True).click()
    page.get_by_role("button", name="Open an example").click()
    assert open_job(page) == job


def test_a_bad_package_is_refused_with_file_and_row(service, tmp_path, zipped, new_page):
    import zipfile

    bad = tmp_path / "bad.zip"
    with zipfile.ZipFile(zipped) as good, zipfile.ZipFile(bad, "w") as out:
        for name in good.namelist():
            content = good.read(name)
            if name == "nodes.csv":
                lines = content.decode().splitlines()
                lines[5] = lines[5].rsplit(",", 1)[0] + ",far away"
                content = "\n".join(lines).encode()
            out.writestr(name, content)
    page = new_page(f"{service.url}/#/models", expected=["422"])
    page.get_by_label("Drop a model package").set_input_files(bad)
    alert = page.get_by_role("alert")
    alert.wait_for()
    assert "nodes.csv" in alert.inner_text() and "line 6" in alert.inner_text()


def test_a_wheel_is_generated_from_a_preset(service, new_page):
    page = new_page(f"{service.url}/#/generate", expected=["422"])
    sectors = page.get_by_label("Number of sectors")
    sectors.fill("2")
    page.get_by_text("at least 3").last.wait_for()
    page.get_by_role("button", name="Generate").click()
    page.locator(".error", has_text="3").wait_for()
    sectors.fill("9")
    page.get_by_role("button", name="Generate").click()
    page.get_by_role("heading", name="9 sectors", level=1).wait_for()
    page.locator("canvas.stage").wait_for()


def test_a_material_is_suggested_in_the_units_of_the_model(service, new_page):
    page = new_page(f"{service.url}/#/generate")
    page.get_by_label("Typical values of").select_option(label="Aluminium 7075-T6, wrought")
    page.get_by_text("confirm them by the certificate").wait_for()
    fields = ["Young’s modulus E", "Poisson’s ratio ν", "Density ρ", "Yield strength", "Ultimate strength", "Amplitude"]
    values = [float(page.get_by_label(name).input_value()) for name in fields]
    # N/mm² and t/mm³.
    assert values == [71700, 0.33, 2.81e-9, 503, 572, 159]
    assert "not confirmed" in page.get_by_label("Source").input_value()
    assert page.get_by_role("img", name="Meridional section").count() == 1
    page.get_by_label("Number of sectors").fill("5")
    page.get_by_role("button", name="Generate", exact=True).click()
    page.wait_for_url("**/#/models/*")
    made = service.call("GET", "/v1/models/" + page.url.rsplit("/", 1)[1].split("?")[0])
    assert abs(made["in_si"]["materials"][0]["youngs_modulus_pa"] / 71.7e9 - 1) < 1e-9


def test_a_sweep_is_planned_asked_for_and_followed(service, model, swept, new_page):
    page = new_page(f"{service.url}/#/sweep?model={model}", expected=["422"])
    plan = page.get_by_role("status", name="Plan")
    plan.get_by_text(re.compile("steps", re.I)).first.wait_for()
    before = plan.inner_text()
    page.get_by_label("Number of speeds").fill("12")
    plan.get_by_text("12", exact=True).wait_for()
    assert plan.inner_text() != before
    # What the form makes is there to be seen, and what is written there the form shows.
    page.get_by_text("The request as JSON").click()
    text = page.get_by_label("Request; the form follows what you write")
    text.fill(text.input_value().replace('"count": 12', '"count": 9'))
    assert page.get_by_label("Number of speeds").input_value() == "9"
    page.get_by_role("button", name="Start").click()
    job = open_job(page)
    page.get_by_text("done", exact=True).wait_for(timeout=120_000)
    assert service.finish(job)["status"] == "successful"
    page.locator(".figure .main-svg").first.wait_for()
    assert service.call("GET", f"/v1/jobs/{job}")["request"]["speeds"]["count"] == 9
    # The verdict comes first; without a limit it is undecided, and no speed is missing any more.
    said = page.locator("[data-verdict=undecided]")
    page.wait_for_function("() => !document.querySelector('[data-verdict]').innerText.includes('without a result')")
    # Names of fields are those of the form.
    assert "give `limits`: `clearance_consumption`" in service.call("GET", f"/v1/jobs/{job}/verdict")["sentence"]
    assert "give “Limits”: clearance consumption, tip motion, utilisation or node force" in said.inner_text()
    assert said.bounding_box()["y"] < page.get_by_text("done", exact=True).bounding_box()["y"]
    # What would decide opens the form with that filled in.
    page.get_by_role("link", name=re.compile("^Open the form with .*“More speeds around peaks” switched on")).first.click()
    page.get_by_text("Changed against that job: “More speeds around peaks”").wait_for()
    assert page.get_by_label("More speeds around peaks").input_value() == "true"
    assert page.get_by_label("Number of speeds").input_value() == "9"
    page.go_back()
    page.get_by_role("link", name=re.compile("^Open the form with give “Limits”")).click()
    page.get_by_text("Changed against that job: “Limits”").wait_for()
    assert page.get_by_label("Clearance consumption").input_value() == "0.9"


def test_a_sweep_opens_on_its_verdict_and_leads_on_from_the_worst_speeds(service, model, new_page):
    ranges = [{"name": "cruise", "from": 18000, "to": 24000, "unit": "rpm", "separation_percent": 5}]
    judged = sweep_of(model, name="judged", operation={"ranges": ranges}, limits={"tip_motion": 0.25}, record={})
    job = service.call("POST", "/v1/sweeps", judged)["id"]
    assert service.finish(job)["status"] == "successful"
    page = new_page(f"{service.url}/#/jobs/{job}")
    level = service.call("GET", f"/v1/jobs/{job}/level")
    verdict = level["verdict"]
    page.get_by_role("heading", name="The worst speeds").wait_for()
    cards = page.locator("li.card")
    assert cards.count() == len(verdict["worst"]) > 0
    page.get_by_role("heading", name=f"{len(verdict['critical_speeds'])} critical speed").wait_for()
    names = page.evaluate("document.querySelector('.figure').data.map((trace) => trace.name)")
    assert {"operating range", "separation asked", "limit"} <= set(names)
    # Each worst speed says by how much the limit is passed.
    for card, worst in zip(cards.all(), verdict["worst"]):
        judged = worst["limits"][0]
        above, stands = judged["above_percent"], judged["standing"]
        by = f"{abs(above):.1f} %" if abs(above) < 10 else f"{abs(above):,.0f} %"
        beside = "above" if above > 0 else "left"
        said = f"passed by {by}" if stands == "passed" else f"{'within the error' if stands == 'open' else 'kept'}, {by} {beside}"
        assert said in card.inner_text() and "tip motion" in card.inner_text()
        value, error = worst["limits"][0]["value"], worst["limits"][0]["error"]
        assert f"({value / (1 + error / value):.3g} to {value * (1 + error / value):.3g}) mm" in card.inner_text()
    # The wheel is recorded and drawn in its place.
    index = verdict["worst"][0]["index"]
    cards.first.get_by_role("button", name=re.compile("^Record the wheel")).click()
    cards.first.locator("img.drawing").wait_for(timeout=120_000)
    assert cards.first.get_by_role("link", name=re.compile("largest tip motion")).get_attribute("href").endswith("view=fields")
    # A run-up begins with the speed and the scene.
    cards.first.get_by_role("link", name=re.compile("^Run-up through")).click()
    page.get_by_text("The request as JSON").click()
    asked = json.loads(page.get_by_label("Request; the form follows what you write").input_value())
    rpm = level["verdict"]["worst"][0]["speed_rad_s"] * 9.549296585513721
    assert asked["speed"]["from"] < rpm < asked["speed"]["to"] and asked["scene"]["casing"]["lobes"]["count"] == 2
    assert index in [speed["index"] for speed in level["speeds"]]


def test_a_remedy_switches_on_blades_that_bend_far(service, new_page):
    page = new_page(f"{service.url}/#/jobs")
    page.get_by_role("heading", name="Jobs").wait_for()

    def mended(remedy, scene):
        script = """async ([remedy, scene]) => {
            const { mendable, mended } = await import('/page/views/request/mend.js');
            const { inWords } = await import('/page/lib/form/named.js');
            return [inWords(remedy), mended({ scene }, mendable(remedy), {}).scene];
        }"""
        return page.evaluate(script, [remedy, scene])

    full = {"contact": {}, "geometric_nonlinearity": {"include": "full"}}
    assert mended("a calculation: `scene.geometric_nonlinearity`", {"contact": {}}) == ["a calculation: “Blades that bend far”", full]
    bent = {"contact": {}, "geometric_nonlinearity": {"include": "kinematics"}}
    assert mended('`scene.geometric_nonlinearity.include` of "full"', bent) == ["“Included” set to “full”", full]


def test_validity_is_about_the_theory_of_the_scene(service, swept, new_page):
    def bending(route):
        answer = route.fetch()
        job = answer.json()
        job["request"]["scene"]["geometric_nonlinearity"] = {"include": "full", "coordinates": 4}
        route.fulfill(response=answer, json=job)

    page = new_page(f"{service.url}/#/jobs/{swept}?view=critical")
    page.get_by_role("columnheader", name="Linear theory").wait_for()
    page.route(f"**/v1/jobs/{swept}", bending)
    page.goto(f"{service.url}/#/jobs/{swept}?view=critical&of=sensor")
    page.get_by_role("columnheader", name="Bending simulated").wait_for()
    assert page.get_by_role("columnheader", name="Linear theory").count() == 0
    page.goto(f"{service.url}/#/jobs/{swept}?view=credentials")
    page.get_by_text("Bending simulated").wait_for()
    assert page.get_by_text("inear theory").count() == 0


def test_nothing_is_counted_before_a_speed_has_finished(service, swept, new_page):
    def emptied(route):
        answer = route.fetch()
        level = answer.json()
        level["speeds"], level["verdict"]["critical_speeds"], level["verdict"]["worst"] = [], [], []
        route.fulfill(response=answer, json=level)

    page = new_page(f"{service.url}/#/jobs")
    page.route("**/level", emptied)
    page.goto(f"{service.url}/#/jobs/{swept}")
    page.get_by_text("No speed was finished.").wait_for()
    assert page.get_by_role("heading", name="critical speed").count() == 0


def test_progress_has_a_percentage_only_where_it_is_known(service, new_page):
    page = new_page(f"{service.url}/#/jobs")
    page.get_by_role("heading", name="Jobs").wait_for()

    def told(progress, total, finished, phase):
        job = {"kind": "sweep", "progress": progress, "phase": phase}
        job |= {"speeds": {"total": total, "finished": finished, "diverged": 0, "failed": 0}}
        return page.evaluate("async (job) => Object.values((await import('/page/lib/progress.js')).progressOf(job))", job)

    assert told(55, 100, 50, "50 of 100 speeds finished") == ["55 % · 50 of 100 speeds finished", 55]
    added = "added around peaks: 0 of 23 speeds finished; control runs follow"
    assert told(99, 123, 100, added) == [added, 100 * 100 / 123]
    assert told(99, 100, 100, "control runs: 1 of 5") == ["control runs: 1 of 5", None]


def test_stress_stands_in_the_order_of_the_speeds(service, model, new_page):
    job = service.call("POST", "/v1/sweeps", sweep_of(model, speeds={"values": [24000, 15000, 18000], "unit": "rpm"}, record={"stress": {}}))["id"]
    assert service.finish(job)["status"] == "successful"
    page = new_page(f"{service.url}/#/jobs/{job}?view=stress")
    rows = page.get_by_role("region", name="Largest stress and utilisation at each speed").locator("tbody tr")
    rows.first.wait_for()
    assert [row.locator("td").first.inner_text() for row in rows.all()] == ["15,000 rpm", "18,000 rpm", "24,000 rpm"]


def test_tables_beside_a_diagram_end_with_a_whole_row(service, model, new_page):
    job = service.call("POST", "/v1/modal-analyses", {"model": model, "speeds": {"from": 0, "to": 36000, "count": 25, "unit": "rpm"}, "lobes": 2})["id"]
    assert service.finish(job)["status"] == "successful"
    page = new_page(f"{service.url}/#/jobs/{job}")
    table = page.get_by_role("region", name="Engine orders of the lobes meet modes at")
    table.wait_for()
    assert table.evaluate("(box) => box.scrollHeight > box.clientHeight")
    end = table.bounding_box()["y"] + table.bounding_box()["height"]
    boxes = [row.bounding_box() for row in table.locator("tbody tr").all()]
    assert [box for box in boxes if box["y"] < end - 1 and box["y"] + box["height"] > end + 1] == []
    # Other tests look at the model without one.
    service.call("DELETE", f"/v1/jobs/{job}")


def test_what_was_not_recorded_is_offered_without_a_refusal(service, model, new_page):
    plain = sweep_of(model, name="plain", record={})
    job = service.call("POST", "/v1/sweeps", plain)["id"]
    assert service.finish(job)["status"] == "successful"
    # Nothing is asked for that is not there: the console stays empty.
    page = new_page(f"{service.url}/#/jobs/{job}?view=fields")
    page.get_by_role("button", name="Record this speed").wait_for()
    page.goto(f"{service.url}/#/jobs/{job}?view=point&speed=4")
    page.get_by_role("button", name="Record this speed").wait_for()
    page.goto(f"{service.url}/#/jobs/{job}?view=stress")
    page.get_by_role("button", name="Same sweep, with stress").click()
    page.wait_for_url(re.compile(f"#/jobs/(?!{job})"))
    assert service.call("GET", f"/v1/jobs/{open_job(page)}")["request"]["record"]["stress"] is not None
    assert service.finish(open_job(page))["status"] == "successful"


def test_a_click_on_the_map_opens_that_speed(service, swept, new_page):
    page = new_page(f"{service.url}/#/jobs/{swept}?view=map")
    drag = page.locator(".figure .nsewdrag.drag").first
    drag.wait_for()
    # Below the verdict, the middle of the map may be out of sight.
    page.mouse.wheel(0, 500)
    page.wait_for_function("() => window.scrollY > 0")
    box = drag.bounding_box()
    # The fifth of ten speeds.
    page.mouse.click(box["x"] + box["width"] * 0.45, box["y"] + box["height"] * 0.5)
    page.wait_for_url(re.compile("view=point"))
    assert "speed=4" in page.url
    page.locator(".figure .main-svg").first.wait_for()
    page.get_by_role("heading", name=re.compile("22,66[67] rpm")).wait_for()


def ends_of(page, group):
    """What the fields of speeds or of a range say."""
    fields = page.get_by_role("group", name=group, exact=True)
    return [fields.get_by_label(name, exact=True).input_value() for name in ("From", "To")]


def type_ends(page, group, *ends):
    for name, end in zip(("From", "To"), ends, strict=True):
        page.get_by_role("group", name=group, exact=True).get_by_label(name, exact=True).fill(end)


def test_lobes_follow_the_clearance_until_they_are_written(service, model, new_page):
    page = new_page(f"{service.url}/#/sweep?model={model}", expected=["422"])
    height = page.get_by_label("Height")
    page.get_by_label("At the leading edge").fill("0.4")
    page.get_by_label("At the trailing edge").fill("0.5")
    # 5 % above the smaller clearance, as the drawing says.
    assert height.input_value() == "0.42"
    page.get_by_text("The casing reaches 0.02 mm past the clearance (5 % of it)").wait_for()
    # A clearance that is being written is none.
    page.get_by_label("At the trailing edge").fill("")
    page.get_by_label("At the trailing edge").fill("0.2")
    assert height.input_value() == "0.21"
    height.fill("0.25")
    page.get_by_label("At the leading edge").fill("0.3")
    assert height.input_value() == "0.25"


def test_speeds_and_operating_ranges_fit_each_other(service, model, new_page):
    note = "The verdict would stay undecided"
    # Speeds first: they are the range, and reach past its separation then.
    page = new_page(f"{service.url}/#/sweep?model={model}", expected=["422"])
    type_ends(page, "Speeds", "18000", "24000")
    page.get_by_role("checkbox", name="Operating ranges").check()
    assert ends_of(page, "Range 1") == ["18000", "24000"] and ends_of(page, "Speeds") == ["17100", "25200"]
    # Speeds that somebody typed are never given up.
    type_ends(page, "Range 1", "20000", "22000")
    assert ends_of(page, "Speeds") == ["18000", "24000"]
    page.get_by_role("button", name="Limit the clearance consumption to 90 %").click()
    expect(page.get_by_text(note)).to_have_count(0)
    assert page.get_by_label("Clearance consumption").input_value() == "0.9"

    # The number of speeds tells no range, and a range leaves room for its separation below the highest speed of the model.
    page = new_page(f"{service.url}/#/sweep?model={model}", expected=["422"])
    highest = int(ends_of(page, "Speeds")[1])
    page.get_by_label("Number of speeds").fill("50")
    page.get_by_role("checkbox", name="Operating ranges").check()
    within = ends_of(page, "Range 1")
    assert int(within[0]) * 0.95 >= int(ends_of(page, "Speeds")[0]) and int(within[1]) * 1.05 <= highest
    page.get_by_role("checkbox", name="Operating ranges").uncheck()
    type_ends(page, "Speeds", "20000", str(highest))
    page.get_by_role("checkbox", name="Operating ranges").check()
    assert ends_of(page, "Range 1")[0] == "20000" and 0 <= highest - 1.05 * int(ends_of(page, "Range 1")[1]) < 2
    expect(page.get_by_text("do not reach the ends")).to_have_count(0)

    # The range first: speeds follow it.
    page = new_page(f"{service.url}/#/sweep?model={model}", expected=["422"])
    page.get_by_role("checkbox", name="Limits").check()
    page.get_by_role("checkbox", name="Operating ranges").check()
    expect(page.get_by_text(note)).to_have_count(0)
    type_ends(page, "Range 1", "18000", "24000")
    assert ends_of(page, "Speeds") == ["17100", "25200"]
    expect(page.get_by_text(note)).to_have_count(0)
    # Speeds that fall short are told, and mended.
    type_ends(page, "Speeds", "18000", "24000")
    page.get_by_text("do not reach the ends of Operation with their separation").wait_for()
    page.get_by_role("button", name="Ask for 17,100 to 25,200 rpm").click()
    assert ends_of(page, "Speeds") == ["17100", "25200"]
    # Steps over 5 % may pass over a critical speed.
    page.get_by_label("Number of speeds").fill("8")
    page.get_by_text("a step of 6.3 %").wait_for()
    page.get_by_role("button", name=re.compile(r"Ask for \d+ speeds")).click()
    page.get_by_role("button", name="Add speeds around peaks").click()
    expect(page.get_by_text(note)).to_have_count(0)
    steps = int(page.get_by_label("Number of speeds").input_value()) - 1
    assert (25200 - 17100) / steps <= 0.05 * (17100 + (25200 - 17100) / steps)
    # A limit needs what it is about.
    page.get_by_text("Effects", exact=True).click()
    page.get_by_role("checkbox", name="Contact of tips and casing").uncheck()
    page.get_by_role("button", name="Switch contact on").click()
    assert page.get_by_role("checkbox", name="Contact of tips and casing").is_checked()
    page.get_by_label("Utilisation").fill("1")
    page.get_by_text("has no strengths").wait_for()
    page.get_by_label("Utilisation").fill("")
    expect(page.get_by_text(note)).to_have_count(0)
    # The stiffness is not known beyond the highest speed of the model.
    type_ends(page, "Range 1", "18000", "60000")
    page.get_by_text("the stiffness of the model ends at").wait_for()


def test_a_range_that_the_speeds_do_not_reach_is_told_before_the_start(service, model, new_page):
    page = new_page(f"{service.url}/#/sweep?model={model}")
    page.get_by_text("The request as JSON").click()
    text = page.get_by_label("Request; the form follows what you write")
    text.wait_for()
    asked = json.loads(text.input_value())
    asked["operation"] = {"ranges": [{"name": "cruise", "from": 18000, "to": 24000, "unit": "rpm", "separation_percent": 5}]}
    note = page.get_by_text("ask for 17,100 rpm to 25,200 rpm")
    for ends, shown in [((18000, 24000), 1), ((17100, 25200), 0), ((17200, 26000), 1)]:
        asked["speeds"] = {"from": ends[0], "to": ends[1], "count": 40, "unit": "rpm"}
        text.fill(json.dumps(asked))
        expect(note).to_have_count(shown)


def test_sweeps_are_compared_and_a_measurement_laid_over(service, swept, model, tmp_path, new_page):
    # Plotly takes some texts for markup.
    job = service.call("POST", "/v1/sweeps", sweep_of(model, name="to compare <b>& so on"))["id"]
    assert service.finish(job)["status"] == "successful"
    page = new_page(f"{service.url}/#/jobs")
    page.get_by_role("checkbox", name="Compare to compare <b>& so on").check()
    name = service.call("GET", f"/v1/jobs/{swept}")["name"]
    page.get_by_role("checkbox", name=f"Compare {name}", exact=True).last.check()
    page.get_by_role("button", name="Compare the chosen").click()
    page.get_by_role("heading", name="Level over speed").wait_for()
    page.locator(".figure .main-svg").first.wait_for()
    page.locator(".legendtext").get_by_text("to compare <b>& so on", exact=True).first.wait_for()
    # They differ by their names alone.
    page.get_by_text("The requests are the same but for names").wait_for()
    measured = tmp_path / "measured.csv"
    measured.write_text("speed,frequency,amplitude\n14000,800,0.1\n22000,1200,0.3\n")
    page.locator("input[type=file]").set_input_files(measured)
    page.get_by_text(re.compile("2 measured points")).first.wait_for()


def test_a_search_goes_on_being_written(service, new_page):
    for view in ("jobs", "models"):
        page = new_page(f"{service.url}/#/{view}")
        page.get_by_label("Name has").press_sequentially("no")
        page.wait_for_url("**name=no")
        page.keyboard.type("pe")
        page.wait_for_url("**name=nope")
        assert page.get_by_label("Name has").input_value() == "nope"


def test_the_content_is_framed_for_readers_with_a_keyboard_only(service, new_page):
    page = new_page(f"{service.url}/#/jobs")
    page.get_by_role("heading", name="Jobs").wait_for()
    outline = "getComputedStyle(document.querySelector('main')).outlineStyle"
    # By an address.
    page.evaluate("location.hash = '#/models'")
    page.get_by_role("heading", name="Models").wait_for()
    assert page.evaluate("document.activeElement.id") == "main" and page.evaluate(outline) == "none"
    page.get_by_role("link", name="Skip to the content").focus()
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.id") == "main" and page.evaluate(outline) == "solid"


def test_what_a_job_is_called_is_changed(service, model, new_page):
    job = service.call("POST", "/v1/sweeps", sweep_of(model, name="before", speeds={"values": [20000], "unit": "rpm"}, record={}))["id"]
    service.finish(job)
    page = new_page(f"{service.url}/#/jobs/{job}", expected=["422"])
    page.get_by_role("button", name="Name, tags, notes").click()
    dialog = page.get_by_role("dialog")
    assert dialog.get_by_label("Name").input_value() == "before"
    dialog.get_by_label("Name").fill('<b>after</b> & "so on"')
    dialog.get_by_label("Tags").fill("x" * 51)
    dialog.get_by_role("button", name="Save").click()
    dialog.get_by_role("alert").wait_for()
    dialog.get_by_label("Tags").fill("one, two ,")
    dialog.get_by_role("button", name="Save").click()
    page.get_by_role("heading", name='<b>after</b> & "so on"').wait_for()
    called = service.call("GET", f"/v1/jobs/{job}")
    assert called["tags"] == ["one", "two"] and "notes" not in called


def test_an_impeller_is_generated_as_another_one(service, new_page):
    first = service.call("POST", "/v1/models", {"name": "five", "sectors": 5, "top_speed_rad_s": 3000})["id"]
    service.finish(first)
    page = new_page(f"{service.url}/#/jobs/{first}")
    page.get_by_role("link", name="As five, but").click()
    page.get_by_label("Sectors").fill("7")
    page.get_by_role("button", name="Generate", exact=True).click()
    page.wait_for_url("**/#/models/*")
    made = service.call("GET", "/v1/models/" + page.url.rsplit("/", 1)[1].split("?")[0])
    assert made["sectors"] == 7 and max(made["speeds_rad_s"]) == 3000


def test_a_job_is_cancelled_run_again_and_deleted(service, model, new_page):
    long = sweep_of(model, name="long one", integration={"revolutions": 20000, "window_revolutions": 20}, record={})
    service.call("POST", "/v1/sweeps", long)
    page = new_page(f"{service.url}/#/jobs?name=long")
    page.get_by_role("progressbar", name="Progress of long one").wait_for()
    page.get_by_role("button", name="Cancel long one").click()
    page.get_by_text("cancelled", exact=True).last.wait_for()
    page.get_by_role("button", name="Run long one again").click()
    job = open_job(page)
    page.reload()
    page.get_by_role("heading", name="long one").wait_for()
    # By the keyboard, while the progress changes.
    page.get_by_role("progressbar", name="Progress").wait_for()
    page.get_by_role("button", name="Cancel long one").focus()
    page.wait_for_timeout(1500)
    page.keyboard.press("Enter")
    page.get_by_role("button", name="Delete long one").click()
    page.get_by_role("dialog").get_by_role("button", name="Keep").click()
    assert service.call("GET", f"/v1/jobs/{job}")["status"] == "dismissed"
    page.get_by_role("button", name="Delete long one").click()
    page.get_by_role("dialog").get_by_role("button", name="Delete it").click()
    page.wait_for_url("**/#/jobs")


def test_the_page_outlives_the_service(tmp_path, zipped, new_page):
    own = Service(tmp_path)
    try:
        model = own.call("POST", "/v1/models", zipped.read_bytes())["id"]
        slow = sweep_of(model, integration={"revolutions": 150, "window_revolutions": 20}, record={})
        job = own.call("POST", "/v1/sweeps", slow)["id"]
        page = new_page(f"{own.url}/#/jobs/{job}", expected=["ERR_CONNECTION_REFUSED", "ERR_INCOMPLETE_CHUNKED", "ERR_EMPTY", "ERR_CONNECTION_RESET", "ERR_ABORTED", "ERR_FAILED"])
        page.get_by_text("running", exact=True).wait_for()
        own.kill()
        page.get_by_text("The service does not answer. Trying again").wait_for(timeout=30_000)
        own.start()
        page.get_by_text("The service does not answer. Trying again").wait_for(state="hidden", timeout=30_000)
        page.get_by_text("done", exact=True).wait_for(timeout=120_000)
        page.locator(".figure .main-svg").first.wait_for()
    finally:
        own.stop()


def test_what_could_not_be_had_is_had_again(service, swept, new_page):
    job = f"/v1/jobs/{swept}"
    view, inner, map_of = "/page/views/job.js", "/page/views/job/linear.js", f"{job}/interaction-map[?]format=plotly"
    for lost in (view, inner, "/page/plotly-*.js", job, "/v1/models/*", map_of):
        page = new_page(f"{service.url}/#/jobs/{swept}?view=map", expected=["ERR_CONNECTION_REFUSED"], lost=service.url + lost)
        page.locator(".figure .main-svg").first.wait_for()
        page.get_by_text("The service does not answer").first.wait_for(state="hidden")


def test_an_answer_that_breaks_off_is_asked_for_again(service, swept, new_page):
    page = new_page(f"{service.url}/#/jobs/{swept}?view=map", broken=f"/v1/jobs/{swept}/interaction-map")
    page.locator("html[data-broken-off]").wait_for()
    page.locator(".figure .main-svg").first.wait_for()
    page.get_by_text("The service does not answer").first.wait_for(state="hidden")


def test_a_form_keeps_what_was_filled_in_and_starts_nothing_else(service, model, new_page):
    before = len(service.call("GET", "/v1/jobs?limit=500")["jobs"])
    page = new_page(f"{service.url}/#/sweep?model={model}")
    page.get_by_text("Effects", exact=True).click()
    page.get_by_role("button", name="Add to forces at engine orders").click()
    page.get_by_label("Plan").get_by_text("Reduction", exact=True).wait_for()
    page.get_by_label("Number of speeds").fill("17")
    page.get_by_role("link", name="Jobs").click()
    page.get_by_role("heading", name="Jobs").wait_for()
    page.go_back()
    page.get_by_text("This is what you had filled in here.").wait_for()
    assert page.get_by_label("Number of speeds").input_value() == "17"
    page.get_by_text("The request as JSON").click()
    page.get_by_label("Request; the form follows").fill('{"model": ')
    page.get_by_role("button", name="Start").click()
    page.locator("[role=alert]", has_text="is not complete").wait_for()
    assert len(service.call("GET", "/v1/jobs?limit=500")["jobs"]) == before
    page.get_by_role("button", name="Begin anew").click()
    page.get_by_text("This is what you had filled in here.").wait_for(state="hidden")
    assert page.get_by_label("Number of speeds").input_value() != "17"


def test_a_form_says_beforehand_by_how_much_lobes_exceed_the_clearance(service, model, new_page):
    page = new_page(f"{service.url}/#/sweep?model={model}")
    told = page.get_by_role("group").get_by_role("status").first
    page.get_by_label("At the leading edge").fill("0.5")
    page.get_by_label("At the trailing edge").fill("0.4")
    page.get_by_label("Height").fill("0.3")
    page.get_by_text("leaves 0.1 mm of the clearance").wait_for()
    page.get_by_label("Height").fill("0.44")
    page.get_by_text("reaches 0.04 mm past the clearance (10 % of it)").wait_for()
    page.get_by_label("Number of lobes").fill("")
    page.get_by_text("The drawing needs clearance").wait_for()
    assert told.count() == 1
    assert page.get_by_role("img", name="Around the circumference").count() == 1


def test_a_job_without_a_name_is_called_by_model_speeds_and_clearance(service, model, new_page):
    page = new_page(f"{service.url}/#/sweep?model={model}", expected=["422"])
    page.get_by_label("At the leading edge").fill("0.31")
    page.get_by_label("At the trailing edge").fill("0.31")
    page.get_by_label("To", exact=True).fill("20000")
    page.get_by_text("named by model, speeds and clearance").wait_for()
    page.get_by_role("button", name="Start").click()
    called = service.call("GET", f"/v1/models/{model}")["name"]
    page.get_by_role("heading", name=re.compile(f"^{re.escape(called)}: .* to 20,000 rpm, clearance 0.31 mm")).wait_for()
    service.call("DELETE", f"/v1/jobs/{open_job(page)}?cancel_only=true")


def test_ranges_and_limits_are_asked_for_over_the_frequencies_of_the_model(service, swept, model, new_page):
    page = new_page(f"{service.url}/#/sweep?model={model}", expected=["422"])
    page.get_by_role("button", name="Compute").click()
    page.locator(".crossing").first.wait_for(state="attached")
    page.get_by_role("checkbox", name="Operating ranges").check()
    first = page.get_by_role("group", name="Range 1")
    first.get_by_label("Name").fill("Idle")
    first.get_by_label("From").fill("15000")
    first.get_by_label("To").fill("18000")
    page.get_by_role("button", name="Another range").click()
    page.get_by_role("group", name="Range 2").get_by_label("Name").fill("Full speed")
    page.get_by_role("checkbox", name="Limits").check()
    page.get_by_label("Tip motion").fill("0.5")
    assert page.locator("rect.range").count() == 2
    page.get_by_text("Idle: ").wait_for()
    page.get_by_text("The request as JSON").click()
    asked = json.loads(page.get_by_label("Request; the form follows").input_value())
    assert [one["name"] for one in asked["operation"]["ranges"]] == ["Idle", "Full speed"]
    assert asked["limits"]["tip_motion"] == 0.5 and asked["limits"]["clearance_consumption"] == 0.9


def test_every_field_of_a_request_has_words(service, new_page):
    """Names of the contract never stand alone, unless they are words."""
    schemas = service.call("GET", "/openapi.json")["components"]["schemas"]

    def resolved(schema):
        while True:
            ones = [one for one in schema.get("oneOf", schema.get("allOf", [])) if one.get("type") != "null"]
            if "$ref" in schema:
                schema = schemas[schema["$ref"].split("/")[-1]]
            elif len(ones) == 1:
                schema = ones[0]
            else:
                return schema

    def pointers(schema, at=""):
        schema = resolved(schema)
        for name, part in schema.get("properties", {}).items():
            yield f"{at}/{name}"
            yield from pointers(part, f"{at}/{name}")
        if "items" in schema:
            yield from pointers(schema["items"], f"{at}/-")
        for one in schema.get("oneOf", []):
            yield from pointers(one, at)

    kinds = ("Sweep", "ModalAnalysis", "Study", "CaseStudy", "Branches", "RunUp", "Campaign", "Impeller")
    asked = sorted({pointer for kind in kinds for pointer in pointers(schemas[f"{kind}Request"])} - {"/model", "/preset"})
    page = new_page(service.url)
    lacking = page.evaluate("async (asked) => { const { wordsOf } = await import('/page/lib/form/words.js'); return asked.filter((one) => !wordsOf(one)); }", asked)
    assert len(asked) > 200 and [one for one in lacking if "_" in one.rsplit("/", 1)[1]] == []


def test_an_accuracy_gives_the_settings_back_in_whose_place_it_was(service, model, new_page):
    page = new_page(f"{service.url}/#/sweep?model={model}", expected=["422"])
    page.get_by_text("The request as JSON").click()
    text = page.get_by_label("Request; the form follows what you write")
    text.wait_for()
    request = json.loads(text.input_value())
    settings = {"modes_per_speed": 7, "integration": {"steps_per_revolution": 500, "revolutions": 20}}
    text.fill(json.dumps(request | settings))
    page.get_by_label("1 %", exact=False).first.check()
    chosen = json.loads(text.input_value())
    assert chosen["accuracy"] == {"target": 0.01} and chosen["modes_per_speed"] == "auto"
    assert chosen["integration"] == {"revolutions": 20}
    page.get_by_label("as the settings below say").check()
    assert json.loads(text.input_value()) == request | settings
    # What no field can show is shown as it is, and the service says what is wrong with it.
    text.fill(json.dumps(request | {"tags": "one"}))
    page.get_by_role("textbox", name="Tags").wait_for(state="attached")
    assert page.get_by_label("Tags", exact=True).input_value() == '"one"'
    page.locator("[aria-invalid=true]").first.wait_for(state="attached")


def test_a_march_is_of_so_many_revolutions_or_until_it_repeats(service, model, new_page):
    page = new_page(f"{service.url}/#/sweep?model={model}")
    page.get_by_text("The request as JSON").click()
    text = page.get_by_label("Request; the form follows what you write")
    text.wait_for()
    page.get_by_text("Accuracy", exact=True).first.click()
    page.get_by_label("Time integration").check()
    field = page.get_by_label("Revolutions", exact=True)
    assert field.get_attribute("placeholder") == "until it repeats"
    for words, value in [("30", {"revolutions": 30}), ("until it repeats", {"revolutions": "auto"}), ("", {})]:
        field.fill(words)
        assert json.loads(text.input_value())["integration"] == value
    text.fill(json.dumps(json.loads(text.input_value()) | {"integration": {"revolutions": "auto"}}))
    assert page.get_by_label("Revolutions", exact=True).input_value() == "until it repeats"


def test_a_choice_keeps_the_focus(service, swept, new_page):
    page = new_page(f"{service.url}/#/jobs/{swept}?view=map")
    page.get_by_label("Amplitude").focus()
    page.get_by_label("Amplitude").select_option("linear")
    page.wait_for_url("**scale=linear")
    page.locator(".figure .main-svg").first.wait_for()
    page.locator("main:not([aria-busy])").wait_for()
    assert page.get_by_label("Amplitude").evaluate("(one) => one === document.activeElement && one.value === 'linear'")


def test_a_speed_of_which_nothing_was_recorded_is_recorded(service, swept, new_page):
    page = new_page(f"{service.url}/#/jobs/{swept}?view=point&speed=0")
    page.get_by_role("button", name="Record this speed").click()
    page.wait_for_url(re.compile(f"#/jobs/(?!{swept})"))
    job = open_job(page)
    assert service.finish(job)["status"] == "successful"
    page.locator(".figure .main-svg").first.wait_for()


def test_a_form_says_what_branches_take(service, swept, model, new_page):
    page = new_page(f"{service.url}/#/sweep?model={model}&kind=branches")
    plan = page.get_by_role("status", name="Plan")
    plan.get_by_text("at least 5").wait_for()
    plan.get_by_text("exact_modal: ").wait_for()


def test_critical_speeds_lead_to_what_looks_closer(service, swept, new_page):
    worst = service.call("GET", f"/v1/jobs/{swept}/critical-speeds/wheel")["critical_speeds"][0]
    page = new_page(f"{service.url}/#/jobs/{swept}?view=critical")
    table = page.get_by_role("region", name="Critical speeds of the wheel")
    table.get_by_role("button", name=re.compile("^Follow branches from")).first.click()
    page.get_by_role("dialog").get_by_role("button", name="Close").click()
    table.get_by_role("link", name=re.compile("^Run-up through")).first.click()
    at = worst["speed_rad_s"] * 9.549296585513721

    def asked(field):
        page.get_by_text("The request as JSON").click()
        request = json.loads(page.get_by_label("Request; the form follows what you write").input_value())
        assert request["scene"]["casing"]["lobes"]["count"] == 2
        return request[field]

    speed = asked("speed")
    assert abs(speed["from"] - 0.9 * at) <= 0.5 and abs(speed["to"] - 1.1 * at) <= 0.5
    page.go_back()
    table.get_by_role("link", name=re.compile("^Campaign at")).first.click()
    speeds = asked("speeds")
    assert abs(speeds["from"] - 0.98 * at) <= 0.5 and abs(speeds["to"] - 1.02 * at) <= 0.5


def test_branches_are_followed_from_a_speed_of_a_sweep(service, model, new_page):
    integration = {"revolutions": 30, "window_revolutions": 10}
    request = sweep_of(model, name="damped", scene=damped(), speeds={"from": 19000, "to": 21000, "count": 5, "unit": "rpm"}, integration=integration, modes_per_speed=3, record={})
    swept = service.call("POST", "/v1/sweeps", request)["id"]
    assert service.finish(swept)["status"] == "successful"
    page = new_page(f"{service.url}/#/jobs/{swept}?view=point&speed=2", expected=["422"])
    page.get_by_role("button", name=re.compile("^Follow branches from")).click()
    dialog = page.get_by_role("dialog")
    assert dialog.get_by_label("From").input_value() == "18000" and dialog.get_by_label("To", exact=True).input_value() == "22000"
    dialog.get_by_label("What changes").select_option("damping")
    assert dialog.get_by_label("From").input_value() == "0.5"
    dialog.get_by_label("What changes").select_option("speed")
    # What is not possible is said, and can be mended.
    dialog.get_by_label("From").fill("20500")
    dialog.get_by_label("To", exact=True).fill("20100")
    dialog.get_by_role("button", name="Follow").click()
    dialog.get_by_text("where the branch begins").first.wait_for()
    dialog.get_by_label("From").fill("19900")
    dialog.get_by_role("button", name="Follow").click()
    page.wait_for_url(re.compile(f"#/jobs/(?!{swept})"))
    job = open_job(page)
    page.get_by_text("done", exact=True).wait_for(timeout=120_000)
    page.locator(".figure .main-svg").first.wait_for()
    page.get_by_text("followed to their ends").wait_for()
    asked = service.call("GET", f"/v1/jobs/{job}")["request"]
    assert asked["sweep"]["scene"]["damping"] == {"modal_ratio": 0.05} and asked["along"]["parameter"] == "speed"
    # The speeds of the sweep are beside, those within the range.
    assert page.get_by_label("Sweep beside").input_value() == swept
    names = page.evaluate("document.querySelector('.figure').data.map((trace) => trace.name)")
    assert any(name.startswith("branch 1") for name in names) and any("sweep" in name for name in names), names
    with page.expect_download() as file:
        page.get_by_role("button", name="csv").click()
    lines = open(file.value.path()).read().splitlines()
    assert any(line.startswith("branch,") for line in lines)
    page.get_by_role("button", name="Run ").click()
    page.wait_for_url(re.compile(f"#/jobs/(?!{job})"))
    again = service.call("GET", f"/v1/jobs/{open_job(page)}")["request"]
    assert abs(again["along"]["from"] / asked["along"]["from"] - 1) < 1e-9 and again["sweep"]["scene"] == asked["sweep"]["scene"]


def test_branches_are_seen_while_they_grow(service, model, new_page):
    long = branches_of(model) | {"name": "long branch", "along": {"parameter": "clearance", "from": 0.5, "to": 2.0}}
    job = service.call("POST", "/v1/branches", long)["id"]
    page = new_page(f"{service.url}/#/jobs/{job}")
    page.locator(".figure .main-svg").first.wait_for(timeout=120_000)
    page.get_by_text(re.compile(r"point(s)? on 1 branch")).first.wait_for()
    assert page.evaluate("document.querySelector('.figure').layout.xaxis.title.text").startswith("clearance / that of the scene")
    service.call("DELETE", f"/v1/jobs/{job}?cancel_only=true")


def test_a_form_says_what_run_ups_take(service, swept, model, new_page):
    page = new_page(f"{service.url}/#/sweep?model={model}&kind=run_up", expected=["422"])
    plan = page.get_by_role("status", name="Plan")
    runs = plan.get_by_text(re.compile(r"rad/s² \(.* rpm/s\): .* revolutions, .* segments of one speed, .* steps"))
    runs.first.wait_for()
    assert runs.count() == 3
    rates = page.get_by_label("Rates")
    rates.fill(rates.input_value().split(",")[0])
    runs.nth(1).wait_for(state="detached")
    assert runs.count() == 1
    # A part that is switched on begins with what suits the wheel.
    page.get_by_text("Effects", exact=True).click()
    page.get_by_role("checkbox", name="Friction").check()
    assert page.get_by_label("Coefficient μ").input_value() == "0.15"
    # What is not possible is said at its field.
    page.get_by_label("From").fill("0")
    page.locator("[aria-invalid=true]").first.wait_for()
    assert page.get_by_label("From").get_attribute("aria-invalid") == "true"


def test_a_wheel_is_run_up_seen_and_run_up_again(service, swept, model, new_page):
    page = new_page(f"{service.url}/#/sweep?model={model}&kind=run_up")
    page.get_by_text("The request as JSON").click()
    text = page.get_by_label("Request; the form follows what you write")
    text.wait_for()
    text.fill(json.dumps(run_ups_of(model) | {"name": "up", "sensors": [{"contact_node": 0, "component": "normal", "sector": 0}, {"contact_node": 0, "component": "axial", "sector": 1}]}))
    assert page.get_by_label("Rates").input_value() == "10000, 40000"
    page.get_by_role("button", name="Start").click()
    job = open_job(page)
    page.get_by_text("done", exact=True).wait_for(timeout=120_000)
    page.locator(".figure .main-svg").first.wait_for()
    page.get_by_text(re.compile("2 runs, .* frames. Limit 0.5 mm, for every sensor: .*rate.*")).wait_for()
    found = service.call("GET", f"/v1/jobs/{job}/run-ups")
    rows = page.get_by_role("region", name="Runs", exact=True).locator("tbody tr")
    assert rows.count() == 2
    largest = found["runs"][0]["end"]["largest"][0]["displacement"]
    assert abs(float(rows.nth(0).locator("td").nth(3).inner_text()) / largest - 1) < 1e-3
    assert page.get_by_role("region", name="What the runs are worth").locator("tbody tr").count() == 2
    # The speeds of a sweep are beside, those within the range.
    page.get_by_label("Sweep beside").select_option(swept)
    page.wait_for_url(f"**sweep={swept}")
    page.get_by_text("Dots are the speeds of").wait_for()
    page.locator(".figure .main-svg").first.wait_for()
    names = page.evaluate("document.querySelector('.figure').data.map((trace) => trace.name)")
    assert any("sweep" in name for name in names if name), names
    with page.expect_download() as file:
        page.get_by_role("button", name="csv").click()
    assert open(file.value.path()).read().startswith("run,rate_rpm_s,")
    # A run opens its spectrogram.
    page.get_by_role("region", name="Runs", exact=True).get_by_role("button", name="2", exact=True).click()
    page.wait_for_url("**view=spectrogram**")
    assert page.get_by_label("Run", exact=True).input_value() == "1"
    page.locator(".figure .main-svg").first.wait_for()
    assert page.evaluate("document.querySelector('.figure').layout.meta.units.y") == "engine_order"
    page.get_by_label("Upwards").select_option("hz")
    page.wait_for_url("**over=hz**")
    page.get_by_label("Sensor").select_option("1")
    page.wait_for_url("**sensor=1**")
    page.locator(".figure .gtitle", has_text="axial").wait_for()
    assert page.evaluate("document.querySelector('.figure').layout.meta.units.y") == "Hz"
    with page.expect_download() as file:
        page.get_by_role("button", name="npz").click()
    assert file.value.suggested_filename == f"{job}-spectrogram-1.npz"
    page.get_by_role("link", name="Run-ups").click()
    page.get_by_role("heading", name="What these numbers are worth").wait_for()
    # The same again, and otherwise: in the unit in which it was asked for.
    page.get_by_role("button", name="Run up again").click()
    page.wait_for_url(re.compile(f"#/jobs/(?!{job})"))
    again, first = (service.call("GET", f"/v1/jobs/{one}")["request"] for one in (open_job(page), job))
    assert again == first
    page.get_by_role("link", name="As up, but").click()
    page.get_by_label("Rates").wait_for()
    assert [page.get_by_label(name, exact=True).input_value() for name in ("Unit", "From", "To", "Rates", "Held before")] == ["rpm", "19000", "21000", "10000, 40000", "0.05"]


def test_a_run_up_through_points_has_one_run(service, model, new_page):
    points = [{"time_s": 0, "speed": 300}, {"time_s": 0.05, "speed": 350}, {"time_s": 0.1, "speed": 340}]
    request = run_ups_of(model) | {"name": "by points", "speed": {"unit": "hz", "points": points, "course": "smooth"}}
    job = service.call("POST", "/v1/run-ups", request)["id"]
    assert service.finish(job)["status"] == "successful"
    page = new_page(f"{service.url}/#/jobs/{job}")
    page.get_by_role("region", name="Runs", exact=True).get_by_text("through points").wait_for()
    page.goto(f"{service.url}/#/jobs/{job}?view=spectrogram")
    page.locator(".figure .main-svg").first.wait_for()
    assert page.get_by_label("Run", exact=True).count() == 0
    page.get_by_role("link", name="As by points, but").click()
    page.get_by_role("group", name="Points 3").get_by_label("Speed").wait_for()
    assert page.get_by_label("Unit", exact=True).input_value() == "hz"
    assert [page.get_by_role("group", name=f"Points {k}").get_by_label("Speed").input_value() for k in (1, 2, 3)] == ["300", "350", "340"]
    assert page.get_by_label("Course").input_value() == "smooth"


def test_run_ups_are_seen_while_they_grow(service, model, new_page):
    long = run_ups_of(model) | {"name": "long run-up"}
    long["speed"] = long["speed"] | {"rates": [10, 10000]}
    job = service.call("POST", "/v1/run-ups", long)["id"]
    page = new_page(f"{service.url}/#/jobs/{job}")
    page.get_by_text(re.compile("frames so far")).wait_for(timeout=120_000)
    page.locator(".figure .main-svg").first.wait_for()
    page.get_by_text("How fast one must pass to stay below 0.5 mm is said when all have ended.").wait_for()
    page.get_by_role("region", name="Runs", exact=True).get_by_text("under way").wait_for()
    page.goto(f"{service.url}/#/jobs/{job}?view=spectrogram&run=1")
    page.get_by_text("Nothing of this run is there yet.").wait_for()
    page.get_by_label("Run", exact=True).select_option("0")
    page.locator(".figure .main-svg").first.wait_for()
    service.call("DELETE", f"/v1/jobs/{job}?cancel_only=true")


def test_amplitudes_are_compared_in_one_unit(service, swept, new_page):
    """The same wheel in metres."""
    units = {"length": "m", "force": "N", "time": "s", "mass": "kg"}
    generation = service.call("POST", "/v1/models", {"name": "in metres", "units": units})["id"]
    request = sweep_of(service.finish(generation)["model"], name="in metres", record={})
    request["scene"]["casing"] = {
        "clearance": {"leading": 0.30e-3, "trailing": 0.22e-3},
        "lobes": {"count": 2, "amplitude": 0.425e-3, "width_rad": 0.35},
    }
    job = service.call("POST", "/v1/sweeps", request)["id"]
    assert service.finish(job)["status"] == "successful"
    page = new_page(f"{service.url}/#/compare?jobs={swept},{job}")
    page.get_by_text("amplitudes in mm").wait_for()
    page.locator(".figure .main-svg").first.wait_for()
    apart = page.get_by_role("region", name="What differs in the requests")
    row = apart.locator("tr", has_text="Casing › Lobes › Height")
    # Both as they were asked for: no unit is said that is not that of both.
    assert row.locator("td").all_inner_texts() == ["Casing › Lobes › Height", "0.425", "0.000425"]
    assert apart.locator("tr", has_text="(m)").locator("td").first.inner_text() == "Model"
    levels = page.evaluate("document.querySelector('.figure').data.map((trace) => trace.y)")
    assert all(abs(a - b) < 1e-3 * max(levels[0]) for a, b in zip(*levels, strict=True))


def test_columns_of_a_measurement_are_found_by_their_names(service, swept, tmp_path, new_page):
    page = new_page(f"{service.url}/#/compare?jobs={swept}")
    page.locator(".figure .main-svg").first.wait_for()
    measured = tmp_path / "measured.csv"

    def read(text, words, role="status"):
        measured.write_text(text, encoding="utf-8")
        page.locator("input[type=file]").set_input_files(measured)
        page.locator(f"[role={role}]", has_text=re.compile(words)).wait_for()

    read("a,b\n1,2\n", "Nothing is taken", "alert")
    read("amplitude_um,speed_rad_s,frequency_Hz\n50,1600,2000\n", "15279 to 15279 rpm.*in rad/s.*“frequency_Hz”.*in um")
    read("Drehzahl [1/min];Frequenz [Hz];Amplitude [µm]\n17000;1500,5;3\n", "17000 to 17000 rpm.*in rpm.*in µm")
    read("14000,800,0.1\n22000,1200,0.3\n", "2 measured points, 14000 to 22000 rpm")


def test_a_measured_casing_comes_from_a_table(service, model, tmp_path, new_page):
    """Into the request, with what stands out of it; and, once swept, around the wheel."""
    import math

    table = tmp_path / "casing.csv"
    heights = [0.42 * max(0.0, math.cos(math.radians(4 * i))) ** 4 for i in range(180)]
    heights[7] += 0.05
    table.write_text("angle_deg,0\n" + "".join(f"{2 * i},{height}\n" for i, height in enumerate(heights)), encoding="utf-8")
    page = new_page(f"{service.url}/#/sweep?model={model}", expected=["422"])
    page.get_by_label("Table of a measured casing (CSV)").set_input_files(table)
    page.get_by_text(re.compile("180 angles, 1 lines; around: periodic cubic splines")).wait_for()
    page.get_by_text(re.compile("stands alone: .* at 14°, 0 of the chord")).wait_for()
    page.get_by_text("The request as JSON").click()
    text = page.get_by_label("Request; the form follows what you write")
    kept = json.loads(text.input_value())["scene"]["casing"]["measured"]
    assert len(kept["angles_rad"]) == 180 and kept["heights"] == [heights]
    table.write_text("angle_deg,0\n1,x\n", encoding="utf-8")
    page.get_by_label("Table of a measured casing (CSV)").set_input_files(table)
    page.get_by_text(re.compile("casing.csv: line 2")).wait_for()


def test_a_token_opens_the_service_for_this_tab(tmp_path, new_page):
    import subprocess

    from service import PROGRAM

    tokens = tmp_path / "tokens"
    made = subprocess.run([PROGRAM, "token", "new", "--tokens", tokens, "--owner", "alice"], capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    token = made.stdout.split()[-1]
    own = Service(tmp_path, "--tokens", str(tokens))
    try:
        page = new_page(f"{own.url}/#/jobs", expected=["401"])
        page.get_by_label("Token").fill("wrong")
        page.get_by_role("button", name="Sign in").click()
        page.get_by_role("alert").wait_for()
        page.get_by_label("Token").fill(token)
        page.get_by_role("button", name="Sign in").click()
        page.get_by_role("heading", name="Jobs").wait_for()
        page.reload()
        page.get_by_role("heading", name="Jobs").wait_for()
        assert page.evaluate("localStorage.length === 0 || !Object.values(localStorage).some((value) => value.length > 20)")
        page.get_by_role("button", name="Sign out").click()
        page.get_by_label("Token").wait_for()
    finally:
        own.stop()


def test_a_wheel_turns_by_mouse_and_keys(service, model, new_page):
    page = new_page(f"{service.url}/#/models/{model}")
    stage = page.locator("canvas.stage")
    stage.wait_for()
    stage.scroll_into_view_if_needed()
    page.wait_for_timeout(500)

    def frames():
        return int(stage.get_attribute("data-frames"))

    stage.focus()
    before, picture = frames(), stage.screenshot()
    page.wait_for_timeout(500)
    assert frames() == before, "what rests is not drawn again"
    page.keyboard.press("ArrowRight")
    page.wait_for_timeout(500)
    assert frames() > before and stage.screenshot() != picture
    page.keyboard.press("0")
    page.wait_for_timeout(500)
    assert stage.screenshot() == picture
