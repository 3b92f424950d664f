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
    """Return whether an object is an instance of a class, which is always true in Python 3."""
    return hasattr(obj, "__class__")


def is_a(obj: object, entity_type: type) -> bool:
    """Return whether an object is an instance of a class."""
    return isinstance(obj, entity_type)


def is_a_subclass(obj: object, entity_type: type) -> bool:
    """Return whether an object is an instance or a subclass of a class."""
    return isinstance(obj, entity_type) or (inspect.isclass(obj) and issubclass(obj, entity_type))


def ensure_argument_type(argument: Any, types: Any, argument_name: str, caller: str | None = None) -> None:
    """Check that an argument has a type, or one of several types.

    Raises:
        TypeError: the argument has another type, or `types` is not valid.
    """
    allowed = [types] if inspect.isclass(types) else types
    listed: list[Any] = list(allowed) if isinstance(allowed, Iterable) and not isinstance(allowed, str) else [None]
    if not all(inspect.isclass(kind) for kind in listed):
        raise TypeError(
            f"'ensure_argument_type()' expected 'types' to be of type "
            f"'type, collections.abc.Iterable of type', but got '{types}' of type '{type(types)}'"
        )
    if isinstance(argument, tuple(listed)):
        return
    by = "" if caller is None else f"'{caller}' "
    names = " or ".join(f"'{kind}'" for kind in listed)
    raise TypeError(
        f"{by}expected '{argument_name}' to be one of {names}, but got '{argument}' of type '{type(argument)}'"
    )


def create_future(loop: asyncio.AbstractEventLoop | None) -> asyncio.Future[Any]:
    """Create a future for an event loop, by default the loop that `get_loop` returns."""
    return (loop or get_loop()).create_future()


def get_loop() -> asyncio.AbstractEventLoop:
    """Return the running event loop, else the open loop from an earlier call, else a new loop."""
    try:
        return asyncio.get_running_loop()
    except RuntimeError:
        pass
    if not _loops or _loops[-1].is_closed():
        _loops[:] = [asyncio.new_event_loop()]
    return _loops[-1]


_loops: list[asyncio.AbstractEventLoop] = []
"""The loop for consecutive runs in one program, created on request."""


def visit_all_entities_and_collect_futures(
    entity: LaunchDescriptionEntity, context: LaunchContext
) -> list[tuple[LaunchDescriptionEntity, asyncio.Future[Any]]]:
    """Visit an entity and its descendants, and return their futures.

    An entity has a future if it continues after its visit.
    """
    following = entity.visit(context)
    future = entity.get_asyncio_future()
    collected = [] if future is None else [(entity, future)]
    for launch_description_entity in following or ():
        collected += visit_all_entities_and_collect_futures(launch_description_entity, context)
    return collected


def shutdown_on_process_exit(process_action: Any) -> RegisterEventHandler:
    """Return an action that shuts the launch down when a process ends."""
    from linkwright.launch.model.actions import EmitEvent, RegisterEventHandler
    from linkwright.launch.model.events import Shutdown
    from linkwright.launch.model.process_event_handlers import OnProcessExit

    ended = EmitEvent(event=Shutdown(reason="process exited"))
    return RegisterEventHandler(OnProcessExit(target_action=process_action, on_exit=[ended]))
