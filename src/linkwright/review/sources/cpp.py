"""Read the names in a C++ source for rclcpp and roscpp."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import SourceText, Span
from linkwright.review.sources.conditions import find_cpp_conditions
from linkwright.review.sources.cpp_callbacks import find_message_type, find_service_type
from linkwright.review.sources.cpp_conditions import Conditions
from linkwright.review.sources.cpp_functions import (
    HIDDEN,
    PROTECTED,
    DeclaredFunction,
    read_base_names,
    read_declared_functions,
    read_declared_members,
    read_scopes,
)
from linkwright.review.sources.cpp_handles import Handles, add_namespace
from linkwright.review.sources.cpp_members import find_constructions, read_included_headers
from linkwright.review.sources.cpp_options import find_options
from linkwright.review.sources.cpp_qos import find_assigned_qos
from linkwright.review.sources.details import read_service_qos
from linkwright.review.sources.enumerators import read_enumerations
from linkwright.review.sources.hardware_interfaces import find_hardware_interfaces
from linkwright.review.sources.interface_types import find_cpp_type
from linkwright.review.sources.name_patterns import find_format
from linkwright.review.sources.names import HEADER_SUFFIXES, YES, Detail, NameKind, SourceName, SourceNames, Timer
from linkwright.review.sources.node_options import Remappings, read_remappings
from linkwright.review.sources.parameter_defaults import find_cpp_parameter_default
from linkwright.review.sources.parameter_helpers import find_helper_calls, is_parameter_name, read_elements
from linkwright.review.sources.registrations import find_registrations
from linkwright.review.sources.shared_constants import read_header_constants

_COMMENT_OR_TEXT = re.compile(r"""//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|(?<!\w)'(?:\\.|[^'\\\n])'""", re.DOTALL)
_KINDS = {
    "create_publisher": NameKind.PUBLISHER,
    "advertise": NameKind.PUBLISHER,
    "advertiseCamera": NameKind.PUBLISHER,
    "create_subscription": NameKind.SUBSCRIPTION,
    "subscribe": NameKind.SUBSCRIPTION,
    "subscribeCamera": NameKind.SUBSCRIPTION,
    "create_service": NameKind.SERVICE,
    "advertiseService": NameKind.SERVICE,
    "create_client": NameKind.CLIENT,
    "serviceClient": NameKind.CLIENT,
    "create_server": NameKind.ACTION,
    "declare_parameter": NameKind.PARAMETER,
    "auto_declare": NameKind.PARAMETER,
    "declare_parameter_if_not_declared": NameKind.PARAMETER,
    "get_parameter_or": NameKind.PARAMETER,
    "param": NameKind.PARAMETER,
    "getParam": NameKind.PARAMETER,
    "getParamCached": NameKind.PARAMETER,
    "lookupTransform": NameKind.FRAME_LOOKUP,
    "waitForTransform": NameKind.FRAME_LOOKUP,
    "canTransform": NameKind.FRAME_LOOKUP,
}
_CALL = re.compile(
    rf"(?P<scope>\brclcpp_action::|\bros::param::|[.>]\s*|\b)(?P<name>{'|'.join(_KINDS)}|(?<=ros::param::)get)"
    r"\s*(?=[<(])"
)
_ROS1_CALLS = frozenset(
    {
        *("advertise", "advertiseCamera", "advertiseService", "subscribe", "subscribeCamera", "serviceClient"),
        *("param", "getParam", "getParamCached", "get", "lookupTransform", "waitForTransform", "canTransform"),
    }
)
"""The methods whose names also occur in other libraries, so that only literal names count."""
_COMMUNICATION_KINDS = (NameKind.PUBLISHER, NameKind.SUBSCRIPTION, NameKind.SERVICE, NameKind.CLIENT)
_GRAPH_KINDS = frozenset({*_COMMUNICATION_KINDS, NameKind.ACTION, NameKind.ACTION_CLIENT})
"""The kinds of names that remappings change."""
_DECLARED_KINDS = (NameKind.CLASS, NameKind.FUNCTION, NameKind.MEMBER)
"""The kinds of names that a header declares, perhaps several times under different conditions."""
_FREE_INDEX = {"create_publisher": 1, "create_subscription": 1, "create_service": 2, "create_client": 3}
"""The index of the name in the free functions of rclcpp, behind the interfaces of the node."""
_SERVICE_QOS_INDEX = {"create_service": 1, "create_client": 0}
"""The index of the QoS behind the name of a service."""
_CLIENT_LIBRARY = "rclcpp::"
_NODE_FIRST_CALLS = frozenset({"declare_parameter_if_not_declared"})
_DEFAULT_INDEX = {"param": 2, "get_parameter_or": 2, "declare_parameter_if_not_declared": 2}
_PARAM_ARGUMENTS = 3
"""The number of arguments of ``param`` of ROS 1, which also has the variable for the value."""
_MEMBER_CALLBACK = re.compile(r",\s*&\s*\w+::\w+\s*,\s*this\b")
_OUTPUT_CALLS = frozenset({"getParam", "getParamCached", "get"})
_ROS2_PARAMETER_CALLS = frozenset({"declare_parameter", "auto_declare", "declare_parameter_if_not_declared"})
_NODE = re.compile(
    r"(?::\s*|,\s*)(?:rclcpp(?:_lifecycle)?::)?(?:Lifecycle)?Node\s*(?:\(|\{(?=\s*\"))|"
    r"\brclcpp(?:_lifecycle)?::(?:Lifecycle)?Node::make_shared\s*\(|"
    r"\bmake_shared<\s*rclcpp(?:_lifecycle)?::(?:Lifecycle)?Node\s*>\s*\("
)
_INIT = re.compile(r"\bros::init\s*\(")
_FRAME = re.compile(r"\b(?P<child>child_)?frame_id_?\s*=(?!=)\s*(?P<value>[^;\n]+);")
_RECONFIGURATION = re.compile(r"\bdynamic_reconfigure\s*::\s*Server\s*<\s*(?:\w+\s*::\s*)*(?P<name>\w+)\s*>")
_POINTER = re.compile(r"&\s*(?:\w+::)*?((?:\w+::)\w+)(?!::|\w)")
_STAMPED = re.compile(r"\bStampedTransform\s*(?:\w+\s*)?\(")
_RATE = re.compile(
    r"\b(?P<name>(?:ros::|rclcpp::)(?:Rate|WallRate)(?:\s+\w+)?|create_(?:wall_)?timer|createTimer)\s*\("
)
_NAMESPACE = re.compile(r"^[ \t]*(?:inline\s+)?namespace\s+(?P<name>[A-Za-z_]\w*(?:\s*::\s*\w+)*)\s*\{", re.MULTILINE)
_ALIAS = re.compile(
    r"\btypedef\s+(?P<type>[^;{}]+[\s>*&])(?P<name>\w+)\s*;|\busing\s+(?P<using>\w+)\s*=\s*(?P<used>[^;{}]+);"
)
_CLASS = re.compile(
    r"^[ \t]*(?:class|struct|enum(?:\s+class)?)\s+(?:[A-Z]\w*_(?:PUBLIC|EXPORT|API|DECL)(?:_TYPE)?\s+)?"
    r"(?P<name>[A-Za-z_]\w*)\s*(?:final\s*)?(?::(?!:)(?P<bases>[^;{]*))?\{",
    re.MULTILINE,
)
_TEXT = re.compile(r'\s*(?:(?:std::)?string\s*\(\s*)?"(?P<text>[^"\\]*)"\s*\)?\s*')
_VARIABLE = re.compile(r"\s*(?:\w+::)*(?P<name>\w+)\s*(?:\.c_str\(\))?\s*")
_CONSTANT = re.compile(
    r"(?:\b(?:string|char|auto|string_view)\b[\s*&const]*\b(?P<name>\w+)\s*(?:\[\s*\])?\s*(?:=|(?P<open>[({]))"
    r'\s*(?P<made>(?:std::)?string\s*\(\s*)?"(?P<text>[^"\\]*)"(?(made)\s*\))(?(open)\s*[)}])\s*;)'
    r'|#\s*define\s+(?P<macro>\w+)[ \t]+\(?"(?P<value>[^"\\]*)"'
)
_LITERAL = re.compile(r'\s*(-?[\d.]+(?:e-?\d+)?f?|true|false|"[^"\\]*"|(?:std::)?string\((?P<text>"[^"\\]*")\))\s*')
_WRAPPED = re.compile(r"\s*(?:rclcpp::)?ParameterValue\s*\((?P<value>.*)\)\s*", re.DOTALL)
_QOS = re.compile(r"\d+|[\w:]*QoS\w*\s*[({].*|rmw_qos_profile_\w+|(?:rclcpp::)?(?:\w+::)?\w*QoS\w*", re.DOTALL)
_BRACKETS = {"(": ")", "<": ">", "[": "]", "{": "}"}


