"""Write the list of the ROS packages and executables that Linkwright replaces.

The engine uses the list. The engine (linkwright-core) checks launch files without the nodes, modules and messages that
are listed here.

Usage: python tools/substituted_names.py [--check]
"""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path
from typing import Any

from linkwright.hosting.rqt_programs import PANEL_PROGRAMS

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "src" / "linkwright"
TABLE_FILE = PACKAGE / "packages" / "substituted_names.txt"

tomllib: Any = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")


def format_names() -> str:
    """Return the list: a line for each package, with its name and the names of its executables."""
    groups = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["entry-points"]
    names_by_module: dict[str, set[str]] = {"rviz2": set()}
    for package, executable in PANEL_PROGRAMS:
        names_by_module.setdefault(package, set()).add(executable)
    for folder in ("standins/tables", "messages/data"):
        names_by_module |= {file.stem: set() for file in (PACKAGE / folder).glob("*.txt")}
    for name in groups["linkwright.components"]:
        names_by_module.setdefault(name.partition("/")[0], set())
    for name in groups["linkwright.nodes"]:
        package, _, executable = name.partition("/")
        names_by_module.setdefault(package, set()).add(executable)
    return "".join(" ".join((package, *sorted(names_by_module[package]))) + "\n" for package in sorted(names_by_module))


def main(words: list[str]) -> int:
    """Write the list, or check it, and return the exit status."""
    if words == ["--check"]:
        if TABLE_FILE.read_text(encoding="utf-8") == format_names():
            return 0
        print(f"{TABLE_FILE.relative_to(ROOT)} is stale: run `python tools/substituted_names.py`", file=sys.stderr)
        return 1
    TABLE_FILE.write_text(format_names(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
