"""The ament linters that the tests of a new Python package call.

These are ``ament_flake8``, ``ament_pep257`` and ``ament_copyright``. The first two run flake8 and pydocstyle with the
settings of ``ament_lint``. If flake8 or pydocstyle is not installed, the test is skipped with this reason.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from importlib.util import find_spec
from pathlib import Path

_MAX_LINE_LENGTH = 99
_IGNORED_DOCSTRING_RULES = ("D100", "D101", "D102", "D103", "D104", "D105", "D106", "D107", "D203", "D212", "D404")
"""The docstring rules that ament disables: missing docstrings, and one rule of each contradictory pair."""
_IGNORED_STYLE_RULES = ("B902", "C816", "I202", *_IGNORED_DOCSTRING_RULES)
_SOURCE_SUFFIXES = frozenset({".c", ".cc", ".cmake", ".cpp", ".cxx", ".h", ".hh", ".hpp", ".hxx", ".py"})
_HEADER_LENGTH = 4000
"""The number of characters at the start of a file in which its copyright notice and license are searched for."""
_COPYRIGHT = re.compile(r"copyright.*\d{4}|SPDX-FileCopyrightText:", re.IGNORECASE)
_LICENSE = re.compile(
    r"licensed under|SPDX-License-Identifier:|permission is hereby granted|redistribution and use|GNU \w* ?general",
    re.IGNORECASE,
)


def flake8(argv: Sequence[str] | None = None) -> int:
    """Run flake8 on a package.

    Return 0 if there are no findings, otherwise 1.

    Args:
        argv: options and paths of the command ``ament_flake8``; None for the arguments of this process.
    """
    return flake8_with_errors(argv)[0]


def flake8_with_errors(argv: Sequence[str] | None = None) -> tuple[int, list[str]]:
    """Run flake8 on a package, and return the exit status and one line per finding."""
    parser = _create_parser("ament_flake8")
    parser.add_argument("--config")
    parser.add_argument("--linelength", type=int)
    options = parser.parse_args(argv)
    if options.config:
        settings = [f"--config={options.config}"]
    else:
        settings = [
            "--isolated",
            f"--extend-ignore={','.join(_IGNORED_STYLE_RULES)}",
            f"--max-line-length={_MAX_LINE_LENGTH}",
        ]
        if find_spec("flake8_import_order") is not None:
            settings.append("--import-order-style=google")
    if options.linelength:
        settings.append(f"--max-line-length={options.linelength}")
    return _run("flake8", settings, [path for path in _find_source_files(options) if path.suffix == ".py"])


def pep257(argv: Sequence[str] | None = None) -> int:
    """Run pydocstyle on a package.

    Return 0 if there are no findings, otherwise 1.

    Args:
        argv: options and paths of the command ``ament_pep257``; None for the arguments of this process.
    """
    parser = _create_parser("ament_pep257")
    for name in ("--ignore", "--select", "--add-ignore", "--add-select"):
        parser.add_argument(name, nargs="+", default=[])
    parser.add_argument("--convention", default="ament")
    options = parser.parse_args(argv)
    if options.select:
        settings = [f"--select={','.join(options.select)}"]
    elif options.ignore or options.convention == "ament":
        settings = [f"--ignore={','.join(options.ignore or _IGNORED_DOCSTRING_RULES)}"]
    else:
        settings = [f"--convention={options.convention}"]
    settings += [f"--{name}={','.join(codes)}" for name, codes in _find_additional_codes(options)]
    return _run("pydocstyle", settings, [path for path in _find_source_files(options) if path.suffix == ".py"])[0]


def copyright_headers(argv: Sequence[str] | None = None) -> int:
    """Check each source file for a copyright notice and a license.

    Return 0 if all files have both, otherwise 1.

    Args:
        argv: paths and options of the command ``ament_copyright``; None for the arguments of this process.
    """
    files = [
        path
        for path in _find_source_files(_create_parser("ament_copyright").parse_args(argv))
        if not _is_setup_of_package(path)
    ]
    findings = []
    for path in files:
        header = path.read_text(encoding="utf-8", errors="replace")[:_HEADER_LENGTH]
        if header and not _COPYRIGHT.search(header):
            findings.append(f"{path}: could not find copyright notice")
        elif header and not _LICENSE.search(header):
            findings.append(f"{path}: could not find a license that is known")
    print("\n".join([*findings, f"{len(findings)} errors, checked {len(files)} files"]))
    return int(bool(findings))


def _create_parser(name: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(name)
    parser.add_argument("paths", nargs="*", type=Path, default=[Path()])
    parser.add_argument("--exclude", nargs="*", type=Path, default=[])
    return parser


def _find_additional_codes(options: argparse.Namespace) -> Iterator[tuple[str, list[str]]]:
    for name in ("add_ignore", "add_select"):
        if codes := getattr(options, name):
            yield name.replace("_", "-"), codes


def _find_source_files(options: argparse.Namespace) -> list[Path]:
    """Return the source files in the paths of the options.

    Excluded files, hidden folders and folders with ``AMENT_IGNORE`` are skipped.
    """
    excluded_paths = {path.resolve() for path in options.exclude}
    paths: set[Path] = set()
    for root in options.paths:
        if root.is_file():
            paths.add(root)
        for folder, folders, names in os.walk(root):
            folders[:] = [] if "AMENT_IGNORE" in names else [name for name in folders if name[0] not in "._"]
            paths.update(Path(folder, name) for name in names if "AMENT_IGNORE" not in names)
    source_paths = (path for path in paths if path.suffix in _SOURCE_SUFFIXES)
    return sorted(path for path in source_paths if excluded_paths.isdisjoint((path.resolve(), *path.resolve().parents)))


def _is_setup_of_package(path: Path) -> bool:
    return path.name == "setup.py" and path.with_name("package.xml").is_file()


def _run(module: str, settings: Sequence[str], files: Sequence[Path]) -> tuple[int, list[str]]:
    """Run a linter on files, print its output, and return the exit status and the output lines.

    If the linter is not installed, skip the current test.
    """
    if not files:
        return 0, []
    if find_spec(module) is None:
        _skip(f"{module} is not installed beside pytest")
    # Running this command is safe: the files belong to the user, and the user installed the program.
    command = [sys.executable, "-m", module, *settings, *map(str, files)]
    completed = subprocess.run(command, capture_output=True, encoding="utf-8", check=False)  # noqa: S603
    print(completed.stdout, end="")
    print(completed.stderr, end="", file=sys.stderr)
    return int(completed.returncode != 0), completed.stdout.splitlines()


def _skip(reason: str) -> None:
    import pytest  # imported here; a test calls this function, so pytest is already loaded

    pytest.skip(reason)
