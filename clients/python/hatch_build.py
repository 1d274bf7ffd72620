"""Puts a program into the wheel, beside the client: the one that ``RUBMAP_WHEEL_PROGRAM`` names. Without it the wheel has the client alone."""

from __future__ import annotations

import os
import platform
import sysconfig
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class ProgramHook(BuildHookInterface):  # type: ignore[type-arg]
    """Puts the program among the scripts of the wheel, which then is of one platform and of any Python 3."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        program = os.environ.get("RUBMAP_WHEEL_PROGRAM")
        if not program or version == "editable":
            return
        name = "rubmap.exe" if os.name == "nt" else "rubmap"
        build_data["shared_scripts"][os.path.abspath(program)] = name
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{_platform()}"


def _platform() -> str:
    """Platform on which the program runs: on Linux with the C library of this machine, or a later one."""
    own = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    library, version = platform.libc_ver()
    if own.startswith("linux_") and library == "glibc":
        return own.replace("linux_", f"manylinux_{version.replace('.', '_')}_", 1)
    return own
