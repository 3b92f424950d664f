"""Tags and substitutions of packages in the workspace that were not built or not sourced.

A built and sourced package says with an entry point which of its modules expose them; Python finds that by itself. Of
others the entry points are read from ``setup.py``, ``setup.cfg`` and ``pyproject.toml``, and from what a build left
behind. That takes its time, so it is done when a tag is met that nobody knows.
"""

from __future__ import annotations

import ast
import importlib
import sys
import traceback
import warnings
from collections.abc import Iterator
from configparser import ConfigParser
from configparser import Error as ConfigError
from contextlib import suppress
from importlib.util import module_from_spec
from pathlib import Path
from typing import Any

from linkwright.launch.ros.python_modules import find_module
from linkwright.launch.ros.workspace_environment import python_folders
from linkwright.workspace import PackageFinder, current_finder, install_prefix, is_installed

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
                yield from _named(_configured(_text(path), GROUP))
        return
    for name, read in (("setup.py", _in_setup), ("setup.cfg", _in_setup_cfg), ("pyproject.toml", _in_pyproject)):
        text = _text(share / name)
        if GROUP in text:
            yield from _named(read(text))


def _named(lines: list[str]) -> Iterator[str]:
    """The modules of lines ``name = module:attribute``."""
    for line in lines:
        _, equals, target = line.partition("=")
        module = target.partition(":")[0].strip()
        if equals and module:
            yield module


def _in_setup(text: str) -> list[str]:
    """The lines of the group wherever ``setup.py`` writes them into a dictionary."""
    with suppress(SyntaxError):
        for node in ast.walk(ast.parse(text)):
            for key, value in zip(node.keys, node.values, strict=True) if isinstance(node, ast.Dict) else ():
                if isinstance(key, ast.Constant) and key.value == GROUP:
                    items = value.elts if isinstance(value, (ast.List, ast.Tuple)) else [value]
                    texts = [each.value for each in items if isinstance(each, ast.Constant)]
                    return [line for each in texts if isinstance(each, str) for line in each.splitlines()]
    return []


def _in_setup_cfg(text: str) -> list[str]:
    return _configured(text, "options.entry_points", GROUP)


def _configured(text: str, section: str, option: str | None = None) -> list[str]:
    """The lines of a section, or of one option in it."""
    parser = ConfigParser(interpolation=None, delimiters=("=",))
    with suppress(ConfigError):
        parser.read_string(text)
    if option is not None:
        return parser.get(section, option, fallback="").splitlines()
    return [f"{name} = {value}" for name, value in parser.items(section)] if parser.has_section(section) else []


def _in_pyproject(text: str) -> list[str]:
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib  # type: ignore[import-not-found, unused-ignore]
    try:
        points: Any = tomllib.loads(text)["project"]["entry-points"][GROUP]
        return [f"{name} = {target}" for name, target in points.items()]
    except (tomllib.TOMLDecodeError, KeyError, TypeError, AttributeError):
        return []


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
