"""Executors with the default context unless another one is given (rclpy ``executors``)."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from linkwright.graph import executors
from linkwright.standins.rclpy_api.context import Context
from linkwright.standins.rclpy_api.defaults import get_default_context


class Executor(executors.Executor):
    """The base class of users' executors, which define ``spin_once``.

    An executor runs the callbacks of nodes.
    """

    def __init__(self, *, context: Context | None = None) -> None:
        super().__init__(context=get_default_context() if context is None else context)


class SingleThreadedExecutor(executors.SingleThreadedExecutor, Executor):
    """An executor that runs callbacks one after another in the spinning thread."""

    def __init__(self, *, context: Context | None = None) -> None:
        super().__init__(context=context)


class MultiThreadedExecutor(executors.MultiThreadedExecutor, Executor):
    """An executor that runs callbacks in a pool of threads."""

    def __init__(self, num_threads: int | None = None, *, context: Context | None = None) -> None:
        super().__init__(num_threads, context=context)


async def await_or_execute(callback: Callable[..., Any], *args: Any) -> Any:
    """Call a function, await it if it is a coroutine function, and return the result."""
    if inspect.iscoroutinefunction(callback):
        return await callback(*args)
    return callback(*args)
