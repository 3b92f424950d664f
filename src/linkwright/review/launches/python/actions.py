"""Read the actions of Python launch files from the calls that make them."""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.launches.outlines import (
    CONDITION,
    MISSING_ARGUMENT,
    NODE_CLASSES,
    UNKNOWN_ARGUMENT,
    Entry,
    Scope,
    find_own_default,
)
from linkwright.review.launches.python.expression_texts import BoundExpression, ExpressionTexts
from linkwright.review.launches.python.helpers import HelperFunctions, find_parameter_defaults
from linkwright.review.launches.python.imported_values import inline_values
from linkwright.review.launches.python.keyword_dictionaries import find_keyword_values
from linkwright.review.launches.python.list_additions import AddedItem, find_added_items, find_later_items
from linkwright.review.launches.python.node_settings import (
    format_settings,
    split_choice,
    split_parameters,
    split_remappings,
)
from linkwright.review.launches.python.substitution_texts import omit_program_search
from linkwright.review.launches.python.syntax import (
    OLD_KEYWORDS,
    find_missing_argument,
    find_name_and_value,
    find_unknown_argument,
)
from linkwright.review.launches.titles import shorten_command

_PROCESS_CLASSES = ("ExecuteProcess", "ExecuteLocal")
_ARGUMENT_CLASSES = ("DeclareLaunchArgument", "DeclareBooleanLaunchArg")
"""The classes that declare arguments; the second is one of MoveIt."""
_ENVIRONMENT_CLASSES = ("SetEnvironmentVariable", "AppendEnvironmentVariable", "UnsetEnvironmentVariable")
_OTHER_ACTIONS = (*_ARGUMENT_CLASSES, "IncludeLaunchDescription", "SetLaunchConfiguration", "SetRemap", "SetParameter")
_INCLUDING_FUNCTIONS = ("include_launch_py_description", "include_scoped_launch_py_description")
"""The functions of launch_pal that include a launch file by its package and the parts of its path."""
ACTIONS = frozenset({*_INCLUDING_FUNCTIONS, *NODE_CLASSES, *_PROCESS_CLASSES, *_ENVIRONMENT_CLASSES, *_OTHER_ACTIONS})
"""The classes whose calls make actions."""
_COPIES = ("list", "tuple", "sorted")
"""The functions that return the items of another list."""
_EMPTY_SCOPE = Scope()


