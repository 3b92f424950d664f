"""The common attributes of the tags ``executable`` and ``node``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import phrase
from linkwright.launch.errors.locations import error_at
from linkwright.launch.model.actions.named import parse_pairs
from linkwright.launch.model.markup.command_line import parse_command_line

if TYPE_CHECKING:
    from linkwright.launch.model.markup.entity import Entity, Parser

_SUBSTITUTED_ATTRIBUTES = {
    "cwd": "cwd",
    "name": "name",
    "prefix": "launch-prefix",
    "output": "output",
    "respawn": "respawn",
}
"""Maps the keyword arguments that may contain substitutions to the attributes of the tag."""

_BOOLEAN_ATTRIBUTES = ("shell", "emulate_tty", "log_cmd", "cached_output", "split_arguments")
_TIMEOUT_ATTRIBUTES = ("sigkill_timeout", "sigterm_timeout")


def parse_process(entity: Entity, parser: Parser, ignored: frozenset[str]) -> dict[str, Any]:
    """Return the keyword arguments for an `ExecuteProcess` from its tag.

    Args:
        entity: the tag.
        parser: parses the substitutions in the tag.
        ignored: names of arguments to skip.

    Raises:
        AttributeError: LAUNCH117, the tag has no ``cmd``.
        TypeError: LAUNCH118, an attribute has the wrong type.
        ValueError: LAUNCH118, the value of an attribute is invalid.
    """
    kwargs: dict[str, Any] = {}
    if "cmd" not in ignored:
        kwargs["cmd"] = parse_command_line(entity.get_attr("cmd"), parser)
    for argument, attribute in _SUBSTITUTED_ATTRIBUTES.items():
        if argument not in ignored:
            value = entity.get_attr(attribute, optional=True, **_attribute_options(argument))
            if value is not None:
                kwargs[argument] = parser.parse_substitution(value) if isinstance(value, str) else value
    for name in _BOOLEAN_ATTRIBUTES:
        if name not in ignored:
            value = entity.get_attr(name, data_type=bool, optional=True, can_be_str=False)
            if value is not None:
                kwargs[name] = value
    if "respawn_max_retries" not in ignored:
        retries = entity.get_attr("respawn_max_retries", data_type=int, optional=True)
        if retries is not None:
            kwargs["respawn_max_retries"] = retries
    if "respawn_delay" not in ignored:
        delay = _read_non_negative(entity, "respawn_delay")
        if delay is not None:
            kwargs["respawn_delay"] = delay
    for name in _TIMEOUT_ATTRIBUTES:
        seconds = None if name in ignored else _read_non_negative(entity, name)
        if seconds is not None:
            kwargs[name] = str(seconds)
    if "on_exit" not in ignored:
        _parse_on_exit(entity, kwargs)
    if "additional_env" not in ignored:
        environment = parse_pairs(entity, parser, "env")
        if environment is not None:
            kwargs["additional_env"] = environment
    return kwargs


def _attribute_options(argument: str) -> dict[str, Any]:
    """Return the options of `get_attr` for an attribute that may contain substitutions.

    In YAML, ``respawn`` may also be a boolean.
    """
    return {"data_type": bool, "can_be_str": True} if argument == "respawn" else {}


def _read_non_negative(entity: Entity, name: str) -> float | None:
    value: float | None = entity.get_attr(name, data_type=float, optional=True, can_be_str=False)
    if value is not None and value < 0.0:
        text = f"Attribute {name} of Entity node expected to be a non-negative value but got `{value}`"
        message = phrase(
            "attribute '{name}' of '{type_name}' must not be negative", name=name, type_name=entity.type_name
        )
        raise error_at(entity.source_location, "LAUNCH118", message, ros_error=ValueError(text))
    return value


def _parse_on_exit(entity: Entity, kwargs: dict[str, Any]) -> None:
    from linkwright.launch.model.actions.events import Shutdown

    on_exit = entity.get_attr("on_exit", optional=True)
    if on_exit is None:
        return
    if on_exit != "shutdown":
        text = (
            f"Attribute on_exit of Entity node expected to be shutdown but got `{on_exit}`"
            "Other on_exit actions not yet supported"
        )
        message = phrase(
            "attribute 'on_exit' of '{type_name}' must be 'shutdown', not '{on_exit}'",
            type_name=entity.type_name,
            on_exit=on_exit,
        )
        raise error_at(entity.source_location, "LAUNCH118", message, ros_error=ValueError(text))
    kwargs["on_exit"] = [Shutdown()]
