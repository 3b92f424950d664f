"""Actions that write a line to the log of the launch."""

from __future__ import annotations

import logging
import warnings
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import phrase, quoted_names
from linkwright.launch.errors.locations import error_at
from linkwright.launch.model.action import Action
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.markup.expose import expose_action
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    TextSubstitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

if TYPE_CHECKING:
    from linkwright.launch.errors.locations import SourceLocation
    from linkwright.launch.model.markup.entity import Entity, Parser

_LOGGER_NAME = "launch.user"
LEVELS = {
    "DEBUG": logging.DEBUG,
    "INFO": logging.INFO,
    "WARN": logging.WARNING,
    "WARNING": logging.WARNING,
    "ERROR": logging.ERROR,
    "FATAL": logging.CRITICAL,
    "CRITICAL": logging.CRITICAL,
}


@expose_action("log")
class Log(Action):
    """An action that writes a line to the log at a level.

    Args:
        msg: the line.
        level: ``DEBUG``, ``INFO``, ``WARNING``, ``ERROR`` or ``CRITICAL``.
    """

    def __init__(self, *, msg: SomeSubstitutionsType, level: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._msg = normalize_to_list_of_substitutions(msg)
        self._level = normalize_to_list_of_substitutions(level)
        if all(isinstance(substitution, TextSubstitution) for substitution in self._level):
            _parse_level(
                "".join(part.text for part in self._level if isinstance(part, TextSubstitution)), self._level_location
            )

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag."""
        _, kwargs = super().parse(entity, parser)
        kwargs["msg"] = parser.parse_substitution(entity.get_attr("message"))
        level = entity.get_attr("level", optional=True)
        if level is None:
            if cls is Log:
                warning = (
                    "The action log now expects a log level. Either provide one or switch to using the log_info action"
                )
                location = entity.source_location
                if location is None:
                    warnings.warn(warning, stacklevel=2)
                else:
                    warnings.warn_explicit(warning, UserWarning, location.file, location.span().line)
                return LogInfo, kwargs  # Jazzy and earlier log this tag at level INFO
            level = "INFO"
        kwargs["level"] = parser.parse_substitution(level)
        return cls, kwargs

    @property
    def msg(self) -> list[Substitution]:
        """The line, as substitutions."""
        return self._msg

    @property
    def level(self) -> list[Substitution]:
        """The level, as substitutions."""
        return self._level

    @property
    def _level_location(self) -> SourceLocation | None:
        return next(
            (substitution.source_location for substitution in self._level if substitution.source_location is not None),
            self.source_location,
        )

    def describe(self) -> str:
        """Return a text with the logged line."""
        return f"{type(self).__name__}({describe(self._msg)})"

    def execute(self, context: LaunchContext) -> None:
        """Write the line to the log.

        Raises:
            KeyError: LAUNCH150, there is no such level.
        """
        level = _parse_level(perform_substitutions(context, self._level), self._level_location)
        context.log(_LOGGER_NAME, level, perform_substitutions(context, self._msg))


def _parse_level(level: str, location: SourceLocation | None) -> int:
    if level.upper() in LEVELS:
        return LEVELS[level.upper()]
    from linkwright.diagnostics import did_you_mean

    hint = did_you_mean(level, LEVELS) or phrase("use one of {names}", names=quoted_names(LEVELS))
    ros_error = KeyError(f"Invalid log level '{level}', expected: {list(LEVELS)}")
    raise error_at(
        location, "LAUNCH150", phrase("there is no log level '{level}'", level=level), hint, ros_error=ros_error
    )


class _FixedLevelLog(Log):
    """The base class of actions that write a line at a fixed log level."""

    _LEVEL = "INFO"

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        kwargs.pop("level", None)
        super().__init__(msg=msg, level=self._LEVEL, **kwargs)


@expose_action("log_info")
class LogInfo(_FixedLevelLog):
    """An action that writes a line at level INFO."""


@expose_action("log_debug")
class LogDebug(_FixedLevelLog):
    """An action that writes a line at level DEBUG, shown only with ``--debug``."""

    _LEVEL = "DEBUG"


@expose_action("log_warning")
class LogWarning(_FixedLevelLog):
    """An action that writes a line at level WARNING."""

    _LEVEL = "WARNING"


@expose_action("log_error")
class LogError(_FixedLevelLog):
    """An action that writes a line at level ERROR.

    The launch continues after an error.
    """

    _LEVEL = "ERROR"
