"""Launch file extensions (tags, substitutions, languages).

The extensions are part of Linkwright, of installed packages or of packages in the workspace.
"""

from __future__ import annotations

import importlib
import sys
import traceback
import warnings
from collections.abc import Iterator
from importlib.metadata import EntryPoint, entry_points
from importlib.util import module_from_spec
from pathlib import Path
from typing import Any

from linkwright.loading.extensions import extensions
from linkwright.packages import PackageFinder, current_finder, install_prefix, is_installed
from linkwright.packages.programs.python_modules import find_module
from linkwright.packages.programs.workspace_environment import python_folders
from linkwright.packages.readers.entry_points import (
    read_metadata_group,
    read_pyproject_group,
    read_setup_cfg_group,
    read_setup_py_group,
    text_of,
)

ACTIONS = "launch.frontend.launch_extension"
"""The group of modules that expose actions and substitutions when they are imported."""
PARSERS = "launch.frontend.parser"
"""The group of parsers, each by the name of its language."""
_KINDS = {ACTIONS: "launch extension", PARSERS: "parser extension"}
_OURS = {
    ACTIONS: {
        "actions": "linkwright.launch.model.actions",
        "include": "linkwright.launch.frontend.include",
        "substitutions": "linkwright.launch.model.substitutions",
        "ros": "linkwright.launch.ros",
    },
    PARSERS: {"xml": "linkwright.launch.frontend.xml:Parser", "yaml": "linkwright.launch.frontend.yaml:Parser"},
}
_STAND_INS = "linkwright.launch_extensions"
"""The group of modules that replace launch extensions, each by the name of one, where it is not installed."""


def load(group: str) -> Iterator[tuple[str, Any]]:
    """Yield the name and object of each entry point of a group, Linkwright's first.

    An entry point that cannot be loaded is skipped with a warning.
    """
    installed = entry_points(group=group)
    ours = (EntryPoint(name, value, group) for name, value in _OURS[group].items())
    stand_ins = extensions(_STAND_INS).values() if group == ACTIONS else ()
    missing = (entry_point for entry_point in stand_ins if entry_point.name not in installed.names)
    for entry_point in (*ours, *missing, *installed):
        try:
            loaded = entry_point.load()
        except Exception:  # noqa: BLE001, PERF203 - a broken package must not stop the others
            problem = f"Failed to load the {_KINDS[group]}: {entry_point.name}\n{traceback.format_exc()}"
            warnings.warn(problem, stacklevel=2)
        else:
            yield entry_point.name, loaded


_loaded: set[tuple[Path, str]] = set()


def load_workspace_extensions() -> None:
    """Import the launch extensions of the packages in the workspace, each module only once."""
    finder = current_finder()
    for package, share in finder.packages().items():
        for module in _modules(package, share):
            if (share, module) not in _loaded:
                _loaded.add((share, module))
                _import(module, finder, share)


def _import(module: str, finder: PackageFinder, share: Path) -> None:
    try:
        top = module.partition(".")[0]
        spec = None if top in sys.modules else find_module(finder, top, share)
        if spec is not None and spec.loader is not None:
            sys.modules[top] = module_from_spec(spec)
            spec.loader.exec_module(sys.modules[top])
        importlib.import_module(module)
    except Exception:  # noqa: BLE001 - a broken package must not stop the others
        warnings.warn(f"Failed to load the launch extension: {module}\n{traceback.format_exc()}", stacklevel=3)


def _modules(package: str, share: Path) -> Iterator[str]:
    """Yield the names of the launch extension modules in a package's entry points."""
    if is_installed(share):
        for folder in python_folders(install_prefix(share), package):
            for path in folder.glob("*-info/entry_points.txt"):
                yield from _modules_in_lines(read_metadata_group(text_of(path), ACTIONS))
        return
    for name, read in (
        ("setup.py", read_setup_py_group),
        ("setup.cfg", read_setup_cfg_group),
        ("pyproject.toml", read_pyproject_group),
    ):
        text = text_of(share / name)
        if ACTIONS in text:
            yield from _modules_in_lines(read(text, ACTIONS))


def _modules_in_lines(lines: list[str]) -> Iterator[str]:
    """Yield the module names in lines of the form ``name = module:attribute``."""
    for line in lines:
        _, equals, target = line.partition("=")
        module = target.partition(":")[0].strip()
        if equals and module:
            yield module
