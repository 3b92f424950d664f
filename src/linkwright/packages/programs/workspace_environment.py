"""The environment that lets a user's executable find the same packages as its launcher."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path

from linkwright.packages import PackageFinder, install_prefix, is_installed, is_substitute
from linkwright.packages.finder import START_VARIABLE
from linkwright.packages.programs.source_programs import find_python_root

_PREFIX_VARIABLE = "AMENT_PREFIX_PATH"
_PYTHON_VARIABLE = "PYTHONPATH"


def make_workspace_environment(finder: PackageFinder, base: Mapping[str, str]) -> dict[str, str]:
    """Return an environment as if all workspaces were built and sourced.

    Args:
        finder: the finder of packages.
        base: the environment to extend; its own entries come first.
    """
    environment = dict(base)
    environment[START_VARIABLE] = os.pathsep.join(map(str, finder.starts))
    existing_prefixes = set(base.get(_PREFIX_VARIABLE, "").split(os.pathsep))
    prefixes: dict[str, None] = {}
    folders: dict[str, None] = {}
    for name, share in finder.packages().items():
        if is_substitute(share):
            continue  # only programs with Linkwright's finder can use this package
        prefix = install_prefix(share)
        if not is_installed(share):
            root = find_python_root(share, name)
            if root is not None:
                folders[str(root)] = None
        elif str(prefix) not in existing_prefixes:
            prefixes[str(prefix)] = None
            folders.update((str(folder), None) for folder in find_python_folders(prefix, name))
    _append(environment, _PREFIX_VARIABLE, prefixes)
    _append(environment, _PYTHON_VARIABLE, folders)
    return environment


def find_python_folders(prefix: Path, package: str) -> Iterator[Path]:
    """Yield the folders that contain an installed package's Python modules.

    With ``--symlink-install``, the environment hooks of the package name some of these folders.
    """
    for pattern in ("lib/python*/site-packages", "local/lib/python*/dist-packages"):
        yield from prefix.glob(pattern)
    for hook in (prefix / "share" / package / "hook").glob("pythonpath*.dsv"):
        try:
            lines = hook.read_text(encoding="utf-8").splitlines()
        except OSError:
            continue
        for line in lines:
            _, _, assignment = line.partition(";")
            variable, _, value = assignment.partition(";")
            if variable == _PYTHON_VARIABLE and value:
                yield prefix / value


def _append(environment: dict[str, str], name: str, entries: Mapping[str, None]) -> None:
    existing_entries = [entry for entry in environment.get(name, "").split(os.pathsep) if entry]
    new_entries = [entry for entry in entries if entry not in existing_entries]
    if new_entries:
        environment[name] = os.pathsep.join([*existing_entries, *new_entries])
