"""Launch file extensions (tags, substitutions, languages).

The extensions come from Linkwright, from installed packages, and from packages in the workspace.
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
from linkwright.packages.programs.workspace_environment import find_python_folders
from linkwright.packages.readers.entry_points import (
    read_metadata_group,
    read_pyproject_group,
    read_setup_cfg_group,
    read_setup_py_group,
    read_text,
)

ACTION_GROUP = "launch.frontend.launch_extension"
"""The entry point group of modules that expose actions and substitutions on import."""
PARSER_GROUP = "launch.frontend.parser"
"""The entry point group of parsers. The names are the languages."""
_GROUP_NAMES = {ACTION_GROUP: "launch extension", PARSER_GROUP: "parser extension"}
_BUILTIN_ENTRY_POINTS = {
    ACTION_GROUP: {
        "actions": "linkwright.launch.model.actions",
        "include": "linkwright.launch.frontend.include",
        "substitutions": "linkwright.launch.model.substitutions",
        "ros": "linkwright.launch.ros",
    },
    PARSER_GROUP: {"xml": "linkwright.launch.frontend.xml:Parser", "yaml": "linkwright.launch.frontend.yaml:Parser"},
}
_STAND_IN_GROUP = "linkwright.launch_extensions"
"""The entry point group of modules that replace launch extensions of the same name if these are not installed."""


def load(group: str) -> Iterator[tuple[str, Any]]:
    """Yield the names and objects of the entry points of a group, Linkwright's own first.

    An entry point that cannot be loaded is skipped with a warning.
    """
    installed_entry_points = entry_points(group=group)
    builtin_entry_points = (EntryPoint(name, value, group) for name, value in _BUILTIN_ENTRY_POINTS[group].items())
    stand_in_entry_points = extensions(_STAND_IN_GROUP).values() if group == ACTION_GROUP else ()
    used_stand_ins = (
        entry_point for entry_point in stand_in_entry_points if entry_point.name not in installed_entry_points.names
    )
    for entry_point in (*builtin_entry_points, *used_stand_ins, *installed_entry_points):
        try:
            loaded_object = entry_point.load()
        except Exception:  # noqa: BLE001, PERF203 - a broken package must not stop the others
            message = f"Failed to load the {_GROUP_NAMES[group]}: {entry_point.name}\n{traceback.format_exc()}"
            warnings.warn(message, stacklevel=2)
        else:
            yield entry_point.name, loaded_object


_loaded_modules: set[tuple[Path, str]] = set()


def load_workspace_extensions() -> None:
    """Import the launch extensions of the packages in the workspace, each module once."""
    finder = current_finder()
    for package, share in finder.packages().items():
        for module in _find_extension_modules(package, share):
            if (share, module) not in _loaded_modules:
                _loaded_modules.add((share, module))
                _import_module(module, finder, share)


def _import_module(module: str, finder: PackageFinder, share: Path) -> None:
    try:
        top_package = module.partition(".")[0]
        spec = None if top_package in sys.modules else find_module(finder, top_package, share)
        if spec is not None and spec.loader is not None:
            sys.modules[top_package] = module_from_spec(spec)
            spec.loader.exec_module(sys.modules[top_package])
        importlib.import_module(module)
    except Exception:  # noqa: BLE001 - a broken package must not stop the others
        warnings.warn(f"Failed to load the launch extension: {module}\n{traceback.format_exc()}", stacklevel=3)


def _find_extension_modules(package: str, share: Path) -> Iterator[str]:
    """Yield the names of the modules with launch extensions in the entry points of a package."""
    if is_installed(share):
        for folder in find_python_folders(install_prefix(share), package):
            for path in folder.glob("*-info/entry_points.txt"):
                yield from _parse_module_names(read_metadata_group(read_text(path), ACTION_GROUP))
        return
    for name, read_group in (
        ("setup.py", read_setup_py_group),
        ("setup.cfg", read_setup_cfg_group),
        ("pyproject.toml", read_pyproject_group),
    ):
        text = read_text(share / name)
        if ACTION_GROUP in text:
            yield from _parse_module_names(read_group(text, ACTION_GROUP))


def _parse_module_names(lines: list[str]) -> Iterator[str]:
    """Yield the names of modules in lines of the form ``name = module:attribute``."""
    for line in lines:
        _, equals, target = line.partition("=")
        module = target.partition(":")[0].strip()
        if equals and module:
            yield module