@dataclass
class ActionReader:
    """A reader of the calls that make actions.

    Attributes:
        python: the parsed file.
        helpers: the functions of the repository that make actions.
        texts: the texts of expressions where the calls are written.
        extra: the keyword arguments that the caller of the function around the calls passes on with ``**``.
        covered: the calls that entries describe, which do not belong to the other code.
        branches: the ``if`` statements whose conditions actions have.
    """

    python: PythonFile
    helpers: HelperFunctions
    texts: ExpressionTexts
    extra: Mapping[str, BoundExpression]
    covered: set[int]
    branches: set[int]

    def read_action(self, call: ast.Call, function: str, scope: Scope) -> Entry:
        """Return the action of a class of launch or launch_ros.

        Args:
            call: the call.
            function: the name of the class.
            scope: the settings that the groups around it give to the action.
        """
        text = self.texts.text
        given = {keyword.arg: keyword.value for keyword in call.keywords if keyword.arg is not None}
        given = {**find_keyword_values(call, self.texts), **given}
        keywords = {OLD_KEYWORDS.get(key, key): value for key, value in given.items()}
        extra = self.extra if any(keyword.arg is None for keyword in call.keywords) else {}
        first_text, second_text = map(text, find_name_and_value(call, function))
        settings: dict[str, str] = {}
        if function in _ARGUMENT_CLASSES:
            kind, name = "argument", text(call.args[0] if call.args else keywords.get("name"))
            names = {"default_value": "default", "choices": "choices"}
            settings = {
                names[key]: text(value)
                for key, value in keywords.items()
                if key in names and not (key == "default_value" and self._is_none(value))
            }
            if "choices" in settings:
                settings["choices"] = self._format_choices(keywords["choices"])
            if "default" in settings:
                settings["default"] = find_own_default(name, self.texts.format_joined(keywords["default_value"]))
        elif function == "SetLaunchConfiguration":
            kind, name, settings = "variable", first_text, {"value": second_text}
        elif function == "SetRemap":
            kind, name, settings = "remapping", first_text, {"to": second_text}
        elif function == "SetParameter":
            kind, name, settings = "parameter", first_text, {"value": second_text}
        elif function in _ENVIRONMENT_CLASSES:
            kind, name = "environment", first_text
            key = {"SetEnvironmentVariable": "value", "AppendEnvironmentVariable": "appended value"}.get(function)
            settings = {key: second_text} if key else {"unset": "true"}
        elif function in _PROCESS_CLASSES:
            kind, name = "process", self._format_command(keywords.get("cmd"))
            settings = self._read_settings(keywords)
        elif function == "IncludeLaunchDescription":
            kind, name = "include", text(call.args[0] if call.args else keywords.get("launch_description_source"))
            settings = self._read_passed_arguments(keywords.get("launch_arguments"))
        elif function in _INCLUDING_FUNCTIONS:
            kind, name = "include", self._format_included_path(call, keywords)
            settings = self._read_passed_arguments(keywords.get("launch_arguments"))
        else:
            kind = "node"
            name = "/".join(text(keywords[key]) for key in ("package", "executable", "plugin") if key in keywords)
            name, settings = name or text(call.func), self._read_node_settings(keywords, extra)
            if function == "LifecycleNode":
                settings["lifecycle"] = "true"
        condition = self.texts.format_condition(keywords.get(CONDITION))
        if not condition and CONDITION in extra:
            condition = extra[CONDITION].texts.format_condition(extra[CONDITION].node)
        if condition:
            settings[CONDITION] = condition
        missing = find_missing_argument(self.python, call, keywords)
        if missing is not None:
            settings[MISSING_ARGUMENT] = missing
        unknown = find_unknown_argument(self.python, call, keywords)
        if unknown is not None:
            settings = {key: value for key, value in settings.items() if key != unknown} | {UNKNOWN_ARGUMENT: unknown}
        return Entry(kind, name, scope.add_to_settings(kind, settings), self.python.span(call))

    def _format_included_path(self, call: ast.Call, keywords: Mapping[str, ast.expr]) -> str:
        """Return the path of a file that a function includes by its package and the parts of its path."""
        named = (keywords[name] for name in ("pkg_name", "paths") if name in keywords)
        package, parts = [*call.args, *named, None, None][:2]
        resolved = None if parts is None else self.python.resolved(parts)
        items = resolved.elts if isinstance(resolved, (ast.List, ast.Tuple)) else [resolved]
        return "/".join([f"$(find-pkg-share {self.texts.text(package)})", *map(self.texts.text, items)])

    def _format_choices(self, node: ast.expr) -> str:
        """Return the values that an argument accepts, also those of ``list(MODELS)`` with imported names."""
        values = inline_values(node, self.python, self.helpers, {})
        if isinstance(values, ast.Call) and called_name(values) in _COPIES and len(values.args) == 1:
            values = values.args[0]
        items = self.texts.find_items(values)
        return self.texts.text(node) if items is None else f"[{', '.join(it.texts.text(it.node) for it in items)}]"

    def _is_none(self, node: ast.expr) -> bool:
        """Return whether an expression is None, also by the default of a parameter of a function around it."""
        value = self.texts.resolve(node).node
        if isinstance(value, ast.Name) and self.texts.text(value) in ("None", value.id):
            functions = (item for item in ast.walk(self.python.tree) if isinstance(item, ast.FunctionDef))
            around = [item for item in functions if item.lineno <= value.lineno <= (item.end_lineno or item.lineno)]
            defaults = {name: default for item in around for name, default in find_parameter_defaults(item).items()}
            value = defaults.get(value.id, value)
        return isinstance(value, ast.Constant) and value.value is None

    def read_handler(self, call: ast.Call, scope: Scope) -> Entry:
        """Return the handler of an event: its class and the action whose event it handles."""
        argument = call.args[0] if call.args else next((item.value for item in call.keywords), None)
        event = None if argument is None else self.python.resolved(argument)
        if not isinstance(event, ast.Call):
            return Entry(
                "handler", self.texts.text(argument), scope.add_to_settings("handler", {}), self.python.span(call)
            )
        keywords = {keyword.arg: keyword.value for keyword in event.keywords if keyword.arg is not None}
        target = keywords.pop("target_action", event.args[0] if event.args else None)
        name = called_name(event).rpartition(".")[2]
        name = f"{name} of {self._format_short_name(target)}" if target is not None else name
        settings = {key: self._format_short_name(item) for key, item in keywords.items()}
        return Entry("handler", name, scope.add_to_settings("handler", settings), self.python.span(call))

    def _format_short_name(self, node: ast.expr, *, is_item: bool = False) -> str:
        """Return the program of a node or the class of another action.

        For a list, the result names each item, and the commands of processes.
        """
        node = self.python.resolved(node)
        if isinstance(node, (ast.List, ast.Tuple)):
            return f"[{', '.join(self._format_short_name(item, is_item=True) for item in node.elts)}]"
        if not isinstance(node, ast.Call):
            return self.texts.text(node)
        function = called_name(node).rpartition(".")[2]
        if function in NODE_CLASSES:
            return self.read_action(node, function, _EMPTY_SCOPE).name
        if function in _PROCESS_CLASSES and is_item:
            return shorten_command(self.read_action(node, function, _EMPTY_SCOPE).name)
        return function

    def read_foreign_action(self, call: ast.Call, scope: Scope) -> Entry:
        """Return the action that a function of another package makes."""
        keywords = {keyword.arg: keyword.value for keyword in call.keywords if keyword.arg is not None}
        programs = {key: self.texts.text(keywords[key]) for key in ("package", "executable") if key in keywords}
        actions = {key: self._format_short_name(node) for key, node in keywords.items() if self._is_action(node)}
        others = {key: node for key, node in keywords.items() if key not in actions}
        settings = programs | actions | self._read_node_settings(others)
        if call.args:
            settings["arguments"] = f"[{', '.join(map(self.texts.text, call.args))}]"
        condition = self.texts.format_condition(keywords.get(CONDITION))
        if condition:
            settings[CONDITION] = condition
        return Entry("action", called_name(call), scope.add_to_settings("action", settings), self.python.span(call))

    def _is_action(self, node: ast.expr) -> bool:
        """Return whether an expression is another action, which has its own entry."""
        action = self.python.resolved(node)
        return (
            isinstance(action, ast.Call)
            and action is not node
            and (called_name(action).rpartition(".")[2] in ACTIONS or self.helpers.is_foreign(self.python, action))
        )

    def _read_passed_arguments(self, node: ast.expr | None) -> dict[str, str]:
        """Return the arguments of an include: ``{...}.items()``, a dictionary or a list of pairs."""
        if node is None:
            return {}
        pairs = self.texts.find_pairs(node)
        return {"launch_arguments": self.texts.text(node)} if pairs is None else dict(pairs)

    def _format_command(self, node: ast.expr | None) -> str:
        """Return the command of a process, with the words that statements add to its list.

        A list in the list is one text of several substitutions, such as a whole line of a shell.
        """
        value = None if node is None else self.texts.resolve(node)
        added = [] if node is None else self._read_added_items(node)
        if value is None or not isinstance(value.node, (ast.List, ast.Tuple)):
            return self.texts.text(node)
        if any(isinstance(item, ast.Starred) for item in value.node.elts) and not added:
            return value.texts.text(value.node)
        words = [omit_program_search(value.texts.format_joined(item)) for item in value.node.elts]
        if len(words) == 1 and not added and " " in words[0] and isinstance(value.node.elts[0], (ast.List, ast.Tuple)):
            return words[0]
        return f"[{', '.join([*words, *added])}]"

    def _read_added_items(self, node: ast.expr) -> list[str]:
        """Return the texts of the items that statements add to the list of a name."""
        return self._cover_added(find_added_items(self.python, node, self.texts) if isinstance(node, ast.Name) else [])

    def _cover_added(self, added: Sequence[AddedItem]) -> list[str]:
        """Return the texts of the items that statements add to a list, which need no lines of their own."""
        self.covered.update(id(item.call) for item in added)
        self.branches.update(id(branch) for item in added for branch in item.branches)
        return [item.text for item in added]

    def _read_settings(self, keywords: Mapping[str, ast.expr]) -> dict[str, str]:
        return format_settings({key: BoundExpression(self.texts, value) for key, value in keywords.items()})

    def _read_node_settings(
        self, keywords: Mapping[str, ast.expr], extra: Mapping[str, BoundExpression] | None = None
    ) -> dict[str, str]:
        """Return the settings of a node, with each parameter and remapping alone.

        Args:
            keywords: the keyword arguments of the call.
            extra: the keyword arguments that the call passes on with ``**``.
        """
        others = {key: BoundExpression(self.texts, value) for key, value in keywords.items()} | dict(extra or {})
        parts: dict[str, str] = {}
        arguments = others.get("arguments")
        words = None if arguments is None else arguments.texts.find_words(arguments.node)
        if arguments is not None and words is not None:
            texts = [word.texts.format_joined(word.node) for word in words]
            if arguments.texts is self.texts and isinstance(arguments.node, ast.Name):
                texts += self._read_added_items(arguments.node)
            else:
                lists = arguments.texts.find_lists(arguments.node)
                texts += self._cover_added([item for found in lists for item in find_later_items(found)])
            parts["arguments"] = f"[{', '.join(texts)}]"
            del others["arguments"]
        if "remappings" in others:
            parts |= split_choice(others.pop("remappings"), split_remappings)
        if "parameters" in others:
            parts |= split_choice(others.pop("parameters"), split_parameters)
        return {**format_settings(others), **parts}
