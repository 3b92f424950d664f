"""Event handlers, which return the entities to visit when an event occurs."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from linkwright.launch.model import events
from linkwright.launch.model.action import Action
from linkwright.launch.model.entity import LaunchDescriptionEntity, SomeEntitiesType, as_entities

if TYPE_CHECKING:
    from linkwright.launch.model.context import LaunchContext

EntitiesOrCallable = SomeEntitiesType | Callable[..., Any] | None


class BaseEventHandler:
    """An event handler for the events that a matcher accepts.

    Users derive from this class and override `handle`.

    Args:
        matcher: called with an event; returns whether the handler accepts the event.
        handle_once: whether the handler is unregistered after the first event.
    """

    def __init__(self, *, matcher: Callable[[Any], bool], handle_once: bool = False) -> None:
        self._matcher = matcher
        self._handle_once = handle_once

    @property
    def handle_once(self) -> bool:
        """Whether the handler is unregistered after the first event that it handles."""
        return self._handle_once

    @property
    def handler_description(self) -> str | None:
        """A text that describes the reaction in listings, or None."""
        return None

    @property
    def matcher_description(self) -> str | None:
        """A text that describes the accepted events in listings, or None."""
        return None

    @property
    def entities(self) -> Any:
        """The entities that the handler visits, or None if they are unknown before the event."""
        return None

    def matches(self, event: Any) -> bool:
        """Return whether the handler accepts the event."""
        return self._matcher(event)

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """Return a line for listings, and the entities that the handler visits, if they are known."""
        text = (
            f"{type(self).__name__}(matcher='{self.matcher_description}', handler='{self.handler_description}', "
            f"handle_once={self.handle_once})"
        )
        return text, list(_as_iterable(self.entities))

    def handle(self, event: Any, context: LaunchContext) -> Any:
        """Make the event a local of the context, and unregister a handler with `handle_once`.

        Subclasses extend this method to return the entities to visit.
        """
        context.extend_locals({"event": event})
        if self.handle_once:
            context.unregister_event_handler(self)
        return None


class EventHandler(BaseEventHandler):
    """An event handler that visits entities when its matcher accepts an event.

    Args:
        matcher: called with an event; returns whether the handler accepts the event.
        entities: the entities to visit.
        handle_once: whether the handler is unregistered after the first event.
    """

    def __init__(
        self, *, matcher: Callable[[Any], bool], entities: SomeEntitiesType | None = None, handle_once: bool = False
    ) -> None:
        super().__init__(matcher=matcher, handle_once=handle_once)
        self._entities = entities

    @property
    def entities(self) -> Any:
        """The entities to visit."""
        return self._entities

    def handle(self, event: Any, context: LaunchContext) -> Any:
        """Return the entities to visit for the event."""
        super().handle(event, context)
        return self._entities


class _ReactionHandler(BaseEventHandler):
    """An event handler that visits given entities, or the entities that a function returns.

    The function is called with the event and the context.

    Args:
        matcher: called with an event; returns whether the handler accepts the event.
        reaction: the entities, or a function of event and context that returns them.
        name: the name of the argument for the reaction in the user's code, for error messages.
        handle_once: whether the handler is unregistered after the first event.

    Raises:
        TypeError: the reaction is neither a function nor entities.
    """

    def __init__(
        self, *, matcher: Callable[[Any], bool], reaction: EntitiesOrCallable, name: str, handle_once: bool
    ) -> None:
        super().__init__(matcher=matcher, handle_once=handle_once)
        self._function, self._entities = _parse_reaction(reaction, name)

    @property
    def entities(self) -> list[LaunchDescriptionEntity]:
        """The given entities to visit.

        The list is empty if a function returns the entities.
        """
        return self._entities

    @property
    def handler_description(self) -> str:
        """A text that names the function, or ``<actions>``."""
        return "<actions>" if self._function is None else str(self._function)

    def handle(self, event: Any, context: LaunchContext) -> Any:
        """Return the entities to visit for the event."""
        super().handle(event, context)
        return self._entities if self._function is None else self._function(event, context)


class OnActionEventBase(_ReactionHandler):
    """A handler for events that come from an action.

    Args:
        action_matcher: the action, a predicate on actions, or None for all actions.
        on_event: the entities to visit, or a function of event and context that returns them.
        target_event_cls: the class of the accepted events.
        target_action_cls: the class of the accepted actions.
        handle_once: whether the handler is unregistered after the first event.
    """

    def __init__(
        self,
        *,
        action_matcher: Any,
        on_event: EntitiesOrCallable,
        target_event_cls: type[events.Event],
        target_action_cls: type[Action],
        handle_once: bool = False,
    ) -> None:
        if not issubclass(target_event_cls, events.Event):
            raise TypeError("'target_event_cls' must be a subclass of 'Event'")
        is_action = isinstance(action_matcher, target_action_cls) and not callable(action_matcher)
        if action_matcher is not None and not is_action and not callable(action_matcher):
            raise TypeError(f"action_matcher must be an '{target_action_cls.__name__}' instance or a callable")

        def matches(event: Any) -> bool:
            if not isinstance(event, target_event_cls):
                return False
            if action_matcher is None:
                return True
            action = event.action  # type: ignore[attr-defined]  # the events of actions have it
            return action is action_matcher if is_action else bool(action_matcher(action))

        super().__init__(matcher=matches, reaction=on_event, name="on_event", handle_once=handle_once)
        self._event_name = target_event_cls.__name__
        self._action_name = None if action_matcher is None else target_action_cls.__name__

    @property
    def matcher_description(self) -> str:
        """A text that describes the accepted events."""
        if self._action_name is None:
            return f"event == {self._event_name}"
        return f"event == {self._event_name} and {self._action_name}(event.action)"


def _parse_reaction(reaction: Any, name: str) -> tuple[Callable[..., Any] | None, list[LaunchDescriptionEntity]]:
    """Return the function of a reaction or None, and the entities of the reaction.

    Raises:
        TypeError: the reaction is neither a function nor entities.
    """
    if callable(reaction) and not isinstance(reaction, LaunchDescriptionEntity):
        return reaction, []
    try:
        return None, as_entities(reaction)
    except TypeError as error:
        raise TypeError(f"'{name}' must be launch actions or a function that returns them: {error}") from error


def _as_iterable(entities: Any) -> Iterable[Any]:
    if entities is None:
        return ()
    return entities if isinstance(entities, Iterable) else (entities,)


class OnExecutionComplete(OnActionEventBase):
    """An event handler that reacts when an action has completed.

    A process has completed when it has ended. If no target is given, the handler accepts all actions except the actions
    that it returned itself, because these would cause an endless loop.
    """

    def __init__(
        self, *, on_completion: EntitiesOrCallable, target_action: Any = None, handle_once: bool = False
    ) -> None:
        self._returned_entities: list[LaunchDescriptionEntity] = []
        super().__init__(
            action_matcher=self._is_foreign_action if target_action is None else target_action,
            on_event=on_completion,
            target_event_cls=events.ExecutionComplete,
            target_action_cls=Action,
            handle_once=handle_once,
        )
        if target_action is None:
            self._action_name = None

    def handle(self, event: Any, context: LaunchContext) -> Any:
        """Return the entities to visit for the event."""
        entities = super().handle(event, context)
        self._returned_entities += as_entities(entities) if entities is not None else ()
        return entities

    def _is_foreign_action(self, action: Action) -> bool:
        return not any(action is entity for entity in self._returned_entities)


class OnIncludeLaunchDescription(BaseEventHandler):
    """An event handler that visits the description of each `IncludeLaunchDescription` event."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(matcher=lambda event: isinstance(event, events.IncludeLaunchDescription), **kwargs)

    def handle(self, event: Any, context: LaunchContext) -> Any:
        """Return the launch description of the event, to be visited next."""
        super().handle(event, context)
        return event.launch_description


class OnShutdown(_ReactionHandler):
    """An event handler that reacts to the shutdown of the launch."""

    def __init__(self, *, on_shutdown: EntitiesOrCallable, handle_once: bool = False, **_: Any) -> None:
        super().__init__(
            matcher=lambda event: isinstance(event, events.Shutdown),
            reaction=on_shutdown,
            name="on_shutdown",
            handle_once=handle_once,
        )

    @property
    def matcher_description(self) -> str:
        """A text that describes the accepted events."""
        return "event issubclass of launch.events.Shutdown"
