"""Commands and environments for user programs that import stand-ins such as ``rclpy``.

An installed rclpy takes precedence.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path

from linkwright.packages.manifest import MANIFEST, package_name
from linkwright.standins import table

_STARTUP_FOLDER = Path(__file__).parent / "startup"

_REQUIRED_PACKAGES = ("linkwright", "numpy", "PIL", "yaml", "rosbags", "cyclonedds", "zenoh", "xxhash")
"""The packages that the stand-ins import, for programs in another environment."""


def standin_path() -> str:
    """Return the folder to add to ``PYTHONPATH``.

    The folder contains only ``linkwright_pytest``, a plugin that pytest loads, and a ``sitecustomize`` that also runs
    the next ``sitecustomize`` on the path.
    """
    return str(_STARTUP_FOLDER)


def create_environment(base: Mapping[str, str] | None = None) -> dict[str, str]:
    """Return an environment that lets a process and its children import the stand-ins.

    Args:
        base: the environment to extend; None for the environment of this process.

    Returns:
        A copy with `standin_path` first on ``PYTHONPATH``. ``LINKWRIGHT_SITE`` names the folders of the packages that
        the stand-ins need, for interpreters that do not have these packages. Source folders of a package that has a
        stand-in, such as a clone of rclpy in the workspace, are removed unless the user added them, because unbuilt
        sources would hide the stand-in. The function is idempotent.
    """
    result = dict(os.environ if base is None else base)
    _remove_hiding_sources(result)
    _prepend(result, "PYTHONPATH", [standin_path()])
    result["LINKWRIGHT_SITE"] = os.pathsep.join(_find_site_folders())
    return result


def python_command(arguments: Sequence[str], base: Mapping[str, str] | None = None) -> list[str]:
    """Return the command that runs a Python program.

    Args:
        arguments: the arguments of the interpreter: a file, or ``-m`` and a module, and the program's arguments.
        base: the environment of the program; None for the environment of this process.

    Returns:
        The interpreter, followed by the arguments. It is the interpreter of the active virtual environment if that has
        the Python version of this process, because the compiled libraries of the stand-ins are built for one version.
        If not, it is the interpreter of this process.
    """
    variables = os.environ if base is None else base
    return [_find_interpreter(variables), *arguments]


def _find_interpreter(variables: Mapping[str, str]) -> str:
    active_environment = variables.get("VIRTUAL_ENV") or variables.get("CONDA_PREFIX")
    if active_environment and Path(active_environment) != Path(sys.prefix):
        version = f"python{sys.version_info.major}.{sys.version_info.minor}"
        folder, suffix = ("Scripts", ".exe") if os.name == "nt" else ("bin", "")
        candidate = Path(active_environment) / folder / f"{version}{suffix}"
        if candidate.exists():
            return str(candidate)
    return sys.executable


def _remove_hiding_sources(variables: dict[str, str]) -> None:
    user_entries = os.environ.get("PYTHONPATH", "").split(os.pathsep)
    entries = variables.get("PYTHONPATH", "").split(os.pathsep)
    hiding_entries = [
        entry for entry in entries if entry and entry not in user_entries and _hides_stand_in(Path(entry))
    ]
    if hiding_entries:
        variables["PYTHONPATH"] = os.pathsep.join(entry for entry in entries if entry not in hiding_entries)


def _hides_stand_in(folder: Path) -> bool:
    names = {package_name(path) for path in (folder, folder.parent) if (path / MANIFEST).is_file()}
    return not names.isdisjoint(table.list_packages()) if names else False


def _prepend(variables: dict[str, str], name: str, folders: Sequence[str]) -> None:
    existing = [entry for entry in variables.get(name, "").split(os.pathsep) if entry and entry not in folders]
    variables[name] = os.pathsep.join([*folders, *existing])


def _find_site_folders() -> list[str]:
    folders: list[str] = []
    for package in _REQUIRED_PACKAGES:
        spec = find_spec(package)
        if spec is not None and spec.origin is not None:
            folder = str(Path(spec.origin).parent.parent)
            if folder not in folders:
                folders.append(folder)
    return folders
