"""Extensions of Linkwright, found through the entry points of packages; our own are declared the same way.

A group is read by its room: ``linkwright.displays``, ``linkwright.page_features`` and others. The entry
points of all installed packages are read once, and each object is imported only when it is loaded.

They are read from where their specification puts them (PyPA, "Entry points specification"), ``*.dist-info`` in the
folders of the search path. `importlib.metadata` finds them in archives too, but loading it takes as long as all other
imports of ``linkwright check`` before it reads a file.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping
from functools import cache
from importlib import import_module
from operator import attrgetter

from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.loading.lean_typing import Any

_OURS = "linkwright."
_NODES = "linkwright.nodes"
"""A group that linkwright declares, and linkwright-core does not."""
_READ = (_OURS, "launch_ros.")
"""The prefixes of the groups in use: ours, and those of launch_ros, which its users' packages extend too."""


class EntryPoint(NamedTuple):
    """An object of an installed package that is used by its name.

    Attributes:
        name: unique within the group.
        value: ``module`` or ``module:attribute``.
        distribution: the package that was installed.
    """

    name: str
    value: str
    distribution: str

    def load(self) -> Any:
        """The object.

        Raises:
            Exception: whatever its module raises when it is imported, or AttributeError.
        """
        module, _, attribute = self.value.partition(":")
        found = import_module(module.strip())
        attribute = attribute.partition("[")[0].strip()  # extras, which the specification allows here
        return attrgetter(attribute)(found) if attribute else found


def extensions(group: str) -> Mapping[str, EntryPoint]:
    """The entry points of a group by name: ours first, then those of other packages, each in the order of names.

    The order in which a package declares them does not reach its metadata: some build tools sort them, others do not.
    If two packages declare the same name, the first one found applies; ours cannot be replaced.

    A group is empty where no installed package declares it: linkwright-core alone has few.

    Raises:
        RuntimeError: a group of ours is missing, because the installation's metadata is older than its code.
    """
    found = _all_groups()
    if group.startswith(_OURS) and group not in found and _NODES in found:
        raise RuntimeError(f"Linkwright's metadata lacks the entry points '{group}': reinstall it")
    return found.get(group, {})


@cache
def _all_groups() -> Mapping[str, Mapping[str, EntryPoint]]:
    groups: dict[str, dict[str, EntryPoint]] = {}
    found = [item for distribution, text in _declarations() for item in _declared(distribution, text)]
    for group, entry in sorted(found, key=lambda item: (not item[1].value.startswith(_OURS), item[1].name)):
        groups.setdefault(group, {}).setdefault(entry.name, entry)
    return groups


def _declarations() -> Iterator[tuple[str, str]]:
    """Each installed distribution that declares entry points, by name, with the text; the first of a name counts."""
    seen = set()
    for folder in sys.path:
        try:
            entries = sorted(entry.name for entry in os.scandir(folder or "."))
        except OSError:
            continue  # an archive, or not there
        for entry in entries:
            if not entry.endswith((".dist-info", ".egg-info")):
                continue
            distribution = entry.rpartition(".")[0].partition("-")[0]
            try:
                with open(os.path.join(folder, entry, "entry_points.txt"), encoding="utf-8") as file:  # noqa: PTH118, PTH123 - pathlib takes long to import
                    text = file.read()
            except (OSError, UnicodeDecodeError):
                continue
            if distribution not in seen:
                seen.add(distribution)
                yield distribution, text


def _declared(distribution: str, text: str) -> Iterator[tuple[str, EntryPoint]]:
    """Group and entry point of each line of an ``entry_points.txt`` whose group is in use here."""
    group = ""
    for line in map(str.strip, text.splitlines()):
        if line.startswith("["):
            group = line.strip("[]").strip()
        elif group.startswith(_READ) and line and not line.startswith(("#", ";")):
            name, _, value = line.partition("=")
            yield group, EntryPoint(name.strip(), value.strip(), distribution)
