"""Actions that call a function or write a line."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from linkwright.launch.context import LaunchContext
from linkwright.launch.entity import Action, LaunchDescriptionEntity, as_entities
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class OpaqueFunction(Action):
    """Calls a function with the launch context when it is visited; what it returns is visited next.

    Args:
        function: called as ``function(context, *args, **kwargs)``.
        args: further arguments.
        kwargs: further named arguments.
    """

    def __init__(
        self,
        *,
        function: Callable[..., Any],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        **others: Any,
    ) -> None:
        super().__init__(**others)
        if not callable(function):
            raise TypeError(f"OpaqueFunction expects a function, got {function!r} of type {type(function).__name__}")
        self._function = function
        self._args = tuple(args or ())
        self._kwargs = dict(kwargs or {})

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity]:
        """Call it."""
        return as_entities(self._function(context, *self._args, **self._kwargs))


class LogInfo(Action):
    """Writes a line into the log of the launch."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._msg = normalize_to_list_of_substitutions(msg)

    @property
    def msg(self) -> list[Substitution]:
        """The line, as substitutions."""
        return self._msg

    def execute(self, context: LaunchContext) -> None:
        """Write it."""
        context.session.log.say("launch.user", perform_substitutions(context, self._msg))
