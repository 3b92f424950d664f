"""Functions of ``launch.utilities`` for users' actions and event handlers."""

from __future__ import annotations

import asyncio
import inspect
import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from linkwright.launch.model.entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from linkwright.launch.model.actions import RegisterEventHandler
    from linkwright.launch.model.context import LaunchContext

FilePath = str | bytes | os.PathLike[Any]


def isclassinstance(obj: object) -> bool:
    """Return whether an object has a class.

    In Python 3, the result is always true.
    """
    return hasattr(obj, "__class__")


def is_a(obj: object, entity_type: type) -> bool:
    """Return whether an object is an instance of a class."""
    return isinstance(obj, entity_type)


def is_a_subclass(obj: object, entity_type: type) -> bool:
    """Return whether an object is an instance or a subclass of a class."""
    return isinstance(obj, entity_type) or (inspect.isclass(obj) and issubclass(obj, entity_type))


def ensure_argument_type(argument: Any, types: Any, argument_name: str, caller: str | None = None) -> None:
    """Raise TypeError unless an argument has a type, or one of several types.

    Raises:
        TypeError: the argument has another type, or `types` is not valid.
    """
    allowed_types = [types] if inspect.isclass(types) else types
    type_list: list[Any] = (
        list(allowed_types) if isinstance(allowed_types, Iterable) and not isinstance(allowed_types, str) else [None]
    )
    if not all(inspect.isclass(allowed_type) for allowed_type in type_list):
        raise TypeError(
            f"'ensure_argument_type()' expected 'types' to be of type "
            f"'type, collections.abc.Iterable of type', but got '{types}' of type '{type(types)}'"
        )
    if isinstance(argument, tuple(type_list)):
        return
    prefix = "" if caller is None else f"'{caller}' "
    names = " or ".join(f"'{kind}'" for kind in type_list)
    raise TypeError(
        f"{prefix}expected '{argument_name}' to be one of {names}, but got '{argument}' of type '{type(argument)}'"
    )


def create_future(loop: asyncio.AbstractEventLoop | None) -> asyncio.Future[Any]:
    """Return a new future of an event loop, by default of the loop that `get_loop` returns."""
    return (loop or get_loop()).create_future()


def get_loop() -> asyncio.AbstractEventLoop:
    """Return the running event loop, or else the loop of an earlier call.

    If that loop is closed, or there is none, a new loop is created.
    """
    try:
        return asyncio.get_running_loop()
    except RuntimeError:
        pass
    if not _fallback_loops or _fallback_loops[-1].is_closed():
        _fallback_loops[:] = [asyncio.new_event_loop()]
    return _fallback_loops[-1]


_fallback_loops: list[asyncio.AbstractEventLoop] = []
"""The event loop that `get_loop` created last, in a list of at most one."""


def visit_all_entities_and_collect_futures(
    entity: LaunchDescriptionEntity, context: LaunchContext
) -> list[tuple[LaunchDescriptionEntity, asyncio.Future[Any]]]:
    """Visit an entity and its descendants, and return pairs of an entity and its future.

    An entity has a future if it continues after its visit.
    """
    next_entities = entity.visit(context)
    future = entity.get_asyncio_future()
    futures = [] if future is None else [(entity, future)]
    for next_entity in next_entities or ():
        futures += visit_all_entities_and_collect_futures(next_entity, context)
    return futures


def shutdown_on_process_exit(process_action: Any) -> RegisterEventHandler:
    """Return an action that shuts the launch down when a process ends."""
    from linkwright.launch.model.actions import EmitEvent, RegisterEventHandler
    from linkwright.launch.model.events import Shutdown
    from linkwright.launch.model.process_event_handlers import OnProcessExit

    shutdown_action = EmitEvent(event=Shutdown(reason="process exited"))
    return RegisterEventHandler(OnProcessExit(target_action=process_action, on_exit=[shutdown_action]))
