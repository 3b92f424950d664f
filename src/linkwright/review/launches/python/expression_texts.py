"""Format expressions of Python launch files, if possible like in XML launch files."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from linkwright.packages.readers.python_values import PYTHON_COMPARISONS, PythonFile, called_name
from linkwright.review.launches.chosen_texts import make_choice, quote_text
from linkwright.review.launches.expressions import shorten_text, unparse_on_one_line
from linkwright.review.launches.outlines import split_text, with_condition
from linkwright.review.launches.python.conditions import SUBSTITUTIONS, read_tests
from linkwright.review.launches.python.helpers import HelperFunctions, find_parameter_defaults
from linkwright.review.launches.python.literals import LOOP_FUNCTIONS
from linkwright.review.launches.python.names import is_chosen_value
from linkwright.review.launches.python.substitution_texts import (
    Formatter,
    find_parent,
    format_substitution,
    get_call_arguments,
    is_configurations,
    is_string,
    split_pieces,
)
from linkwright.review.launches.python.syntax import find_list_item, is_filled
from linkwright.review.launches.python.text_templates import format_template, strip_conversion
from linkwright.review.texts.list_changes import EMPTY

_MAX_DEPTH = 30
_MAX_FUNCTION_DEPTH = 3
"""The maximum number of functions that return the value of each other."""
_VALUES = (ast.BinOp, ast.Constant, ast.Dict, ast.JoinedStr, ast.List, ast.Tuple)
"""The expressions of a function whose value is known, apart from calls and names."""
_COMPARISON_CONDITIONS = {"LaunchConfigurationEquals": "==", "LaunchConfigurationNotEquals": "!="}
_NON_STRING = re.compile(r"[-+]?[\d.]+([eE][-+]?\d+)?|true|false|yes|no|on|off|\[.*\]|", re.IGNORECASE)
"""Texts that are only strings if they are quoted. Otherwise, they are numbers, booleans, lists, or empty."""
_ARGUMENT_CONDITIONS = {"IfCondition": "if", "UnlessCondition": "unless"}


@dataclass(frozen=True)
class BoundExpression:
    """An expression that is the value of a name.

    Attributes:
        texts: the texts of the expressions where it is written.
        node: the syntax tree of the expression.
    """

    texts: ExpressionTexts
    node: ast.expr


class ExpressionTexts:
    """The texts of expressions of a file.

    Args:
        python: the parsed file.
        bindings: the texts of the parameters of the function that is read, by name.
        values: the expressions of parameters and of variables of loops, by name.
        helpers: the functions of the repository; None to leave their calls as they are.
        depth: the number of functions through which the expressions are read.
    """

    def __init__(
        self,
        python: PythonFile,
        bindings: Mapping[str, str] | None = None,
        values: Mapping[str, BoundExpression] | None = None,
        helpers: HelperFunctions | None = None,
        depth: int = 0,
    ) -> None:
        self.python = python
        self._helpers = helpers
        self._depth = depth
        self._bindings = bindings or {}
        self._values = values or {}
        self._texts: dict[int, tuple[ast.expr, str]] = {}
        """The texts by the identity of the expression, which exists as long as its text."""

    def with_item(self, target: ast.expr, item: BoundExpression) -> ExpressionTexts | None:
        """Return the texts of a loop pass, or None if the item does not fit the variables."""
        items_by_name = _assign_item(target, item)
        if items_by_name is None:
            return None
        bindings = {name: value.texts.text(value.node) for name, value in items_by_name.items()}
        return self.with_names(bindings, items_by_name)

    def with_unknown_item(self, target: ast.expr) -> ExpressionTexts:
        """Return the texts with expressions of unknown value for the variables of a loop."""
        names = [node.id for node in ast.walk(target) if isinstance(node, ast.Name)]
        unknown = {name: f"$(eval {name})" for name in names}
        return self.with_names(unknown, {})

    def with_names(self, bindings: Mapping[str, str], values: Mapping[str, BoundExpression]) -> ExpressionTexts:
        """Return the texts with other names, such as the parameters of a function inside of the function.

        Args:
            bindings: the texts of the names.
            values: the expressions of the names whose values are known.
        """
        known = {name: value for name, value in self._values.items() if name not in bindings}
        return ExpressionTexts(
            self.python, {**self._bindings, **bindings}, {**known, **values}, self._helpers, self._depth
        )

    def resolve(self, node: ast.expr) -> BoundExpression:
        """Return the value of a name or of a call of a function, or any other expression unchanged."""
        node = self.python.resolved(node)
        bound = self._values.get(node.id) if isinstance(node, ast.Name) else None
        if bound is None and isinstance(node, ast.Call) and (result := self._find_result(node)) is not None:
            return result.texts.resolve(result.node)
        operand = self._choose_operand(node) if isinstance(node, ast.BoolOp) else None
        return self.resolve(operand) if operand is not None else bound or BoundExpression(self, node)

    def _choose_operand(self, node: ast.BoolOp) -> ast.expr | None:
        """Return the value of ``a or b`` or ``a and b`` if constants of parameters decide it, or None."""
        for operand in node.values[:-1]:
            holds = self.evaluate_parameter(operand)
            if holds is None or holds is isinstance(node.op, ast.Or):
                return None if holds is None else operand
        return node.values[-1]

    def _find_result(self, call: ast.Call) -> BoundExpression | None:
        """Return the expression that a function of the repository returns, or None if its value is unknown."""
        function = None
        if self._helpers is not None and self._depth < _MAX_FUNCTION_DEPTH:
            function = self._helpers.find_value_function(self.python, call)
        if function is None or any(isinstance(argument, ast.Starred) for argument in call.args):
            return None
        parameters = function.node.args
        names = [argument.arg for argument in (*parameters.posonlyargs, *parameters.args)]
        passed = dict(zip(names, call.args, strict=False))
        count = len(passed)
        if parameters.vararg is not None:
            passed[parameters.vararg.arg] = ast.Tuple(call.args[count:], ast.Load())
            count = len(call.args)
        passed |= {keyword.arg: keyword.value for keyword in call.keywords if keyword.arg is not None}
        defaults = find_parameter_defaults(function.node)
        names += [argument.arg for argument in (*parameters.kwonlyargs, parameters.vararg) if argument is not None]
        is_complete = count == len(call.args) and set(names) == passed.keys() | defaults.keys()
        if not is_complete:
            return None
        module_texts = ExpressionTexts(function.python, helpers=self._helpers, depth=self._depth + 1)
        bindings = {name: module_texts.text(value) for name, value in defaults.items()}
        bindings |= {name: self.text(value) for name, value in passed.items()}
        values = {name: module_texts.resolve(value) for name, value in defaults.items()}
        values |= {name: self.resolve(value) for name, value in passed.items()}
        texts = ExpressionTexts(function.python, bindings, values, self._helpers, self._depth + 1)
        returned = function.node.body[-1]
        value = returned.value if isinstance(returned, ast.Return) else None
        return BoundExpression(texts, value) if value is not None and texts.is_known(value) else None

    def evaluate_parameter(self, test: ast.expr) -> bool | None:
        """Return whether a test holds that depends only on a constant which a parameter has; None for other tests."""
        if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
            holds = self.evaluate_parameter(test.operand)
            return None if holds is None else not holds
        comparison = test if isinstance(test, ast.Compare) and len(test.ops) == 1 else None
        name = test if comparison is None else comparison.left
        bound = self._values.get(name.id) if isinstance(name, ast.Name) else None
        if bound is None or not isinstance(bound.node, ast.Constant):
            return None
        if comparison is None:
            return bool(bound.node.value)
        other, compare = comparison.comparators[0], PYTHON_COMPARISONS.get(type(comparison.ops[0]))
        if not isinstance(other, ast.Constant) or compare is None:
            return None
        try:
            return bool(compare(bound.node.value, other.value))
        except TypeError:
            return None

    def is_known(self, node: ast.expr) -> bool:
        """Return whether an expression is not a call of an unknown function, or a name of unknown value."""
        node = self.python.resolved(node)
        if isinstance(node, ast.Call):
            return format_substitution(self.python, node, self.text) is not None or self._find_result(node) is not None
        if isinstance(node, ast.Name):
            return node.id in self._bindings
        return isinstance(node, _VALUES)

    def find_items(self, node: ast.expr) -> list[BoundExpression] | None:
        """Return what a loop over a literal list or dictionary yields, or None for other expressions.

        The loop may number or join the items with ``enumerate`` or ``zip``.
        """
        value = self.resolve(node)
        if isinstance(value.node, ast.Call) and called_name(value.node) in LOOP_FUNCTIONS:
            return value.texts._find_loop_items(value.node)
        items = value.texts.find_dictionary_items(value.node)
        if items is not None:
            return items
        if not isinstance(value.node, (ast.List, ast.Tuple)):
            return None
        if not value.node.elts and isinstance(node, ast.Name) and is_filled(self.python.tree, node.id):
            return None
        return [value.texts.resolve(item) for item in value.node.elts]

    def _find_loop_items(self, call: ast.Call) -> list[BoundExpression] | None:
        """Return what ``enumerate`` or ``zip`` yields, or None if an argument is unknown."""
        function = called_name(call)
        if call.keywords or not call.args:
            return None
        lists = [self.find_items(argument) for argument in call.args]
        known_lists = [items for items in lists if items is not None]
        if len(known_lists) < len(lists):
            return None
        if function == "enumerate":
            numbers = [BoundExpression(self, ast.Constant(number)) for number in range(len(known_lists[0]))]
            known_lists = [numbers, *known_lists]
        return [self._make_tuple(items, call) for items in zip(*known_lists, strict=False)]

    def _make_tuple(self, items: Sequence[BoundExpression], location: ast.expr) -> BoundExpression:
        """Return a tuple of expressions that may be written in several files."""
        names = [f"*{number}" for number in range(len(items))]  # no other name is written so
        bindings = {name: item.texts.text(item.node) for name, item in zip(names, items, strict=True)}
        texts = self.with_names(bindings, dict(zip(names, items, strict=True)))
        elements: list[ast.expr] = [ast.copy_location(ast.Name(name, ast.Load()), location) for name in names]
        return BoundExpression(texts, ast.copy_location(ast.Tuple(elements, ast.Load()), location))

    def find_dictionary_items(self, node: ast.expr) -> list[BoundExpression] | None:
        """Return what a loop over a dictionary or a view of it yields, or None."""
        view = "keys"
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and not node.args:
            method = node.func
            node, view = method.value, method.attr
        dictionary = self.resolve(node)
        if not isinstance(dictionary.node, ast.Dict) or view not in ("items", "keys", "values"):
            return None
        items: list[BoundExpression] = []
        for key, value in zip(dictionary.node.keys, dictionary.node.values, strict=True):
            if key is None:
                return None
            pair = ast.Tuple([key, value], ast.Load())
            item = {"items": pair, "keys": key, "values": value}[view]
            items.append(dictionary.texts.resolve(item))
        return items

    def find_list_parts(self, node: ast.expr) -> list[BoundExpression]:
        """Return the items of a list, including sums of lists and unpacked lists (``*items``).

        A part whose items are unknown counts as one item.
        """
        value = self.resolve(node)
        node, texts = value.node, value.texts
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
            return [*texts.find_list_parts(node.left), *texts.find_list_parts(node.right)]
        if not isinstance(node, (ast.List, ast.Tuple)):
            return [value]
        parts: list[BoundExpression] = []
        for item in node.elts:
            parts += texts.find_list_parts(item.value) if isinstance(item, ast.Starred) else [texts.resolve(item)]
        return parts

    def find_words(self, node: ast.expr) -> list[BoundExpression] | None:
        """Return the items of a command line, or None if it is not a list.

        Of a sum of lists, or a list that repeats an expression for each item of another one, all items must be known.
        """
        value = self.resolve(node)
        node, texts = value.node, value.texts
        if isinstance(node, (ast.List, ast.Tuple)):
            return texts.find_list_parts(node)
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
            left, right = texts.find_words(node.left), texts.find_words(node.right)
            return None if left is None or right is None else left + right
        if isinstance(node, ast.IfExp) and (holds := texts.evaluate_parameter(node.test)) is not None:
            return texts.find_words(node.body if holds else node.orelse)
        if not isinstance(node, ast.ListComp) or len(node.generators) != 1 or node.generators[0].ifs:
            return None
        items = texts.find_items(node.generators[0].iter)
        passes = [texts.with_item(node.generators[0].target, item) for item in items or ()]
        known = [item.resolve(node.elt) for item in passes if item is not None]
        return None if items is None or len(known) != len(items) else known

    def find_lists(self, node: ast.expr) -> list[BoundExpression]:
        """Return the lists that a sum of lists joins."""
        value = self.resolve(node)
        if isinstance(value.node, ast.BinOp) and isinstance(value.node.op, ast.Add):
            return [*value.texts.find_lists(value.node.left), *value.texts.find_lists(value.node.right)]
        return [value] if isinstance(value.node, ast.List) else []

    def text(self, node: ast.expr | None, depth: int = 0) -> str:
        """Return an expression as text, with the values of names that are assigned once."""
        if node is None:
            return ""
        if depth > _MAX_DEPTH:
            return shorten_text(" ".join(ast.unparse(node).split()))
        known = self._texts.get(id(node))
        if known is None:
            known = self._texts[id(node)] = node, shorten_text(self._format(node, depth))
        return known[1]

    def format_joined(self, node: ast.expr) -> str:
        """Return an expression as text. A list of substitutions is joined."""
        return "".join(map(self.text, split_pieces(self.python, node)))

    def format_condition(self, node: ast.expr | None) -> str:
        """Return a condition as text, such as ``unless $(var headless)``; empty if there is none."""
        if node is None:
            return ""
        node = self.python.resolved(node)
        if isinstance(node, ast.Name) and node.id in self._bindings:
            return self._bindings[node.id]
        if isinstance(node, ast.Constant) and node.value is None:
            return ""
        if isinstance(node, ast.Call):
            function, arguments = called_name(node).rpartition(".")[2], get_call_arguments(node)
            if function in _ARGUMENT_CONDITIONS and arguments:
                return f"{_ARGUMENT_CONDITIONS[function]} {self.text(arguments[0])}"
            if function in _COMPARISON_CONDITIONS and len(arguments) > 1:
                right = self.text(arguments[1]) or EMPTY
                return f"if $(var {self.text(arguments[0])}) {_COMPARISON_CONDITIONS[function]} {right}"
        return f"if {self.text(node)}"

    def format_parameter(self, node: ast.expr) -> str:
        """Return the value of a parameter as text.

        A string that looks like a value of a different type is in quotes.
        """
        node, text = self.python.resolved(node), self.text(node)
        is_string = isinstance(node, ast.Constant) and isinstance(node.value, str)
        return f"'{text}'" if is_string and _NON_STRING.fullmatch(text) else text

    def find_pairs(self, node: ast.expr, *, are_parameters: bool = False) -> list[tuple[str, str]] | None:
        """Return the pairs of a dictionary, of its ``items()`` or of a list of pairs, or None.

        Args:
            node: the syntax tree of the expression.
            are_parameters: whether the values are parameters, whose texts show their types; see `format_parameter`.
        """
        format_value = self.format_parameter if are_parameters else self.format_joined
        node = self.python.resolved(node)
        if isinstance(node, ast.Call) and called_name(node) == "list" and len(node.args) == 1:
            node = self.python.resolved(node.args[0])
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "items":
            node = self.python.resolved(node.func.value)
        bound = self.resolve(node)
        if bound.texts is not self:
            return bound.texts.find_pairs(bound.node, are_parameters=are_parameters)
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.BitOr):
            return self._join_pairs([node.left, node.right], are_parameters=are_parameters)
        if isinstance(node, ast.IfExp):
            return self._find_chosen_pairs(node, are_parameters=are_parameters)
        if isinstance(node, ast.Dict) and None in node.keys:
            items = zip(node.keys, node.values, strict=True)
            parts = [value if key is None else ast.Dict([key], [value]) for key, value in items]
            joined = self._join_pairs(parts, are_parameters=are_parameters)
            if joined is not None:
                return joined
        if isinstance(node, ast.Call) and called_name(node) == "dict" and not node.args:
            return [(keyword.arg or "", format_value(keyword.value)) for keyword in node.keywords]
        if isinstance(node, ast.Dict):
            return list(self._flatten_items(node, "", format_value))
        if not isinstance(node, (ast.List, ast.Tuple, ast.Set)):
            return None
        pairs = [self._format_pair(item, format_value) for item in node.elts]
        known = [pair for pair in pairs if pair is not None]
        return known if len(known) == len(pairs) else None

    def _join_pairs(self, parts: Sequence[ast.expr], *, are_parameters: bool) -> list[tuple[str, str]] | None:
        """Return the pairs of the union of dictionaries, in which later values replace earlier ones, or None."""
        pairs: dict[str, str] = {}
        for part in parts:
            found = self.find_pairs(part, are_parameters=are_parameters)
            if found is None:
                return None
            pairs |= found
        return list(pairs.items())

    def _find_chosen_pairs(self, node: ast.IfExp, *, are_parameters: bool) -> list[tuple[str, str]] | None:
        """Return the pairs of one of two dictionaries. Those of only one of them have the condition in the name."""
        test = self.python.resolved(node.test)
        if isinstance(test, ast.Constant):
            return self.find_pairs(node.body if test.value else node.orelse, are_parameters=are_parameters)
        branches = [self.find_pairs(value, are_parameters=are_parameters) for value in (node.body, node.orelse)]
        known = [dict(branch) for branch in branches if branch is not None]
        if len(known) < len(branches):
            return None
        common = {name: value for name, value in known[0].items() if known[1].get(name) == value}
        for condition, pairs in zip(format_branches(node.test), known, strict=True):
            common |= {with_condition(name, condition): value for name, value in pairs.items() if name not in common}
        return list(common.items())

    def find_pair(self, node: ast.expr) -> tuple[str, str] | None:
        """Return the texts of a pair, or None for other expressions."""
        return self._format_pair(node, self.format_joined)

    def _format_pair(self, node: ast.expr, format_value: Callable[[ast.expr], str]) -> tuple[str, str] | None:
        node = self.python.resolved(node)
        if not isinstance(node, (ast.Tuple, ast.List)) or len(node.elts) != 2:
            return None
        return self.format_joined(node.elts[0]), format_value(node.elts[1])

    def _flatten_items(
        self, node: ast.Dict, path: str, format_value: Callable[[ast.expr], str]
    ) -> Iterator[tuple[str, str]]:
        for key, value in zip(node.keys, node.values, strict=True):
            if key is None:
                yield f"{path}**", self.text(value)
                continue
            name, resolved = f"{path}{self.text(key)}", self.python.resolved(value)
            if isinstance(resolved, ast.Dict) and resolved.keys:
                yield from self._flatten_items(resolved, f"{name}.", format_value)
            else:
                yield name, format_value(resolved)

    def _format(self, node: ast.expr, depth: int) -> str:
        def part(item: ast.expr | None) -> str:
            return self.text(item, depth + 1)

        if isinstance(node, ast.Name):
            if node.id in self._bindings:
                return self._bindings[node.id]
            value = self.python.resolved(node)
            return node.id if value is node or isinstance(value, ast.Name) else part(value)
        if isinstance(node, ast.Constant):
            text = str(node.value)
            return " ".join(text.split()) if "\n" in text else text
        if isinstance(node, (ast.List, ast.Tuple, ast.Set)):
            return f"[{', '.join(map(part, node.elts))}]"
        if isinstance(node, ast.Dict):
            pairs = zip(node.keys, node.values, strict=True)
            return f"{{{', '.join(f'{part(key)}: {part(value)}' for key, value in pairs)}}}"
        template = format_template(node, lambda value: self._format_value(value, part))
        if template is not None:
            return template
        if isinstance(node, ast.Call):
            unpacked = self._unpack_arguments(node)
            if unpacked is not None:
                return unpacked.texts._format(unpacked.node, depth)
            substitution = format_substitution(self.python, node, part)
            result = self._find_result(node) if substitution is None else None
            if result is not None:
                return result.texts.text(result.node, depth + 1)
            return split_text(_format_call(node, part)) if substitution is None else substitution
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
            return f"{part(node.left)}{'' if is_string(self.python, node) else ' + '}{part(node.right)}"
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div):
            return f"{part(node.left)}/{part(node.right)}"
        if isinstance(node, ast.JoinedStr):
            return "".join(self._format_text_part(item, part) for item in node.values)
        if isinstance(node, ast.Subscript):
            if is_configurations(self.python, node.value):
                return f"$(var {part(node.slice)})"
            item = self._find_item(node)
            if item.node is not node:
                return item.texts.text(item.node, depth + 1)
            if self.is_unknown_item(node):
                owner = self._find_owner(node)
                function = owner.node.func if isinstance(owner.node, ast.Call) else owner.node
                return f"{owner.texts.text(function, depth + 1)}(...)[{part(node.slice)}]"
            return f"{part(node.value)}[{part(node.slice)}]"
        if isinstance(node, ast.Attribute):
            text = part(node.value)
            folder = find_parent(self.python, text) if node.attr == "parent" else None
            return f"{text}.{node.attr}" if folder is None else folder
        if isinstance(node, ast.BoolOp) and (operand := self._choose_operand(node)) is not None:
            return part(operand)
        choice = self._format_choice(node, part)
        if choice is not None:
            return choice
        if isinstance(node, ast.IfExp) and not is_chosen_value(node):
            values = (
                unparse_on_one_line(v) if isinstance(v, ast.Constant) else part(v) for v in (node.body, node.orelse)
            )
            return f" if {unparse_on_one_line(node.test)} else ".join(values)
        return unparse_on_one_line(node)

    def _unpack_arguments(self, call: ast.Call) -> BoundExpression | None:
        """Return a call with the items of the lists that it unpacks (``*items``), or None for other calls."""
        arguments: list[ast.expr] = []
        bindings: dict[str, str] = {}
        for argument in call.args:
            value = self.resolve(argument.value) if isinstance(argument, ast.Starred) else None
            if value is None or not isinstance(value.node, (ast.List, ast.Tuple)) or _unpacks(value.node):
                arguments.append(argument)
                continue
            for item in value.node.elts:
                name = f"*{len(bindings)}"  # no other name is written so
                bindings[name] = value.texts.text(item)
                arguments.append(ast.copy_location(ast.Name(name, ast.Load()), call))
        if not bindings:
            return None
        unpacked = ast.copy_location(ast.Call(call.func, arguments, call.keywords), call)
        return BoundExpression(self.with_names(bindings, {}), unpacked)

    def _format_choice(self, node: ast.expr, part: Formatter) -> str | None:
        """Return one of two texts that an argument chooses as an expression of XML launch files; None for others."""
        test = read_tests(self.python).get(unparse_on_one_line(node.test)) if isinstance(node, ast.IfExp) else None
        if test is None or not isinstance(node, ast.IfExp):
            return None
        body, other = (quote_text(part(value)) for value in (node.body, node.orelse))
        return None if body is None or other is None else make_choice(test, body, other)

    def _format_text_part(self, item: ast.expr, part: Formatter) -> str:
        """Return a part of a formatted text."""
        return self._format_value(item.value, part) if isinstance(item, ast.FormattedValue) else part(item)

    def _format_value(self, node: ast.expr, part: Formatter) -> str:
        """Return a value in a formatted text. A substitution is an object, which has no value there."""
        is_bound = isinstance(node, ast.Name) and node.id in self._bindings
        value = strip_conversion(node if is_bound else self.python.resolved(node))
        is_object = isinstance(value, ast.Call) and called_name(value).rpartition(".")[2] in SUBSTITUTIONS
        is_unknown = isinstance(self.python.resolved(value), ast.Name) and ast.unparse(value) not in self._bindings
        text = unparse_on_one_line(value) if is_object else part(value)
        return f"$(eval {text})" if is_unknown else text

    def is_unknown_item(self, node: ast.Subscript) -> bool:
        """Return whether an expression is an item of the result of an unknown function that has a name.

        The text of such an item has no arguments of the function. They are compared where the name gets the result.
        """
        owner = self._find_owner(node)
        return (
            isinstance(node.value, ast.Name)
            and isinstance(owner.node, ast.Call)
            and not owner.texts.is_known(owner.node)
        )

    def _find_owner(self, node: ast.Subscript) -> BoundExpression:
        """Return the value whose item an expression is."""
        owner = self.resolve(node.value)
        return owner.texts._find_item(owner.node) if isinstance(owner.node, ast.Subscript) else owner

    def _find_item(self, node: ast.Subscript) -> BoundExpression:
        """Return the value of an item of a dictionary or list, or the expression itself if it is unknown."""
        owner, key = self._find_owner(node), self.resolve(node.slice).node
        if isinstance(owner.node, ast.Dict):
            pairs = zip(owner.node.keys, owner.node.values, strict=True)
            values = [value for name, value in pairs if name is not None and ast.dump(name) == ast.dump(key)]
            if values:
                return owner.texts.resolve(values[-1])
        if isinstance(owner.node, (ast.List, ast.Tuple)):
            item = find_list_item(owner.node, key)
            if item is not None:
                return owner.texts.resolve(item)
        return BoundExpression(self, node)


def _assign_item(target: ast.expr, item: BoundExpression) -> dict[str, BoundExpression] | None:
    """Return the values of the variables of a loop, by name, or None if the item does not fit them."""
    if isinstance(target, ast.Name):
        return {target.id: item}
    if not isinstance(target, (ast.Tuple, ast.List)) or not isinstance(item.node, (ast.Tuple, ast.List)):
        return None
    if len(target.elts) != len(item.node.elts):
        return None
    values: dict[str, BoundExpression] = {}
    for part, value in zip(target.elts, item.node.elts, strict=True):
        assigned = _assign_item(part, item.texts.resolve(value))
        if assigned is None:
            return None
        values |= assigned
    return values


def _unpacks(node: ast.List | ast.Tuple) -> bool:
    """Return whether a literal list contains the items of another list."""
    return any(isinstance(item, ast.Starred) for item in node.elts)


def format_branches(test: ast.expr) -> tuple[str, str]:
    """Return the conditions of both branches of a test."""
    source = unparse_on_one_line(test)
    return f"if `{source}`", f"unless `{source}`"


def _format_call(node: ast.Call, part: Formatter) -> str:
    """Return any other call as text: the function unchanged, its arguments with their values."""
    words = [part(argument) for argument in node.args]
    words += [
        f"{keyword.arg}={part(keyword.value)}" if keyword.arg else part(keyword.value) for keyword in node.keywords
    ]
    return f"{part(node.func)}({', '.join(words)})"
