"""The actions of ``launch_testing``, for the launch files of tests.

Any launch can run these launch files. ``launch_test`` also runs the tests in them; see
`linkwright.launch.standins.launch_testing_api`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from linkwright.launch.model import events
from linkwright.launch.model.action import Action
from linkwright.launch.model.actions.events import EmitEvent
from linkwright.launch.model.actions.execute import ExecuteProcess
from linkwright.launch.model.actions.timer import TimerAction
from linkwright.launch.model.entity import LaunchDescriptionEntity
from linkwright.launch.model.markup.expose import expose_action
from linkwright.launch.model.substitution import SomeSubstitutionsType

if TYPE_CHECKING:
    from linkwright.launch.model.context import LaunchContext


@expose_action("ready_to_test")
class ReadyToTest(Action):
    """Signals that tests may start.

    Outside of tests, this action has no effect.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._callbacks: list[Callable[[], object]] = []

    def _add_callback(self, callback: Callable[[], object]) -> None:
        """Register a function to call when the action is executed."""
        self._callbacks.append(callback)

    def execute(self, context: LaunchContext) -> None:
        """Call the functions that `_add_callback` registered."""
        for callback in self._callbacks:
            callback()


def find_ready_actions(entities: Iterable[LaunchDescriptionEntity]) -> Iterator[ReadyToTest]:
    """Yield the `ReadyToTest` actions among entities and their descendants."""
    for entity in entities:
        if isinstance(entity, ReadyToTest):
            yield entity
        yield from find_ready_actions(entity.describe_sub_entities())
        for _, children in entity.describe_conditional_sub_entities():
            yield from find_ready_actions(children)


class Test(ExecuteProcess):
    """A process that runs a test.

    Args:
        timeout: the seconds after which the process is shut down; None for no limit.
        kill_timeout: has no effect, as in ROS.
        kwargs: see `ExecuteProcess`.
    """

    __test__ = False  # keeps pytest from collecting the class as a test

    def __init__(
        self,
        *,
        timeout: float | SomeSubstitutionsType | None = None,
        kill_timeout: float | SomeSubstitutionsType = 5.0,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._timeout = timeout
        self._timer: TimerAction | None = None

    @property
    def timeout(self) -> Any:
        """The timeout as passed to the constructor: seconds, substitutions, or None."""
        return self._timeout

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Start the test, and return the entities to visit next, such as the timer of the timeout."""
        entities = list(super().execute(context) or ())
        if self._timeout is not None:
            shutdown_action = EmitEvent(event=events.ShutdownProcess(process_matcher=events.matches_action(self)))
            self._timer = TimerAction(period=self._timeout, actions=[shutdown_action])
            entities.append(self._timer)
        return entities

    def record_exit(self, event: events.ProcessExited, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Cancel the timer of the timeout, and return the entities to visit next."""
        if self._timer is not None:
            self._timer.cancel()
        return super().record_exit(event, context)


class GTest(Test):
    """A test in a compiled program.

    Args:
        path: the path of the program.
        kwargs: see `Test`.
    """

    def __init__(self, *, path: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(cmd=[path], **kwargs)
        self.path = path


class PyTest(Test):
    """A test file that pytest runs.

    Args:
        path: the path of the test file.
        kwargs: see `Test`.
    """

    def __init__(self, *, path: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(cmd=[sys.executable, "-m", "pytest", path], **kwargs)
        self.path = path