def read_cpp(source: SourceText, names: SourceNames) -> None:
    """Add the names in a C++ source."""
    reader = _Reader(source, names)
    reader.read()


class _Reader:
    """Reads the names in a C++ source.

    Args:
        source: the text of the source.
        names: the collection to which the names are added.
    """

    def __init__(self, source: SourceText, names: SourceNames) -> None:
        self._source = source
        self._names = names
        self._text = _COMMENT_OR_TEXT.sub(_blank_comment, source.text)
        self._conditions = Conditions(source.text)
        self._constants = _find_constants(self._text)

    def read(self) -> None:
        """Add the names."""
        text = self._text
        for match in _CALL.finditer(text):
            self._read_call(match)
        for pattern, kind, index in ((_NODE, NameKind.NODE, 0), (_INIT, NameKind.NODE, 2)):
            for match in pattern.finditer(text):
                self._names.makes_node = True
                self._add_argument(kind, match.end() - 1, index)
        for match in _FRAME.finditer(text):
            kind = NameKind.FRAME if match["child"] else NameKind.MESSAGE_FRAME
            self._add_frame(kind, match.start("value"), match.end("value"))
        for match in _STAMPED.finditer(text):
            for index in (2, 3):
                self._add_argument(NameKind.FRAME, match.end() - 1, index)
        self._read_members()
        elements = list(read_elements(text))
        self._read_helper_calls({element.start for element in elements})
        for element in elements:
            end = element.start + len(element.name)
            self._add(NameKind.ELEMENT, element.name, element.start, end, element.default)
        for interface in find_hardware_interfaces(text):
            self._add(interface.kind, interface.name, interface.start, interface.end)
        for option in find_options(text, _find_arguments):
            self._add(NameKind.OPTION, option.name, option.start, option.end, option.default, option.details)
        for match in _RATE.finditer(text):
            self._read_rate(match)
        for match in _RECONFIGURATION.finditer(text):
            self._add(NameKind.RECONFIGURATION, match["name"], match.start("name"), match.end("name"))
        for item in find_registrations(text):
            self._add(item.kind, item.name, item.start, item.end)
        self._read_classes()
        self._read_functions()
        self._names.conditional_lines += find_cpp_conditions(text)
        self._names.is_program = re.search(r"\bint\s+main\s*\(", text) is not None

    def _read_classes(self) -> None:
        """Add the classes and enumerations.

        Other packages cannot use those that a class hides.
        """
        scopes = {end: classes for classes, end in read_scopes(self._text, HIDDEN)}
        protected = {end for _, end in read_scopes(self._text, PROTECTED)}
        for match in _CLASS.finditer(self._text):
            end = match.end() - 1
            if end not in scopes:
                self._names.bases.setdefault(match["name"], []).extend(read_base_names(match["bases"] or ""))
                self._add(NameKind.CLASS, match["name"], match.start("name"), match.end("name"))
                continue
            self._names.hidden_classes.add(match["name"])
            if end in protected:
                span = self._make_span(match.start("name"), match.end("name"))
                name = "::".join([*scopes[end], match["name"]])
                self._names.protected.append(SourceName(NameKind.CLASS, name, "", span))

    def _read_functions(self) -> None:
        """Add the functions and members of a header.

        The type of a function is the list of parameters of each overload.
        """
        if PurePosixPath(self._source.name).suffix not in HEADER_SUFFIXES:
            return
        for match in _ALIAS.finditer(self._text):
            type_name = re.sub(r"\s*([*&<>,:()])\s*", r"\1", " ".join((match["type"] or match["used"]).split()))
            self._names.aliases[match["name"] or match["using"]] = type_name
        for match in _NAMESPACE.finditer(self._text):
            self._names.namespaces.setdefault(match["name"], self._make_span(match.start("name"), match.end("name")))
        for enumeration, enumerators in read_enumerations(self._text).items():
            self._names.enumerations[enumeration] = {
                name: (item.value, self._make_span(item.start, item.start + len(name)))
                for name, item in enumerators.items()
            }
        overloads: dict[str, list[DeclaredFunction]] = {}
        for function in read_declared_functions(self._text):
            if function.is_override:
                self._names.overrides.add(function.name)
            else:
                overloads.setdefault(function.name, []).append(function)
        for name, functions in overloads.items():
            types = _join_overloads(functions)
            details = ((Detail.REQUIRED, YES),) if any(function.is_pure for function in functions) else ()
            if len(functions) == 1 and functions[0].result:
                details = (*details, (Detail.RESULT, functions[0].result))
            start = self._text.find(name.rpartition("::")[2], functions[0].start)
            self._add(NameKind.FUNCTION, name, start, start + len(name.rpartition("::")[2]), types, details)
        for member in read_declared_members(self._text):
            end = member.start + len(member.name.rpartition("::")[2])
            self._add(NameKind.MEMBER, member.name, member.start, end, member.type)
        non_public = (read_declared_functions(self._text, HIDDEN), read_declared_members(self._text, HIDDEN))
        self._names.non_public = frozenset(item.name for items in non_public for item in items)
        protected: dict[str, list[DeclaredFunction]] = {}
        for function in read_declared_functions(self._text, PROTECTED):
            if not function.is_override:
                protected.setdefault(function.name, []).append(function)
        for name, functions in protected.items():
            short = name.rpartition("::")[2]
            start = max(functions[0].start, self._text.find(short, functions[0].start))
            span = self._make_span(start, start + len(short))
            self._names.protected.append(SourceName(NameKind.FUNCTION, name, _join_overloads(functions), span))
        for member in read_declared_members(self._text, PROTECTED):
            span = self._make_span(member.start, member.start + len(member.name.rpartition("::")[2]))
            self._names.protected.append(SourceName(NameKind.MEMBER, member.name, member.type, span))

    def _read_call(self, match: re.Match[str]) -> None:
        text, function = self._text, match["name"]
        kind = NameKind.PARAMETER if function == "get" else _KINDS[function]
        is_action = match["scope"].startswith("rclcpp_action") or function == "create_server"
        if is_action and kind is NameKind.CLIENT:
            kind = NameKind.ACTION_CLIENT
        start, type_name = match.end(), ""
        if text[start] == "<":
            end = _find_closing_bracket(text, start)
            type_name = " ".join(text[start + 1 : end].split())
            if function == "advertiseService":
                type_name = type_name.partition(",")[0].removesuffix("::Request")
            if kind not in _GRAPH_KINDS:
                type_name = type_name.rpartition("::")[2]
            start = text.find("(", end, end + 20)
        if start < 0 or text[start : start + 1] != "(":
            return
        if function == "param" and not type_name and not match["scope"].strip():
            return  # a different function with the same name
        arguments = list(_find_arguments(text, start))
        if function in _FREE_INDEX and text.startswith(_CLIENT_LIBRARY, match.start("name") - len(_CLIENT_LIBRARY)):
            arguments = arguments[_FREE_INDEX[function] :]
        if kind is NameKind.FRAME_LOOKUP:
            for begin, end in arguments[:2]:
                self._add_frame(kind, begin, end)
            return
        name_arguments = arguments[1:2] if function in _NODE_FIRST_CALLS else arguments[:1]
        if (
            name_arguments
            and kind in _COMMUNICATION_KINDS
            and self._add_format_pattern(kind, type_name, *name_arguments[0])
        ):
            return
        candidates = arguments if is_action else name_arguments
        name_offsets = next(
            ((begin, end) for begin, end in candidates if self._get_literal(begin, end) is not None), None
        )
        if name_offsets is not None:
            namespace, has_known_scope = "", True
            if function in _ROS1_CALLS:
                namespace = self._handles.find_handle_namespace(match.start("name"))
                is_global = match["scope"].startswith("ros::param")
                has_known_scope = is_global or self._handles.has_known_namespace(match.start("name"))
            elif kind is not NameKind.PARAMETER:
                namespace = self._handles.find_sub_namespace(match.start("name"))
            self._add_named_call(kind, function, type_name, arguments, name_offsets, namespace)
            if kind is NameKind.PARAMETER and not has_known_scope:
                self._names.unknown_scopes.add(self._get_literal(*name_offsets) or "")
        elif candidates:
            begin, end = candidates[0] if not is_action else candidates[min(1, len(candidates) - 1)]
            name = " ".join(text[begin:end].split())
            is_ros = self._add_default(kind, name) or function not in _ROS1_CALLS
            if function == "param" and type_name and len(arguments) == _PARAM_ARGUMENTS:
                is_ros, type_name = True, self._find_literal_default(function, arguments)
            elif kind is not NameKind.PARAMETER:
                is_ros = is_ros or bool(type_name) or _MEMBER_CALLBACK.search(text, start, arguments[-1][1]) is not None
                type_name = type_name or self._find_callback_type(kind, arguments)
            if is_ros:
                self._names.expressions.append(self._make_name(kind, name, type_name, begin, end))

    def _add_default(self, kind: NameKind, expression: str) -> bool:
        """Add the name that an expression has by default, and return whether a parameter gives it."""
        is_parameter = kind is NameKind.PARAMETER
        parameter = None if is_parameter else find_cpp_parameter_default(self._text, expression)
        if parameter is not None:
            self._names.add_default(kind, expression, *parameter)
        return parameter is not None

    def _add_frame(self, kind: NameKind, begin: int, end: int) -> None:
        """Add a frame that is a literal, or that a parameter gives."""
        if not self._add_literal(kind, begin, end):
            self._add_default(kind, self._text[begin:end])

    def _add_format_pattern(self, kind: NameKind, type_name: str, begin: int, end: int) -> bool:
        """Add the pattern of a name that ``snprintf`` writes.

        Returns whether there is one.
        """
        variable = _VARIABLE.fullmatch(self._text[begin:end])
        pattern = None if variable is None else find_format(self._text[:begin], variable["name"])
        if pattern is None:
            return False
        self._names.expressions.append(self._make_name(kind, pattern, type_name, begin, end))
        return True

    def _add_named_call(
        self,
        kind: NameKind,
        function: str,
        type_name: str,
        arguments: list[tuple[int, int]],
        name_offsets: tuple[int, int],
        namespace: str,
    ) -> None:
        details: list[tuple[Detail, str]] = []
        other_arguments = [self._text[begin:end].strip() for begin, end in arguments[1:]]
        if kind is NameKind.PARAMETER:
            if type_name:
                details.append((Detail.VALUE_TYPE if function in _ROS2_PARAMETER_CALLS else Detail.READ_AS, type_name))
            type_name = "" if function in _OUTPUT_CALLS else self._find_literal_default(function, arguments)
        elif kind in (NameKind.PUBLISHER, NameKind.SUBSCRIPTION) and other_arguments:
            qos = find_assigned_qos(self._text, other_arguments[0], arguments[0][0]) or other_arguments[0]
            if _QOS.fullmatch(qos):
                details.append((Detail.QUEUE if function in _ROS1_CALLS else Detail.QOS, " ".join(qos.split())))
        if function in _SERVICE_QOS_INDEX and kind is not NameKind.ACTION_CLIENT:
            index = _SERVICE_QOS_INDEX[function]
            details += read_service_qos(
                " ".join(other_arguments[index].split()) if index < len(other_arguments) else None
            )
        if kind is NameKind.PUBLISHER and function in _ROS1_CALLS and other_arguments[-1:] == ["true"]:
            details.append((Detail.LATCH, YES))
        if not type_name:
            type_name = self._find_callback_type(kind, arguments)
        name = add_namespace(namespace, self._get_literal(*name_offsets) or "")
        self._add(kind, name, *name_offsets, type_name, tuple(details))
        if kind in (NameKind.SUBSCRIPTION, NameKind.SERVICE, NameKind.ACTION):
            self._add_callback(kind, name, arguments)

    def _add_callback(self, kind: NameKind | None, name: str, arguments: list[tuple[int, int]]) -> None:
        """Add the member function that messages, requests, goals or a timer call.

        Calls with several functions among their arguments are left out.
        """
        functions = self._find_pointers(arguments)
        if len(functions) == 1:
            self._names.callbacks.setdefault(functions.pop(), (kind, name))

    def _find_pointers(self, arguments: list[tuple[int, int]]) -> set[str]:
        """Return the member functions whose addresses are among the arguments, qualified by their classes."""
        return set(_POINTER.findall(self._text[arguments[0][0] : arguments[-1][1]]))

    def _find_callback_type(self, kind: NameKind, arguments: list[tuple[int, int]]) -> str:
        """Return the type of the messages or requests that the only callback among the arguments takes.

        It is empty if it is unknown, and for other kinds than subscriptions and services.
        """
        find_type = {NameKind.SUBSCRIPTION: find_message_type, NameKind.SERVICE: find_service_type}.get(kind)
        first = 2 if kind is NameKind.SUBSCRIPTION else 1
        functions = {name.rpartition("::")[2] for name in self._find_pointers(arguments)}
        words = (self._text[begin:end].strip().lstrip("&") for begin, end in arguments[first : first + 1])
        functions = functions or {word for word in words if word.isidentifier()}
        if find_type is None or len(functions) != 1:
            return ""
        return find_type(functions.pop(), [self._text, *self._headers])

    @cached_property
    def _headers(self) -> list[str]:
        """The headers that may declare members of the classes of the source, without comments."""
        return [_COMMENT_OR_TEXT.sub(_blank_comment, text) for text in read_included_headers(Path(self._source.name))]

    @cached_property
    def _remappings(self) -> Remappings:
        """The remappings that the source passes to its node."""
        return read_remappings(self._text)

    @cached_property
    def _handles(self) -> Handles:
        """The node handles and sub-nodes. A header may declare the handles of a class."""
        return Handles(self._text, self._headers if "::" in self._text else [])

    def _find_literal_default(self, function: str, arguments: list[tuple[int, int]]) -> str:
        """Return the literal default of a parameter; empty if there is none.

        Functions that return the value have the default as their second argument.
        """
        index = _DEFAULT_INDEX.get(function, 1)
        index = index if index < len(arguments) else 1
        if index >= len(arguments):
            return ""
        text = self._text[slice(*arguments[index])]
        wrapped = _WRAPPED.fullmatch(text)
        value = _LITERAL.fullmatch(wrapped["value"] if wrapped else text)
        if value is not None:
            return value["text"] or value[1]
        variable = _VARIABLE.fullmatch(text)
        constant = self._constants.get(variable["name"]) if variable else None
        return "" if constant is None else f'"{constant}"'

    def _read_members(self) -> None:
        """Add the topics and actions with which members and variables are constructed."""
        for member in find_constructions(self._text, self._headers):
            for begin, end in list(_find_arguments(self._text, member.start))[:3]:
                if self._add_literal(member.kind, begin, end, member.type):
                    break

    def _read_helper_calls(self, element_starts: Collection[int]) -> None:
        """Add the parameters that functions of the repository read.

        The name is one of the first two arguments. Elements of SDF at the given offsets are left out.
        """
        for call in find_helper_calls(self._text):
            if call.function in _KINDS:
                continue
            kind = NameKind.ELEMENT if call.is_of_plugin else NameKind.PARAMETER
            arguments = list(_find_arguments(self._text, call.start))
            for index, (begin, end) in enumerate(arguments[:2]):
                literal = _TEXT.fullmatch(self._text[begin:end])
                is_element = literal is not None and begin + literal.start("text") in element_starts
                if literal is not None and not is_element and is_parameter_name(literal["text"]):
                    values = (_LITERAL.fullmatch(self._text[slice(*argument)]) for argument in arguments[index + 1 :])
                    default = next((value["text"] or value[1] for value in values if value is not None), "")
                    self._add(kind, literal["text"], begin, end, default)
                    self._names.unknown_scopes.add(literal["text"])  # the function has the node handle
                    break

    def _read_rate(self, match: re.Match[str]) -> None:
        arguments = list(_find_arguments(self._text, match.end() - 1))
        is_timer = match["name"] == "create_timer"
        texts = [" ".join(self._text[slice(*argument)].split()) for argument in arguments]
        index = 1 if is_timer and len(texts) > 1 and not re.search(r"\d", texts[0]) else 0
        if index < len(texts):
            name = match["name"].split()[0]
            rate = f"{name}({texts[index]})", self._make_span(*arguments[index])
            self._names.rates.append(rate)
            if "imer" in name:
                functions = self._find_pointers(arguments)
                name = functions.pop().rpartition("::")[2] if len(functions) == 1 else ""
                self._names.timers.append(Timer(name, *rate))
                self._add_callback(None, "", arguments)

    def _get_literal(self, begin: int, end: int) -> str | None:
        """Return the text of a literal or constant, or None for other expressions."""
        literal = _TEXT.fullmatch(self._text[begin:end])
        if literal is not None:
            return literal["text"]
        variable = _VARIABLE.fullmatch(self._text[begin:end])
        if variable is None or variable["name"] in self._constants:
            return None if variable is None else self._constants[variable["name"]]
        return self._shared_constants.get(variable["name"])

    @cached_property
    def _shared_constants(self) -> Mapping[str, str]:
        """The constants of included headers that the source does not define otherwise."""
        constants = read_header_constants(self._headers)
        assigned = set(re.findall(r"\b(\w+)\s*(?:\[[^\]]*\]\s*)?(?:=(?!=)|[{(]\s*\")", self._text))
        return {name: text for name, text in constants.items() if name not in assigned}

    def _add_argument(self, kind: NameKind, start: int, index: int) -> None:
        arguments = list(_find_arguments(self._text, start))
        if index < len(arguments):
            self._add_literal(kind, *arguments[index])

    def _add_literal(self, kind: NameKind, begin: int, end: int, type_name: str = "") -> bool:
        """Add the name in an argument if it is a literal, and return whether it is."""
        text = self._get_literal(begin, end)
        if text:
            self._add(kind, text, begin, end, type_name)
        return bool(text)

    def _add(
        self,
        kind: NameKind,
        name: str,
        begin: int,
        end: int,
        type_name: str = "",
        details: tuple[tuple[Detail, str], ...] = (),
    ) -> None:
        literal = _TEXT.fullmatch(self._text[begin:end])
        if literal is not None:
            begin, end = begin + literal.start("text"), begin + literal.end("text")
        if kind is NameKind.NODE:
            name = self._remappings.node or name
        elif kind in _GRAPH_KINDS:
            name = self._remappings.resolve(name)
        if name:
            self._names.add(self._make_name(kind, name, type_name, begin, end, details))

    def _make_name(
        self,
        kind: NameKind,
        name: str,
        type_name: str,
        begin: int,
        end: int,
        details: tuple[tuple[Detail, str], ...] = (),
    ) -> SourceName:
        """Return a name. Types of messages, services and actions are as written."""
        full_type = ""
        if kind in _GRAPH_KINDS and type_name:
            full_type = find_cpp_type(type_name, [self._text, *self._headers])
            type_name = type_name.rpartition("::")[2]
        condition = "" if kind in _DECLARED_KINDS else self._conditions.find(begin)
        if condition:
            details = (*details, (Detail.CONDITION, condition))
        return SourceName(kind, name, type_name, self._make_span(begin, end), details, full_type)

    def _make_span(self, begin: int, end: int) -> Span:
        while begin < end and self._text[begin].isspace():
            begin += 1
        return self._source.span(begin, max(end, begin + 1))


