"""Find the names that a Python source binds, and the undefined names that it uses."""

from __future__ import annotations

import ast
import builtins
import re
from collections import Counter
from collections.abc import Iterator

_PYTHON_2_BUILTINS = frozenset(
    {
        *(
            "unicode",
            "xrange",
            "raw_input",
            "basestring",
            "unichr",
            "reduce",
            "file",
            "long",
            "cmp",
            "reload",
            "execfile",
        ),
        *("apply", "buffer", "coerce", "intern", "WindowsError", "_"),
    }
)
"""The builtins of Python 2, and builtins that other programs add."""
_DYNAMIC_NAMES = frozenset({"globals", "exec", "execfile", "setattr", "builtins", "__builtins__", "vars"})
"""The names with which a source can define further names."""
_OWN_OBJECT = "self"
"""The name of a parameter that no module has as a name of its own."""
_INTERFACES = re.compile(r"\w+\.(?:msg|srv|action)")
"""A module with the types of a package."""


def find_bound_names(tree: ast.AST) -> Iterator[str]:
    """Yield each name as often as a source binds it; ``*`` for all names of a module."""
    for node in ast.walk(tree):
        yield from _find_names_bound_by(node)


def _find_names_bound_by(node: ast.AST) -> Iterator[str]:
    if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
        yield node.name
    elif isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load):
        yield node.id
    elif isinstance(node, ast.arg):
        yield node.arg
    elif isinstance(node, ast.alias):
        yield node.asname or node.name.partition(".")[0]
    elif isinstance(node, (ast.Global, ast.Nonlocal)):
        yield from node.names
    elif isinstance(name := getattr(node, "name", None), str):
        yield name  # of an error, a pattern or the parameter of a type
    elif isinstance(rest_name := getattr(node, "rest", None), str):
        yield rest_name  # of a mapping pattern


def _walk_scope(scope: ast.ClassDef) -> Iterator[ast.AST]:
    """Yield the parts of a class outside of its functions and of the classes in it, such as default values."""
    pending: list[ast.AST] = list(scope.body)
    while pending:
        node = pending.pop()
        if isinstance(node, ast.arg):
            continue
        yield node
        inner: list[ast.AST] = []
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            inner = [*node.body]
        elif isinstance(node, ast.Lambda):
            inner = [node.body]
        pending += [child for child in ast.iter_child_nodes(node) if child not in inner]


def find_undefined_names(tree: ast.AST) -> dict[str, ast.Name]:
    """Return the first use of each name that the source certainly does not define.

    Uses in annotations, which need not be evaluated, and inside ``try`` are left out. Functions do not see the names of
    a class around them, such as those of its methods.
    """
    bound_names = Counter(find_bound_names(tree))
    class_scopes = [list(_walk_scope(node)) for node in ast.walk(tree) if isinstance(node, ast.ClassDef)]
    class_names = Counter(name for scope in class_scopes for node in scope for name in _find_names_bound_by(node))
    visible_ids = {id(node) for scope in class_scopes for node in scope}
    uses = [
        node
        for node in ast.walk(tree)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)
        if node.id not in bound_names or (class_names[node.id] == bound_names[node.id] and id(node) not in visible_ids)
    ]
    names = {node.id for node in uses} - set(dir(builtins)) - _PYTHON_2_BUILTINS
    has_star, brings_types = _read_star_imports(tree)
    if not _DYNAMIC_NAMES.isdisjoint(node.id for node in uses):
        return {}
    if has_star and not brings_types:
        names &= {_OWN_OBJECT}
    names = {name for name in names if not name.startswith("__") and not (has_star and name[:1].isupper())}
    skipped_ids = {id(inner) for part in _find_uncertain_parts(tree) for inner in ast.walk(part)} if names else set()
    first_uses: dict[str, ast.Name] = {}
    for node in sorted(uses, key=lambda node: (node.lineno, node.col_offset)):
        if node.id in names and id(node) not in skipped_ids:
            first_uses.setdefault(node.id, node)
    return first_uses


def _read_star_imports(tree: ast.AST) -> tuple[bool, bool]:
    """Return whether a source imports all names of a module, and whether all such modules only have types.

    The names of the types of messages, services and actions begin with capital letters.
    """
    imports = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    modules = [node.module or "" for node in imports if any(alias.name == "*" for alias in node.names)]
    return bool(modules), all(_INTERFACES.fullmatch(module) for module in modules)


def _find_uncertain_parts(tree: ast.AST) -> Iterator[ast.AST]:
    """Yield the annotations, and the statements whose errors are caught."""
    for node in ast.walk(tree):
        for name in ("annotation", "returns"):
            annotation = getattr(node, name, None)
            if annotation is not None:
                yield annotation
        if isinstance(node, ast.Try):
            yield from node.body
