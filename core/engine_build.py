"""Hatchling's hook of linkwright-core: the modules of the engine, out of the sources of the whole.

In a checkout they are in ``../src``, and the contract of import-linter in ``../pyproject.toml`` names them. A source
distribution has them alone, in ``src``, with the compiled catalogs.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

HERE = Path(__file__).resolve().parent
OF_SDIST = HERE / "src"
SOURCES = OF_SDIST if OF_SDIST.exists() else HERE.parent / "src"
_LOOSE = ("__init__.py", "__main__.py", "_version.py", "py.typed", "cli/__init__.py")
"""Files of the engine in packages that it shares with the rest."""


def version() -> str:
    """Return the version, which the engine and the rest share."""
    (found,) = re.findall(r'__version__ = "(.+)"', (SOURCES / "linkwright" / "_version.py").read_text(encoding="utf-8"))
    return str(found)


def modules() -> list[str]:
    """Return the modules of the engine as paths below ``linkwright``, from the contract in a checkout."""
    toml: Any = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")
    project = toml.loads((SOURCES.parent / "pyproject.toml").read_text(encoding="utf-8"))
    contracts = project["tool"]["importlinter"]["contracts"]
    (contract,) = (contract for contract in contracts if contract["name"].startswith("The engine imports nothing else"))
    return [name.partition(".")[2].replace(".", "/") for name in contract["source_modules"]]


def files() -> Iterator[Path]:
    """Yield the files of the engine, below ``linkwright``."""
    package = SOURCES / "linkwright"
    if SOURCES == OF_SDIST:
        yield from (path.relative_to(package) for path in package.rglob("*") if path.is_file())
        return
    yield from map(Path, _LOOSE)
    for module in modules():
        if (package / f"{module}.py").is_file():
            yield Path(f"{module}.py")
        for path in sorted((package / module).rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts:
                yield path.relative_to(package)


class Engine(BuildHookInterface):
    """Take the files of the engine into a wheel or a source distribution."""

    def dependencies(self) -> list[str]:
        """What compiling the catalogs and reading the contract need."""
        if SOURCES == OF_SDIST:
            return []
        return ["babel>=2.16", *(["tomli>=2.0"] if sys.version_info < (3, 11) else [])]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Name the files; catalogs are compiled first, in a checkout."""
        if SOURCES != OF_SDIST:
            sys.path.insert(0, str(HERE.parent / "tools"))
            import catalogs  # what it imports, `dependencies` names

            catalogs.compile_catalogs()
        if version == "editable":
            return
        folder = "src/linkwright" if self.target_name == "sdist" else "linkwright"
        for file in files():
            if self.target_name == "sdist" or file.suffix != ".po":  # what is read is compiled from it
                build_data["force_include"][str(SOURCES / "linkwright" / file)] = f"{folder}/{file.as_posix()}"
