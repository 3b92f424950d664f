"""The programs that a package in its sources would install, found without building it.

They are read from ``setup.py``, ``setup.cfg`` and ``pyproject.toml`` (entry points and scripts) and from the
``install(PROGRAMS ...)`` of a ``CMakeLists.txt``. Nothing is run for it, with one exception: a ``setup.py`` that puts
its entry points together by a program is asked by running it, in a process of its own with a ``setup()`` that only
reports.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Iterator
from configparser import ConfigParser
from configparser import Error as ConfigError
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from linkwright.diagnostics import SourceText

_ENTRY = re.compile(r"\s*([^\s=]+)\s*=\s*([\w.]+)\s*(?::\s*([\w.]+))?")
_PYTHON_PACKAGE = re.compile(r"^\s*ament_python_install_package\s*\(", re.MULTILINE | re.IGNORECASE)
_COMPILED_NODE = re.compile(r"rclcpp_components_register_node\s*\([^)]*\bEXECUTABLE\s+\"?([\w.-]+)", re.IGNORECASE)
NOT_FOR_PROGRAMS = frozenset({"setup", "conftest", "test", "tests"})
_ASK_SECONDS = 10.0
_ASK = """
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


@dataclass(frozen=True, slots=True)
class EntryPoint:
    """A function that is a program.

    Attributes:
        module: full name of its module.
        function: its name there, perhaps with dots.
    """

    module: str
    function: str

    def __str__(self) -> str:
        return f"{self.module}:{self.function}"


@dataclass
class SourcePrograms:
    """What a source package would install to ``lib/PACKAGE``.

    Attributes:
        folder: the package.
        entry_points: by the program's name.
        scripts: files by the program's name.
        compiled: names of programs that have to be built first.
    """

    folder: Path
    entry_points: dict[str, EntryPoint] = field(default_factory=dict)
    scripts: dict[str, Path] = field(default_factory=dict)
    compiled: set[str] = field(default_factory=set)

    def names(self) -> list[str]:
        """The names of all programs, built or not, sorted."""
        return sorted({*self.entry_points, *self.scripts, *self.compiled})


def source_programs(folder: Path) -> SourcePrograms:
    """The programs of a source package."""
    found = SourcePrograms(folder)
    _read_pyproject(found)
    _read_setup_cfg(found)
    _read_setup_py(found)
    _read_cmake(found)
    return found


def python_root(folder: Path, package: str) -> Path | None:
    """The folder to import the Python modules of a source package from; None where it has none."""
    for candidate in (folder, folder / "src"):
        if (candidate / package / "__init__.py").is_file():
            return candidate
    if _PYTHON_PACKAGE.search(_text(folder / "CMakeLists.txt")):
        return folder
    is_python = (folder / "setup.py").is_file() or (folder / "setup.cfg").is_file()
    return folder if is_python and any(_modules(folder)) else None


def module_file(root: Path, module: str) -> Path | None:
    """The file of a module below a folder; None where there is none."""
    path = root.joinpath(*module.split("."))
    for candidate in (path.with_name(path.name + ".py"), path / "__init__.py"):
        if candidate.is_file():
            return candidate
    return None


def _modules(folder: Path) -> Iterator[Path]:
    """The modules and packages in a folder that a program could import; not those for building and testing."""
    for path in (*folder.glob("*.py"), *(each.parent for each in folder.glob("*/__init__.py"))):
        if path.stem not in NOT_FOR_PROGRAMS:
            yield path


def _read_pyproject(found: SourcePrograms) -> None:
    text = _text(found.folder / "pyproject.toml")
    if not text:
        return
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib  # type: ignore[import-not-found, unused-ignore]
    try:
        project = tomllib.loads(text).get("project", {})
    except tomllib.TOMLDecodeError:
        return
    scripts = project.get("scripts", {}) if isinstance(project, dict) else {}
    for name, target in scripts.items():
        _add_entry(found, f"{name} = {target}")


def _read_setup_cfg(found: SourcePrograms) -> None:
    parser = ConfigParser(interpolation=None)
    try:
        parser.read_string(_text(found.folder / "setup.cfg"))
    except ConfigError:
        return
    for line in parser.get("options.entry_points", "console_scripts", fallback="").splitlines():
        _add_entry(found, line)
    for line in parser.get("options", "scripts", fallback="").splitlines():
        _add_script(found, line.strip())


def _read_setup_py(found: SourcePrograms) -> None:
    from linkwright.lint.setup_reader import read_setup

    path = found.folder / "setup.py"
    text = _text(path)
    if not text:
        return
    facts = read_setup(SourceText(str(path), text))
    for entry in facts.entry_points:
        found.entry_points[entry.executable] = EntryPoint(entry.module, entry.function or "main")
    computed = facts.call and not facts.entry_points_complete
    if computed or re.search(r"\bscripts\s*=", text):
        entries, scripts = _asked(found.folder)
        for line in entries:
            _add_entry(found, line)
        for name in scripts:
            _add_script(found, name)


def _asked(folder: Path) -> tuple[list[str], list[str]]:
    """The entry points and scripts that a ``setup.py`` gives when it runs; none where it fails."""
    try:
        done = subprocess.run(  # noqa: S603 - the user asks for a program of this very package
            [sys.executable, "-c", _ASK], cwd=folder, capture_output=True, timeout=_ASK_SECONDS, check=True, text=True
        )
        entries, scripts = json.loads(done.stdout.splitlines()[-1])
    except (OSError, subprocess.SubprocessError, ValueError, IndexError):
        return [], []
    return [str(each) for each in entries], [str(each) for each in scripts]


def _read_cmake(found: SourcePrograms) -> None:
    path = found.folder / "CMakeLists.txt"
    text = _text(path)
    if not text:
        return
    from linkwright.lint.cmake_reader import read_cmake

    file = read_cmake(SourceText(str(path), text))
    for name, relative in file.programs.items():
        _add_script(found, relative, name)
    found.compiled |= file.executables - set(file.programs)
    found.compiled |= set(_COMPILED_NODE.findall(text))


def _add_entry(found: SourcePrograms, line: Any) -> None:
    match = _ENTRY.match(line) if isinstance(line, str) else None
    if match is not None:
        found.entry_points[match[1]] = EntryPoint(match[2], match[3] or "main")


def _add_script(found: SourcePrograms, relative: str, name: str | None = None) -> None:
    path = found.folder / relative
    if relative and path.is_file():
        found.scripts[name or path.name] = path


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
