"""Find the default names of nodes, and their scripts, in the sources of the repository."""

from __future__ import annotations

import re
from pathlib import Path

from linkwright.diagnostics import SourceText
from linkwright.lint.targets import find_targets
from linkwright.packages.manifest import package_name
from linkwright.packages.readers.setup_py import read_setup
from linkwright.review.caching import cached_in_review
from linkwright.review.sources.names import CPP_SUFFIXES, NameKind
from linkwright.review.sources.reading import read_source_names


@cached_in_review(maxsize=256)
def find_default_name(root: Path, program: str) -> str | None:
    """Return the default name of a node, or None if the sources do not contain it.

    Args:
        root: the folder of the repository.
        program: the package and the executable or the class of a component, such as ``arm/arm::Driver``.
    """
    package, _, name = program.partition("/")
    folder = find_package_folders(root).get(package)
    if folder is None or not name:
        return None
    if "::" in name:
        files = _find_class_sources(folder, name.rpartition("::")[2])
    else:
        script = find_script(root, program)
        files = [] if script is None else [script]
    names = {item.name for file in files for item in read_source_names(file).names if item.kind is NameKind.NODE}
    return names.pop() if len(names) == 1 else None


@cached_in_review(maxsize=256)
def find_script(root: Path, program: str) -> Path | None:
    """Return the Python script that a node runs, or None if the repository has none or several.

    Args:
        root: the folder of the repository.
        program: the package and the executable, such as ``arm/driver.py``.
    """
    package, _, name = program.partition("/")
    folder = find_package_folders(root).get(package)
    if folder is None or not name or "/" in name or "$" in name or "*" in name:
        return None
    modules = _find_module_paths(folder, name)
    names = (name,) if name.endswith(".py") else (name, f"{name}.py")
    scripts = modules or [file for name in names for file in sorted(folder.rglob(name)) if file.is_file()]
    return scripts[0] if len(scripts) == 1 else None


@cached_in_review(maxsize=4)
def find_package_folders(root: Path) -> dict[str | None, Path]:
    """Return the folders of the packages of a repository, by name."""
    return {package_name(folder): folder for folder in find_targets([root]).packages}


def _find_class_sources(folder: Path, name: str) -> list[Path]:
    """Return the sources that define the constructor of a class."""
    constructor = re.compile(rf"\b{re.escape(name)}\s*\([^;{{}}]*\)\s*:")
    files = (file for file in folder.rglob("*") if file.suffix in CPP_SUFFIXES and file.is_file())
    return [file for file in files if constructor.search(file.read_text("utf-8", errors="replace"))]


def _find_module_paths(folder: Path, executable: str) -> list[Path]:
    """Return the modules that can contain an executable of a Python package."""
    setup = folder / "setup.py"
    if not setup.is_file():
        return []
    programs = read_setup(SourceText(str(setup), setup.read_text("utf-8", errors="replace"))).entry_points
    modules = [
        folder / f"{program.module.replace('.', '/')}.py" for program in programs if program.executable == executable
    ]
    return [module for module in modules if module.is_file()]
