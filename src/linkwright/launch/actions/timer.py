"""Actions after a while."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from linkwright.launch import events
from linkwright.launch.context import LaunchContext
from linkwright.launch.entity import Action, LaunchDescriptionEntity, as_entities
from linkwright.launch.places import error_at
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class TimerAction(Action):
    """Visits actions once, after a period; an end of the launch before that cancels it.

    Args:
        period: seconds, a number or substitutions that give one.
        actions: what is visited then.
        cancel_on_shutdown: kept for compatibility: a launch that ends waits for no timer either way.
    """

    def __init__(
        self,
        *,
        period: float | SomeSubstitutionsType,
        actions: Iterable[LaunchDescriptionEntity],
        cancel_on_shutdown: bool | SomeSubstitutionsType = True,  # noqa: ARG002 - part of the interface
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        period = str(period) if isinstance(period, (int, float)) else period
        self._period = normalize_to_list_of_substitutions(period)
        self._actions = as_entities(actions)
        self._cancel: Any = None
        self._canceled = False

    @property
    def actions(self) -> list[LaunchDescriptionEntity]:
        """The actions."""
        return self._actions

    def get_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        """The actions."""
        return self._actions

    def cancel(self) -> None:
        """Visit nothing, if the time has not come yet."""
        self._canceled = True
        if self._cancel is not None:
            self._cancel()

    def execute(self, context: LaunchContext) -> None:
        """Start to wait.

        Raises:
            LinkwrightError: LAUNCH127, if the period is no number.
        """
        text = perform_substitutions(context, self._period)
        try:
            seconds = float(text)
        except ValueError as error:
            raise error_at(self.place, "LAUNCH127", f"the period '{text}' of a timer is no number") from error
        if not self._canceled:
            event = events.TimerEvent(timer_action=self, context=context)
            self._cancel = context.session.call_later(seconds, event, self._actions)
