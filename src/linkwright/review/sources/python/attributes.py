"""Find the declared attributes of Python classes, and those that a version no longer has."""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator, Mapping, Sequence

from linkwright.review.sources.names import PYTHON_SUFFIX, SourceName, SourceNames
from linkwright.review.versions import Version

_PROPERTIES = frozenset({"property", "cached_property", "functools.cached_property"})
"""The decorators with which a method is read as an attribute."""


def find_attributes(definition: ast.ClassDef) -> Iterator[tuple[str, ast.stmt]]:
    """Yield the public attributes that the body of a class declares: those with a type, and properties."""
    names: dict[str, ast.stmt] = {}
    for node in definition.body:
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            names.setdefault(node.target.id, node)
        elif isinstance(node, ast.FunctionDef) and any(
            ast.unparse(item) in _PROPERTIES for item in node.decorator_list
        ):
            names.setdefault(node.name, node)
    yield from ((name, node) for name, node in names.items() if not name.startswith("_"))


def select_attributes(
    items: Sequence[SourceName], own: SourceNames, other: SourceNames, version: Version, package: str
) -> list[SourceName]:
    """Return the attributes that only one version has, without those that the other version sets or inherits.

    An attribute of a class with base classes of other packages may only replace a default of theirs, unless the package
    reads it. Classes that one version lacks are left out, too.

    Args:
        items: the attributes of one version.
        own: the names in the source of this version.
        other: the names in the source of the other version.
        version: this version.
        package: the folder of the package.
    """
    return [
        item
        for item in items
        if _is_lost(item, other.attributes, other.class_names)
        and (item.name.rpartition(".")[0] in own.inherited_names or _is_read(item, version, package))
    ]


def _is_lost(item: SourceName, attributes: Collection[str], class_names: Mapping[str, Collection[str]]) -> bool:
    """Return whether a source that has the class of an attribute sets the attribute nowhere."""
    owner, _, name = item.name.rpartition(".")
    return owner in class_names and name not in class_names[owner] and name not in attributes


def _is_read(item: SourceName, version: Version, package: str) -> bool:
    """Return whether a Python file of the package reads an attribute with the name."""
    pattern = re.compile(rf"\.{re.escape(item.name.rpartition('.')[2])}\b")
    return any(pattern.search(version.text(path)) for path in version.paths((PYTHON_SUFFIX,), package))
