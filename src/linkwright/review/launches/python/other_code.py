"""Normalize the code of a Python launch file besides its actions, to compare it."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Sequence
from copy import copy

from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.launches.expressions import shorten_text
from linkwright.review.launches.outlines import CodePart
from linkwright.review.launches.python.expression_texts import ExpressionTexts
from linkwright.review.launches.python.failing_tests import find_failing_tests

_COMBINING_CALLS = frozenset(
    {"add_action", "add_entity", "GroupAction", "LaunchDescription", "LoadComposableNodes", "TimerAction"}
)
"""The calls that only combine actions."""
_CALLING_CLASS = "OpaqueFunction"
_LIST_METHODS = ("append", "extend")
"""The methods that add actions to lists."""
_ACTION_ARGUMENTS = ("actions", "composable_node_descriptions", None)
"""The arguments of these calls that contain actions."""
_BODY_FIELDS = ("body", "orelse", "finalbody", "handlers", "cases")
"""The fields of statements that contain nested statements."""
_MAX_NAMES = 10
"""The maximum number of names through which an item of a value is followed."""
_SCOPES = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
_UNCOMPARED_FIELDS = frozenset({"ctx", "returns", "annotation", "type_comment", "type_params", "kind"})


def find_definitions(python: PythonFile, texts: ExpressionTexts) -> list[CodePart]:
    """Return the statements that assign a name for the only time."""
    normalizer = _CodeNormalizer(python, (), (), texts)
    scopes = _find_scopes(python.tree)
    return [
        CodePart("", _unparse(node), python.span(node), scopes=scopes[id(node)])
        for node in _find_statements(python.tree)
        if isinstance(node, (ast.Assign, ast.AnnAssign)) and normalizer.is_definition(node)
    ]


def read_other_code(
    python: PythonFile, covered: Collection[int], branches: Collection[int], texts: ExpressionTexts
) -> list[CodePart]:
    """Return the statements besides the actions in comparable form.

    The form lacks names of variables, imports, comments and layout.

    Args:
        python: the parsed file.
        covered: the identities of the calls that make actions.
        branches: the identities of the ``if`` statements whose conditions actions have.
        texts: the texts of the expressions of the file.
    """
    normalizer = _CodeNormalizer(python, covered, branches, texts)
    tests = find_failing_tests(python)
    scopes, conditions = _find_scopes(python.tree), _find_conditions(python.tree)
    parts = (
        CodePart(
            normalizer.format_statement(node),
            _unparse(_copy_header(node)),
            python.span(node),
            tests.get(id(node), ()),
            scopes[id(node)],
            conditions[id(node)],
        )
        for node in sorted(_find_statements(python.tree), key=lambda node: (node.lineno, node.col_offset))
    )
    return [part for part in parts if part.text]


def find_scope_sources(python: PythonFile) -> dict[str, str]:
    """Return the source of each function and class without comments and layout, by qualified name."""
    sources: dict[str, str] = {}
    scopes = _find_scopes(python.tree)
    for node in _find_statements(python.tree):
        if isinstance(node, _SCOPES):
            name = scopes[id(node)][-1]
            sources[name] = sources.get(name, "") + ast.unparse(node)
    return sources


def _find_scopes(tree: ast.AST) -> dict[int, tuple[str, ...]]:
    """Return the qualified names of the functions and classes that are or contain a statement, by its identity."""
    scopes: dict[int, tuple[str, ...]] = {}
    pending: list[tuple[ast.AST, tuple[str, ...]]] = [(tree, ())]
    while pending:
        node, around = pending.pop()
        if isinstance(node, _SCOPES):
            around = (*around, ".".join((*around[-1:], node.name)))
        if isinstance(node, ast.stmt):
            scopes[id(node)] = around
        pending += [(child, around) for child in ast.iter_child_nodes(node)]
    return scopes


def _find_conditions(tree: ast.AST) -> dict[int, str]:
    """Return the test of the innermost ``if`` around a statement, by the identity of the statement."""
    conditions: dict[int, str] = {}
    pending: list[tuple[ast.AST, str]] = [(tree, "")]
    while pending:
        node, around = pending.pop()
        if isinstance(node, ast.stmt):
            conditions[id(node)] = around
        if isinstance(node, ast.If):
            test = _unparse(node.test)
            pending += [(statement, f"if {test}") for statement in node.body]
            pending += [(statement, f"if not ({test})") for statement in node.orelse]
        else:
            pending += [(child, around) for child in ast.iter_child_nodes(node) if not isinstance(child, ast.expr)]
    return conditions


def _unparse(node: ast.AST) -> str:
    return " ".join(ast.unparse(node).split())


def _find_statements(tree: ast.AST) -> list[ast.stmt]:
    return [node for node in ast.walk(tree) if isinstance(node, ast.stmt)]


def _copy_header(node: ast.stmt) -> ast.stmt:
    """Return a copy of a statement with ``...`` in place of its body."""
    if not any(getattr(node, name, None) for name in _BODY_FIELDS):
        return node
    header = copy(node)
    for name in _BODY_FIELDS:
        if getattr(node, name, None):
            setattr(header, name, [ast.Expr(ast.Constant(...))] if name == "body" else [])
    return header


def _find_owner_names(python: PythonFile, node: ast.expr) -> Iterator[str]:
    """Yield the names through which an expression is an item of a value."""
    for _ in range(_MAX_NAMES):
        if not isinstance(node, ast.Subscript) or not isinstance(node.value, ast.Name):
            break
        yield node.value.id
        node = python.resolved(node.value)


def _find_names_outside(tree: ast.AST, covered: Collection[int]) -> Iterator[str]:
    """Yield the names that code outside of the calls of actions uses, and those that it assigns again."""
    assigned: set[str] = set()
    pending = [tree]
    while pending:
        node = pending.pop()
        if isinstance(node, ast.Name):
            is_assigned = not isinstance(node.ctx, ast.Load)
            if not is_assigned or node.id in assigned:
                yield node.id
            assigned |= {node.id} if is_assigned else set()
        if id(node) not in covered:
            pending += ast.iter_child_nodes(node)


def _find_target_names(node: ast.Assign) -> list[str | None]:
    """Return the names that a statement assigns; None for another target."""
    return [target.id if isinstance(target, ast.Name) else None for target in node.targets]


def _find_action_names(tree: ast.AST, covered: Collection[int]) -> set[str]:
    """Return the names to which only actions are assigned, such as one of two nodes in each branch."""
    stored = Counter(
        node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
    )
    made = (node for node in ast.walk(tree) if isinstance(node, ast.Assign) and id(node.value) in covered)
    assigned = Counter(name for node in made for name in _find_target_names(node) if name is not None)
    return {name for name, count in assigned.items() if count == stored[name]}


def _find_called_function(call: ast.Call) -> str | None:
    """Return the function that an action calls to make others, or None if it gets more than the context."""
    if called_name(call).rpartition(".")[2] != _CALLING_CLASS:
        return None
    values = [*call.args, *(keyword.value for keyword in call.keywords if keyword.arg == "function")]
    is_only = len(values) == 1 == len(call.args) + len(call.keywords)
    return values[0].id if is_only and isinstance(values[0], ast.Name) else None


class _CodeNormalizer:
    """A formatter of code in comparable form.

    Args:
        python: the parsed file.
        covered: the identities of the calls that make actions.
        branches: the identities of the ``if`` statements whose conditions actions have.
        texts: the texts of the expressions of the file.
    """

    def __init__(
        self, python: PythonFile, covered: Collection[int], branches: Collection[int], texts: ExpressionTexts
    ) -> None:
        self._python = python
        items = [node for node in ast.walk(python.tree) if isinstance(node, ast.Subscript)]
        self._unknown_owners = {
            name for node in items if texts.is_unknown_item(node) for name in _find_owner_names(python, node)
        }
        self._branches = branches
        self._covered = covered
        names = (_find_called_function(node) for node in ast.walk(python.tree) if isinstance(node, ast.Call))
        self._called_functions = {name for name in names if name is not None}
        self._texts: dict[int, str] = {}
        self._names_outside = set(_find_names_outside(python.tree, covered))
        self._action_names = _find_action_names(python.tree, covered)

    def format_node(self, node: ast.AST) -> str:
        """Return a part of the code in comparable form; empty if it only makes actions."""
        known = self._texts.get(id(node))
        if known is None:
            self._texts[id(node)] = ""  # a name that is defined by itself
            known = self._texts[id(node)] = shorten_text(self._normalize(node))
        return known

    def format_statement(self, node: ast.stmt) -> str:
        """Return a statement without its body in comparable form; empty if it only makes actions."""
        if not any(hasattr(node, name) for name in _BODY_FIELDS):
            return self.format_node(node)
        is_read = isinstance(node, ast.FunctionDef) and node.name in self._called_functions and not node.decorator_list
        return "" if id(node) in self._branches or is_read else self._format_fields(node)

    def _normalize(self, node: ast.AST) -> str:
        if isinstance(node, (ast.Import, ast.ImportFrom, ast.Pass)) or id(node) in self._covered:
            return ""
        if isinstance(node, ast.Call) and _find_called_function(node) is not None:
            return ""  # its actions are compared
        if isinstance(node, ast.Expr):
            return "" if isinstance(node.value, ast.Constant) else self.format_node(node.value)
        if isinstance(node, ast.Name):
            if node.id in self._action_names:
                return ""
            assigned = self._python.assigned_expression(node.id)
            return f"name {node.id}" if assigned is None else self.format_node(assigned)
        if isinstance(node, (ast.Assign, ast.AnnAssign)) and self.is_definition(node):
            return ""
        if isinstance(node, ast.Assign) and self._action_names.issuperset(_find_target_names(node)):
            return ""
        if isinstance(node, ast.Call) and called_name(node).rpartition(".")[2] in _COMBINING_CALLS:
            return self._format_group(node)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in _LIST_METHODS:
            return self._format_fields(node) if self._format_items(node.args) else ""
        if isinstance(node, ast.AugAssign) and not self.format_node(node.value):
            return ""
        if isinstance(node, (ast.List, ast.Tuple)):
            return self._format_items(node.elts)
        if isinstance(node, ast.Starred):
            return self.format_node(node.value)
        if isinstance(node, ast.BinOp) and not self.format_node(node.left) and not self.format_node(node.right):
            return ""  # a sum of lists of actions
        if isinstance(node, (ast.ListComp, ast.GeneratorExp)) and not self._has_other_parts(node):
            return ""  # actions for each item of a list
        if isinstance(node, ast.Return):
            value = "" if node.value is None else self.format_node(node.value)
            return f"return {value}" if value else ""
        return self._format_fields(node)

    def _has_other_parts(self, node: ast.ListComp | ast.GeneratorExp) -> bool:
        """Return whether a comprehension does more than make actions for each item of a literal list."""
        loop = node.generators[0]
        return len(node.generators) > 1 or bool(loop.ifs) or any(map(self.format_node, (node.elt, loop.iter)))

    def is_definition(self, node: ast.Assign | ast.AnnAssign) -> bool:
        """Return whether a statement assigns a name that is assigned only once.

        The value is compared where the name is used, unless the items of an unknown result are used there.
        """
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
        if isinstance(targets[0], (ast.Tuple, ast.List)):
            names = {name.id for name in targets[0].elts if isinstance(name, ast.Name)}
            is_single = len(targets) == 1 and len(names) == len(targets[0].elts)
            return is_single and names.isdisjoint(self._names_outside)  # the actions have the values
        return all(
            isinstance(target, ast.Name)
            and self._python.assigned_expression(target.id) is node.value
            and target.id not in self._unknown_owners
            for target in targets
        )

    def _format_group(self, node: ast.Call) -> str:
        """Return the contents of a group or launch description besides actions."""
        arguments = [*node.args, *(keyword.value for keyword in node.keywords if keyword.arg in _ACTION_ARGUMENTS)]
        settings = [
            f"{keyword.arg}={self.format_node(keyword.value)}"
            for keyword in node.keywords
            if keyword.arg not in (*_ACTION_ARGUMENTS, "condition", "initial_entities", "period")
        ]
        return self._format_items(arguments) + "".join(settings)

    def _format_items(self, nodes: list[ast.expr]) -> str:
        texts = dict.fromkeys(text for text in map(self.format_node, nodes) if text)
        return f"[{', '.join(texts)}]" if texts else ""

    def _format_fields(self, node: ast.AST) -> str:
        words = []
        for name, value in ast.iter_fields(node):
            if name in _UNCOMPARED_FIELDS or name in _BODY_FIELDS:
                continue
            if isinstance(value, ast.AST):
                text = self.format_node(value)
            elif isinstance(value, list):
                parts = (self.format_node(item) if isinstance(item, ast.AST) else repr(item) for item in value)
                text = ", ".join(part for part in parts if part)
            else:
                text = repr(value)
            if text:
                words.append(f"{name}={text}")
        return f"{type(node).__name__}({' '.join(words)})"


def outside(parts: Iterable[CodePart], equal_scopes: Collection[str]) -> list[CodePart]:
    """Return the statements outside of the functions and classes that are equal in both versions."""
    return [part for part in parts if not any(scope in equal_scopes for scope in part.scopes)]


def drop_common_parts(
    parts: Sequence[CodePart], other_parts: Sequence[CodePart], equal_scopes: Collection[str]
) -> list[CodePart]:
    """Return the statements without those that the other version has, each counted once.

    A statement is looked for in the same function first, and then in other functions, to which it may have moved. A
    function that is equal in both versions keeps its statements.
    """
    unpaired = _subtract(parts, other_parts, lambda part: (part.scopes, part.text))
    other_unpaired = _subtract(other_parts, parts, lambda part: (part.scopes, part.text))
    changed = _subtract(outside(unpaired, equal_scopes), outside(other_unpaired, equal_scopes), lambda part: part.text)
    kept = {id(part) for part in changed}
    return [part for part in unpaired if id(part) in kept or not outside([part], equal_scopes)]


def _subtract(
    parts: Iterable[CodePart], other_parts: Iterable[CodePart], find_key: Callable[[CodePart], Hashable]
) -> list[CodePart]:
    """Return the statements without those of another list that have the same key, each counted once."""
    remaining_counts = Counter(map(find_key, other_parts))
    unpaired = []
    for part in parts:
        if remaining_counts[find_key(part)]:
            remaining_counts[find_key(part)] -= 1
        else:
            unpaired.append(part)
    return unpaired
