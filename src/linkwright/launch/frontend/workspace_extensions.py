"""Tags and substitutions of packages in the workspace that were not built or not sourced.

A built and sourced package says with an entry point which of its modules expose them; Python finds that by itself. Of
others the entry points are read from ``setup.py``, ``setup.cfg`` and ``pyproject.toml``, and from what a build left
behind. That takes its time, so it is done when a tag is met that nobody knows.
"""

from __future__ import annotations

import importlib
import sys
import traceback
import warnings
from collections.abc import Iterator
from importlib.util import module_from_spec
from pathlib import Path

from linkwright.packages import PackageFinder, current_finder, install_prefix, is_installed
from linkwright.packages.programs.python_modules import find_module
from linkwright.packages.programs.workspace_environment import python_folders
from linkwright.packages.readers.entry_points import in_metadata, in_pyproject, in_setup_cfg, in_setup_py, text_of

GROUP = "launch.frontend.launch_extension"

_loaded: set[tuple[Path, str]] = set()


def load_workspace_extensions() -> None:
    """Import the modules with tags and substitutions of the packages that the finder in force finds, each once."""
    finder = current_finder()
    for package, share in finder.packages().items():
        for module in _modules(package, share):
            if (share, module) not in _loaded:
                _loaded.add((share, module))
                _import(module, finder)


def _import(module: str, finder: PackageFinder) -> None:
    try:
        top = module.partition(".")[0]
        spec = None if top in sys.modules else find_module(finder, top)
        if spec is not None and spec.loader is not None:
            sys.modules[top] = module_from_spec(spec)
            spec.loader.exec_module(sys.modules[top])
        importlib.import_module(module)
    except Exception:  # noqa: BLE001 - a broken package must not stop the others
        warnings.warn(f"Failed to load the launch extension: {module}\n{traceback.format_exc()}", stacklevel=3)


def _modules(package: str, share: Path) -> Iterator[str]:
    """The modules that a package's entry points name."""
    if is_installed(share):
        for folder in python_folders(install_prefix(share), package):
            for path in folder.glob("*-info/entry_points.txt"):
                yield from _named(in_metadata(text_of(path), GROUP))
        return
    for name, read in (("setup.py", in_setup_py), ("setup.cfg", in_setup_cfg), ("pyproject.toml", in_pyproject)):
        text = text_of(share / name)
        if GROUP in text:
            yield from _named(read(text, GROUP))


def _named(lines: list[str]) -> Iterator[str]:
    """The modules of lines ``name = module:attribute``."""
    for line in lines:
        _, equals, target = line.partition("=")
        module = target.partition(":")[0].strip()
        if equals and module:
            yield module
