"""The real program, as a service that tests start, kill and start again at the same address."""

import json
import os
import re
import signal
import subprocess
import time
import urllib.error
import urllib.request
from pathlib import Path

PROGRAM = os.environ["RUBMAP_BINARY"]


class Service:
    """`rubmap serve` on a folder of its own."""

    def __init__(self, folder: Path, *arguments: str):
        self.folder, self.arguments, self.url, self.process = folder, arguments, None, None
        self.start()

    def start(self):
        """Starts it; a second time at the address that it had."""
        log = self.folder / "service.log"
        begin = log.stat().st_size if log.exists() else 0
        address = self.url.removeprefix("http://") if self.url else "127.0.0.1:0"
        with open(log, "a") as out:
            command = [PROGRAM, "serve", "--addr", address, "--data", self.folder / "data", *self.arguments]
            self.process = subprocess.Popen(command, stderr=out, stdout=out)
        for _ in range(300):
            found = re.search(r"listening on (http:\S+)", log.read_text()[begin:])
            if found:
                self.url = found[1].rstrip("/")
                return
            time.sleep(0.1)
        raise RuntimeError(log.read_text()[begin:])

    def kill(self):
        """As a crash would."""
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()

    def stop(self):
        self.process.terminate()
        self.process.wait(30)

    def call(self, method, path, body=None, token=None):
        """JSON of an answer; what is refused raises."""
        headers = {"content-type": "application/json"}
        if isinstance(body, bytes):
            headers["content-type"] = "application/zip"
        elif body is not None:
            body = json.dumps(body).encode()
        if token:
            headers["authorization"] = f"Bearer {token}"
        request = urllib.request.Request(self.url + path, body, headers, method=method)
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                text = answer.read()
        except urllib.error.HTTPError as refusal:
            raise RuntimeError(f"{method} {path}: {refusal.code} {refusal.read().decode()}") from None
        return json.loads(text) if text else None

    def finish(self, job):
        """The job when it has ended."""
        for _ in range(6000):
            found = self.call("GET", f"/v1/jobs/{job}")
            if found["status"] not in ("accepted", "running"):
                return found
            time.sleep(0.1)
        raise RuntimeError(f"job {job} did not end")


def package(path: Path, *arguments: str) -> Path:
    """A package of the built-in generator."""
    subprocess.run([PROGRAM, "generate", "--out", path, *arguments], check=True, capture_output=True)
    return path
