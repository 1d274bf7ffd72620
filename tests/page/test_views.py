"""Every view, wide and light as well as narrow and dark: nothing in the console, no serious finding of axe, nothing wider than the window."""

import pytest
from conftest import WINDOWS, branches_of, judged, run_ups_of, sweep_of

VIEWS = {
    "home": "#/home",
    "models": "#/models",
    "model": "#/models/{model}",
    "modes": "#/models/{model}?view=modes",
    "reductions": "#/models/{model}?view=reductions",
    "generate": "#/generate",
    "sweep": "#/sweep?model={model}",
    "sweep-as": "#/sweep?as={swept}",
    "study": "#/study?model={model}",
    "jobs": "#/jobs",
    "verdict": "#/jobs/{judged}",
    "verdict-without-ranges": "#/jobs/{swept}",
    "map": "#/jobs/{swept}?view=map",
    "point": "#/jobs/{swept}?view=point&speed=4",
    "campbell": "#/jobs/{swept}?view=campbell",
    "modal-analysis": "#/jobs/{modal}",
    "backbones": "#/jobs/{modal}?view=backbones",
    "interference": "#/jobs/{modal}?view=interference&speed=20000&lobes=2&from=18000&to=22000",
    "critical": "#/jobs/{swept}?view=critical",
    "critical-sensor": "#/jobs/{swept}?view=critical&of=sensor",
    "forces": "#/jobs/{swept}?view=forces",
    "stress": "#/jobs/{swept}?view=stress",
    "fields": "#/jobs/{swept}?view=fields&speed=4",
    "fields-unrecorded": "#/jobs/{judged}?view=fields",
    "stress-unrecorded": "#/jobs/{judged}?view=stress",
    "credentials": "#/jobs/{swept}?view=credentials",
    "downloads": "#/jobs/{swept}?view=downloads",
    "work-precision": "#/jobs/{study}",
    "histories": "#/jobs/{case}",
    "branches": "#/jobs/{branches}?sweep={swept}",
    "branches-new": "#/sweep?model={model}&kind=branches",
    "branches-as": "#/sweep?as={branches}",
    "run_ups": "#/jobs/{run_ups}?sweep={swept}",
    "run_ups-spectrogram": "#/jobs/{run_ups}?view=spectrogram&run=1",
    "run_ups-spectrogram-hz": "#/jobs/{run_ups}?view=spectrogram&over=hz&scale=linear",
    "run_up-new": "#/sweep?model={model}&kind=run_up",
    "run_up-as": "#/sweep?as={run_ups}",
    "campaign": "#/jobs/{campaign}",
    "campaign-new": "#/sweep?model={model}&kind=campaign",
    "campaign-as": "#/sweep?as={campaign}",
    "compare": "#/compare?jobs={swept},{swept_as_well}",
    "sign-in": "#/sign-in",
    "nowhere": "#/nowhere",
}


@pytest.fixture(scope="session")
def places(service, model, swept):
    again = sweep_of(model, speeds={"from": 14000, "to": 34000, "count": 8, "unit": "rpm"})
    job = service.call("POST", "/v1/sweeps", again)["id"]
    assert service.finish(job)["status"] == "successful"
    quick = {"revolutions": 30, "window_revolutions": 10}
    scene = again["scene"]
    grid = {"kept_modes": [5], "modes_per_speed": [3], "steps_per_revolution": [4000, 8000], "schemes": ["central_differences", "exact_modal"]}
    study = {"model": model, "speeds": {"values": [20000], "unit": "rpm"}, "scene": scene, "integration": quick, "grid": grid}
    case = {"model": model, "speed": {"value": 20000, "unit": "rpm"}, "scene": scene, "integration": quick, "record": {"revolutions": [28, 30]}}
    ranges = [{"name": "cruise", "from": 18000, "to": 24000, "unit": "rpm", "separation_percent": 5}]
    judged = sweep_of(model, operation={"ranges": ranges}, limits={"tip_motion": 0.25, "node_force": 4000}, control_speeds=1, record={})
    ended = {"model": model, "swept": swept, "swept_as_well": job, "judged": service.call("POST", "/v1/sweeps", judged)["id"]}
    assert service.finish(ended["judged"])["status"] == "successful"
    branches = branches_of(model)
    parameter = {"name": "damping", "at": ["/scene/damping/modal_ratio"], "from": 0.005, "to": 0.02, "levels": 2}
    campaign = case | {"speeds": again["speeds"], "parameters": [parameter], "design": {"kind": "grid"}, "limit": 0.5}
    del campaign["speed"], campaign["record"]
    modal = {"model": model, "modes_per_speed": 3, "speeds": {"from": 0, "to": 26000, "count": 9, "unit": "rpm"}, "backbones": {"nodal_diameters": [0, 1, 2]}}
    asked = (
        ("modal", "/v1/modal-analyses", modal),
        ("study", "/v1/studies", study),
        ("case", "/v1/case-studies", case),
        ("branches", "/v1/branches", branches),
        ("run_ups", "/v1/run-ups", run_ups_of(model)),
        ("campaign", "/v1/campaigns", campaign),
    )
    for name, path, request in asked:
        ended[name] = service.call("POST", path, request)["id"]
        assert service.finish(ended[name])["status"] == "successful"
    return ended


@pytest.mark.parametrize(("width", "theme"), WINDOWS)
@pytest.mark.parametrize("view", VIEWS)
def test_view(service, places, new_page, pictures, view, width, theme):
    page = new_page(f"{service.url}/{VIEWS[view].format(**places)}", width=width, theme=theme)
    page.get_by_role("main").get_by_role("heading", level=1).wait_for()
    page.wait_for_load_state("networkidle")
    page.locator("main:not([aria-busy])").wait_for()
    judged(page, pictures / f"{view}-{width}-{theme}.png")
