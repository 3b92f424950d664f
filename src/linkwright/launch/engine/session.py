"""A launch that runs: the queue of events, the visits to entities, the end."""

from __future__ import annotations

import asyncio
import os
from collections import deque
from collections.abc import Callable, Coroutine, Sequence
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import LinkwrightError
from linkwright.launch import events
from linkwright.launch.context import LaunchContext
from linkwright.launch.engine.descriptions import DescriptionError, Descriptions, XacroCall, current_descriptions
from linkwright.launch.engine.hosting import NodeHost
from linkwright.launch.engine.log import LaunchLog
from linkwright.launch.engine.process_table import ProcessTable
from linkwright.launch.engine.reload import LiveReload
from linkwright.launch.entity import LaunchDescriptionEntity
from linkwright.launch.event_handlers import EventHandler
from linkwright.launch.places import located
from linkwright.launch.user_errors import explain
from linkwright.workspace import PackageFinder

if TYPE_CHECKING:
    from tempfile import TemporaryDirectory

_INTERRUPT_GRACE = (1.0, 0.5)
"""Seconds to SIGTERM and from there to SIGKILL on the user's interrupt: all has to end within two seconds."""


@dataclass(frozen=True)
class SessionOptions:
    """How a launch is run.

    Attributes:
        host: the address that the viewer's server binds to.
        port: its port; None for the default one, or the next that is free.
        open_browser: whether the page is opened in the user's browser.
        title: what the page is called.
    """

    host: str = "127.0.0.1"
    port: int | None = None
    open_browser: bool = True
    title: str = ""


