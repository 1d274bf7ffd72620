"""Starts what compose.yaml says, as it says it, has a sweep computed, stops a worker on the way and looks whether anything is lost."""

import json
import os
import re
import secrets
import shlex
import shutil
import signal
import subprocess
import sys
import time
import urllib.request
from contextlib import ExitStack
from pathlib import Path

import yaml

BINARY, FOLDER = sys.argv[1], Path(sys.argv[2], "run")
PROJECT = Path(__file__).resolve().parents[2]
POSTGRES = max(Path("/usr/lib/postgresql").glob("*/bin"))
AS_NOBODY = ["setpriv", "--reuid", "65534", "--regid", "65534", "--clear-groups", "--"]
SECRETS = {name: secrets.token_hex(16) for name in ["OWNER_PASSWORD", "DATABASE_PASSWORD", "OBJECTS_KEY", "OBJECTS_SECRET"]}
# For documentation, and of nobody: on a loopback address the service would be more careful than it is in a container.
NETWORK = "192.0.2"
# Long enough for a start, for a job that a worker leaves behind, and for a sweep.
PATIENCE_SECONDS = 180

SWEEP = {
    "speeds": {"from": 12000, "to": 36000, "count": 24, "unit": "rpm"},
    "scene": {
        "damping": {"modal_ratio": 0.005},
        "casing": {
            "clearance": {"leading": 0.30, "trailing": 0.22},
            "lobes": {"count": 2, "amplitude": 0.425, "width_rad": 0.35},
        },
        "contact": {},
    },
    "integration": {"revolutions": 60, "ramp_revolutions": 1, "window_revolutions": 20},
}


def say(*words):
    print(f"{time.monotonic() - BEGIN:6.1f} s", *words, flush=True)


def until(what, happened):
    begin = time.monotonic()
    while not (found := happened()):
        if time.monotonic() - begin > PATIENCE_SECONDS:
            sys.exit(f"{what}: not within {PATIENCE_SECONDS} s")
        time.sleep(0.2)
    return found


def instruction(name):
    """The last instruction of this name in the Dockerfile."""
    text = re.sub(r"\\\n\s*", "", (PROJECT / "Dockerfile").read_text())
    return re.findall(rf"^{name} (.*)$", text, re.MULTILINE)[-1]


class Service:
    """One container of compose.yaml: a process with the address that its name means."""

    def __init__(self, name, said, address):
        self.name, self.said, self.address = name, said, address
        self.is_ours = said.get("image") == "rubmap"
        self.grace_seconds = int(said.get("stop_grace_period", "10s").removesuffix("s"))
        self.environment = {"PATH": os.environ["PATH"], "HOME": str(FOLDER), **said.get("environment", {})}
        self.command = [*said.get("entrypoint", []), *said.get("command", [])]
        self.health = said.get("healthcheck", {}).get("test", [])[1:]
        if self.is_ours:
            # What the image says, on an address of its own in place of a network of its own.
            image = dict(word.split("=", 1) for word in shlex.split(instruction("ENV")))
            image |= {"RUBMAP_ADDR": image["RUBMAP_ADDR"].replace("0.0.0.0", address), "RUBMAP_DATA": str(FOLDER / name)}
            self.environment = image | self.environment
            program = json.loads(instruction("ENTRYPOINT"))
            assert program == ["rubmap"]
            self.command = [BINARY, *self.command]
            self.health = json.loads(instruction("HEALTHCHECK").split(" CMD ")[1])
        self.health = [word.replace("127.0.0.1", address) for word in self.health]
        self.log = FOLDER / f"{name}.log"
        self.process = None

    def start(self, command=None):
        with self.log.open("ab") as log:
            self.process = subprocess.Popen(command or self.command, env=self.environment, stdout=log, stderr=log)
        return self

    def is_healthy(self):
        assert self.process.poll() is None, f"{self.name} has ended: {self.log.read_text()}"
        return subprocess.run(self.health, env=self.environment, capture_output=True).returncode == 0

    def completes(self):
        code = self.start().process.wait(PATIENCE_SECONDS)
        assert code == 0, f"{self.name} has ended with {code}: {self.log.read_text()}"
        say(self.name, "has done its part")

    def stop(self):
        begin = time.monotonic()
        self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(self.grace_seconds)
        say(self.name, f"has ended with {code}, {time.monotonic() - begin:.1f} s after SIGTERM")
        assert code == 0

    def metric(self, name):
        with urllib.request.urlopen(f"http://{self.address}:8080/metrics", timeout=5) as answer:
            return int(re.search(rf"^rubmap_{name} (\d+)$", answer.read().decode(), re.MULTILINE)[1])


def read_compose():
    """The file with its variables filled in."""

    def value(match):
        name, default = match[1], match[2]
        return SECRETS.get(name) or default.removeprefix(":-")

    return yaml.safe_load(re.sub(r"\$\{(\w+)(:[-?][^}]*)?\}", value, (PROJECT / "compose.yaml").read_text()))


def services_of(compose):
    found = {}
    for name, said in compose["services"].items():
        for k in range(said.get("scale", 1)):
            label = f"{name}-{k + 1}" if "scale" in said else name
            found[label] = Service(label, said, f"{NETWORK}.{len(found) + 1}")
    return found


