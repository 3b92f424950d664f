"""Read the outlines of Python launch files from their syntax trees."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from linkwright.packages.readers.launch_files import LAUNCH_FUNCTION
from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.launches.outlines import (
    CONDITION,
    Entry,
    LaunchOutline,
    Scope,
    merge_branches,
)
from linkwright.review.launches.python.actions import ACTIONS, ActionReader
from linkwright.review.launches.python.conditions import find_opaque_arguments, read_tests
from linkwright.review.launches.python.environment import find_set_variables
from linkwright.review.launches.python.expression_texts import BoundExpression, ExpressionTexts, format_branches
from linkwright.review.launches.python.helpers import (
    Function,
    HelperFunctions,
    find_parameter_defaults,
    find_program_guard,
)
from linkwright.review.launches.python.literals import CoveredLiterals, Literals
from linkwright.review.launches.python.log_messages import LOG_CLASS, read_log_message
from linkwright.review.launches.python.names import is_chosen_value
from linkwright.review.launches.python.other_code import find_definitions, find_scope_sources, read_other_code
from linkwright.review.launches.python.syntax import (
    ADD_METHODS,
    LIST_METHODS,
    find_added_action,
    find_unused_values,
)

_HANDLER_CLASS = "RegisterEventHandler"
_NAMESPACE_CLASSES = ("PushRosNamespace", "PushROSNamespace", "PushNamespace")
_ACTION_LISTS = ("LaunchDescription", "GroupAction", "TimerAction")
"""The objects whose first argument is a list of actions."""
_GROUP_CLASS = "GroupAction"
_LAUNCHES_MODULE = "moveit_configs_utils.launches"
"""The module whose functions make launch descriptions, such as ``generate_move_group_launch``."""
_EXISTENCE = ("exists", "is_dir", "is_file", "isdir", "isfile")
"""The functions that tell if a file or folder exists."""
_EMPTY_SCOPE = Scope()
_MAX_HELPER_DEPTH = 3
_CallKey = tuple[int, tuple[int, ...]]
"""The identity of a call, and the numbers of the passes of the loops around it."""


def read_python_outline(python: PythonFile, helpers: HelperFunctions) -> LaunchOutline:
    """Return the outline of a Python launch file.

    Args:
        python: the parsed file.
        helpers: the functions of the repository that make actions.
    """
    texts = ExpressionTexts(python, helpers=helpers)
    reader = _Reader(python, helpers, texts)
    reader.visit(python.tree)
    variables = find_set_variables(python, texts)
    entries = [*_drop_declared_defaults(merge_branches(list(reader.read_entries()))), *variables.values()]
    entries.sort(key=lambda entry: (entry.span.line, entry.span.column))
    covered = reader.covered | variables.keys() | _find_covered_literals(python, helpers, reader.evaluated)
    code = read_other_code(python, covered, reader.branches, texts)
    definitions = find_definitions(python, texts)
    return LaunchOutline(entries, code, definitions, find_scope_sources(python), tests=read_tests(python))


def _drop_declared_defaults(entries: Sequence[Entry]) -> Iterator[Entry]:
    """Yield entries without the defaults in ``$(var NAME DEFAULT)`` that the arguments of the file have as well."""
    arguments = [entry for entry in entries if entry.kind == "argument" and CONDITION not in entry.settings]
    texts = {
        f"$(var {item.name} {default})": item.name for item in arguments if (default := item.settings.get("default"))
    }

    def drop(value: str) -> str:
        for text, name in texts.items() if "$(var " in value else ():
            value = value.replace(text, f"$(var {name})")
        return value

    for entry in entries:
        yield replace(entry, settings={key: drop(value) for key, value in entry.settings.items()})


def _find_covered_literals(python: PythonFile, helpers: HelperFunctions, evaluated: Sequence[ast.expr]) -> set[int]:
    """Return the identities of function arguments and loop iterables in actions."""
    if not evaluated:
        return set()
    shown_literals = []
    for marks_keys in (False, True):
        literals = Literals(python, marks_keys=marks_keys)
        reader = _Reader(python, helpers, ExpressionTexts(python, helpers=helpers), literals=literals)
        reader.visit(python.tree)
        shown_literals.append(literals.find_shown_literals(reader.read_entries()))
    parts = CoveredLiterals(python, *shown_literals)
    for node in evaluated:
        if isinstance(node, ast.Call) and helpers.find(python, node) is not None:
            parts.add_call(node)
        else:
            parts.add(node)
    return parts.covered


@dataclass
class _Reader:
    """A reader of the actions of a file or of one of its functions.

    Attributes:
        python: the parsed file.
        helpers: the functions of the repository that make actions.
        texts: the texts of expressions.
        extra: the keyword arguments that the caller of a function passes on with ``**``.
        depth: the depth of nested calls at which the function is read.
        scopes: each call that makes an action, with its scope and its texts, by the identity of its syntax tree and
            the passes of the loops around it.
        covered: the calls that entries describe, which do not belong to the other code.
        branches: the ``if`` statements whose conditions actions have.
        evaluated: the calls of read functions, and the iterables of loops that are read for each item.
        literals: the marks in place of the literals of the file; None to read the literals themselves.
    """

    python: PythonFile
    helpers: HelperFunctions
    texts: ExpressionTexts
    extra: Mapping[str, BoundExpression] = field(default_factory=dict)
    depth: int = 0
    scopes: dict[_CallKey, tuple[ast.Call, Scope, ExpressionTexts]] = field(default_factory=dict)
    covered: set[int] = field(default_factory=set)
    branches: set[int] = field(default_factory=set)
    evaluated: list[ast.expr] = field(default_factory=list)
    literals: Literals | None = None
    _passes: tuple[int, ...] = ()
    _open_loops: list[tuple[int, int, ExpressionTexts, tuple[int, ...]]] = field(default_factory=list)
    _visited: set[tuple[int, tuple[int, ...], Scope]] = field(default_factory=set)

    def read_entries(self) -> Iterator[Entry]:
        """Yield the entries of the visited actions."""
        unused = find_unused_values(self.python.tree)
        for call, scope, texts in list(self.scopes.values()):
            self.texts = texts
            if id(call) not in unused and self._is_helper(call) and not _is_known_action(call):
                entries = list(self._read_helper_entries(call, scope))
            else:
                self.covered.add(id(call))
                entries = [] if id(call) in unused else [self._read_action(call, scope)]
            for entry in entries:
                yield replace(entry, groups=(*scope.groups, *entry.groups))

    def _read_action(self, call: ast.Call, scope: Scope) -> Entry:
        """Return the action that a call makes."""
        function = called_name(call).rpartition(".")[2]
        reader = ActionReader(self.python, self.helpers, self.texts, self.extra, self.covered, self.branches)
        if function == _HANDLER_CLASS:
            return reader.read_handler(call, scope)
        if function in ACTIONS:
            return reader.read_action(call, function, scope)
        if function == LOG_CLASS:
            return read_log_message(call, scope, self.texts, self.python.span(call))
        return reader.read_foreign_action(call, scope)

    # --- the scopes of actions ---------------------------------------------------------------------------------------

    def visit(self, node: ast.AST, scope: Scope = _EMPTY_SCOPE) -> None:
        """Find the actions below a node, which is in a scope."""
        if isinstance(node, ast.Name):
            value = self.python.resolved(node)
            if value is not node and not isinstance(node.ctx, ast.Store):
                self._visit_value(value, scope)
            return
        if (id(node), self._passes, scope) in self._visited:
            return
        self._visited.add((id(node), self._passes, scope))
        if isinstance(node, ast.Call):
            self._visit_call(node, scope)
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            return  # the object of a method, whose value is not in the scope of the call
        elif isinstance(node, ast.Assign) and scope.conditions and isinstance(node.value, (ast.List, ast.Tuple)):
            for item in node.value.elts:
                if not isinstance(item, ast.Name):  # the named actions get their conditions where the list is used
                    self.visit(item, scope)
        elif isinstance(node, ast.IfExp) and is_chosen_value(node):
            self._visit_chosen_values(node, scope)
        elif isinstance(node, (ast.List, ast.Tuple)):
            for item in node.elts:
                scope = scope.with_namespace(self._find_pushed_namespace(item))
                self.visit(item, scope)
        elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
            for term in (node.left, node.right):
                self.visit(term, scope)
                for item in self._list_items(term):
                    scope = scope.with_namespace(self._find_pushed_namespace(item))
        elif isinstance(node, ast.For):
            self._visit_loop(node.target, node.iter, node.body, scope)
        elif isinstance(node, (ast.ListComp, ast.GeneratorExp)):
            self._visit_loop(node.generators[0].target, node.generators[0].iter, [node.elt], scope)
        elif isinstance(node, ast.If):
            if node is not find_program_guard(self.python.tree):
                self._visit_branches(node, scope)
        elif isinstance(node, ast.FunctionDef):
            if node.name not in self.helpers.find_local_names(self.python):
                self._visit_called_function(node, scope)
        else:
            for child in ast.iter_child_nodes(node):
                self.visit(child, scope)

    def _list_items(self, node: ast.expr) -> list[ast.expr]:
        """Return the items of a list, also of a sum of lists; none for other expressions."""
        node = self.python.resolved(node)
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
            return [*self._list_items(node.left), *self._list_items(node.right)]
        return node.elts if isinstance(node, (ast.List, ast.Tuple)) else []

    def _visit_value(self, value: ast.expr, scope: Scope) -> None:
        """Find the actions in the value of a name.

        The name may be assigned outside of the loops that use it.
        """
        texts, loops = self.texts, self._passes
        left_loop = next(
            (enclosing for enclosing in self._open_loops if not enclosing[0] <= value.lineno <= enclosing[1]), None
        )
        if left_loop is not None:
            _, _, self.texts, self._passes = left_loop
        self.visit(value, scope)
        self.texts, self._passes = texts, loops

    def _visit_loop(
        self, target: ast.expr, iterable: ast.expr, body: Sequence[ast.stmt | ast.expr], scope: Scope
    ) -> None:
        """Find the actions of a loop, for each pass if the file contains the list literally."""
        chosen = self.texts.resolve(iterable)
        if isinstance(chosen.node, ast.IfExp) and chosen.texts is self.texts:
            self._visit_chosen_loops(target, chosen.node, body, scope)
            return
        items = self.texts.find_items(self._mark_literals(iterable))
        passes = [self.texts.with_item(target, item) for item in items or ()]
        if items is None or None in passes or not self.helpers.reserve_passes(len(items)):
            texts, self.texts = self.texts, self.texts.with_unknown_item(target)
            for statement in body:
                self.visit(statement, scope)
            self.texts = texts
            return
        self.evaluated.append(iterable)
        texts, loops = self.texts, self._passes
        lines = [line for node in body for line in (node.lineno, node.end_lineno or node.lineno)]
        self._open_loops.append((min(lines), max(lines), texts, loops))
        for number, pass_texts in enumerate(filter(None, passes)):
            self.texts, self._passes = pass_texts, (*loops, number)
            for statement in body:
                self.visit(statement, scope)
        self.texts, self._passes = texts, loops
        self._open_loops.pop()

    def _visit_chosen_loops(
        self, target: ast.expr, choice: ast.IfExp, body: Sequence[ast.stmt | ast.expr], scope: Scope
    ) -> None:
        """Find the actions of a loop over one of two lists, with the condition that chooses the list."""
        loops = self._passes
        if_true, if_false = format_branches(choice.test)
        for number, (condition, opposite, iterable) in enumerate(
            ((if_true, if_false, choice.body), (if_false, if_true, choice.orelse))
        ):
            if opposite not in scope.conditions:
                self._passes = (*loops, number)
                self._visit_loop(target, iterable, body, scope.with_condition(condition))
        self._passes = loops
        self.covered.add(id(choice))

    def _visit_chosen_values(self, choice: ast.IfExp, scope: Scope) -> None:
        """Find the actions of the lists that a statement chooses. An action of both lists has no condition."""
        branches = [[part.node for part in self.texts.find_list_parts(value)] for value in (choice.body, choice.orelse)]
        common = {id(node) for node in branches[0]} & {id(node) for node in branches[1]}
        for condition, nodes in zip(format_branches(choice.test), branches, strict=True):
            for node in nodes:
                self.visit(node, scope if id(node) in common else scope.with_condition(condition))

    def _visit_branches(self, node: ast.If, scope: Scope) -> None:
        """Find the actions of both branches, with the condition of the statement."""
        holds = self.texts.evaluate_parameter(node.test)
        if holds is not None:
            count = len(self.scopes)
            for statement in node.body if holds else node.orelse:
                scope = scope.with_namespace(self._find_pushed_namespace(find_added_action(statement)))
                self.visit(statement, scope)
            if len(self.scopes) > count:
                self.branches.add(id(node))
            return
        conditions = format_branches(node.test)
        for condition, body in zip(conditions, (node.body, node.orelse), strict=True):
            inner = scope.with_condition(condition)
            for statement in body:
                inner = inner.with_namespace(self._find_pushed_namespace(find_added_action(statement)))
                self.visit(statement, inner)
        if any(condition in inner.conditions for _, inner, _ in self.scopes.values() for condition in conditions):
            self.branches.add(id(node))

    def _visit_called_function(self, function: ast.FunctionDef, scope: Scope) -> None:
        """Find the actions of a function that launch calls, with the values that ``OpaqueFunction`` passes to it."""
        texts = self.texts
        passed = find_opaque_arguments(self.python, function)
        values = {name: texts.resolve(value) for name, value in passed.items()}
        if values:
            self.texts = texts.with_names(
                {name: value.texts.text(value.node) for name, value in values.items()}, values
            )
        self._visit_body(function, scope)
        self.texts = texts

    def _visit_body(self, function: ast.FunctionDef, scope: Scope) -> None:
        for statement in function.body:
            scope = scope.with_namespace(self._find_pushed_namespace(find_added_action(statement)))
            self.visit(statement, scope)
            if isinstance(statement, ast.Return) and statement.value is not None:
                for action in map(self.python.resolved, self._list_items(statement.value) or [statement.value]):
                    is_action = function.name == LAUNCH_FUNCTION or self._makes_launch(action)
                    if isinstance(action, ast.Call) and is_action and self.helpers.is_foreign(self.python, action):
                        self._add_call(action, scope)
            if isinstance(statement, ast.If) and isinstance(statement.body[-1], ast.Return) and not statement.orelse:
                holds = self.texts.evaluate_parameter(statement.test)
                if holds:
                    return
                if holds is not None or _is_guard_of_missing_value(statement):
                    continue
                scope = scope.with_condition(format_branches(statement.test)[1])  # the rest runs otherwise

    def _makes_launch(self, action: ast.expr) -> bool:
        """Return whether a function of a common package makes a launch description."""
        name = called_name(action) if isinstance(action, ast.Call) else ""
        sources = self.python.find_import_sources(name.partition(".")[0])
        return any(module == _LAUNCHES_MODULE for module, _ in sources)

    def visit_function(self, function: ast.FunctionDef) -> None:
        """Find the actions of a function."""
        self._visit_body(function, _EMPTY_SCOPE)

    def _visit_call(self, call: ast.Call, scope: Scope) -> None:
        function = called_name(call).rpartition(".")[2]
        if function in _NAMESPACE_CLASSES:
            self.covered.add(id(call))
            return
        if _is_known_action(call) or self._is_helper(call):
            self._add_call(call, scope)
        condition = next((keyword.value for keyword in call.keywords if keyword.arg == CONDITION), None)
        inner = scope.with_condition(self.texts.format_condition(condition))
        if function == _GROUP_CLASS and not _leaves_arguments(call):
            inner = inner.with_group(call.lineno)
        if function == "TimerAction":
            period = next((keyword.value for keyword in call.keywords if keyword.arg == "period"), None)
            inner = inner.with_condition(f"after {self.texts.text(period)} s")
        if function in _ACTION_LISTS or function in ADD_METHODS:
            for action in self._find_foreign_actions(call):
                self._add_call(action, inner)
        children = [call.func, *call.args, *(item.value for item in call.keywords if item.arg != CONDITION)]
        if not self._takes_actions(call, function):
            children = [child for child in children if not isinstance(child, ast.Name)]
        for child in children:
            self.visit(child, inner)

    def _takes_actions(self, call: ast.Call, function: str) -> bool:
        """Return whether the actions in the arguments of a call are in the scope of the call."""
        is_list = function in (*_ACTION_LISTS, *ADD_METHODS, *LIST_METHODS, _HANDLER_CLASS) or function in ACTIONS
        return is_list or self._is_helper(call)

    def _add_call(self, call: ast.Call, scope: Scope) -> None:
        """Add an action with the innermost scope that contains it."""
        key = id(call), self._passes
        known = self.scopes.get(key)
        if known is None or known[1].depth < scope.depth:
            self.scopes[key] = call, scope, self.texts

    def _find_foreign_actions(self, call: ast.Call) -> Iterator[ast.Call]:
        """Yield the calls in a list that make actions in functions of other packages."""
        arguments = [
            *call.args[:1],
            *(item.value for item in call.keywords if item.arg in ("actions", "initial_entities")),
        ]
        for argument in arguments:
            for action in map(self.python.resolved, self._list_items(argument) or [argument]):
                if isinstance(action, ast.Call) and self.helpers.is_foreign(self.python, action):
                    yield action

    def _is_helper(self, call: ast.Call) -> bool:
        return self.depth < _MAX_HELPER_DEPTH and self.helpers.find(self.python, call) is not None

    def _find_pushed_namespace(self, node: ast.AST | None) -> str:
        """Return the namespace that an action pushes, with its condition; empty for other actions."""
        node = self.python.resolved(node) if isinstance(node, ast.expr) else node
        if not isinstance(node, ast.Call) or called_name(node).rpartition(".")[2] not in _NAMESPACE_CLASSES:
            return ""
        keywords = {keyword.arg: keyword.value for keyword in node.keywords}
        namespace = self.texts.text(node.args[0] if node.args else keywords.get("namespace"))
        condition = self.texts.format_condition(keywords.get(CONDITION))
        return f"{namespace} ({condition})" if condition else namespace

    # --- helpers -----------------------------------------------------------------------------------------------------

    def _read_helper_entries(self, call: ast.Call, scope: Scope) -> Iterator[Entry]:
        """Yield the actions that a function of the repository makes."""
        function = self.helpers.find(self.python, call)
        if function is None:
            return
        bindings, values, extra = self._bind_arguments(call, function)
        if function.is_nested:
            texts = self.texts.with_names(bindings, values)
        else:
            texts = ExpressionTexts(function.python, bindings, values, self.helpers)
        reader = _Reader(function.python, self.helpers, texts, extra, self.depth + 1)
        if function.python is self.python:
            reader.covered, reader.branches = self.covered, self.branches
            reader.evaluated, reader.literals = self.evaluated, self.literals
        reader.visit_function(function.node)
        span = self.python.span(call)
        self.evaluated.append(call)
        for entry in reader.read_entries():
            yield replace(entry, span=span, settings=scope.add_to_settings(entry.kind, entry.settings))

    def _mark_literals(self, node: ast.expr) -> ast.expr:
        return node if self.literals is None else self.literals.mark_literals(node)

    def _bind_arguments(
        self, call: ast.Call, function: Function
    ) -> tuple[dict[str, str], dict[str, BoundExpression], dict[str, BoundExpression]]:
        """Return the texts and expressions of a function's parameters.

        The third item has the expressions of its ``**`` parameter.
        """
        arguments = function.node.args
        names = [argument.arg for argument in (*arguments.posonlyargs, *arguments.args)]
        defaults = find_parameter_defaults(function.node)
        default_texts = ExpressionTexts(function.python, helpers=self.helpers)
        bindings = {name: default_texts.text(value) for name, value in defaults.items()}
        if function.is_method:
            names = names[1:]
        passed = dict(zip(names, map(self._mark_literals, call.args), strict=False))
        if arguments.vararg is not None and not any(isinstance(value, ast.Starred) for value in call.args):
            rest = list(map(self._mark_literals, call.args[len(names) :]))
            passed[arguments.vararg.arg] = ast.Tuple(rest, ast.Load())
        bindings |= {name: self.texts.text(value) for name, value in passed.items()}
        extra: dict[str, BoundExpression] = {}
        known = {*names, *(argument.arg for argument in arguments.kwonlyargs)}
        for keyword in call.keywords:
            value = self._mark_literals(keyword.value)
            if keyword.arg is None:
                extra |= self.extra
            elif keyword.arg not in known:
                extra[keyword.arg] = self.texts.resolve(value)
            elif keyword.arg == CONDITION:
                bindings[keyword.arg] = self.texts.format_condition(value)
                passed[keyword.arg] = value
            else:
                bindings[keyword.arg] = self.texts.text(value)
                passed[keyword.arg] = value
        values = {name: default_texts.resolve(value) for name, value in defaults.items()}
        values |= {name: self.texts.resolve(value) for name, value in passed.items()}
        return bindings, values, extra


def _is_guard_of_missing_value(statement: ast.If) -> bool:
    """Return whether a statement only ends a function, with a message, because a file or value is missing."""
    test = statement.test
    if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
        is_missing = isinstance(test.operand, ast.Call) and called_name(test.operand).rpartition(".")[2] in _EXISTENCE
    else:
        operators = test.ops if isinstance(test, ast.Compare) else []
        right = test.comparators[0] if isinstance(test, ast.Compare) else None
        is_missing = len(operators) == 1 and isinstance(operators[0], ast.Is) and _is_nothing(right)
    *messages, last = statement.body
    is_message = all(isinstance(item, ast.Expr) and isinstance(item.value, ast.Call) for item in messages)
    value = last.value if isinstance(last, ast.Return) else None
    if isinstance(value, ast.Call) and called_name(value) == "LaunchDescription" and not value.keywords:
        value = value.args[0] if value.args else None
    return is_missing and is_message and isinstance(last, ast.Return) and _is_nothing(value)


def _is_nothing(node: ast.expr | None) -> bool:
    """Return whether an expression is None or an empty list."""
    is_none = node is None or (isinstance(node, ast.Constant) and node.value is None)
    return is_none or (isinstance(node, ast.List) and not node.elts)


def _is_known_action(call: ast.Call) -> bool:
    """Return whether a call makes an action of a class of launch or launch_ros."""
    function = called_name(call).rpartition(".")[2]
    return function in (_HANDLER_CLASS, LOG_CLASS) or function in ACTIONS


def _leaves_arguments(group: ast.Call) -> bool:
    """Return whether arguments that a group sets may keep their values after it."""
    scoped = next((keyword.value for keyword in group.keywords if keyword.arg == "scoped"), None)
    return scoped is not None and not (isinstance(scoped, ast.Constant) and scoped.value is True)