def _join_overloads(functions: Sequence[DeclaredFunction]) -> str:
    """Return the parameters of each overload of a function."""
    return "; ".join(sorted(", ".join(function.parameters) for function in functions))


def _find_constants(text: str) -> Mapping[str, str]:
    """Return the texts of constants and of variables assigned once, by name."""
    constants: dict[str, str] = {}
    for match in _CONSTANT.finditer(text):
        name = match["name"] or match["macro"]
        assignment_count = len(re.findall(rf"\b{name}\b\s*(?:\[\s*\])?\s*=(?!=)", text))
        output = rf"\b(?:\w*[pP]aram\w*|get\w*)\s*(?:<[^<>]*>)?\([^;()]*\b{name}\b"
        is_output = match["macro"] is None and re.search(output, text) is not None
        if assignment_count <= 1 and not is_output and name not in constants:
            constants[name] = match["text"] if match["macro"] is None else match["value"]
    return constants


def _blank_comment(match: re.Match[str]) -> str:
    """Return a string unchanged, or spaces for a comment or character literal."""
    return match[0] if match[0].startswith('"') else re.sub(r"[^\n]", " ", match[0])


def _find_closing_bracket(text: str, start: int) -> int:
    """Return the offset of the matching closing bracket, or the end of the text."""
    depth, opening = 0, text[start]
    for index in range(start, len(text)):
        depth += (text[index] == opening) - (text[index] == _BRACKETS[opening])
        if depth == 0:
            return index
    return len(text)


def _find_arguments(text: str, start: int) -> Iterator[tuple[int, int]]:
    """Yield the offsets of the arguments in the parentheses that begin at an offset."""
    depth, begin, is_text = 0, start + 1, False
    for index in range(start + 1, len(text)):
        character = text[index]
        if character == '"' and text[index - 1] != "\\":
            is_text = not is_text
        if is_text:
            continue
        if depth == 0 and character in ",)":
            if text[begin:index].strip():
                yield begin, index
            if character == ")":
                return
            begin = index + 1
        depth += (character in "([{") - (character in ")]}")
