"""Compare the entry points and the installed files in ``setup.py`` files."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import SourceText, foreign
from linkwright.packages.readers.installed import PROGRAM_GROUP
from linkwright.packages.readers.python_values import PythonFile, argument_of, called_name
from linkwright.packages.readers.setup_py import SetupFile, read_setup
from linkwright.review.file_pair import FilePair, UnreadableFileError
from linkwright.review.files.build.comparison import compare_build_files
from linkwright.review.files.build.facts import BuildFacts, Fact, FactKind
from linkwright.review.files.build.installed_modules import FIND_PACKAGES, compare_modules, finds_packages
from linkwright.review.versions import Version

SETUP_FILE = "setup.py"
_CATKIN_SETUP = "generate_distutils_setup"
_COMPARED_ARGUMENTS = frozenset({"entry_points", "data_files", "packages"})
_SHOWN_ARGUMENTS = frozenset({"name", "version", "description", "python_requires", "license"})
"""The arguments of ``setup`` whose string values are shown."""


def compare_setup_files(pair: FilePair) -> None:
    """Compare two versions of a ``setup.py`` without running it."""
    compare_build_files(pair, read_setup_facts)
    compare_modules(pair)


def read_setup_facts(version: Version, path: str) -> BuildFacts:
    """Return the facts of a ``setup.py``.

    Raises:
        UnreadableFileError: the file is not valid Python.
    """
    file = version.file(path)
    source = SourceText(str(file), file.read_text(encoding="utf-8", errors="replace"))
    setup = read_setup(source)
    if setup.error is not None:
        raise UnreadableFileError(foreign(setup.error.message))
    parent = PurePosixPath(path).parent.as_posix()
    facts = BuildFacts(package="" if parent == "." else parent)
    facts.unknown = frozenset() if setup.has_call else frozenset({"setup"})
    facts.project = "" if setup.name is None else setup.name[0]
    for installed in setup.installed_files(file.parent):
        facts.files[installed.destination] = installed.source
    facts.facts += [
        Fact(FactKind.EXECUTABLE, program.executable, f"{program.module}:{program.function or ''}", program.span)
        for program in setup.entry_points
    ]
    facts.facts += [Fact(FactKind.MODULE, name, span=span) for name, span in setup.packages or ()]
    facts.facts += _find_other_packages(PythonFile(source), file.parent)
    _read_call(facts, setup, PythonFile(source))
    return facts


def _find_other_packages(python: PythonFile, folder: Path) -> Iterator[Fact]:
    """Yield the Python packages that ``find_packages`` finds, or that catkin installs."""
    for call in python.calls(FIND_PACKAGES):
        excluded = [python.text(item) for item in getattr(argument_of(call, "exclude"), "elts", ())]
        for name in _find_packages_below(folder, ""):
            if not any(fnmatchcase(name, pattern) for pattern in excluded if pattern is not None):
                yield Fact(FactKind.MODULE, name, span=python.span(call))
    for packages in _list_catkin_packages(python):
        for item in getattr(python.resolved(packages), "elts", ()):
            package = python.text(item)
            if package is not None:
                yield Fact(FactKind.MODULE, package, span=python.span(item))


def _list_catkin_packages(python: PythonFile) -> Iterator[ast.expr]:
    """Yield the packages that ``generate_distutils_setup`` gets as argument or that its result gets as item."""
    calls = list(python.calls(_CATKIN_SETUP))
    yield from (packages for call in calls if (packages := argument_of(call, "packages")) is not None)
    assignments = [node for node in ast.walk(python.tree) if isinstance(node, ast.Assign)] if calls else []
    for node in assignments:
        target = node.targets[0]
        if not isinstance(target, ast.Subscript) or python.text(target.slice) != "packages":
            continue
        settings = python.resolved(target.value)
        if isinstance(settings, ast.Call) and called_name(settings).rpartition(".")[2] == _CATKIN_SETUP:
            yield node.value


def _find_packages_below(folder: Path, prefix: str) -> Iterator[str]:
    """Yield the names of the Python packages in a folder, including nested ones, except tests."""
    for file in sorted(folder.glob("*/__init__.py")):
        name = f"{prefix}{file.parent.name}"
        if not name.startswith("test"):
            yield name
            yield from _find_packages_below(file.parent, f"{name}.")


def _read_call(facts: BuildFacts, setup: SetupFile, python: PythonFile) -> None:
    call = next(python.calls("setup"), None)
    if call is None:
        return
    facts.facts += _read_entry_points(python, argument_of(call, "entry_points"))
    for keyword in call.keywords:
        is_known = keyword.arg != "packages" or setup.packages is not None or finds_packages(python, keyword.value)
        if keyword.arg in _COMPARED_ARGUMENTS and is_known:
            continue
        text = python.text(keyword.value)
        if keyword.arg in _SHOWN_ARGUMENTS and text is not None:
            facts.facts.append(Fact(FactKind.SETTING, keyword.arg or "", text, python.span(keyword.value)))
        else:
            facts.other_commands.append((keyword.arg or "**", " ".join(ast.unparse(keyword.value).split())))


def _read_entry_points(python: PythonFile, node: ast.expr | None) -> Iterator[Fact]:
    """Yield the entry points of all groups except the executables."""
    entries = None if node is None else python.resolved(node)
    if not isinstance(entries, ast.Dict):
        return
    for key, value in zip(entries.keys, entries.values, strict=True):
        group, items = python.text(key), python.resolved(value)
        if group is None or group == PROGRAM_GROUP or not isinstance(items, (ast.List, ast.Tuple)):
            continue
        for item in items.elts:
            name, _, target = (python.text(item) or "").partition("=")
            if target:
                yield Fact(FactKind.ENTRY_POINT, f"{group}: {name.strip()}", target.strip(), python.span(item))
