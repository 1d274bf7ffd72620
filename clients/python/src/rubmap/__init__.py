"""Client of rubmap: at which speeds the blade tips of a centrifugal impeller interact dangerously with their casing.

>>> import rubmap
>>> with rubmap.local() as client:  # or rubmap.Client("http://service:8080", token="…")
...     model = client.upload("impeller.zip")
...     sweep = client.sweep({"model": model.id, "speeds": ..., "scene": ...}).submit().wait()
...     print(sweep.wheel_critical_speeds())
"""

from . import contract, plot
from .client import Client
from .errors import JobFailed, PackageError, Refusal, RubmapError, Unreachable
from .jobs import Job, ModelGeneration
from .local import local
from .models import Model
from .package import write_package
from .results import Branches, Campaign, CaseStudy, ModalAnalysis, RunUps, Study, Sweep
from .step import mesh_step
from .verdict import Verdict

__all__ = [
    "Branches",
    "Campaign",
    "CaseStudy",
    "Client",
    "Job",
    "JobFailed",
    "ModalAnalysis",
    "Model",
    "ModelGeneration",
    "PackageError",
    "Refusal",
    "RubmapError",
    "RunUps",
    "Study",
    "Sweep",
    "Unreachable",
    "Verdict",
    "contract",
    "local",
    "mesh_step",
    "plot",
    "write_package",
]
