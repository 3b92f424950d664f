"""Reader for calls of xacro in Python files: launch files, tests, and other programs."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping

from linkwright.diagnostics import SourceText
from linkwright.packages.readers.python_values import PythonFile, argument_of, called_name
from linkwright.packages.readers.xacro_calls.call import CallingFile, Inclusion, XacroCall
from linkwright.packages.readers.xacro_calls.command_line import parse_xacro_command
from linkwright.packages.readers.xacro_calls.python_scopes import Function, Scope, walk_with_scopes
from linkwright.packages.readers.xacro_calls.python_texts import UNKNOWN_ENTRIES, Entries, Items, PythonTexts, Value
from linkwright.packages.readers.xacro_calls.texts import Selection, Text, join_texts, resolve

_DESCRIPTION_EXTENSIONS = (".xacro", ".urdf")
_XACRO_FUNCTIONS = frozenset({"process_file", "process_doc", "process", "load_xacro", "Xacro"})
_BUILDER_NAME = "MoveItConfigsBuilder"


def read_python(source: SourceText) -> CallingFile:
    """Read the calls of xacro in a Python file.

    The result is empty if the file is not valid Python.
    """
    file = CallingFile(source.name)
    try:
        python_file = PythonFile(source)
        _Reader(python_file, file).read()
    except (SyntaxError, ValueError, RecursionError):
        return CallingFile(source.name)
    return file


class _Reader:
    def __init__(self, python_file: PythonFile, file: CallingFile) -> None:
        self._python_file = python_file
        self._file = file
        self._nodes = walk_with_scopes(python_file.tree)
        functions = {node.name for node, _ in self._nodes if isinstance(node, Function)}
        calls: dict[str, list[tuple[ast.Call, Scope]]] = {}
        for node, scope in self._nodes:
            if isinstance(node, ast.Call) and called_name(node) in functions:
                calls.setdefault(called_name(node), []).append((node, scope))
        self._texts = PythonTexts(file, calls)
        self._handled_nodes: set[ast.AST] = set()

    def read(self) -> None:
        """Collect the calls and inclusions of the file."""
        for node, scope in self._nodes:
            if isinstance(node, ast.Call) and called_name(node).endswith("DeclareLaunchArgument"):
                self._read_declaration(node, scope)
            elif isinstance(node, ast.Call) and called_name(node).endswith("Command") and node.args:
                # The items of a list may be fragments of arguments, so they are not read as separate commands.
                self._handled_nodes.update(_find_assigned_expressions(node.args[0], scope))
        for node, scope in self._nodes:
            if node in self._handled_nodes:
                self._handled_nodes.update(ast.iter_child_nodes(node))
            elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
                self._handled_nodes.add(node.value)  # skip docstrings
            elif isinstance(node, ast.Call):
                self._handle_call(node, scope)
            elif isinstance(node, (ast.JoinedStr, ast.BinOp, ast.Constant, ast.List)):
                self._record_command(node, scope)

    def _read_declaration(self, node: ast.Call, scope: Scope) -> None:
        name = self._texts.text(node.args[0] if node.args else argument_of(node, "name"), scope)
        default, choices = argument_of(node, "default_value"), argument_of(node, "choices")
        choice_values = self._texts.value(choices, scope) if choices is not None else Items(())
        if len(name) == 1 and isinstance(name[0], str):
            values = (
                tuple(value for value in choice_values.values if isinstance(value, tuple))
                if isinstance(choice_values, Items)
                else ()
            )
            self._file.declare(name[0], None if default is None else self._texts.text(default, scope), values)

    def _handle_call(self, node: ast.Call, scope: Scope) -> None:
        name = called_name(node).rpartition(".")[2]
        if name == "Command":
            command = node.args[0] if node.args else argument_of(node, "command")
            self._record_call(parse_xacro_command(self._texts.text(command, scope)), node, is_command=True)
            self._handled_nodes.update(ast.iter_child_nodes(node))
        elif name == "IncludeLaunchDescription":
            self._read_inclusion(node, scope)
        elif name == "robot_description" and isinstance(node.func, ast.Attribute):
            self._read_builder_call(node, scope)
        else:
            self._read_expansion(node, name, scope)

    def _record_command(self, node: ast.JoinedStr | ast.BinOp | ast.Constant | ast.List, scope: Scope) -> None:
        """Record the call in a text, or in a list of arguments, if it is a command line of xacro."""
        value = self._texts.value(node, scope)
        if isinstance(value, Items):
            tokens = [item for item in value.values if isinstance(item, tuple)]
            command_line = join_texts((*token, " ") for token in tokens) if len(tokens) == len(value.values) else ()
        else:
            command_line = value if isinstance(value, tuple) else ()
        if any(isinstance(fragment, str) and "xacro" in fragment for fragment in command_line):
            self._record_call(parse_xacro_command(command_line), node, is_command=True)
        if not isinstance(node, ast.List):
            self._handled_nodes.update(ast.iter_child_nodes(node))

    def _read_expansion(self, node: ast.Call, name: str, scope: Scope) -> None:
        """Record a call of any function that receives the path of a description and a mapping."""
        paths: list[Text] = []
        mapping: Mapping[str, Value] | None = None
        for argument in (*node.args, *(keyword.value for keyword in node.keywords)):
            value = self._texts.value(argument, scope)
            if isinstance(value, tuple) and self._is_description(value):
                paths.append(value)
            elif isinstance(value, Entries) and mapping is None:
                mapping = value.values
        if mapping is None and name in _XACRO_FUNCTIONS:
            has_mappings = len(node.args) > 1 or argument_of(node, "mappings") is not None
            mapping = UNKNOWN_ENTRIES if has_mappings else {}
        if paths and mapping is not None:
            is_command = name == "Xacro" or name not in _XACRO_FUNCTIONS  # a helper may build a command line
            self._record_call((paths[0], dict(_iterate_entry_texts(mapping))), node, is_command=is_command)

    def _read_builder_call(self, node: ast.Call, scope: Scope) -> None:
        """Record a call ``MoveItConfigsBuilder(...).robot_description(...)``."""
        builder = next((descendant for descendant in ast.walk(node.func) if _is_builder(descendant)), None)
        if not isinstance(builder, ast.Call):
            return
        robot = self._texts.text(builder.args[0] if builder.args else argument_of(builder, "robot_name"), scope)
        package = argument_of(builder, "package_name")
        file_path = argument_of(node, "file_path") or (node.args[0] if node.args else None)
        file = (
            self._texts.text(file_path, scope)
            if file_path is not None
            else join_texts((("config/",), robot, (".urdf.xacro",)))
        )
        package_name = self._texts.text(package, scope) if package is not None else (*robot, "_moveit_config")
        mappings = self._texts.value(
            argument_of(node, "mappings") or (node.args[1] if len(node.args) > 1 else None), scope
        )
        arguments = dict(_iterate_entry_texts(mappings.values)) if isinstance(mappings, Entries) else {}
        # The builder passes its arguments on a command line, as the substitution `Command` does.
        self._record_call((_make_share_path(package_name, file), arguments), node, is_command=True)

    def _read_inclusion(self, node: ast.Call, scope: Scope) -> None:
        source = node.args[0] if node.args else argument_of(node, "launch_description_source")
        if isinstance(source, ast.Call) and called_name(source).endswith("LaunchDescriptionSource"):
            source = source.args[0] if source.args else argument_of(source, "launch_file_path")
        launch_arguments = self._texts.value(argument_of(node, "launch_arguments"), scope)
        arguments: dict[str, Text] = {}
        if isinstance(launch_arguments, Entries):
            arguments = dict(_iterate_entry_texts(launch_arguments.values))
        elif isinstance(launch_arguments, Items):
            pairs = [
                value.values for value in launch_arguments.values if isinstance(value, Items) and len(value.values) == 2
            ]
            arguments = dict(
                _iterate_entry_texts(
                    {resolve(key, {}, Selection()) or "": value for key, value in pairs if isinstance(key, tuple)}
                )
            )
        self._file.inclusions.append(Inclusion(self._texts.text(source, scope), arguments))

    def _is_description(self, path: Text) -> bool:
        text = resolve(path, self._file.choices, Selection())
        if text is None:
            text = path[-1] if path and isinstance(path[-1], str) else ""
        return text.endswith(_DESCRIPTION_EXTENSIONS)

    def _record_call(
        self, call: tuple[Text, dict[str, Text]] | None, node: ast.expr, *, is_command: bool = False
    ) -> None:
        if call is not None:
            self._file.calls.append(XacroCall(*call, self._python_file.span(node), is_command))


def _find_assigned_expressions(node: ast.expr, scope: Scope) -> Iterator[ast.AST]:
    """Yield the expressions that are assigned to a name, or nothing for any other node."""
    lookup = scope.find(node.id) if isinstance(node, ast.Name) else None
    yield from (binding.value for binding in (lookup[1] if lookup else ()) if binding.value is not None)


def _is_builder(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and called_name(node).rpartition(".")[2] == _BUILDER_NAME


def _iterate_entry_texts(entries: Mapping[str, Value]) -> Iterator[tuple[str, Text]]:
    for name, value in entries.items():
        yield (
            name,
            value
            if isinstance(value, tuple)
            else join_texts(item for item in getattr(value, "values", ()) if isinstance(item, tuple)),
        )


def _make_share_path(package: Text, file: Text) -> Text:
    from linkwright.packages.readers.xacro_calls.texts import Share, join_path

    return join_path([(Share(package),), file])
