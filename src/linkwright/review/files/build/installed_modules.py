"""Find the executables of a ``setup.py`` whose module is not in an installed Python package."""

from __future__ import annotations

import ast
from pathlib import Path

from linkwright.diagnostics import Phrase, SourceText, phrase
from linkwright.packages.readers.python_values import PythonFile, argument_of, called_name
from linkwright.packages.readers.setup_py import SetupFile, read_setup
from linkwright.review.file_pair import FilePair

FIND_PACKAGES = "find_packages"
_PACKAGE_FOLDERS = "package_dir"


def compare_modules(pair: FilePair) -> None:
    """Report the executables whose module was removed, or is in a Python package that is not installed."""
    setups = [_read_setup_file(file) for file in (pair.old_file, pair.new_file)]
    old_names = {program.executable for program in setups[0].entry_points}
    old_faults = _find_faults(setups[0], pair.old_file.parent)
    new_faults = _find_faults(setups[1], pair.new_file.parent)
    for program in setups[1].entry_points:
        name, path = program.executable, program.module.replace(".", "/")
        files = [f"{path}.py", f"{path}/__init__.py"]
        had_module, has_module = (
            any((file.parent / name).is_file() for name in files) for file in (pair.old_file, pair.new_file)
        )
        fault = new_faults.get(name)
        if had_module and not has_module:
            text = phrase("executable '{name}': its module '{module}' was removed", name=name, module=program.module)
        elif fault is not None and name not in old_faults:
            text = phrase("executable '{name}': {fault}", name=name, fault=fault)
        else:
            continue
        was_started = name in old_names or fault is None
        reason = phrase("the executable no longer starts") if was_started else phrase("the executable does not start")
        pair.add(text, pair.location(program.span), reason)


def finds_packages(python: PythonFile, node: ast.expr) -> bool:
    """Return whether an expression is a call of ``find_packages`` for the folder of the file."""
    call = python.resolved(node)
    if not isinstance(call, ast.Call) or called_name(call).rpartition(".")[2] != FIND_PACKAGES or call.args:
        return False
    excluded = argument_of(call, "exclude")
    is_literal = excluded is None or (
        isinstance(excluded, (ast.List, ast.Tuple)) and None not in map(python.text, excluded.elts)
    )
    return is_literal and all(keyword.arg == "exclude" for keyword in call.keywords)


def _read_setup_file(file: Path) -> SetupFile:
    return read_setup(SourceText(str(file), file.read_text(encoding="utf-8", errors="replace")))


def _find_faults(setup: SetupFile, folder: Path) -> dict[str, Phrase]:
    """Return why modules that exist are not installed, by the names of their executables.

    Like setuptools, ``find_packages`` skips a folder without ``__init__.py`` and the folders in it.
    """
    python = None if setup.tree is None else PythonFile(setup.source)
    call = None if python is None else next(python.calls("setup"), None)
    packages = None if call is None else argument_of(call, "packages")
    if python is None or packages is None or _PACKAGE_FOLDERS in setup.source.text:
        return {}
    value = python.resolved(packages)
    listed = [python.text(item) for item in value.elts] if isinstance(value, (ast.List, ast.Tuple)) else None
    is_searched = finds_packages(python, packages)
    faults = {}
    for program in setup.entry_points:
        package = program.module.rpartition(".")[0]
        if not package or not (folder / f"{program.module.replace('.', '/')}.py").is_file():
            continue
        parts = package.split(".")
        parents = [".".join(parts[: count + 1]) for count in range(len(parts))]
        empty = next((name for name in parents if not (folder / name.replace(".", "/") / "__init__.py").is_file()), "")
        if is_searched and empty:
            text = phrase("find_packages() does not install '{package}', which has no __init__.py", package=empty)
        elif listed is not None and None not in listed and package not in listed:
            text = phrase("setup.py does not install the Python package '{package}' of its module", package=package)
        else:
            continue
        faults[program.executable] = text
    return faults
