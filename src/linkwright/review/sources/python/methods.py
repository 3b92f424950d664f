"""Find undefined attributes and methods that Python classes use of themselves."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from linkwright.review.caching import cached_in_review
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.sources.python.bases import find_class, find_inherited_names
from linkwright.review.versions import Version

_DYNAMIC_NAMES = frozenset({"setattr", "__dict__", "__getattr__", "__getattribute__", "__setattr__", "vars"})
"""The names with which a class can get further attributes."""
_LOOKUPS = ("hasattr", "getattr")
_MAX_DEPTH = 8
_MAX_TREES = 256
"""The maximum number of syntax trees whose properties are kept. A source can have many classes."""


def find_defined_attributes(tree: ast.AST) -> Iterator[str]:
    """Yield the attributes that a source defines in classes or assigns to objects."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef):
            for part in node.body:
                if isinstance(part, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
                    yield part.name
                else:
                    yield from (inner.id for inner in ast.walk(part) if isinstance(inner, ast.Name))
        elif isinstance(node, ast.Attribute) and not isinstance(node.ctx, ast.Load):
            yield node.attr


def find_undefined_attributes(path: Path, tree: ast.Module) -> dict[str, tuple[ast.Attribute, str, bool]]:
    """Return the first use of each undefined attribute or method that a class uses of itself.

    Each has the name of the class, and whether it is a call. Classes with base classes of unknown packages, which may
    define the attribute, are left out, as are uses inside ``try`` and names that a source looks up with ``hasattr``.

    Args:
        path: the path of the source.
        tree: the syntax tree of the source.
    """
    looked_up = set(_find_looked_up(tree))
    first_uses: dict[str, tuple[ast.Attribute, str, bool]] = {}
    for definition in (node for node in tree.body if isinstance(node, ast.ClassDef)):
        known = find_known_attributes(path, tree, definition)
        for node, is_call in find_own_uses(definition) if known is not None else ():
            if known is not None and node.attr not in known | looked_up:
                first_uses.setdefault(node.attr, (node, definition.name, is_call))
    return first_uses


def find_known_attributes(path: Path, tree: ast.Module, definition: ast.ClassDef) -> frozenset[str] | None:
    """Return the attributes that objects of a class may have, or None if they are uncertain.

    They are uncertain if a base class is of an unknown package, or if a source sets attributes by computed names.

    Args:
        path: the path of the source.
        tree: the syntax tree of the source.
        definition: the class.
    """
    inherited = None if _is_dynamic(tree) else find_inherited_names(path, tree, definition)
    if inherited is None:
        return None
    bases = [found[1] for found in _find_bases(path, tree, definition)]
    if any(map(_is_dynamic, bases)):
        return None
    return frozenset(inherited).union(*map(find_defined_attributes, [tree, *bases]))


def is_defined_by_others(version: Version, path: str, class_name: str, name: str) -> bool:
    """Return whether another source that names a class may define one of its attributes, such as a derived class.

    Args:
        version: the version of the repository.
        path: the path of the source with the class.
        class_name: the name of the class.
        name: the name of the attribute.
    """
    definition = re.compile(
        rf"\bdef {name}\b|^\s+{name}\s*[:=]|\.{name}\s*(?::[^=\n]+)?=[^=]|['\"]{name}['\"]", re.MULTILINE
    )
    texts = (version.text(other) for other in version.paths((PYTHON_SUFFIX,)) if other != path)
    return any(class_name in text and definition.search(text) is not None for text in texts)


@cached_in_review(maxsize=_MAX_TREES)
def _is_dynamic(tree: ast.Module) -> bool:
    """Return whether a source can give objects attributes that it does not name."""
    names = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    names |= {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    return not _DYNAMIC_NAMES.isdisjoint(names | set(find_defined_attributes(tree)))


def _find_looked_up(tree: ast.Module) -> Iterator[str]:
    """Yield the names of attributes that a source looks up by text, because an object may lack them."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in _LOOKUPS:
            yield from (arg.value for arg in node.args if isinstance(arg, ast.Constant) and isinstance(arg.value, str))


def _find_bases(
    path: Path, tree: ast.Module, definition: ast.ClassDef, depth: int = 0
) -> Iterator[tuple[Path, ast.Module, ast.ClassDef]]:
    """Yield the base classes that the package defines, each with its source."""
    for base in definition.bases if depth < _MAX_DEPTH else ():
        name = base.value if isinstance(base, ast.Subscript) else base  # ``Generic[T]``
        found = find_class(path, tree, ast.unparse(name))
        if found is not None:
            yield found
            yield from _find_bases(*found, depth + 1)


def find_own_uses(definition: ast.ClassDef) -> Iterator[tuple[ast.Attribute, bool]]:
    """Yield the attributes of ``self`` that methods of a class read outside of ``try``, and whether they call them."""
    for method in definition.body:
        if not isinstance(method, (ast.FunctionDef, ast.AsyncFunctionDef)) or not method.args.args:
            continue
        if any(ast.unparse(decorator) == "staticmethod" for decorator in method.decorator_list):
            continue
        first = method.args.args[0].arg
        nodes = list(ast.walk(method))
        skipped = [part for node in nodes if isinstance(node, ast.Try) for part in node.body]
        skipped += [node for node in nodes if isinstance(node, ast.ClassDef)]
        skipped_ids = {id(inner) for part in skipped for inner in ast.walk(part)}
        called_ids = {id(node.func) for node in nodes if isinstance(node, ast.Call)}
        reads = (node for node in nodes if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load))
        for node in reads:
            is_own = isinstance(node.value, ast.Name) and node.value.id == first
            if is_own and id(node) not in skipped_ids and not node.attr.startswith("__"):
                yield node, id(node) in called_ids
