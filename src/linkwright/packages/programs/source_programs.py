"""The programs that an unbuilt package would install.

The programs are read from ``setup.py``, ``setup.cfg`` and ``pyproject.toml`` (entry points and scripts) and from
``install(PROGRAMS ...)`` in ``CMakeLists.txt``. Nothing is executed, with one exception: a ``setup.py`` that computes
its entry points is run in a separate process, with a ``setup()`` that only reports them.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from linkwright.diagnostics import SourceText
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.loading.lean_typing import Any
from linkwright.packages.readers.entry_points import (
    read_option_lines,
    read_pyproject_group,
    read_setup_cfg_group,
    read_text,
)
from linkwright.packages.readers.installed import ENTRY_POINT_LINE, PROGRAM_GROUP, EntryPoint

_PYTHON_PACKAGE = lazy_pattern(r"^\s*ament_python_install_package\s*\(", re.MULTILINE | re.IGNORECASE)
BUILD_FILES = ("setup.py", "setup.cfg", "pyproject.toml", "CMakeLists.txt")
NON_PROGRAM_MODULES = frozenset({"setup", "conftest", "test", "tests"})
_SETUP_TIMEOUT_S = 10.0
_SETUP_RUNNER = """
import json, runpy, sys, types
def setup(**given):
    found = given.get("entry_points") or {}
    print(json.dumps([list(found.get("console_scripts") or ()), list(given.get("scripts") or ())]))
fake = types.ModuleType("setuptools")
fake.setup = setup
fake.find_packages = fake.find_namespace_packages = lambda *_, **__: []
fake.__getattr__ = lambda name: type(name, (), {})
sys.modules["setuptools"] = fake
sys.argv = ["setup.py"]
runpy.run_path("setup.py", run_name="__main__")
"""


@dataclass
class SourcePrograms:
    """The programs that a source package would install to ``lib/PACKAGE``.

    Attributes:
        folder: the folder of the package.
        entry_points: the entry points, by program name.
        scripts: the script files, by program name.
        compiled: the names of programs that must be built first.
        is_complete: whether there are no other programs; False if the files that describe the build are missing or use
            unknown commands.
    """

    folder: Path
    entry_points: dict[str, EntryPoint] = field(default_factory=dict)
    scripts: dict[str, Path] = field(default_factory=dict)
    compiled: set[str] = field(default_factory=set)
    is_complete: bool = True

    def names(self) -> list[str]:
        """Return the sorted names of all programs, built or not."""
        return sorted({*self.entry_points, *self.scripts, *self.compiled})


def find_source_programs(folder: Path, *, runs_setup: bool = True) -> SourcePrograms:
    """Return the programs of a source package.

    Args:
        folder: the folder of the package.
        runs_setup: whether a ``setup.py`` that computes its programs is run. Otherwise, such programs are left out.
    """
    programs = SourcePrograms(folder)
    programs.is_complete = any((folder / name).is_file() for name in BUILD_FILES)
    _read_configurations(programs)
    _read_setup_py(programs, runs_setup=runs_setup)
    _read_cmake(programs)
    return programs


def find_python_root(folder: Path, package: str) -> Path | None:
    """Return the folder from which a source package's Python modules are imported, or None."""
    for candidate in (folder, folder / "src"):
        if (candidate / package / "__init__.py").is_file():
            return candidate
    if _PYTHON_PACKAGE.search(read_text(folder / "CMakeLists.txt")):
        return folder
    is_python = (folder / "setup.py").is_file() or (folder / "setup.cfg").is_file()
    return folder if is_python and any(_iterate_modules(folder)) else None


def find_module_file(root: Path, module: str) -> Path | None:
    """Return the file of a module below a folder, or None if there is no such module."""
    path = root.joinpath(*module.split("."))
    for candidate in (path.with_name(path.name + ".py"), path / "__init__.py"):
        if candidate.is_file():
            return candidate
    return None


def _iterate_modules(folder: Path) -> Iterator[Path]:
    """Yield the importable modules and packages in a folder, except build and test modules."""
    for path in (*folder.glob("*.py"), *(path.parent for path in folder.glob("*/__init__.py"))):
        if path.stem not in NON_PROGRAM_MODULES:
            yield path


def _read_configurations(programs: SourcePrograms) -> None:
    """Add the programs in ``pyproject.toml`` and ``setup.cfg``."""
    cfg = read_text(programs.folder / "setup.cfg")
    for line in (
        *read_pyproject_group(read_text(programs.folder / "pyproject.toml"), PROGRAM_GROUP),
        *read_setup_cfg_group(cfg, PROGRAM_GROUP),
    ):
        _add_entry(programs, line)
    for line in read_option_lines(cfg, "options", "scripts"):
        _add_script(programs, line.strip())


def _read_setup_py(programs: SourcePrograms, *, runs_setup: bool) -> None:
    from linkwright.packages.readers.setup_py import read_setup

    path = programs.folder / "setup.py"
    text = read_text(path)
    if not text:
        return
    facts = read_setup(SourceText(str(path), text))
    for entry in facts.entry_points:
        programs.entry_points[entry.executable] = EntryPoint(entry.module, entry.function or "main")
    has_computed_entry_points = facts.has_call and not facts.entry_points_complete
    if runs_setup and (has_computed_entry_points or re.search(r"\bscripts\s*=", text)):
        entries, scripts = _run_setup_py(programs.folder)
        for line in entries:
            _add_entry(programs, line)
        for name in scripts:
            _add_script(programs, name)


def _run_setup_py(folder: Path) -> tuple[list[str], list[str]]:
    """Run a ``setup.py``, and return the entry points and scripts that it reports.

    Both lists are empty if the run fails.
    """
    try:
        process = subprocess.run(  # noqa: S603 - the user runs a program of this very package
            [sys.executable, "-c", _SETUP_RUNNER],
            cwd=folder,
            capture_output=True,
            timeout=_SETUP_TIMEOUT_S,
            check=True,
            text=True,
        )
        entries, scripts = json.loads(process.stdout.splitlines()[-1])
    except (OSError, subprocess.SubprocessError, ValueError, IndexError):
        return [], []
    return [str(entry) for entry in entries], [str(script) for script in scripts]


def _read_cmake(programs: SourcePrograms) -> None:
    path = programs.folder / "CMakeLists.txt"
    text = read_text(path)
    if not text:
        return
    from linkwright.packages.readers.cmake import read_cmake

    file = read_cmake(SourceText(str(path), text), programs.folder)
    for name, relative in file.programs.items():
        _add_script(programs, relative, name)
    programs.compiled |= file.executables - set(file.programs)
    programs.is_complete &= file.is_complete


def _add_entry(programs: SourcePrograms, line: Any) -> None:
    match = ENTRY_POINT_LINE.match(line) if isinstance(line, str) else None
    if match is not None:
        programs.entry_points[match[1]] = EntryPoint(match[2], match[3] or "main")


def _add_script(programs: SourcePrograms, relative: str, name: str | None = None) -> None:
    path = programs.folder / relative
    if relative and path.is_file():
        programs.scripts[name or path.name] = path
