"""Actions that call a function or start a coroutine."""

from __future__ import annotations

import asyncio
import inspect
from collections.abc import Callable, Coroutine, Iterable, Mapping
from typing import Any

from linkwright.launch.model.action import Action
from linkwright.launch.model.context import LaunchContext


class OpaqueFunction(Action):
    """An action that calls a function, and visits the entities that it returns.

    Args:
        function: the function, which is called as ``function(context, *args, **kwargs)``.
        args: further positional arguments.
        kwargs: further keyword arguments.
    """

    def __init__(
        self,
        *,
        function: Callable[..., Any],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        **options: Any,
    ) -> None:
        super().__init__(**options)
        if not callable(function):
            raise TypeError(f"OpaqueFunction expects a function, got {function!r} of type {type(function).__name__}")
        self._function = function
        self._args = tuple(args or ())
        self._kwargs = dict(kwargs or {})

    def describe(self) -> str:
        """Return a text with the function's name."""
        name = getattr(self._function, "__qualname__", None) or type(self._function).__name__
        return f"{type(self).__name__}(function={name.rpartition('<locals>.')[2]})"

    def execute(self, context: LaunchContext) -> Any:
        """Call the function, and return the entities to visit next."""
        return self._function(context, *self._args, **self._kwargs)


class OpaqueCoroutine(Action):
    """An action that starts a coroutine.

    The launch waits for the coroutine to finish, and a shutdown cancels it.

    Args:
        coroutine: the coroutine function, which is called as ``coroutine(context, *args, **kwargs)``.
        args: further positional arguments.
        kwargs: further keyword arguments.
        ignore_context: whether the coroutine function is called without the launch context.
    """

    def __init__(
        self,
        *,
        coroutine: Callable[..., Coroutine[Any, Any, Any]],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        ignore_context: bool = False,
        **options: Any,
    ) -> None:
        super().__init__(**options)
        if not inspect.iscoroutinefunction(coroutine):
            type_name = type(coroutine).__name__
            raise TypeError(f"OpaqueCoroutine expected a coroutine function for 'coroutine', got '{type_name}'")
        self._coroutine = coroutine
        self._args = tuple(args or ())
        self._kwargs = dict(kwargs or {})
        self._ignore_context = ignore_context
        self._task: asyncio.Task[Any] | None = None

    def execute(self, context: LaunchContext) -> None:
        """Start the coroutine."""
        from linkwright.launch.model.event_handlers import OnShutdown

        loop = context.asyncio_loop
        if loop is None:
            raise RuntimeError("a coroutine can be started only while a launch is running")
        args = self._args if self._ignore_context else (context, *self._args)
        task = loop.create_task(self._coroutine(*args, **self._kwargs))
        self._task = task
        context.register_event_handler(OnShutdown(on_shutdown=lambda *_: self._cancel(task)))

    @staticmethod
    def _cancel(task: asyncio.Task[Any]) -> None:
        if not task.done():
            task.cancel()

    def get_asyncio_future(self) -> asyncio.Future[Any] | None:
        """Return the coroutine's task, or None if the coroutine is not started yet."""
        return self._task
