"""Models and jobs, against the real program."""

from __future__ import annotations

import json
import pickle
import subprocess
import sys
import threading
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from conftest import sweep_of

import rubmap
from rubmap.progress import progress
from rubmap.service import Service

#: Id of a job that no service has.
JOB = "00000000-0000-7000-8000-000000000001"


def test_a_plan_starts_nothing(client: rubmap.Client, model: rubmap.Model) -> None:
    before = len(client.jobs())
    plan = client.sweep(sweep_of(model.id)).plan()
    assert {effect["name"] for effect in plan["effects"] if effect["on"]} >= {"contact", "casing"}
    assert len(client.jobs()) == before


def test_a_plan_prints_as_a_table_and_is_a_dictionary(client: rubmap.Client, model: rubmap.Model) -> None:
    plan = client.sweep(sweep_of(model.id)).plan()
    lines = dict(line.split(maxsplit=1) for line in str(plan).splitlines())
    assert lines["speeds"].startswith("6, ") and "friction" in lines["off"] and "unknowns" in lines["reduction"]
    assert type(plan.raw) is dict and json.loads(json.dumps(plan)) == plan.raw
    shown = plan._repr_html_()
    assert shown.count("<tr>") == len(str(plan).splitlines()) and "<td" in shown


def test_progress_where_nobody_watches_is_some_lines(
    capsys: pytest.CaptureFixture[str], client: rubmap.Client, model: rubmap.Model
) -> None:
    with progress("sweep", True) as lines:
        for done in range(100):
            lines.show({"progress": done, "status": "running", "phase": "speeds"})
        lines.show({"progress": 100, "status": "successful"})
    said = capsys.readouterr().err.splitlines()
    assert [line.split("%")[0] for line in said] == [f"sweep: {done:3} " for done in range(0, 101, 10)]
    assert "speeds" in said[3] and "successful" in said[-1]
    # Where the percentage stands still, a line for each phase.
    with progress("sweep", True) as lines:
        for phase in [
            "40 of 40 speeds finished; speeds around peaks follow",
            *(f"added around peaks: {n} of 9" for n in range(9)),
            "control runs: 0 of 5",
        ]:
            lines.show({"progress": 99, "status": "running", "phase": phase})
    said = capsys.readouterr().err.splitlines()
    assert [line.split(", ")[1] for line in said] == [
        "40 of 40 speeds finished; speeds around peaks follow",
        "added around peaks: 0 of 9",
        "control runs: 0 of 5",
    ]
    client.sweep(sweep_of(model.id, record={})).submit().wait()
    said = capsys.readouterr().err.splitlines()
    assert 1 <= len(said) <= 20 and all(line.startswith("sweep: ") for line in said), said
    with progress("sweep", False) as nothing:
        nothing.show({"progress": 1, "status": "running"})
    assert capsys.readouterr().err == ""


def test_jobs_and_models_show_themselves_in_notebooks(swept: rubmap.Sweep, model: rubmap.Model) -> None:
    shown = swept._repr_html_()
    assert "successful, 100 %" in shown and f"/#/jobs/{swept.id}" in shown and ">undecided</span>" in shown
    assert "for tests" in model._repr_html_() and model.id in model._repr_html_()
    # A service that is gone is not waited for, and a name is text.
    gone = rubmap.Sweep(Service("http://127.0.0.1:9"), {}, JOB)
    assert gone._repr_html_() == f"&lt;rubmap sweep {JOB}&gt;"
    assert "submitted" in rubmap.Sweep(Service("http://127.0.0.1:9"), {})._repr_html_()
    named = mocked(lambda _: httpx.Response(200, json={"status": "running", "progress": 1, "name": "<b>"}))
    assert "&lt;b&gt;" in rubmap.Sweep(named.service, {}, JOB)._repr_html_()


