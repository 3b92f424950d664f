"""ROS arguments: the arguments between ``--ros-args`` and ``--``, in the syntax of rcl."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, joined, phrase
from linkwright.graph.log.logger import LogLevel, level_from_name
from linkwright.graph.parameters.parameter import ANY_NODE, ParameterRules

ROS_ARGUMENTS_START = "--ros-args"
ROS_ARGUMENTS_END = "--"
_NODE_PREFIX = re.compile(r"(?!ros(?:topic|service)://)(/?[A-Za-z_*][\w/*]*):(.+)", re.DOTALL)


@dataclass(frozen=True, slots=True)
class RemapRule:
    """A remapping rule.

    Attributes:
        node: the name of the node that the rule applies to; None for every node.
        source: the name to replace, ``__node`` (or ``__name``), or ``__ns``. The prefix ``rostopic://`` or
            ``rosservice://`` restricts the rule to topics or services.
        target: the new name.
    """

    node: str | None
    source: str
    target: str


@dataclass(slots=True)
class RosArguments:
    """The parsed ROS arguments of a command line.

    Attributes:
        remap_rules: the remapping rules, in order.
        parameters: parameter values, from files and from the command line, in order.
        log_level: the minimum severity to log; None if not given.
        log_levels: the minimum severities of individual loggers, by name.
        log_config_file: the file that configures the log files, as given on the command line.
        rosout_logs: whether to publish the log on ``/rosout``; None if not given.
        stdout_logs: whether to write the log to the console; None if not given.
        external_lib_logs: whether to write the log to a log file; None if not given.
        enclave: the security enclave.
        non_ros_arguments: the arguments that are not ROS arguments.
    """

    remap_rules: list[RemapRule] = field(default_factory=list)
    parameters: ParameterRules = field(default_factory=ParameterRules)
    log_level: LogLevel | None = None
    log_levels: dict[str, LogLevel] = field(default_factory=dict)
    log_config_file: str | None = None
    rosout_logs: bool | None = None
    stdout_logs: bool | None = None
    external_lib_logs: bool | None = None
    enclave: str | None = None
    non_ros_arguments: list[str] = field(default_factory=list)

    def remappings_for(self, node_name: str) -> list[tuple[str, str]]:
        """Return the remappings ``(from, to)`` that apply to a node, in order.

        Args:
            node_name: the node's name in the source code, before remapping.
        """
        return [(rule.source, rule.target) for rule in self.remap_rules if rule.node in (None, node_name)]

    def parameters_for(self, full_name: str) -> dict[str, Any]:
        """Return the parameter values of a node by parameter name.

        Args:
            full_name: the node's namespace and name, after remapping.
        """
        return self.parameters.for_node(full_name)


def parse(arguments: Sequence[str]) -> RosArguments:
    """Parse a command line, given without the program's name.

    Raises:
        LinkwrightError: GRAPH221, a ROS argument is unknown, has no value or a malformed value; or the code of an error
            in a parameter file.
    """
    ros_arguments = RosArguments()
    in_ros_arguments = False
    remaining = iter(arguments)
    for argument in remaining:
        if argument == ROS_ARGUMENTS_START:
            in_ros_arguments = True
        elif not in_ros_arguments:
            ros_arguments.non_ros_arguments.append(argument)
        elif argument == ROS_ARGUMENTS_END:
            in_ros_arguments = False
        elif argument in _FLAGS:
            setattr(ros_arguments, *_FLAGS[argument])
        elif argument in _OPTIONS:
            value = next(remaining, None)
            if value is None or value in (ROS_ARGUMENTS_START, ROS_ARGUMENTS_END):
                raise _argument_error(
                    phrase("ROS argument '{argument}' needs a value", argument=argument),
                    phrase("write {argument} {form}", argument=argument, form=_VALUE_FORMS[argument]),
                )
            _OPTIONS[argument](ros_arguments, value)
        else:
            raise _unknown_argument_error(argument)
    return ros_arguments


def remove_ros_arguments(arguments: Sequence[str]) -> list[str]:
    """Return the arguments of a command line that are not ROS arguments."""
    other_arguments: list[str] = []
    in_ros_arguments = False
    for argument in arguments:
        if argument == ROS_ARGUMENTS_START:
            in_ros_arguments = True
        elif in_ros_arguments:
            in_ros_arguments = argument != ROS_ARGUMENTS_END
        else:
            other_arguments.append(argument)
    return other_arguments


def _read_remapping(ros_arguments: RosArguments, rule: str) -> None:
    source, target = _split_assignment(rule, phrase("a remapping rule"), phrase("from:=to"))
    node = None
    match = _NODE_PREFIX.fullmatch(source)
    if match:
        node, source = match[1], match[2]
    ros_arguments.remap_rules.append(RemapRule(node, source, target))


def _read_parameter(ros_arguments: RosArguments, rule: str) -> None:
    from linkwright.graph.parameters.files import parse_value  # Imported here because few nodes receive parameters.

    name, text = _split_assignment(rule, phrase("a parameter"), phrase("name:=value"))
    pattern = ANY_NODE
    match = _NODE_PREFIX.fullmatch(name)
    if match:
        pattern, name = match[1], match[2]
    ros_arguments.parameters.set(pattern, name, parse_value(text, name))


def _read_parameter_file(ros_arguments: RosArguments, path: str) -> None:
    from linkwright.graph.parameters.files import read_parameter_file

    ros_arguments.parameters.add(read_parameter_file(Path(path)))


def _read_log_level(ros_arguments: RosArguments, rule: str) -> None:
    name, separator, level_name = rule.rpartition(":=")
    level = level_from_name(level_name)
    if level is None or (separator and not name):
        levels = [log_level.name.lower() for log_level in LogLevel]
        raise _argument_error(
            phrase("unknown log level '{level}'", level=level_name),
            did_you_mean(level_name.lower(), levels) or phrase("the levels are {levels}", levels=joined(levels)),
        )
    if separator:
        ros_arguments.log_levels[name] = level
    else:
        ros_arguments.log_level = level


def _read_log_config_file(ros_arguments: RosArguments, path: str) -> None:
    ros_arguments.log_config_file = path


def _read_enclave(ros_arguments: RosArguments, enclave: str) -> None:
    if not re.fullmatch(r"(/|(/[A-Za-z_]\w*)+)", enclave):
        raise _argument_error(
            phrase("'{enclave}' is not a valid enclave", enclave=enclave),
            phrase("write a name that begins with a slash, such as /robot/talker"),
        )
    ros_arguments.enclave = enclave


_OPTIONS: dict[str, Callable[[RosArguments, str], None]] = {
    "-r": _read_remapping,
    "--remap": _read_remapping,
    "-p": _read_parameter,
    "--param": _read_parameter,
    "--params-file": _read_parameter_file,
    "--log-level": _read_log_level,
    "--log-config-file": _read_log_config_file,
    "--log-file-name": lambda _ros, _name: None,
    "-e": _read_enclave,
    "--enclave": _read_enclave,
}
_VALUE_FORMS = {
    "-r": phrase("from:=to"),
    "--remap": phrase("from:=to"),
    "-p": phrase("name:=value"),
    "--param": phrase("name:=value"),
    "--params-file": phrase("FILE.yaml"),
    "--log-level": phrase("LEVEL or LOGGER:=LEVEL"),
    "--log-config-file": phrase("FILE"),
    "--log-file-name": phrase("NAME"),
    "-e": "/ENCLAVE",
    "--enclave": "/ENCLAVE",
}
_FLAGS = {
    f"--{verb}-{destination}-logs": (f"{destination.replace('-', '_')}_logs", verb == "enable")
    for verb in ("enable", "disable")
    for destination in ("rosout", "stdout", "external-lib")
}


def _split_assignment(rule: str, description: Phrase, form: Phrase) -> tuple[str, str]:
    name, separator, value = rule.partition(":=")
    if not separator or not name:
        raise _argument_error(
            phrase("'{rule}' is not {expected}", rule=rule, expected=description), phrase("write {form}", form=form)
        )
    return name, value


def _unknown_argument_error(argument: str) -> LinkwrightError:
    hint = did_you_mean(argument, (*_OPTIONS, *_FLAGS))
    if hint is None and ":=" in argument:
        option = "-r" if argument.startswith("__") else "-p"
        hint = (
            phrase("write {option} {argument}", option=option, argument=argument)
            if option == "-r"
            else phrase("write -p {argument} or -r {argument}", argument=argument)
        )
    return _argument_error(phrase("unknown ROS argument '{argument}'", argument=argument), hint)


def _argument_error(message: Phrase, hint: Phrase | None = None) -> LinkwrightError:
    return LinkwrightError(Diagnostic("GRAPH221", message, hint=hint))
