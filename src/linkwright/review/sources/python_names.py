"""Read the names in Python sources and dynamic_reconfigure descriptions.

Sources may use rclpy, rospy and argparse.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import SourceText
from linkwright.packages.readers.python2 import as_python3
from linkwright.packages.readers.python_values import PythonFile, argument_of, called_name
from linkwright.review.sources.conditions import find_python_conditions
from linkwright.review.sources.details import read_service_qos
from linkwright.review.sources.interface_types import PythonTypes
from linkwright.review.sources.names import NO, YES, Detail, NameKind, OwnUse, SourceName, SourceNames, Timer
from linkwright.review.sources.parameter_defaults import find_parameter_default
from linkwright.review.sources.parameter_helpers import is_parameter_name, reads_parameter
from linkwright.review.sources.python.attributes import find_attributes
from linkwright.review.sources.python.bases import find_inherited_names, list_known_names
from linkwright.review.sources.python.callbacks import CallbackFunctions
from linkwright.review.sources.python.declared_types import find_declared_type
from linkwright.review.sources.python.frame_helpers import find_frame_arguments
from linkwright.review.sources.python.methods import find_defined_attributes, find_undefined_attributes
from linkwright.review.sources.python.package_imports import PACKAGE_FILE, read_imports
from linkwright.review.sources.python.parameter_ranges import PythonRanges
from linkwright.review.sources.python.required_parameters import is_required_parameter
from linkwright.review.sources.python.signatures import (
    Signature,
    count_returned,
    find_argument_default,
    find_returned,
    ignores_keywords,
    is_data_class,
    read_method_signatures,
    read_signature,
)
from linkwright.review.sources.python.uncalled_functions import find_uncalled_functions
from linkwright.review.sources.python.undefined_names import find_bound_names, find_undefined_names
from linkwright.review.sources.python.values import PythonSource
from linkwright.review.sources.python.wrappers import CREATING_METHODS, WrapperClasses, get_argument

_NAME_FIRST_CLASSES = {
    "Publisher": NameKind.PUBLISHER,
    "Subscriber": NameKind.SUBSCRIPTION,
    "Service": NameKind.SERVICE,
    "ServiceProxy": NameKind.CLIENT,
    "SimpleActionServer": NameKind.ACTION,
    "SimpleActionClient": NameKind.ACTION_CLIENT,
}
"""The classes of ROS 1 whose first two arguments are the name and the type."""
_NODE_FIRST_CLASSES = {
    "ActionServer": NameKind.ACTION,
    "ActionClient": NameKind.ACTION_CLIENT,
    "Subscriber": NameKind.SUBSCRIPTION,
}
"""The classes of ROS 2 whose first three arguments are the node, the type and the name."""
_CALLBACK_KEYWORDS = {
    NameKind.SUBSCRIPTION: "callback",
    NameKind.SERVICE: "handler",
    NameKind.ACTION: "execute_cb",
}
"""The kinds of names with a callback as their third argument, and its name in ROS 1."""
_ROUTE_METHODS = ("route", "get", "post", "put", "delete", "patch", "websocket")
_NODE_CALLS = ("init_node", "create_node", "Node", "LifecycleNode")
_PRIVATE_NAME = re.compile(r"rospy\.get_name\(\) \+ '/(?P<name>[\w/]+)'")
_PART_OF_INTERFACE = re.compile(r"\w+\.(?:Goal|Result|Feedback|Request|Response)\Z")
_RATE_CALLS = ("Rate", "create_rate", "Timer", "create_timer")
_TRANSFORM_CALLS = {
    **dict.fromkeys(("lookup_transform", "lookupTransform", "can_transform", "canTransform"), (0, 1)),
    **dict.fromkeys(("waitForTransform", "lookup_transform_async", "lookupTransformFull"), (0, 1)),
}
"""The indexes of the frames among the arguments of a lookup."""
_PARAMETER_CALLS = ("declare_parameter", "get_param", "get_param_cached", "get_parameter_or", "add_parameter")
_PARAMETER_NAME_CALLS = (*_PARAMETER_CALLS, "search_param", "has_param")
_DICTIONARY_METHODS = ("items", "iteritems", "keys", "iterkeys")
_FRAME_FIELDS = {"frame_id": NameKind.MESSAGE_FRAME, "child_frame_id": NameKind.FRAME}
_CLICK_OPTION = "click.option"
_SHORT_OPTION = re.compile(r"-\w")
_QOS = re.compile(r"\d+|[\w.]*(QoS|qos_profile|QOS)\w*(?:\.\w+)*(\(.*\))?", re.DOTALL)


def read_python(source: SourceText, names: SourceNames) -> None:
    """Add the names in a Python 3 or Python 2 source.

    Raises:
        SyntaxError: the text is neither.
    """
    python = parse_source(source)
    _Reader(python, names).read()
    if python.source is source:  # not converted from Python 2
        names.bound_names = frozenset(find_bound_names(python.tree))
        names.undefined_names.update(
            (name, python.span(node)) for name, node in find_undefined_names(python.tree).items()
        )
        names.attributes = frozenset(find_defined_attributes(python.tree))
        for name, (node, owner, is_call) in find_undefined_attributes(Path(source.name), python.tree).items():
            names.undefined_attributes[name] = OwnUse(owner, python.span(node), is_call)
    if PurePosixPath(source.name).name == PACKAGE_FILE:
        read_imports(python, names)


def read_dynamic_parameters(source: SourceText, names: SourceNames) -> None:
    """Add the parameters of a dynamic_reconfigure description, with their defaults and limits.

    Raises:
        SyntaxError: the text is not Python.
    """
    python = parse_source(source)
    for call in python.calls("add"):
        name = python.text(get_argument(call, 0, "name"))
        if name is None:
            continue
        details = [
            (Detail.VALUE_TYPE, _format_expression(python, get_argument(call, 1, "paramtype")).removesuffix("_t"))
        ]
        for detail, index, keyword in (
            (Detail.LEVEL, 2, "level"),
            (Detail.MINIMUM, 5, "min"),
            (Detail.MAXIMUM, 6, "max"),
        ):
            text = _format_expression(python, get_argument(call, index, keyword))
            if text and text != "None":
                details.append((detail, text))
        choices = argument_of(call, "edit_method")
        if choices is not None:
            values = (
                _format_expression(python, item.args[1])
                for item in _find_enumeration_constants(python, choices)
                if len(item.args) > 1
            )
            details.append((Detail.CHOICES, ", ".join(values)))
        default = _format_expression(python, get_argument(call, 4, "default"))
        names.add(SourceName(NameKind.PARAMETER, name, default, python.span(call), tuple(details)))


def _find_enumeration_constants(python: PythonFile, node: ast.expr) -> Iterator[ast.Call]:
    """Yield the calls that define the constants of a dynamic_reconfigure enumeration."""
    for part in ast.walk(python.resolved(node)):
        value = python.resolved(part) if isinstance(part, ast.Name) else part
        if isinstance(value, ast.Call) and called_name(value).endswith("const"):
            yield value


def parse_source(source: SourceText) -> PythonSource:
    """Return a parsed Python 3 or Python 2 source.

    Raises:
        SyntaxError: the text is neither.
    """
    try:
        return PythonSource(source)
    except SyntaxError:
        text = as_python3(source.text)
        return PythonSource(SourceText(source.name, text))


def _format_expression(python: PythonFile, node: ast.expr | None) -> str:
    """Return the text of an expression, or of the literal that it names."""
    if node is None:
        return ""
    value = python.resolved(node)
    return " ".join(ast.unparse(value if isinstance(value, (ast.Constant, ast.UnaryOp)) else node).split())


def _list_details(definition: ast.FunctionDef | ast.ClassDef, signature: Signature) -> tuple[tuple[Detail, str], ...]:
    """Return the parameters of a function or class, and the result of a function if it is certain."""
    details = [(Detail.ARGUMENTS, signature.text)]
    if isinstance(definition, ast.FunctionDef):
        returned, count = find_returned(definition), count_returned(definition)
        details += [] if returned is None else [(Detail.RETURNED, returned)]
        details += [] if count is None else [(Detail.RETURNED_COUNT, str(count))]
    return tuple(details)


def _has_uncertain_arguments(call: ast.Call) -> bool:
    """Return whether a call passes on arguments with ``*`` or ``**``."""
    return any(keyword.arg is None for keyword in call.keywords) or any(
        isinstance(argument, ast.Starred) for argument in call.args
    )


def _is_required(call: ast.Call, option: str) -> bool:
    """Return whether an option or argument of a command line is required."""
    if not option.startswith("-"):
        return argument_of(call, "nargs") is None and argument_of(call, "default") is None
    value = argument_of(call, "required")
    return isinstance(value, ast.Constant) and value.value is True


class _Reader:
    """Reads the names in a Python source.

    Args:
        python: the parsed source.
        names: the collection to which the names are added.
    """

    def __init__(self, python: PythonSource, names: SourceNames) -> None:
        self._python = python
        self._names = names
        self._types = PythonTypes(python.tree)
        self._functions = CallbackFunctions(python.tree)
        self._wrappers = WrapperClasses(Path(python.source.name), python.tree)
        self._ranges = PythonRanges(python)
        self._frame_arguments = find_frame_arguments(python.tree, _FRAME_FIELDS)

    def read(self) -> None:
        """Add the names."""
        tree = self._python.tree
        uncalled = {id(node) for function in find_uncalled_functions(tree) for node in ast.walk(function)}
        nodes = [node for node in ast.walk(tree) if isinstance(node, (ast.Call, ast.Assign, ast.For))]
        nodes = [node for node in nodes if id(node) not in uncalled]
        for node in sorted(nodes, key=lambda node: (node.lineno, node.col_offset)):
            if isinstance(node, ast.Assign):
                self._read_assignment(node)
            elif isinstance(node, ast.For):
                self._read_loop(node)
            else:
                function = called_name(node).rpartition(".")[2]
                if isinstance(node.func, ast.Attribute) and function == "":
                    function = node.func.attr
                self._read_call(node, function)
        self._names.wrapper_arguments |= self._wrappers.list_arguments()
        self._names.conditional_lines += find_python_conditions(tree)
        for part in ast.walk(tree):
            if isinstance(part, (ast.FunctionDef, ast.AsyncFunctionDef)):
                self._read_decorators(part)
        for statement in tree.body:
            if isinstance(statement, (ast.ClassDef, ast.FunctionDef)) and not statement.name.startswith("_"):
                kind = NameKind.CLASS if isinstance(statement, ast.ClassDef) else NameKind.FUNCTION
                signature = read_signature(statement)
                details = () if signature is None else _list_details(statement, signature)
                if ignores_keywords(statement):
                    self._names.ignoring_keywords.add(statement.name)
                self._names.add(SourceName(kind, statement.name, "", self._python.span(statement), details))
                if isinstance(statement, ast.ClassDef):
                    self._read_attributes(statement)
                    self._read_methods(statement)
            self._names.is_program |= isinstance(statement, ast.If) and "__main__" in ast.unparse(statement.test)
            self._names.is_program |= isinstance(statement, ast.FunctionDef) and statement.name == "main"

    def _read_decorators(self, function: ast.FunctionDef | ast.AsyncFunctionDef) -> None:
        """Add the routes of a web server, and the events of Socket.IO, that call a function."""
        for decorator in function.decorator_list:
            text = self._python.text(decorator.args[0]) if isinstance(decorator, ast.Call) and decorator.args else None
            if not isinstance(decorator, ast.Call) or text is None:
                continue
            method = called_name(decorator).rpartition(".")[2]
            kind = NameKind.ROUTE if method in _ROUTE_METHODS and text.startswith("/") else None
            if method == "on" and "socketio" in self._python.source.text:
                kind = NameKind.WEB_EVENT
            if kind is not None:
                self._add(kind, decorator.args[0], None)
                self._names.callbacks[self._functions.qualify(function)] = (kind, text)

    def _read_attributes(self, definition: ast.ClassDef) -> None:
        """Add the declared attributes of a class, unless they are the parameters of its constructor."""
        path = Path(self._python.source.name)
        self._names.class_names[definition.name] = list_known_names(path, self._python.tree, definition)
        if is_data_class(definition):
            self._names.data_classes.add(definition.name)
            return
        for attribute, node in find_attributes(definition):
            name = f"{definition.name}.{attribute}"
            self._names.add(SourceName(NameKind.MEMBER, name, "", self._python.span(node)))

    def _read_methods(self, definition: ast.ClassDef) -> None:
        """Add the public methods of a class whose base classes are known.

        Methods that the source passes on, such as callbacks, are left out.
        """
        inherited = find_inherited_names(Path(self._python.source.name), self._python.tree, definition)
        if inherited is None:
            return
        nodes = list(ast.walk(definition))
        called_ids = {id(node.func) for node in nodes if isinstance(node, ast.Call)}
        reads = (node for node in nodes if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load))
        passed_on = {node.attr for node in reads if id(node) not in called_ids}
        self._names.inherited_names[definition.name] = inherited
        for method, signature in read_method_signatures(definition):
            name, details = f"{definition.name}.{method.name}", _list_details(method, signature)
            if method.name in passed_on:
                self._names.passed_on.add(name)
            else:
                self._names.add(SourceName(NameKind.FUNCTION, name, "", self._python.span(method), details))
                if ignores_keywords(method):
                    self._names.ignoring_keywords.add(name)

    def _read_assignment(self, node: ast.Assign) -> None:
        for target in node.targets:
            if isinstance(target, ast.Attribute) and target.attr in _FRAME_FIELDS:
                self._add_frame(_FRAME_FIELDS[target.attr], node.value)

    def _read_loop(self, loop: ast.For) -> None:
        """Add the parameters that a loop over a dictionary of defaults reads."""
        source = loop.iter
        if (
            isinstance(source, ast.Call)
            and isinstance(source.func, ast.Attribute)
            and source.func.attr in _DICTIONARY_METHODS
        ):
            source = source.func.value
        defaults = self._python.resolved(source)
        variable = loop.target.elts[0] if isinstance(loop.target, ast.Tuple) else loop.target
        if not isinstance(defaults, ast.Dict) or not isinstance(variable, ast.Name):
            return
        calls = (node for node in ast.walk(loop) if isinstance(node, ast.Call) and node.args)
        names = [call.args[0] for call in calls if called_name(call).rpartition(".")[2] in _PARAMETER_NAME_CALLS]
        names_with_variable = [
            name for name in names if variable.id in (n.id for n in ast.walk(name) if isinstance(n, ast.Name))
        ]
        if not names_with_variable:
            return
        prefix = (
            "~"
            if isinstance(names_with_variable[0], ast.BinOp) and self._python.text(names_with_variable[0].left) == "~"
            else ""
        )
        for key, value in zip(defaults.keys, defaults.values, strict=True):
            self._add(NameKind.PARAMETER, key, value, prefix=prefix)

    def _read_call(self, call: ast.Call, function: str) -> None:
        if isinstance(call.func, ast.Name) or ast.unparse(call.func) == f"self.{function}":
            for argument in self._frame_arguments.get(function, ()):
                node = get_argument(call, argument.position, argument.name)
                if node is not None:
                    self._add_frame(_FRAME_FIELDS[argument.field], node)
        for keyword in call.keywords:
            if keyword.arg in _FRAME_FIELDS and function not in _PARAMETER_CALLS:
                self._add_frame(_FRAME_FIELDS[keyword.arg], keyword.value)
        if function in CREATING_METHODS:
            kind, type_keyword, name_keyword, qos_index = CREATING_METHODS[function]
            qos = self._read_qos(kind, get_argument(call, qos_index, "qos_profile"))
            self._add(kind, get_argument(call, 1, name_keyword), get_argument(call, 0, type_keyword), qos)
            if kind in _CALLBACK_KEYWORDS:
                self._add_callback(kind, get_argument(call, 1, name_keyword), get_argument(call, 2, "callback"))
        elif function == "wait_for_message" and len(call.args) > 1:
            is_ros1 = self._is_ros1(call)
            name, types = (call.args[0], call.args[1]) if is_ros1 else (get_argument(call, 2, "topic"), call.args[0])
            self._add(NameKind.SUBSCRIPTION, name, types)
        elif self._has_node_first(call, function):
            self._add(
                _NODE_FIRST_CLASSES[function],
                get_argument(call, 2, "action_name"),
                get_argument(call, 1, "action_type"),
            )
            if _NODE_FIRST_CLASSES[function] is NameKind.ACTION:
                self._add_callback(NameKind.ACTION, call.args[2], get_argument(call, 3, "execute_callback"))
        elif function in _NAME_FIRST_CLASSES and (call.args or call.keywords):
            self._read_ros1_call(call, function)
        elif function in _PARAMETER_CALLS:
            self._read_parameter(call, function)
        elif function == "declare_parameters":
            self._read_parameters(get_argument(call, 0, "namespace"), get_argument(call, 1, "parameters"))
        elif (function in _NODE_CALLS and self._python.text(get_argument(call, 0, "node_name")) is not None) or (
            function == "__init__" and self._is_node_constructor(call)
        ):
            self._names.makes_node = True
            index = int(bool(call.args) and ast.unparse(call.args[0]) == "self")  # ``Base.__init__(self, ...)``
            node = get_argument(call, index, "node_name")
            default = find_argument_default(self._python.tree, node) if isinstance(node, ast.Name) else None
            self._add(NameKind.NODE, node if self._python.text(default) is None else default, None)
        else:
            self._names.makes_node |= function == "init_node"  # a node with a computed name
            self._read_other_call(call, function)

    def _has_node_first(self, call: ast.Call, function: str) -> bool:
        """Return whether the arguments of a call begin with a node of ROS 2, which a name of ROS 1 may look like."""
        is_known = function in _NODE_FIRST_CLASSES and len(call.args) > 2
        return is_known and self._python.text(call.args[0]) is None and not self._is_ros1(call)

    def _is_ros1(self, call: ast.Call) -> bool:
        """Return whether a call is one of ROS 1, by its written or imported name."""
        names = called_name(call), self._types.resolve(call.func)
        return any(name.partition(".")[0] in ("rospy", "actionlib") for name in names)

    def _read_ros1_call(self, call: ast.Call, function: str) -> None:
        name, types = get_argument(call, 0, "name"), get_argument(call, 1, "data_class")
        if self._python.text(name) is None and not self._is_ros1(call):
            return
        details = []
        for keyword, detail in (("queue_size", Detail.QUEUE), ("latch", Detail.LATCH)):
            value = argument_of(call, keyword)
            if isinstance(value, ast.Constant) and value.value not in (None, False):
                details.append((detail, YES if value.value is True else str(value.value)))
        kind = _NAME_FIRST_CLASSES[function]
        self._add(kind, name, types, tuple(details))
        if kind in _CALLBACK_KEYWORDS:
            self._add_callback(kind, name, get_argument(call, 2, _CALLBACK_KEYWORDS[kind]))

    def _read_wrapper_call(self, call: ast.Call) -> None:
        """Add the topics and services that a class of the package makes for its caller."""
        for wrapped in () if _has_uncertain_arguments(call) else self._wrappers.find(call):
            given = (None if place is None else get_argument(call, *place) for place in wrapped[2:5])
            name, type_node, qos_node = given
            qos = () if qos_node is None else self._read_qos(wrapped.kind, qos_node)
            self._add(wrapped.kind, wrapped.default if name is None else name, type_node, qos)

    def _read_other_call(self, call: ast.Call, function: str) -> None:
        self._read_wrapper_call(call)
        if function in _RATE_CALLS and called_name(call).partition(".")[0] != "threading" and call.args:
            period = self._python.resolved(call.args[0])
            text = f"{function}({_format_expression(self._python, period)})"
            span = self._python.span(call.args[0])
            self._names.rates.append((text, span))
            if "imer" in function:
                callback = get_argument(call, 1, "callback")
                self._add_callback(None, None, callback)
                is_name = isinstance(callback, (ast.Name, ast.Attribute))
                name = ast.unparse(callback).rpartition(".")[2] if is_name and callback is not None else ""
                self._names.timers.append(Timer(name, text, span))
        elif function in _TRANSFORM_CALLS:
            for index in _TRANSFORM_CALLS[function]:
                if index < len(call.args):
                    self._add_frame(NameKind.FRAME_LOOKUP, call.args[index])
        elif function == "sendTransform" and len(call.args) == 5:
            for index in (3, 4):
                self._add_frame(NameKind.FRAME, call.args[index])
        elif function == "Server" and len(call.args) > 1 and ast.unparse(call.args[0]).endswith("Config"):
            name = ast.unparse(call.args[0]).rpartition(".")[2]
            self._names.add(SourceName(NameKind.RECONFIGURATION, name, "", self._python.span(call)))
        elif function in ("add_argument", "add_option") or self._types.resolve(call.func) == _CLICK_OPTION:
            self._read_option(call)
        elif function in ("getopt", "gnu_getopt"):
            self._read_getopt(call)
        elif reads_parameter(function):
            self._read_helper_call(call)
            parameter = self._python.text(get_argument(call, 0, "name")) if function == "get_parameter" else None
            if parameter is not None:
                self._names.parameter_reads.setdefault(parameter, []).append(call.lineno)

    def _read_helper_call(self, call: ast.Call) -> None:
        """Add the parameter that a function of the repository reads.

        The name is one of the first two arguments.
        """
        for index, argument in enumerate(call.args[:2]):
            text = argument.value if isinstance(argument, ast.Constant) else None
            if isinstance(text, str) and is_parameter_name(text):
                default = call.args[index + 1] if index + 1 < len(call.args) else argument_of(call, "default")
                self._add(NameKind.PARAMETER, argument, default)
                return

    def _add_callback(self, kind: NameKind | None, name: ast.expr | None, callback: ast.expr | None) -> None:
        """Add the function that messages, requests, goals or a timer call, if both names are known."""
        text = self._python.text(name)
        is_known = text is not None or kind is None
        for function in self._functions.find(callback) if callback is not None and is_known else ():
            self._names.callbacks.setdefault(function, (kind, text or ""))

    def _read_option(self, call: ast.Call) -> None:
        texts = [text for text in map(self._python.text, call.args) if text]
        if not texts:
            return
        name = max([text for text in texts if text.startswith("-")] or texts, key=len)
        default = argument_of(call, "default")
        details = [(Detail.REQUIRED, YES)] if _is_required(call, name) else []
        short = [text for text in texts if _SHORT_OPTION.fullmatch(text) and text != name]
        details += [(Detail.SHORT_FORM, ", ".join(sorted(short)))] if short else []
        for detail, keyword in ((Detail.VALUE_TYPE, "type"), (Detail.CHOICES, "choices")):
            node = argument_of(call, keyword)
            if node is not None:
                details.append((detail, _format_expression(self._python, node)))
        text = "" if default is None else _format_expression(self._python, default)
        self._names.add(SourceName(NameKind.OPTION, name, text, self._python.span(call.args[0]), tuple(details)))

    def _read_getopt(self, call: ast.Call) -> None:
        """Add the options of getopt: the letters of the second argument, and the names in the third."""
        letters, names = get_argument(call, 1, "shortopts"), get_argument(call, 2, "longopts")
        for letter in re.findall(r"[A-Za-z0-9?]", self._python.text(letters) or ""):
            self._names.add(SourceName(NameKind.OPTION, f"-{letter}", "", self._python.span(call)))
        items = None if names is None else self._python.resolved(names)
        for item in items.elts if isinstance(items, (ast.List, ast.Tuple)) else ():
            name = (self._python.text(item) or "").rstrip("=?")
            if name:
                self._names.add(SourceName(NameKind.OPTION, f"--{name}", "", self._python.span(item)))

    def _read_parameter(self, call: ast.Call, function: str) -> None:
        keyword = {"declare_parameter": "value", "get_parameter_or": "alternative_value"}.get(function, "default")
        node, value = get_argument(call, 0, "name"), get_argument(call, 1, keyword)
        if function == "get_parameter_or" and isinstance(value, ast.Call) and called_name(value).endswith("Parameter"):
            value = get_argument(value, 2, "value")
        is_ros1 = function.startswith("get_param") and function != "get_parameter_or"
        if is_ros1 and self._read_name(node) is None:
            return  # a different function with the same name
        resolved = None if value is None else self._python.resolved(value)
        details: tuple[tuple[Detail, str], ...] = ()
        if function == "declare_parameter" and isinstance(resolved, (ast.Constant, ast.UnaryOp)):
            literal = resolved.operand if isinstance(resolved, ast.UnaryOp) else resolved
            if isinstance(literal, ast.Constant) and literal.value is not None:
                details = ((Detail.VALUE_TYPE, type(literal.value).__name__),)
        elif is_required_parameter(self._python, call):
            details = ((Detail.REQUIRED, YES),)
        elif function == "declare_parameter" and not _has_uncertain_arguments(call):
            type_name = find_declared_type(self._python, value, get_argument(call, 2, "descriptor"))
            details = ((Detail.DEFAULT, NO),) if value is None or type_name is not None else ()
            details += () if type_name is None else ((Detail.VALUE_TYPE, type_name),)
        if function == "declare_parameter":
            details += tuple(self._ranges.find(get_argument(call, 2, "descriptor"), call.lineno))
        self._add(NameKind.PARAMETER, node, value, details)

    def _read_parameters(self, namespace: ast.expr | None, parameters: ast.expr | None) -> None:
        items = None if parameters is None else self._python.resolved(parameters)
        prefix = self._python.text(namespace)
        if not isinstance(items, (ast.List, ast.Tuple)) or prefix is None:
            if parameters is not None:
                self._add_expression(NameKind.PARAMETER, parameters, "")
            return
        for item in items.elts:
            pair = self._python.resolved(item)
            if isinstance(pair, (ast.Tuple, ast.List)) and pair.elts:
                value = pair.elts[1] if len(pair.elts) > 1 else None
                details: tuple[tuple[Detail, str], ...] = ((Detail.DEFAULT, NO),) if value is None else ()
                details += tuple(self._ranges.find(pair.elts[2] if len(pair.elts) > 2 else None, pair.lineno))
                self._add(NameKind.PARAMETER, pair.elts[0], value, details, f"{prefix}." if prefix else "")
            else:
                self._add_expression(NameKind.PARAMETER, item, "")

    def _is_node_constructor(self, call: ast.Call) -> bool:
        """Return whether a call of ``__init__`` is in a subclass of a node."""
        classes = (node for node in ast.walk(self._python.tree) if isinstance(node, ast.ClassDef))
        enclosing = [node for node in classes if node.lineno <= call.lineno <= (node.end_lineno or node.lineno)]
        return bool(enclosing) and any(ast.unparse(base).endswith("Node") for base in enclosing[-1].bases)

    def _read_qos(self, kind: NameKind, node: ast.expr | None) -> tuple[tuple[Detail, str], ...]:
        text = "" if node is None else _format_expression(self._python, self._python.resolved(node))
        if kind in (NameKind.SERVICE, NameKind.CLIENT):
            return read_service_qos(text or None)
        return ((Detail.QOS, text),) if _QOS.fullmatch(text) else ()

    def _add_frame(self, kind: NameKind, node: ast.expr) -> None:
        text = self._python.text(node)
        if text:
            self._names.add(SourceName(kind, text, "", self._python.span(node)))
        parameter = find_parameter_default(self._python, node) if text is None else None
        if parameter is not None:
            self._names.add_default(kind, ast.unparse(node), *parameter)

    def _add(
        self,
        kind: NameKind,
        node: ast.expr | None,
        type_node: ast.expr | None,
        details: tuple[tuple[Detail, str], ...] = (),
        prefix: str = "",
    ) -> None:
        for _ in self._python.iterate(node):
            self._add_one(kind, node, type_node, details, prefix)

    def _add_one(
        self,
        kind: NameKind,
        node: ast.expr | None,
        type_node: ast.expr | None,
        details: tuple[tuple[Detail, str], ...],
        prefix: str,
    ) -> None:
        text, full_type = self._read_name(node), ""
        if kind is NameKind.PARAMETER:
            value = None if type_node is None else self._python.resolved(type_node)
            is_literal = isinstance(value, (ast.Constant, ast.List, ast.UnaryOp))
            type_name = ast.unparse(value) if is_literal and value is not None else ""
        else:
            type_node = None if type_node is None else self._python.find_in_loop(type_node)
            type_name = "" if type_node is None else _format_type(type_node)
            full_type = "" if type_node is None else self._types.find(type_node)
        if node is not None and text is None:
            self._add_expression(kind, node, type_name, full_type)
        elif node is not None and text:
            self._names.add(SourceName(kind, prefix + text, type_name, self._python.span(node), details, full_type))

    def _read_name(self, node: ast.expr | None) -> str | None:
        """Return the name that an expression gives, or None. In ROS 1, one below that of the node is private."""
        match = None if node is None else _PRIVATE_NAME.fullmatch(ast.unparse(node))
        return self._python.text(node) if match is None else f"~{match['name']}"

    def _add_expression(self, kind: NameKind, node: ast.expr, type_name: str, full_type: str = "") -> None:
        text = " ".join(ast.unparse(node).split())
        text = text if '"' in text else text.replace("'", '"')  # reports quote it by '
        self._names.expressions.append(SourceName(kind, text, type_name, self._python.span(node), full_type=full_type))
        texts = self._python.find_texts(node)
        if texts:
            self._names.choices[text] = texts
        parameter = None if kind is NameKind.PARAMETER else find_parameter_default(self._python, node)
        if parameter is not None:
            self._names.add_default(kind, text, *parameter)


def _format_type(node: ast.expr) -> str:
    """Return the name of a type without its package, such as ``String`` or ``Move.Feedback``."""
    text = ast.unparse(node)
    part = _PART_OF_INTERFACE.search(text)
    return part[0] if part is not None else text.rpartition(".")[2]
