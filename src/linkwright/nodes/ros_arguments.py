"""ROS arguments on a node's command line: what stands between ``--ros-args`` and ``--``.

Remappings, parameters, parameter files and the log level are understood, in the forms that rcl documents.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean
from linkwright.graph import LogLevel

_LEVELS = {level.name.lower(): level for level in LogLevel}


@dataclass(slots=True)
class RosArguments:
    """What ROS arguments say.

    Attributes:
        remappings: rules ``(from, to)``.
        parameters: values by name.
        log_level: the least severity to log; None when it is not given.
    """

    remappings: list[tuple[str, str]] = field(default_factory=list)
    parameters: dict[str, Any] = field(default_factory=dict)
    log_level: LogLevel | None = None


def split_ros_arguments(arguments: Sequence[str]) -> tuple[RosArguments, list[str]]:
    """The ROS arguments of a command line, and the other arguments.

    Raises:
        LinkwrightError: a ROS argument is unknown, lacks its value or has a malformed one.
    """
    ros, others = RosArguments(), []
    inside = False
    waiting = iter(arguments)
    for argument in waiting:
        if argument == "--ros-args":
            inside = True
        elif not inside:
            others.append(argument)
        elif argument == "--":
            inside = False
        else:
            reader = _OPTIONS.get(argument)
            if reader is None:
                raise _error(f"unknown ROS argument '{argument}'", did_you_mean(argument, _OPTIONS))
            value = next(waiting, None)
            if value is None:
                raise _error(f"ROS argument '{argument}' needs a value")
            reader(ros, value)
    return ros, others


def _read_remapping(ros: RosArguments, rule: str) -> None:
    ros.remappings.append(_assignment(rule, "a remapping rule", "from:=to"))


def _read_parameter(ros: RosArguments, rule: str) -> None:
    import yaml

    name, text = _assignment(rule, "a parameter", "name:=value")
    try:
        ros.parameters[name] = yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise _error(f"the value of parameter '{name}' is not valid YAML: '{text}'") from error


def _read_parameter_file(ros: RosArguments, path: str) -> None:
    import yaml

    try:
        content = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise _error(f"parameter file '{path}' cannot be read: {error.strerror}") from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise _error(f"parameter file '{path}' is not valid YAML: {error}") from error
    sections = content.values() if isinstance(content, Mapping) else ()
    parameters = [section.get("ros__parameters") for section in sections if isinstance(section, Mapping)]
    if not parameters or not all(isinstance(section, Mapping) for section in parameters):
        raise _error(
            f"parameter file '{path}' has not the form of one",
            "it maps node names to 'ros__parameters', which maps names to values",
        )
    for section in parameters:
        assert section is not None
        ros.parameters.update(section)


def _read_log_level(ros: RosArguments, level: str) -> None:
    found = _LEVELS.get(level.rpartition(":=")[2].lower())
    if found is None:
        raise _error(f"unknown log level '{level}'", f"the levels are {', '.join(_LEVELS)}")
    ros.log_level = found


_OPTIONS = {
    "-r": _read_remapping,
    "--remap": _read_remapping,
    "-p": _read_parameter,
    "--param": _read_parameter,
    "--params-file": _read_parameter_file,
    "--log-level": _read_log_level,
}


def _assignment(rule: str, what: str, form: str) -> tuple[str, str]:
    left, separator, right = rule.partition(":=")
    if not separator or not left:
        raise _error(f"'{rule}' is not {what}", f"write {form}")
    return left, right


def _error(message: str, hint: str | None = None) -> LinkwrightError:
    return LinkwrightError(Diagnostic("NODE001", message, hint=hint))
