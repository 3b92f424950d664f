"""Read the names in a C++ source for rclcpp and roscpp."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from functools import cached_property
from pathlib import Path

from linkwright.diagnostics import SourceText, Span
from linkwright.review.sources.conditions import find_cpp_conditions
from linkwright.review.sources.cpp.base_classes import find_base_sources, read_code
from linkwright.review.sources.cpp.callbacks import find_message_type, find_service_type
from linkwright.review.sources.cpp.callers import CallerNames
from linkwright.review.sources.cpp.calls import (
    COMMUNICATION_KINDS,
    GRAPH_KINDS,
    KINDS,
    ROS1_CALLS,
    Call,
    find_calls,
)
from linkwright.review.sources.cpp.declared_groups import find_declared_groups
from linkwright.review.sources.cpp.helper_nodes import is_helper_node
from linkwright.review.sources.cpp.lifecycle import LifecycleCallbacks
from linkwright.review.sources.cpp.members import Construction, find_constructions, read_included_headers
from linkwright.review.sources.cpp.node_handles import Handles, add_namespace
from linkwright.review.sources.cpp.node_options import Remappings, read_remappings
from linkwright.review.sources.cpp.options import find_options
from linkwright.review.sources.cpp.parameter_calls import (
    ParameterDefaults,
    find_table_names,
    find_type_of_default,
    is_required_parameter,
)
from linkwright.review.sources.cpp.parameter_ranges import find_range
from linkwright.review.sources.cpp.preprocessor import Conditions
from linkwright.review.sources.cpp.qos import find_assigned_qos
from linkwright.review.sources.cpp.text import blank_comments, find_arguments
from linkwright.review.sources.cpp.timers import FoundRate, find_rates
from linkwright.review.sources.cpp.values import (
    TEXT,
    VARIABLE,
    InitialValues,
    parse_literal,
)
from linkwright.review.sources.cpp.variable_types import VariableTypes
from linkwright.review.sources.cpp.yaml_keys import find_yaml_keys
from linkwright.review.sources.cpp_constant_texts import ConstantTexts
from linkwright.review.sources.cpp_declarations import read_declarations
from linkwright.review.sources.details import read_service_qos
from linkwright.review.sources.gazebo_topics import find_gazebo_topics
from linkwright.review.sources.hardware_interfaces import find_hardware_interfaces
from linkwright.review.sources.hardware_parameters import find_hardware_parameters
from linkwright.review.sources.interface_types import find_cpp_type
from linkwright.review.sources.name_patterns import extract_pattern, find_format
from linkwright.review.sources.names import NO, YES, Detail, NameKind, SourceName, SourceNames, Timer
from linkwright.review.sources.parameter_defaults import find_cpp_parameter_default
from linkwright.review.sources.parameter_helpers import (
    find_helper_calls,
    is_known_to_be_set,
    is_parameter_name,
    read_elements,
)
from linkwright.review.sources.registrations import find_registrations

_DECLARED_KINDS = (NameKind.CLASS, NameKind.FUNCTION, NameKind.MEMBER)
"""The kinds of names that a header declares, perhaps several times under different conditions."""
_SERVICE_QOS_INDEX = {"create_service": 1, "create_client": 0}
"""The index of the QoS behind the name of a service."""
_PARAM_ARGUMENTS = 3
"""The number of arguments of ``param`` of ROS 1, which also has the variable for the value."""
_NODE_HANDLE = "NodeHandle"
_MEMBER_CALLBACK = re.compile(r",\s*&\s*\w+::\w+\s*,\s*this\b")
_OUTPUT_CALLS = frozenset({"getParam", "getParamCached", "get"})
_ROS2_PARAMETER_CALLS = frozenset({"declare_parameter", "auto_declare", "declare_parameter_if_not_declared"})
_NODE = re.compile(
    r"(?::\s*|,\s*)(?:rclcpp(?:_lifecycle)?::)?(?:Lifecycle)?Node\s*[({]|"
    r"\brclcpp(?:_lifecycle)?::(?:Lifecycle)?Node::make_shared\s*\(|"
    r"\bmake_shared<\s*rclcpp(?:_lifecycle)?::(?:Lifecycle)?Node\s*>\s*\("
)
_BASE_CALL = re.compile(r"(?<=[:,])\s*(?:\w+::)*(?P<base>\w+)\s*(?=[({]\s*\")")
"""The construction of a base class with a text in the initializer list of a constructor."""
_NODE_CLASS = re.compile(
    r"\bclass\s+(?:[A-Z]\w*_\w+\s+)?(?P<name>\w+)\s*(?:final\s*)?:[^;{}]*\b(?:Lifecycle)?Node\b[^;{}]*\{"
)
_INIT = re.compile(r"\bros::init\s*\(")
_FRAME = re.compile(r"\b(?P<child>child_)?frame_id_?\s*=(?!=)\s*(?P<value>[^;\n]+);")
_RECONFIGURATION = re.compile(r"\bdynamic_reconfigure\s*::\s*Server\s*<\s*(?:\w+\s*::\s*)*(?P<name>\w+)\s*>")
_POINTER = re.compile(r"&\s*(?:\w+::)*?((?:\w+::)\w+)(?!::|\w)")
_STAMPED = re.compile(r"\bStampedTransform\s*(?:\w+\s*)?\(")
_QOS = re.compile(r"\d+|[\w:]*QoS\w*\s*[({].*|rmw_qos_profile_\w+|(?:rclcpp::)?(?:\w+::)?\w*QoS\w*", re.DOTALL)


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
        self._text = blank_comments(source.text)
        self._conditions = Conditions(source.text)

    def read(self) -> None:
        """Add the names."""
        text = self._text
        for call in find_calls(text):
            self._read_call(call)
        for use in self._caller_names.find_uses():
            name, offsets = use.name or self._texts.evaluate(use.begin, use.end), (use.begin, use.end)
            if name:
                self._add_named_call(use.call, name, offsets, use.arguments)
            else:
                self._add_computed_call(use.call, offsets, use.arguments)
        for pattern, kind, index in ((_NODE, NameKind.NODE, 0), (_INIT, NameKind.NODE, 2)):
            for match in pattern.finditer(text):
                self._names.makes_node = True
                known = len(self._names.names)
                self._add_argument(kind, match.end() - 1, index)
                if is_helper_node(text, match.start()):
                    self._names.helper_nodes.update(item.name for item in self._names.names[known:])
        for match in _BASE_CALL.finditer(text):
            if match["base"] in self._node_bases:
                self._names.makes_node = True
                self._add_argument(NameKind.NODE, match.end(), 0)
        for match in _FRAME.finditer(text):
            kind = NameKind.FRAME if match["child"] else NameKind.MESSAGE_FRAME
            self._add_frame(kind, match.start("value"), match.end("value"))
        for match in _STAMPED.finditer(text):
            for index in (2, 3):
                self._add_argument(NameKind.FRAME, match.end() - 1, index)
        self._read_members()
        elements = list(read_elements(text))
        hardware_parameters = list(find_hardware_parameters(text))
        self._read_helper_calls({item.start for item in elements} | {item.start for item in hardware_parameters})
        for element in elements:
            end = element.start + len(element.name)
            self._add(NameKind.ELEMENT, element.name, element.start, end, element.default)
        for topic in find_gazebo_topics(text, self._headers, self._texts.evaluate):
            self._add(topic.kind, topic.name, topic.begin, topic.end, topic.type)
        interfaces = find_hardware_interfaces(text, self._texts.evaluate)
        for found in (*interfaces, *hardware_parameters, *find_yaml_keys(text, self._headers)):
            details = ((Detail.REQUIRED, YES),) if found.is_required else ()
            default = parse_literal(found.variable) or self._initial_values.find_default(found.variable, found.start)
            self._add(found.kind, found.name, found.start, found.end, default or "", details)
        for declared in find_declared_groups(text):
            details = ((Detail.VALUE_TYPE, declared.type),) if declared.type else ()
            self._add(NameKind.PARAMETER, declared.name, declared.start, declared.end, declared.default, details)
        for option in find_options(text, find_arguments):
            self._add(NameKind.OPTION, option.name, option.start, option.end, option.default, option.details)
        for rate in find_rates(text):
            self._read_rate(rate)
        for match in _RECONFIGURATION.finditer(text):
            self._add(NameKind.RECONFIGURATION, match["name"], match.start("name"), match.end("name"))
        registrations = list(find_registrations(text))
        for item in registrations:
            bases = sorted({other.base for other in registrations if other[:2] == item[:2] and other.base})
            details = ((Detail.BASES, ", ".join(bases)),) if bases else ()
            self._add(item.kind, item.name, item.start, item.end, details=details)
        read_declarations(self._source, text, self._names, self._add, self._make_span)
        self._names.conditional_lines += find_cpp_conditions(text)
        self._names.is_program = re.search(r"\bint\s+main\s*\(", text) is not None

    def _read_call(self, call: Call) -> None:
        text, kind = self._text, call.kind
        if kind is NameKind.FRAME_LOOKUP:
            for begin, end in call.arguments[:2]:
                self._add_frame(kind, begin, end)
            return
        candidates = call.arguments if call.is_action else call.arguments[:1]
        if not candidates or (
            kind in COMMUNICATION_KINDS and self._add_format_pattern(kind, call.type, *candidates[0])
        ):
            return
        offsets = next(
            ((begin, end) for begin, end in candidates if self._texts.evaluate(begin, end) is not None), None
        )
        if offsets is not None:
            texts = [text[begin:end].strip() for begin, end in call.arguments[1:]]
            self._add_named_call(call, self._texts.evaluate(*offsets) or "", offsets, texts)
            return
        begin, end = candidates[0] if not call.is_action else candidates[min(1, len(candidates) - 1)]
        if call.start in self._caller_names.inner_calls:
            return  # the callers give the names
        texts = [text[slice(*argument)].strip() for argument in call.arguments[1:]]
        name = " ".join(text[begin:end].split())
        listed = list(find_table_names(text, name, call.start)) if kind is NameKind.PARAMETER else []
        for item in listed:
            self._add_named_call(call, item.name, (item.start, item.end), texts)
        if not listed:
            self._add_computed_call(call, (begin, end), texts)

    def _add_computed_call(self, call: Call, offsets: tuple[int, int], texts: Sequence[str]) -> None:
        """Add the expression in a call that gives a name.

        Args:
            call: the call.
            offsets: the offsets of the expression.
            texts: the arguments behind it.
        """
        kind, type_name = call.kind, call.type
        name = " ".join(self._text[slice(*offsets)].split())
        name = self._texts.expand(name, offsets[0])
        is_ros = self._add_default(kind, name) or call.function not in ROS1_CALLS
        details: tuple[tuple[Detail, str], ...] = ()
        is_param = call.function == "param" and len(call.arguments) == _PARAM_ARGUMENTS
        if is_param and (type_name or (extract_pattern(name) is not None and _NODE_HANDLE in self._text)):
            is_ros, type_name = True, self._parameter_defaults.find(call, texts)
        elif kind is not NameKind.PARAMETER:
            is_ros = is_ros or bool(type_name) or _MEMBER_CALLBACK.search(", ".join(["", *texts])) is not None
            type_name = type_name or self._find_callback_type(kind, texts)
            details = tuple(self._find_qos(call, texts))
        if is_ros:
            self._names.expressions.append(self._make_name(kind, name, type_name, *offsets, details))

    def _add_default(self, kind: NameKind, expression: str) -> bool:
        """Add the name that an expression has by default, and return whether a parameter gives it."""
        is_parameter = kind is NameKind.PARAMETER
        parameter = None
        if not is_parameter:
            parameter = find_cpp_parameter_default(
                [self._text, *self._base_texts], expression, self._find_known_default
            )
        if parameter is not None:
            self._names.add_default(kind, expression, *parameter)
        return parameter is not None

    def _find_known_default(self, parameter: str) -> str | None:
        """Return the text that a parameter has by default, as a call before tells; None if it is unknown."""
        for item in self._names.of_kind(NameKind.PARAMETER):
            if item.name.lstrip("~/") == parameter.lstrip("~/"):
                literal = TEXT.fullmatch(item.type)
                return None if literal is None else literal["text"]
        return None

    def _add_frame(self, kind: NameKind, begin: int, end: int) -> None:
        """Add a frame that is a literal, or that a parameter gives."""
        if not self._add_literal(kind, begin, end):
            self._add_default(kind, self._text[begin:end])

    def _add_format_pattern(self, kind: NameKind, type_name: str, begin: int, end: int) -> bool:
        """Add the pattern of a name that ``snprintf`` writes.

        Returns whether there is one.
        """
        variable = VARIABLE.fullmatch(self._text[begin:end])
        pattern = None if variable is None else find_format(self._text[:begin], variable["name"])
        if pattern is None:
            return False
        self._names.expressions.append(self._make_name(kind, pattern, type_name, begin, end))
        return True

    def _add_named_call(self, call: Call, name: str, offsets: tuple[int, int], texts: Sequence[str]) -> None:
        """Add the name in a call.

        Args:
            call: the call.
            name: the name that it is given.
            offsets: the offsets of the argument with the name.
            texts: the arguments behind the name.
        """
        kind, type_name = call.kind, call.type
        details: list[tuple[Detail, str]] = []
        namespace, has_known_scope = "", True
        if call.function in ROS1_CALLS:
            namespace, has_known_scope = self._find_scope(call)
        elif kind is not NameKind.PARAMETER:
            namespace = self._handles.find_sub_namespace(call.start)
        if kind is NameKind.PARAMETER:
            if call.function in _ROS2_PARAMETER_CALLS:
                declared = "" if type_name.startswith("decltype") else type_name
                declared = declared or find_type_of_default(self._text, texts)
                declared = declared or self._variable_types.find_passed(offsets[1])
                details += [(Detail.VALUE_TYPE, declared)] if declared else []
                details += [] if texts else [(Detail.DEFAULT, NO)]
                details += find_range(self._text, call.start, texts)
            elif read_type := type_name or self._variable_types.find_passed(offsets[1]):
                details.append((Detail.READ_AS, read_type))
            if is_required_parameter(self._text, call, texts):
                details.append((Detail.REQUIRED, YES))
            elif call.function in _OUTPUT_CALLS and texts and self._initial_values.is_undefined(texts[0], call.start):
                details.append((Detail.UNDEFINED, YES))
            is_output = call.function in _OUTPUT_CALLS or is_known_to_be_set(self._text, name, call.start)
            type_name = (
                self._parameter_defaults.find_kept(call, texts)
                if is_output
                else self._parameter_defaults.find(call, texts)
            )
        else:
            details += self._find_qos(call, texts)
        callback = self._lifecycle.find(offsets[0])
        if kind in GRAPH_KINDS and callback:
            details.append((Detail.CREATED_IN, callback))
        if kind is NameKind.PUBLISHER and call.function in ROS1_CALLS and list(texts[-1:]) == ["true"]:
            details.append((Detail.LATCH, YES))
        if not type_name:
            type_name = self._find_callback_type(kind, texts)
        if not has_known_scope:
            self._names.unknown_scopes.add(name)
        name = add_namespace(namespace, name)
        self._add(kind, name, *offsets, type_name, tuple(details))
        if kind in (NameKind.SUBSCRIPTION, NameKind.SERVICE, NameKind.ACTION):
            self._add_callback(kind, name, texts)

    def _find_scope(self, call: Call) -> tuple[str, bool]:
        """Return the namespace of a name of ROS 1, and whether it is known if the name is of a parameter."""
        if call.node:
            return self._handles.get_namespace(call.node), False
        is_known = call.kind is not NameKind.PARAMETER or call.scope.startswith("ros::param")
        namespace = self._handles.find_handle_namespace(call.start)
        return namespace, is_known or self._handles.has_known_namespace(call.start)

    def _find_qos(self, call: Call, texts: Sequence[str]) -> Iterator[tuple[Detail, str]]:
        """Yield the QoS or the length of the queue of a topic or service."""
        if call.kind in (NameKind.PUBLISHER, NameKind.SUBSCRIPTION) and texts:
            qos = find_assigned_qos(self._text, texts[0], call.start) or texts[0]
            if _QOS.fullmatch(qos):
                yield Detail.QUEUE if call.function in ROS1_CALLS else Detail.QOS, " ".join(qos.split())
        if call.function in _SERVICE_QOS_INDEX and call.kind is not NameKind.ACTION_CLIENT:
            index = _SERVICE_QOS_INDEX[call.function]
            yield from read_service_qos(" ".join(texts[index].split()) if index < len(texts) else None)

    @cached_property
    def _caller_names(self) -> CallerNames:
        return CallerNames(self._source, self._text, self._headers)

    def _add_callback(self, kind: NameKind | None, name: str, texts: Sequence[str]) -> None:
        """Add the member function that messages, requests, goals or a timer call.

        Calls with several functions among their arguments are left out.
        """
        functions = _find_pointers(texts)
        if len(functions) == 1:
            self._names.callbacks.setdefault(functions.pop(), (kind, name))

    def _find_callback_type(self, kind: NameKind, texts: Sequence[str]) -> str:
        """Return the type of the messages or requests that the only callback among the arguments takes.

        It is empty if it is unknown, and for other kinds than subscriptions and services.
        """
        find_type = {NameKind.SUBSCRIPTION: find_message_type, NameKind.SERVICE: find_service_type}.get(kind)
        first = 1 if kind is NameKind.SUBSCRIPTION else 0
        functions = {name.rpartition("::")[2] for name in _find_pointers(texts)}
        words = (text.lstrip("&") for text in texts[first : first + 1])
        functions = functions or {word for word in words if word.isidentifier()}
        if find_type is None or len(functions) != 1:
            return ""
        return find_type(functions.pop(), [self._text, *self._headers])

    @cached_property
    def _headers(self) -> list[str]:
        """The headers that may declare members of the classes of the source, without comments."""
        return [blank_comments(text) for text in read_included_headers(Path(self._source.name))]

    @cached_property
    def _base_texts(self) -> Sequence[str]:
        """The headers and sources of the base classes of the repository, without comments."""
        return [read_code(path) for path in find_base_sources(Path(self._source.name))]

    @cached_property
    def _node_bases(self) -> Collection[str]:
        """The classes of included headers that derive from a node, to which derived classes give its name."""
        return {match["name"] for text in self._headers for match in _NODE_CLASS.finditer(text)}

    @cached_property
    def _lifecycle(self) -> LifecycleCallbacks:
        return LifecycleCallbacks(self._text)

    @cached_property
    def _remappings(self) -> Remappings:
        """The remappings that the source passes to its node."""
        return read_remappings(self._text)

    @cached_property
    def _handles(self) -> Handles:
        """The node handles and sub-nodes. A header may declare the handles of a class."""
        return Handles(self._text, self._headers if "::" in self._text else [])

    @cached_property
    def _parameter_defaults(self) -> ParameterDefaults:
        return ParameterDefaults(self._text, self._texts.own, self._initial_values)

    def _read_members(self) -> None:
        """Add the topics and actions with which members and variables are constructed."""
        for member in find_constructions(self._text, self._headers):
            arguments = list(find_arguments(self._text, member.start))[:3]
            for begin, end in arguments:
                if self._add_literal(member.kind, begin, end, member.type):
                    break
            else:
                self._add_given_member(member, arguments)

    def _add_given_member(self, member: Construction, arguments: Sequence[tuple[int, int]]) -> None:
        """Add the expression with which a member is constructed, if a parameter gives a name to it."""
        for begin, end in arguments:
            expression = " ".join(self._text[begin:end].split())
            if self._add_default(member.kind, expression):
                self._names.expressions.append(self._make_name(member.kind, expression, member.type, begin, end))
                return

    def _read_helper_calls(self, known_starts: Collection[int]) -> None:
        """Add the parameters that functions of the repository read.

        The name is one of the first two arguments. Names at the given offsets are left out.
        """
        own = self._caller_names.helper_names
        for call in find_helper_calls(self._text):
            if call.function in KINDS or call.function in own:
                continue
            kind = NameKind.ELEMENT if call.is_of_plugin else NameKind.PARAMETER
            arguments = list(find_arguments(self._text, call.start))
            for index, (begin, end) in enumerate(arguments[:2]):
                literal = TEXT.fullmatch(self._text[begin:end])
                is_known = literal is not None and begin + literal.start("text") in known_starts
                if literal is not None and not is_known and is_parameter_name(literal["text"]):
                    values = (parse_literal(self._text[slice(*argument)]) for argument in arguments[index + 1 :])
                    default = next((value for value in values if value is not None), "")
                    read_type = self._variable_types.find_passed(end) if kind is NameKind.PARAMETER else ""
                    details = ((Detail.READ_AS, read_type),) if read_type else ()
                    self._add(kind, literal["text"], begin, end, default, details)
                    self._names.unknown_scopes.add(literal["text"])  # the function has the node handle
                    break

    def _read_rate(self, rate: FoundRate) -> None:
        text, span = rate.text, self._make_span(rate.begin, rate.end)
        self._names.rates.append((text, span))
        if rate.is_timer:
            functions = _find_pointers(rate.arguments)
            callback = functions.pop().rpartition("::")[2] if len(functions) == 1 else ""
            self._names.timers.append(Timer(callback, text, span, rate.clock))
            self._add_callback(None, "", rate.arguments)

    @cached_property
    def _texts(self) -> ConstantTexts:
        path = Path(self._source.name)
        return ConstantTexts(path, self._text, self._headers, self._initial_values, lambda: self._base_texts)

    @cached_property
    def _initial_values(self) -> InitialValues:
        return InitialValues(self._text, self._headers)

    @cached_property
    def _variable_types(self) -> VariableTypes:
        return VariableTypes(Path(self._source.name), self._text, self._headers)

    def _add_argument(self, kind: NameKind, start: int, index: int) -> None:
        arguments = list(find_arguments(self._text, start))
        if index < len(arguments):
            self._add_literal(kind, *arguments[index])

    def _add_literal(self, kind: NameKind, begin: int, end: int, type_name: str = "") -> bool:
        """Add the name in an argument if it is a literal, and return whether it is."""
        text = self._texts.evaluate(begin, end)
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
        literal = TEXT.fullmatch(self._text[begin:end])
        if literal is not None:
            begin, end = begin + literal.start("text"), begin + literal.end("text")
        if kind is NameKind.NODE:
            name = self._remappings.node or name
        elif kind in GRAPH_KINDS:
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
        if kind in GRAPH_KINDS and type_name:
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


def _find_pointers(texts: Sequence[str]) -> set[str]:
    """Return the member functions whose addresses are among arguments, qualified by their classes."""
    return set(_POINTER.findall(", ".join(texts)))
