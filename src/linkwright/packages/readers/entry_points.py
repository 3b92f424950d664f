"""Reader for entry points in the source files of a package.

An entry point is a line ``name = module:attribute`` of a group.
"""

from __future__ import annotations

import ast
import sys
from contextlib import suppress
from pathlib import Path

from linkwright.loading.lean_typing import Any
from linkwright.packages.readers.installed import PROGRAM_GROUP
from linkwright.packages.readers.python_values import parse_python


def read_setup_py_group(text: str, group: str) -> list[str]:
    """Return the lines of a group in any dictionary of a ``setup.py``, without running it."""
    with suppress(SyntaxError, ValueError):
        for node in ast.walk(parse_python(text)):
            for key, value in zip(node.keys, node.values, strict=True) if isinstance(node, ast.Dict) else ():
                if isinstance(key, ast.Constant) and key.value == group:
                    items = value.elts if isinstance(value, (ast.List, ast.Tuple)) else [value]
                    texts = [item.value for item in items if isinstance(item, ast.Constant)]
                    return [line for text in texts if isinstance(text, str) for line in text.splitlines()]
    return []


def read_setup_cfg_group(text: str, group: str) -> list[str]:
    """Return the lines of a group in a ``setup.cfg``."""
    return read_option_lines(text, "options.entry_points", group)


def parse_toml(text: str) -> dict[str, Any]:
    """Return the document of a text in TOML.

    Raises:
        ValueError: the text has wrong syntax.
    """
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib  # type: ignore[import-not-found, unused-ignore]
    return tomllib.loads(text)


def read_pyproject_group(text: str, group: str) -> list[str]:
    """Return the lines of a group in a ``pyproject.toml``."""
    try:
        project: Any = parse_toml(text)["project"]
        entry_points = project["scripts"] if group == PROGRAM_GROUP else project["entry-points"][group]
        return [f"{name} = {target}" for name, target in entry_points.items()]
    except (ValueError, KeyError, TypeError, AttributeError):
        return []


def read_metadata_group(text: str, group: str) -> list[str]:
    """Return the lines of a group in the ``entry_points.txt`` that a build writes."""
    from configparser import ConfigParser, Error

    parser = ConfigParser(interpolation=None, delimiters=("=",))
    with suppress(Error):
        parser.read_string(text)
    return [f"{name} = {value}" for name, value in parser.items(group)] if parser.has_section(group) else []


def read_option_lines(text: str, section: str, option: str) -> list[str]:
    """Return the lines of an option of a ``setup.cfg``."""
    from configparser import ConfigParser, Error

    parser = ConfigParser(interpolation=None)
    with suppress(Error):
        parser.read_string(text)
    return parser.get(section, option, fallback="").splitlines()


def read_text(path: Path) -> str:
    """Return the text of a file, or an empty string if the file cannot be read."""
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