class LaunchSession:
    """One launch on the running event loop.

    Args:
        finder: where packages are.
        options: how it is run.
        log: what is printed.
    """

    def __init__(self, finder: PackageFinder, options: SessionOptions, log: LaunchLog) -> None:
        self.finder = finder
        self.options = options
        self.log = log
        self.descriptions = current_descriptions() or Descriptions(finder)
        self.context = LaunchContext()
        self.context.attach(self)
        self.handlers: list[EventHandler] = []
        self.initial_environment = dict(os.environ)
        self.loop: asyncio.AbstractEventLoop | None = None
        self.ending = False
        self._failures: set[object] = set()
        self._visiting = False
        self._queue: deque[events.Event] = deque()
        self._wake = asyncio.Event()
        self._waiting: set[object] = set()
        self._tasks: set[asyncio.Task[Any]] = set()
        self._process_numbers = count(1)
        self._crash: BaseException | None = None
        self._scratch: TemporaryDirectory[str] | None = None
        self.processes = ProcessTable(self)
        self.host = NodeHost(self)
        self.reload = LiveReload(self.descriptions, self.host.show_findings, log)

    async def run(self, description: LaunchDescriptionEntity, locals_: dict[str, Any] | None = None) -> bool:
        """Visit a description and handle events until nothing runs any more.

        Args:
            description: what is launched.
            locals_: values of the moment to begin with, such as the path of the launch file.

        Returns:
            Whether everything started and nothing in the launch failed.
        """
        self.loop = asyncio.get_running_loop()
        self.context.extend_locals(locals_ or {})
        try:
            self.visit(description, self.context)
            await self._start_hosted()
            self.reload.start()
            await self._handle_events()
        finally:
            await self._close()
        return not self._failures

    @property
    def visiting(self) -> bool:
        """Whether the launch file's code runs right now, so that the event loop cannot react."""
        return self._visiting

    @property
    def scratch_folder(self) -> Path:
        """A folder for files that the processes of this launch read; it goes when the launch is over."""
        if self._scratch is None:
            import tempfile

            self._scratch = tempfile.TemporaryDirectory(prefix="linkwright_launch_")
        return Path(self._scratch.name)

    # --- what actions ask for -------------------------------------------------------------------------------

    def emit(self, event: events.Event) -> None:
        """Put an event into the queue."""
        self._queue.append(event)
        self._wake.set()

    def visit(self, entity: LaunchDescriptionEntity, context: LaunchContext) -> None:
        """Visit an entity and all it leads to. An error ends the launch, as in ROS."""
        self._visiting = True
        try:
            self._visit(entity, context)
        except LinkwrightError as error:
            self.log.diagnostics(error.diagnostics)
            self.fail(entity)
            self.host.forget_planned()
            self.emit(events.Shutdown(reason="a launch action failed"))
        except KeyboardInterrupt:
            self.interrupt("user interrupted with ctrl-c (SIGINT)")
        finally:
            self._visiting = False

    def fail(self, what: object) -> None:
        """Take note that something failed: the launch is no success unless it is mended."""
        self._failures.add(what)

    def mend(self, what: object) -> None:
        """Take note that what had failed works now."""
        self._failures.discard(what)

    def number_process(self, base_name: str) -> str:
        """The name of a process in the log: that of its program with the next number."""
        return f"{base_name}-{next(self._process_numbers)}"

    def call_later(
        self, seconds: float, event: events.Event, entities: Sequence[LaunchDescriptionEntity]
    ) -> Callable[[], None]:
        """Visit entities after a while; returns what cancels that."""
        assert self.loop is not None
        token = object()

        def due() -> None:
            self._waiting.discard(token)
            self.emit(event)
            for entity in entities:
                self.visit(entity, self.context)
            self.spawn(self._start_hosted())

        def cancel() -> None:
            handle.cancel()
            self._waiting.discard(token)
            self._wake.set()

        handle = self.loop.call_later(seconds, due)
        self._waiting.add(token)
        return cancel

    # --- the end --------------------------------------------------------------------------------------------

    def interrupt(self, reason: str) -> None:
        """End the launch because the user said so; one that is ending already gets no more time."""
        self.log.caution("launch", reason)
        if self.ending:
            self.processes.kill_all()
        self.emit(events.Shutdown(reason=reason, due_to_sigint=True))

    # --- visits ---------------------------------------------------------------------------------------------

    def _visit(self, entity: LaunchDescriptionEntity, context: LaunchContext) -> None:
        try:
            following = entity.visit(context)
        except DescriptionError as error:
            if error.missing or self.ending:
                raise located(error, entity.place) from error
            self._await_repair(entity, context.snapshot(), error)
            return
        except Exception as error:
            name = type(entity).__name__
            raise explain(error, f"launch action {name}", entity.place) from error
        for each in following or ():
            self._visit(each, context)

    def _await_repair(self, entity: LaunchDescriptionEntity, context: LaunchContext, error: DescriptionError) -> None:
        """Visit an entity again as soon as the model file that it needs can be expanded."""
        self.fail(error.call)

        def again(_text: str) -> None:
            self.reload.unbind(error.call, again)
            self.mend(error.call)
            self.visit(entity, context)
            self.spawn(self._start_hosted())

        self.reload.bind(error.call, again)
        self.reload.report(error.call, error.diagnostics)

    # --- events ---------------------------------------------------------------------------------------------

    async def _handle_events(self) -> None:
        while True:
            if self._crash is not None:
                raise self._crash
            while self._queue:
                self._handle(self._queue.popleft())
                await self._start_hosted()
            if not self._is_busy():
                if self.ending:
                    return
                self.emit(events.Shutdown(reason="idle"))
                continue
            self._wake.clear()
            await self._wake.wait()

    def _is_busy(self) -> bool:
        return bool(self.processes.is_busy or self._tasks or self._waiting or self.host.is_busy)

    def _handle(self, event: events.Event) -> None:
        if self.ending and isinstance(event, events.Shutdown):
            return  # once is enough
        context = self.context
        context.push_locals()
        try:
            entities: list[LaunchDescriptionEntity] = []
            for handler in tuple(self.handlers):
                if handler.matches(event):
                    entities += handler.handle(event, context)
                    if handler.handle_once:
                        self.handlers.remove(handler)
            if isinstance(event, events.ProcessExited):
                context.extend_locals({"event": event})
                entities += event.action.exited(event, context)
            for entity in entities:
                self.visit(entity, context)
        except Exception as error:  # noqa: BLE001 - handlers are the launch file's code
            self.log.diagnostics(explain(error, "an event handler").diagnostics)
            self.fail(event)
            self.emit(events.Shutdown(reason="an event handler failed"))
        finally:
            context.pop_locals()
        self._react(event)

    def _react(self, event: events.Event) -> None:
        """What the launcher itself does about an event."""
        if isinstance(event, events.Shutdown):
            self._begin_end(event)
        elif isinstance(event, events.ShutdownProcess):
            self.processes.stop_matching(event.process_matcher)
            self.host.stop_matching(event.process_matcher)
        elif isinstance(event, events.SignalProcess):
            self.processes.signal_matching(event.process_matcher, event.signal)
            self.host.stop_matching(event.process_matcher)

    def _begin_end(self, event: events.Shutdown) -> None:
        self.ending = True
        self._waiting.clear()
        self.reload.close()
        self.host.close_nodes()
        self.processes.stop_all(_INTERRUPT_GRACE if event.due_to_sigint else None)

    async def _start_hosted(self) -> None:
        await self.host.start_planned()
        waits = any(isinstance(failure, XacroCall) for failure in self._failures)
        if waits and not self.host.has_viewer and not self.ending:
            self.emit(events.Shutdown(reason="the robot cannot be read, and there is no viewer to wait in"))

    def spawn(self, work: Coroutine[Any, Any, None]) -> None:
        """Have something done beside; the launch does not end before it is."""
        assert self.loop is not None
        task = self.loop.create_task(work)
        self._tasks.add(task)

        def done(task: asyncio.Task[Any]) -> None:
            self._tasks.discard(task)
            self._wake.set()
            if not task.cancelled() and task.exception() is not None:
                self._crash = task.exception()

        task.add_done_callback(done)

    async def _close(self) -> None:
        self.reload.close()
        self.processes.kill_all()
        for task in tuple(self._tasks):
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        await self.host.close()
        if self._scratch is not None:
            self._scratch.cleanup()
        self.log.close()
