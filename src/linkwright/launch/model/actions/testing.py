"""Actions of ``launch_testing`` that launch files of tests have in them.

The tests themselves are run by ``launch_testing``; here such a launch file can be launched as any other.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

from linkwright.launch.model.action import Action
from linkwright.launch.model.actions.execute import ExecuteProcess
from linkwright.launch.model.markup.expose import expose_action

if TYPE_CHECKING:
    from linkwright.launch.model.context import LaunchContext
    from linkwright.launch.model.description import LaunchDescription

F = TypeVar("F", bound=Callable[..., Any])

_WAIT = "import signal, threading; signal.signal(signal.SIGINT, lambda *_: exit(0)); threading.Event().wait()"


@expose_action("ready_to_test")
class ReadyToTest(Action):
    """Says that tests may begin; has no effect outside of tests."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._callbacks: list[Callable[[], object]] = []

    def _add_callback(self, callback: Callable[[], object]) -> None:
        """Have a function called when it is executed."""
        self._callbacks.append(callback)

    def execute(self, context: LaunchContext) -> None:
        """Emit the event."""
        for callback in self._callbacks:
            callback()


class KeepAliveProc(ExecuteProcess):
    """A process that does nothing until the launch ends, so that it does not end by itself."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(cmd=[sys.executable, "-c", _WAIT], name="keep_alive", **kwargs)


def keep_alive(test_description: F) -> F:
    """Decorates the function that makes a description: what it makes does not end by itself."""
    import functools

    @functools.wraps(test_description)
    def wrapper(*args: Any, **kwargs: Any) -> Any:
        made = test_description(*args, **kwargs)
        description: LaunchDescription = made[0] if isinstance(made, tuple) else made
        description.add_action(KeepAliveProc())
        return made

    return wrapper  # type: ignore[return-value]  # wraps gives it the signature of F