def start_postgres(service, accounts):
    """As the image does: a superuser with a password, a database, and the statements for the beginning."""
    folder, user = FOLDER / "database", service.environment["POSTGRES_USER"]
    password = FOLDER / "password"
    password.write_text(service.environment["POSTGRES_PASSWORD"])
    folder.mkdir()
    for path in [folder, password]:
        os.chown(path, 65534, 65534)

    def run(program, *arguments, **options):
        subprocess.run([*AS_NOBODY, POSTGRES / program, *arguments], check=True, stdout=subprocess.DEVNULL, cwd="/tmp", **options)

    run("initdb", "-U", user, "--auth-local=trust", f"--pwfile={password}", "--no-sync", "-D", folder / "data")
    with (folder / "data/pg_hba.conf").open("a") as rules:
        rules.write("host all all all scram-sha-256\n")
    server = [POSTGRES / "postgres", "-D", folder / "data", "-k", folder, "-c", f"listen_addresses={service.address}"]
    service.start([*AS_NOBODY, *server])
    until("PostgreSQL", lambda: subprocess.run([POSTGRES / "pg_isready", "-q", "-h", folder]).returncode == 0)
    database = service.environment["POSTGRES_DB"]
    run("createdb", "-h", folder, "-U", user, database)
    run("psql", "-q", "-h", folder, "-U", user, "-v", "ON_ERROR_STOP=1", database, input=accounts, text=True)
    until("the health of PostgreSQL", service.is_healthy)
    say("PostgreSQL is healthy")


def start(compose, services):
    start_postgres(services["database"], compose["configs"]["accounts"]["content"])
    services["objects"].start(["moto_server", "-H", services["objects"].address, "-p", "8333"])
    services["bucket"].completes()
    services["migrate"].completes()
    running = [service for service in services.values() if service.is_ours and service.name != "migrate"]
    for service in running:
        service.start()
    for service in running:
        until(f"the health of {service.name}", service.is_healthy)
        say(service.name, "is healthy")
    return running


def compute(services):
    gateway, first = services["gateway"], services["worker-1"]

    def rubmap(*arguments, **options):
        environment = os.environ | {"RUBMAP_SERVER": "http://gateway:8080"}
        done = subprocess.run([BINARY, *arguments], env=environment, check=True, stdout=subprocess.PIPE, text=True, cwd=FOLDER, **options)
        return done.stdout.strip()

    rubmap("generate", "--out", "impeller.zip")
    job = rubmap("sweep", "-", "--model", "impeller.zip", input=json.dumps(SWEEP))
    say("sweep", job, "is accepted")
    until("a speed on worker-1", lambda: first.metric("speeds_running") > 0)
    say(first.metric("speeds_waiting"), "speeds are waiting,", first.metric("speeds_running"), "are computed by worker-1")
    first.stop()
    left = gateway.metric("speeds_waiting")
    assert left > 0, "nothing was left to do: the sweep is too short"
    say(left, "speeds are left to worker-2")
    until("a speed on worker-2", lambda: services["worker-2"].metric("speeds_finished_total") > 0)
    first.start()
    until("the health of worker-1, again", first.is_healthy)
    ended = json.loads(rubmap("watch", job, "--json"))["jobs"][0]
    say("the sweep is", ended["status"])
    found = json.loads(rubmap("get", job, "interaction-map"))["points"]
    statuses = {point["status"] for point in found}
    assert ended["status"] == "successful" and len(found) == SWEEP["speeds"]["count"], f"{len(found)} speeds: {statuses}"
    say("speeds finished:", {name: services[name].metric("speeds_finished_total") for name in ["worker-1", "worker-2"]})


def expect_least_rights(services):
    """The account of gateway and workers cannot make a table, and its password is needed."""
    address = services["database"].address

    def ask(password, statement):
        command = [POSTGRES / "psql", "-h", address, "-U", "rubmap", "-v", "ON_ERROR_STOP=1", "-c", statement, "rubmap"]
        done = subprocess.run(command, env=os.environ | {"PGPASSWORD": password}, capture_output=True)
        return done.returncode == 0

    right = SECRETS["DATABASE_PASSWORD"]
    assert ask(right, "select 1 from jobs") and not ask("wrong", "select 1")
    assert not ask(right, "create table public.more (id int)") and not ask(right, "drop table jobs")
    say("the account of gateway and workers has no more than it needs")


def expect_no_secrets():
    for log in FOLDER.glob("*.log"):
        for name, secret in SECRETS.items():
            assert secret not in log.read_text(), f"{log.name} has {name} in it"
    say("no log has a password or a key in it")


def main():
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir()
    compose = read_compose()
    services = services_of(compose)
    hosts = FOLDER / "hosts"
    names = [f"{service.address} {service.name}" for service in services.values()]
    hosts.write_text("\n".join(["127.0.0.1 localhost", *names, ""]))
    subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
    for service in services.values():
        subprocess.run(["ip", "address", "add", service.address, "dev", "lo"], check=True)
    subprocess.run(["mount", "--bind", hosts, "/etc/hosts"], check=True)
    with ExitStack() as ends:
        for service in services.values():
            ends.callback(lambda service=service: service.process and service.process.kill())
        running = start(compose, services)
        compute(services)
        expect_least_rights(services)
        for service in running:
            service.stop()
        expect_no_secrets()
    say("fine")


BEGIN = time.monotonic()
main()