def test_a_refusal_says_where(client: rubmap.Client, model: rubmap.Model) -> None:
    request = sweep_of(model.id)
    request["scene"] = request["scene"] | {"damping": {"modal_ratio": -1}}
    with pytest.raises(rubmap.Refusal) as refused:
        client.sweep(request).submit()
    assert refused.value.status == 422
    assert refused.value.errors[0]["pointer"] == "/scene/damping/modal_ratio"
    assert "/scene/damping/modal_ratio" in str(refused.value)


def test_a_bad_package_is_refused_by_file(client: rubmap.Client, tmp_path: Path) -> None:
    (tmp_path / "bad.zip").write_bytes(b"PK no zip")
    with pytest.raises(rubmap.Refusal) as refused:
        client.upload(tmp_path / "bad.zip")
    assert refused.value.status == 422
    with pytest.raises(FileNotFoundError):
        client.upload(tmp_path / "nothing.zip")


def test_jobs_are_found_again(client: rubmap.Client, swept: rubmap.Sweep, model: rubmap.Model) -> None:
    assert swept.id is not None
    again = client.job(swept.id)
    assert isinstance(again, rubmap.Sweep) and again.request["speeds"]["count"] == 6
    assert again.plan()["settings"]["speeds"] == swept.request["speeds"]
    listed = client.jobs(kind="sweep", model=model.id)
    assert swept.id in {job.id for job in listed} and listed[0].request["model"] == model.id
    assert len(client.jobs(limit=1)) == 1
    client.job(swept.id[:30])
    with pytest.raises(LookupError, match="none of the jobs"):
        client.job("../models")
    with pytest.raises(LookupError, match="may be"):
        client.job(swept.id[:1])
    assert client.model(model.id[:10]).id == client.model("for tests").id == model.id
    assert model.id in {each.id for each in client.models(name="for tests")}
    with pytest.raises(ValueError, match="submitted already"):
        swept.submit()
    with pytest.raises(ValueError, match="submit"):
        client.sweep(sweep_of(model.id)).wait()


def test_a_job_that_is_cancelled_says_so_and_keeps_nothing_else_from_ending(
    client: rubmap.Client, model: rubmap.Model
) -> None:
    long = client.sweep(sweep_of(model.id, integration={"revolutions": 5000, "window_revolutions": 10})).submit()
    threading.Timer(0.5, long.cancel).start()
    with pytest.raises(rubmap.JobFailed) as ended:
        long.wait(progress=False)
    assert ended.value.status == "dismissed"
    long.cancel()
    assert long.status == "dismissed"
    long.delete()
    with pytest.raises(rubmap.Refusal) as gone:
        _ = long.status
    assert gone.value.status == 404


def test_waiting_ends_in_time(client: rubmap.Client, model: rubmap.Model) -> None:
    long = client.sweep(sweep_of(model.id, integration={"revolutions": 20000, "window_revolutions": 10})).submit()
    # The stream of events is silent for longer.
    begin = time.monotonic()
    with pytest.raises(TimeoutError):
        long.wait(progress=False, timeout=0.5)
    assert time.monotonic() - begin < 10.0
    assert long.points().empty and "speed_rpm" in long.points()
    with warnings.catch_warnings(action="error"):
        rubmap.plot.interaction_map(long.interaction_map())
    long.cancel()


def test_numbers_of_numpy_are_numbers(client: rubmap.Client, model: rubmap.Model) -> None:
    grid: Any = {"values": np.linspace(16000, 26000, 3), "unit": "rpm"}
    plan = client.sweep(sweep_of(model.id, speeds=grid, modes_per_speed=np.int64(3))).plan()
    assert plan["settings"]["speeds"]["values"] == [16000.0, 21000.0, 26000.0]
    with pytest.raises(ValueError, match="/speeds/values/1"):
        client.sweep(sweep_of(model.id, speeds={"values": [1.0, np.nan], "unit": "rpm"})).plan()


