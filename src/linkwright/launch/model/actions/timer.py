"""The action that delays other actions."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import phrase
from linkwright.launch.errors.locations import error_at
from linkwright.launch.model import events
from linkwright.launch.model.action import Action
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.entity import LaunchDescriptionEntity, as_entities
from linkwright.launch.model.markup.expose import expose_action
from linkwright.launch.model.markup.values import normalize_typed_substitution, perform_typed_substitution
from linkwright.launch.model.substitution import SomeSubstitutionsType, perform_substitutions

if TYPE_CHECKING:
    from linkwright.launch.model.markup.entity import Entity, Parser
    from linkwright.launch.model.running_launch import Schedule


@expose_action("timer")
class TimerAction(Action):
    """An action that visits actions once, when a period has passed.

    Args:
        period: the period in seconds, as a number or substitutions.
        actions: the actions to visit.
        cancel_on_shutdown: whether a shutdown cancels the timer. If False, the launch waits for the timer.
    """

    def __init__(
        self,
        *,
        period: float | SomeSubstitutionsType,
        actions: Iterable[LaunchDescriptionEntity],
        cancel_on_shutdown: bool | SomeSubstitutionsType = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._period = normalize_typed_substitution(_normalize_period(period, self), float)
        self._actions = as_entities(actions)
        self._cancel_on_shutdown = normalize_typed_substitution(cancel_on_shutdown, bool)
        self._cancel: Callable[[], None] | None = None
        self._is_canceled = False

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag, with the actions inside."""
        _, kwargs = super().parse(entity, parser)
        kwargs["period"] = parser.parse_if_substitutions(entity.get_attr("period", data_type=float, can_be_str=True))
        cancel_on_shutdown = entity.get_attr("cancel_on_shutdown", optional=True, data_type=bool, can_be_str=True)
        if cancel_on_shutdown is not None:
            kwargs["cancel_on_shutdown"] = parser.parse_if_substitutions(cancel_on_shutdown)
        kwargs["actions"] = [parser.parse_action(child) for child in entity.children]
        return cls, kwargs

    @property
    def period(self) -> Any:
        """The period in seconds, as a number or substitutions."""
        return self._period

    @property
    def actions(self) -> list[LaunchDescriptionEntity]:
        """The actions to visit."""
        return self._actions

    def describe(self) -> str:
        """Return a text with the period."""
        return f"{type(self).__name__}(period={self._period}, actions=<actions>)"

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return an empty list, because the actions are visited only when the period has passed."""
        return []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the actions, with a text about the period."""
        return [(f"{self._period} seconds pass without being canceled", self._actions)]

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the actions to visit."""
        return self._actions

    def cancel(self) -> None:
        """Cancel the timer.

        This method has no effect once the period has passed.
        """
        self._is_canceled = True
        if self._cancel is not None:
            self._cancel()

    def execute(self, context: LaunchContext) -> None:
        """Start the timer.

        Raises:
            LinkwrightError: LAUNCH127, the period is not a number.
        """
        try:
            seconds = float(perform_typed_substitution(context, self._period, float))
            cancel_on_shutdown = bool(perform_typed_substitution(context, self._cancel_on_shutdown, bool))
        except ValueError as error:
            text = perform_substitutions(context, self._period) if isinstance(self._period, list) else self._period
            message = phrase("the period '{text}' of a timer is not a number", text=text)
            raise error_at(self.source_location, "LAUNCH127", message, ros_error=error) from error
        if not self._is_canceled:
            event = events.TimerEvent(timer_action=self, context=context)
            self._cancel = context.session.call_later(
                seconds, event, self._actions, cancel_on_shutdown=cancel_on_shutdown, schedule=self._schedule(context)
            )

    def _schedule(self, context: LaunchContext) -> Schedule | None:
        """Return the scheduler that calls the timer, or None for the event loop of the launch."""
        return None


def _normalize_period(period: Any, timer: TimerAction) -> Any:
    """Return a literal period as a number, and substitutions unchanged.

    Raises:
        LinkwrightError: LAUNCH127, the literal is not a number.
    """
    if isinstance(period, (bool, int)):
        return float(period)
    if isinstance(period, (list, tuple)) and all(isinstance(item, str) for item in period):
        period = "".join(period)
    if not isinstance(period, str):
        return period
    try:
        return float(period)
    except ValueError as error:
        message = phrase("the period '{text}' of a timer is not a number", text=period)
        raise error_at(timer.source_location, "LAUNCH127", message, ros_error=error) from error
