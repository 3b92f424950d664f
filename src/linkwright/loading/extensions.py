"""Extensions of Linkwright, which packages declare as entry points.

Linkwright's own extensions are declared in the same way. Each group belongs to one subpackage: ``linkwright.displays``,
``linkwright.page_features`` and others. The entry points of all installed packages are read once, and an object is
imported only when it is loaded.

Entry points are read from ``*.dist-info`` in the folders of the search path (PyPA, "Entry points specification").
`importlib.metadata` also finds them in archives, but importing it takes as long as all other imports of
``linkwright check`` before a file is read.
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
    """An object of an installed package that is declared by a name.

    Attributes:
        name: the name, which is unique in the group.
        value: ``module`` or ``module:attribute``.
        distribution: the name of the installed package.
    """

    name: str
    value: str
    distribution: str

    def load(self) -> Any:
        """Import the module, and return the object.

        Raises:
            Exception: any error raised by importing the module, or AttributeError.
        """
        module, _, attribute = self.value.partition(":")
        found = import_module(module.strip())
        attribute = attribute.partition("[")[0].strip()  # remove extras, which the specification allows here
        return attrgetter(attribute)(found) if attribute else found


def extensions(group: str) -> Mapping[str, EntryPoint]:
    """Return the entry points of a group by name, Linkwright's before other packages'.

    The entry points of a package are sorted by name. The order in which a package declares them is not reliable,
    because some build tools sort entry points in the metadata. If two packages declare the same name, the first one
    found is used; Linkwright's cannot be replaced.

    A group is empty if no installed package declares it, for instance if linkwright-core is installed alone.

    Raises:
        RuntimeError: a group of Linkwright is missing, because the installation's metadata is older than its code.
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
    """Yield the name and the entry-point file of each distribution that has one.

    If several distributions have the same name, only the first is used.
    """
    seen = set()
    for folder in sys.path:
        try:
            entries = sorted(entry.name for entry in os.scandir(folder or "."))
        except OSError:
            continue  # an archive, or a folder that does not exist
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
    """Yield the group and the entry point for each line of an ``entry_points.txt``.

    Groups that are not Linkwright's are skipped.
    """
    group = ""
    for line in map(str.strip, text.splitlines()):
        if line.startswith("["):
            group = line.strip("[]").strip()
        elif group.startswith(_READ) and line and not line.startswith(("#", ";")):
            name, _, value = line.partition("=")
            yield group, EntryPoint(name.strip(), value.strip(), distribution)