def test_what_jobs_and_models_are_called_is_changed(
    client: rubmap.Client, swept: rubmap.Sweep, model: rubmap.Model
) -> None:
    state = swept.label(name="first", tags=["a", "b"]).state
    assert (state["name"], state["tags"]) == ("first", ["a", "b"])
    assert "name" not in swept.label(name=None).state and swept.state["tags"] == ["a", "b"]
    assert model.label(notes="of the demo").facts["notes"] == "of the demo"
    assert model.facts["name"] == "for tests"


def test_what_is_lost_on_the_way_is_made_once() -> None:
    """The first answer is lost after the service has got the request, the second says that there is no room."""
    keys: list[str] = []

    def answer(request: httpx.Request) -> httpx.Response:
        keys.append(request.headers["idempotency-key"])
        if len(keys) == 1:
            raise httpx.ReadError("lost")
        if len(keys) == 2:
            return httpx.Response(503, headers={"retry-after": "0"}, json={"title": "no room"})
        return httpx.Response(201, json={"id": "1"})

    service = Service("http://nowhere", patience=5.0)
    service._http = httpx.Client(base_url="http://nowhere", transport=httpx.MockTransport(answer))
    assert service.post("/v1/sweeps", {}, "one key")["id"] == "1"
    assert len(keys) == 3 and len(set(keys)) == 1


def mocked(answer: Callable[[httpx.Request], httpx.Response], patience: float = 5.0) -> rubmap.Client:
    """A client whose requests ``answer`` answers."""
    client = rubmap.Client("http://nowhere", patience=patience)
    client.service._http = httpx.Client(base_url="http://nowhere", transport=httpx.MockTransport(answer))
    return client


def test_a_submission_that_stayed_broken_is_the_same_when_it_is_repeated() -> None:
    keys: list[str] = []

    def answer(request: httpx.Request) -> httpx.Response:
        keys.append(request.headers["idempotency-key"])
        if len(keys) == 1:
            raise httpx.ReadError("lost")
        return httpx.Response(202, json={"id": "1"})

    client = mocked(answer, patience=0.0)
    request: Any = {"model": "m"}
    job = client.sweep(request)
    with pytest.raises(rubmap.Unreachable):
        job.submit()
    assert job.submit().id == "1"
    assert keys[0] == keys[1] and client.sweep(request)._key != keys[0]


def test_what_stands_between_is_put_up_with() -> None:
    """A gateway that cannot reach the service for a while, and keeps events to itself."""
    asked: list[str] = []

    def answer(request: httpx.Request) -> httpx.Response:
        asked.append(request.url.path)
        if len(asked) == 1:
            return httpx.Response(502, text="<html>")
        if request.url.path.endswith("/events"):
            return httpx.Response(200, text="")
        return httpx.Response(200, json={"id": JOB, "kind": "sweep", "status": "successful", "progress": 100})

    job = mocked(answer).job(JOB)
    asked.clear()
    asked.append("")
    job.wait(progress=False, timeout=3.0)
    assert asked[1:] == [f"/v1/jobs/{JOB}/events", f"/v1/jobs/{JOB}"]


def test_a_deletion_whose_answer_is_lost_is_done() -> None:
    asked: list[str] = []

    def answer(request: httpx.Request) -> httpx.Response:
        asked.append(str(request.url))
        if len(asked) == 1:
            raise httpx.ReadError("lost")
        return httpx.Response(404, json={"title": "There is no such job"})

    client = mocked(answer)
    client.service.delete("/v1/jobs/1")
    with pytest.raises(rubmap.Refusal):
        client.service.delete("/v1/jobs/1")


def test_a_time_to_try_again_may_be_a_date() -> None:
    answers = [
        httpx.Response(503, headers={"retry-after": "Wed, 21 Oct 2015 07:28:00 GMT"}, json={}),
        httpx.Response(503, headers={"retry-after": "soon"}, json={}),
        httpx.Response(200, json={"version": "1"}),
    ]
    assert mocked(lambda _: answers.pop(0)).version() == {"version": "1"}


