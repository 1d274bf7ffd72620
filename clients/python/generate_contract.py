"""Writes ``src/rubmap/contract.py``, the types of requests and answers, from the repository's ``openapi.yaml``. With ``--check`` it only compares."""

import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
TARGET = HERE / "src" / "rubmap" / "contract.py"
ARGUMENTS = [
    "--input", str(HERE / "../../openapi.yaml"), "--input-file-type", "openapi", "--output-model-type", "typing.TypedDict",
    "--target-python-version", "3.11", "--disable-timestamp", "--formatters", "ruff-format", "--custom-file-header",
    '"""Requests and answers of the contract, openapi.yaml: made by generate_contract.py."""',
]  # fmt: skip


def made() -> str:
    """The module as it must be."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "contract.py"
        subprocess.run([sys.executable, "-m", "datamodel_code_generator", *ARGUMENTS, "--output", str(out)], check=True)
        return out.read_text()


if __name__ == "__main__":
    if "--check" in sys.argv:
        if TARGET.read_text() != made():
            sys.exit("src/rubmap/contract.py is not what openapi.yaml says: run generate_contract.py")
    else:
        TARGET.write_text(made())
