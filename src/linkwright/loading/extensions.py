"""Extensions of Linkwright, which packages declare as entry points.

Linkwright declares its own extensions in the same way. Each group, such as ``linkwright.displays`` or
``linkwright.page_features``, belongs to one subpackage. The entry points of all installed packages are read once, and
an object is imported only when it is loaded.

Entry points are read from ``*.dist-info`` in the folders of the search path (PyPA, "Entry points specification").
`importlib.metadata` would also find them in archives. However, importing it takes as long as all other imports of
``linkwright check`` together.
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

_OWN_PREFIX = "linkwright."
_NODES_GROUP = "linkwright.nodes"
"""A group that the distribution linkwright declares, but not linkwright-core."""
_READ_PREFIXES = (_OWN_PREFIX, "launch_ros.")
"""The prefixes of the groups that are read.

They are the groups of Linkwright, and the groups of launch_ros, which packages also extend.
"""


class EntryPoint(NamedTuple):
    """A named object that an installed package declares.

    Attributes:
        name: the name, which is unique in its group.
        value: the location of the object, as ``module`` or ``module:attribute``.
        distribution: the name of the installed package.
    """

    name: str
    value: str
    distribution: str

    def load(self) -> Any:
        """Import the module, and return the object.

        Raises:
            Exception: the module cannot be imported.
            AttributeError: the module has no such attribute.
        """
        module, _, attribute = self.value.partition(":")
        loaded = import_module(module.strip())
        attribute = attribute.partition("[")[0].strip()  # remove extras, which the specification allows here
        return attrgetter(attribute)(loaded) if attribute else loaded


def extensions(group: str) -> Mapping[str, EntryPoint]:
    """Return the entry points of a group by name.

    Linkwright's own entry points precede those of other packages.

    The entry points of a package are sorted by name, because the order in which a package declares them is not
    reliable: some build tools sort them in the metadata. If two packages declare the same name, the first one that was
    found is used. Linkwright's own entry points cannot be replaced.

    A group is empty if no installed package declares it, for example if linkwright-core is installed alone.

    Raises:
        RuntimeError: one of Linkwright's groups is missing, because the installed metadata is older than the code.
    """
    groups = _read_all_groups()
    if group.startswith(_OWN_PREFIX) and group not in groups and _NODES_GROUP in groups:
        raise RuntimeError(f"Linkwright's metadata lacks the entry points '{group}': reinstall it")
    return groups.get(group, {})


@cache
def _read_all_groups() -> Mapping[str, Mapping[str, EntryPoint]]:
    groups: dict[str, dict[str, EntryPoint]] = {}
    entries = [item for distribution, text in _read_declarations() for item in _parse_declaration(distribution, text)]
    for group, entry_point in sorted(
        entries, key=lambda item: (not item[1].value.startswith(_OWN_PREFIX), item[1].name)
    ):
        groups.setdefault(group, {}).setdefault(entry_point.name, entry_point)
    return groups


def _read_declarations() -> Iterator[tuple[str, str]]:
    """Yield the name and the entry-point text of each distribution that has entry points.

    If several distributions have the same name, only the first one is yielded.
    """
    yielded_names = set()
    for folder in sys.path:
        try:
            names = sorted(entry.name for entry in os.scandir(folder or "."))
        except OSError:
            continue  # an archive, or a folder that does not exist
        for name in names:
            if not name.endswith((".dist-info", ".egg-info")):
                continue
            distribution = name.rpartition(".")[0].partition("-")[0]
            try:
                with open(os.path.join(folder, name, "entry_points.txt"), encoding="utf-8") as file:  # noqa: PTH118, PTH123 - pathlib takes long to import
                    text = file.read()
            except (OSError, UnicodeDecodeError):
                continue
            if distribution not in yielded_names:
                yielded_names.add(distribution)
                yield distribution, text


def _parse_declaration(distribution: str, text: str) -> Iterator[tuple[str, EntryPoint]]:
    """Yield the group and the entry point of each line in an ``entry_points.txt``.

    Groups that are not in use are skipped.
    """
    group = ""
    for line in map(str.strip, text.splitlines()):
        if line.startswith("["):
            group = line.strip("[]").strip()
        elif group.startswith(_READ_PREFIXES) and line and not line.startswith(("#", ";")):
            name, _, value = line.partition("=")
            yield group, EntryPoint(name.strip(), value.strip(), distribution)