def test_another_server_at_the_address_is_said_to_be_none_of_ours() -> None:
    page = httpx.Response(200, headers={"content-type": "text/html"}, text="<h1>")
    with pytest.raises(rubmap.RubmapError, match="text/html.*no rubmap service"):
        mocked(lambda _: page).version()


def test_a_token_is_not_shown() -> None:
    assert (
        rubmap.Client("http://nowhere", token="rubmap_1\n").service._http.headers["authorization"] == "Bearer rubmap_1"
    )
    with pytest.raises(ValueError) as refused:
        rubmap.Client("http://nowhere", token="rubmap_1\nrubmap_2")
    assert "rubmap_1" not in str(refused.value)


def test_errors_go_to_other_processes() -> None:
    job = {"id": "1", "status": "failed", "error": {"title": "It failed", "detail": "so"}}
    refusal = rubmap.Refusal(422, {"title": "no", "errors": [{"pointer": "/a", "detail": "b"}]})
    for error in (refusal, rubmap.JobFailed(job)):
        again = pickle.loads(pickle.dumps(error))
        assert type(again) is type(error) and str(again) == str(error) and vars(again) == vars(error)


def test_a_local_service_is_nobody_else_s(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """What the environment says of proxies, logs and other services is not for it."""
    for name, value in {
        "HTTP_PROXY": "http://127.0.0.1:9", "RUST_LOG": "off", "RUBMAP_TOKENS": str(tmp_path), "RUBMAP_TOKEN": "rubmap_1",
    }.items():  # fmt: skip
        monkeypatch.setenv(name, value)
    with rubmap.local() as client:
        assert client.jobs() == []


def test_a_local_service_ends_with_its_program() -> None:
    script = "import rubmap, time\nwith rubmap.local() as c:\n    print(c.service.url, flush=True)\n    time.sleep(60)"
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as program:
        assert program.stdout
        url = program.stdout.readline().strip()
        client = rubmap.Client(url, token="", patience=0.0)
        client.version()
        program.kill()
    end = time.monotonic() + 30.0
    with pytest.raises(rubmap.Unreachable):
        while time.monotonic() < end:
            client.version()
            time.sleep(0.1)


def test_a_service_that_is_not_there_is_said_to_be_so() -> None:
    service = Service("http://127.0.0.1:9", patience=0.5)
    for nonsense in ("nonsense", "ftp://127.0.0.1", "127.0.0.1:8080", ""):
        with pytest.raises(ValueError, match="no address"):
            rubmap.Client(nonsense)
    begin = time.monotonic()
    with pytest.raises(rubmap.Unreachable, match="127.0.0.1:9"):
        service.get("/v1/version")
    assert time.monotonic() - begin < 5.0


def test_a_program_that_does_not_start_shows_its_log(tmp_path: Path) -> None:
    with pytest.raises(rubmap.RubmapError, match="no program"), rubmap.local(tmp_path / "rubmap"):
        pass
    file = tmp_path / "file"
    file.write_text("")
    with pytest.raises(rubmap.RubmapError, match="did not start"), rubmap.local(data=file / "below"):
        pass


def test_lists_come_in_pages() -> None:
    asked: list[Any] = []

    def answer(request: httpx.Request) -> httpx.Response:
        asked.append(str(request.url))
        more = {"jobs": [{"id": "a", "kind": "sweep"}], "next": "/v1/jobs?limit=500&cursor=7"}
        return httpx.Response(200, json=more if len(asked) == 1 else {"jobs": [{"id": "b", "kind": "study"}]})

    client = rubmap.Client("http://nowhere")
    client.service._http = httpx.Client(base_url="http://nowhere", transport=httpx.MockTransport(answer))
    assert [job.id for job in client.jobs()] == ["a", "b"]
    assert asked[1].endswith("?limit=500&cursor=7")
