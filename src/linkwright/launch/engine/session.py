"""A running launch: its event queue, the visits to its entities, and its shutdown."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Coroutine, Sequence
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.hosting.launch_log import LaunchLog
from linkwright.hosting.node_host import NodeHost
from linkwright.hosting.reload import LiveReload
from linkwright.hosting.xacro_calls import DescriptionError, Descriptions, XacroCall, current_descriptions
from linkwright.launch.engine.omissions import Omissions
from linkwright.launch.engine.process_table import ProcessTable
from linkwright.launch.engine.supervisor import SessionOptions
from linkwright.launch.engine.unwritten_files import find_unwritten_file, wait_until_written
from linkwright.launch.errors.locations import with_location
from linkwright.launch.errors.user_code import MAX_NESTING_DEPTH, endless_nesting_error, explain
from linkwright.launch.log.loggers import launch_config
from linkwright.launch.model import events
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.entity import LaunchDescriptionEntity, as_entities
from linkwright.packages import PackageFinder

if TYPE_CHECKING:
    from linkwright.files.scratch_folders import ScratchFolder
    from linkwright.hosting.plans import HostedPlan
    from linkwright.launch.model.plans import ProcessPlan
    from linkwright.launch.model.running_launch import Schedule


_REPORT_DELAY_S = 1.0
"""The seconds after Ctrl-C until the processes that delay the end are logged."""


class LaunchSession:
    """A launch that runs on the current event loop.

    Args:
        finder: the finder of ROS packages.
        options: the options of the launch.
        log: the log of the launch.
        context: an existing context with its handlers and queued events; None to create a new one.
    """

    def __init__(
        self, finder: PackageFinder, options: SessionOptions, log: LaunchLog, context: LaunchContext | None = None
    ) -> None:
        self.finder = finder
        self.options = options
        self.log = log
        self.descriptions = current_descriptions() or Descriptions(finder)
        self.context = LaunchContext() if context is None else context
        self._queue = self.context.attach(self)
        self.loop: asyncio.AbstractEventLoop | None = None
        self.is_ending = False
        self._failures: set[object] = set()
        self._is_visiting = False
        self._is_shutdown_requested = False
        self._wake_event = asyncio.Event()
        self._queue.on_put = self._wake_event.set
        self._awaited_futures: set[asyncio.Future[Any]] = set()
        self._scheduled_calls: dict[object, Callable[[], None] | None] = {}
        self._tasks: set[asyncio.Task[Any]] = set()
        self._process_numbers = count(1)
        self._exception: BaseException | None = None
        self._scratch: ScratchFolder | None = None
        self._included_descriptions: deque[LaunchDescriptionEntity] = deque()
        self.skipped_nodes: set[str] = set()
        self._omissions = Omissions(log, options.command_to_skip_missing, skip_all=options.skip_missing)
        self.processes = ProcessTable(self)
        self.host = NodeHost(self)
        self.reload = LiveReload(self.descriptions, self.host.show_findings, log)

    async def run(self, description: LaunchDescriptionEntity, locals_: dict[str, Any] | None = None) -> bool:
        """Visit a description, and handle events until the launch ends.

        Args:
            description: the launch description.
            locals_: the initial locals of the context, such as the path of the launch file.

        Returns:
            Whether the launch succeeded. A launch without failures still fails if parts were skipped without
            `skip_missing` and no other part started a process or node.
        """
        self.loop = asyncio.get_running_loop()
        self.context.extend_locals(locals_ or {})
        self.log.begin()
        launch_config.use_launch_folder(self.log.folder)
        try:
            self.visit(description, self.context)
            self._visit_included()
            await self._start_hosted()
            self.reload.start()
            await self._handle_events()
        finally:
            await self._close()
        has_run_nothing = (
            self._omissions.has_skipped and not self.options.skip_missing and next(self._process_numbers) == 1
        )
        return not (self._failures or has_run_nothing)

    @property
    def is_blocking(self) -> bool:
        """Whether the event loop is blocked because code of the launch file is running."""
        return self._is_visiting

    @property
    def scratch_folder(self) -> Path:
        """A folder for files that the processes of this launch read.

        The folder is created on first access, and deleted after the launch.
        """
        if self._scratch is None:
            from linkwright.files.scratch_folders import ScratchFolder

            self._scratch = ScratchFolder("launch")
            self.processes.register_folder(Path(self._scratch.name))
        return Path(self._scratch.name)

    def include(self, description: LaunchDescriptionEntity) -> None:
        """Queue a description to be visited.

        This method may be called from any thread, also before the run.
        """
        self._included_descriptions.append(description)
        if self.loop is not None:
            self.loop.call_soon_threadsafe(self._visit_included)

    # --- requests from actions ------------------------------------------------------------------------------

    def emit(self, event: events.Event) -> None:
        """Queue an event."""
        self._queue.put_nowait(event)

    def visit(self, entity: LaunchDescriptionEntity, context: LaunchContext) -> None:
        """Visit an entity and the entities that it returns.

        As in ROS, an error ends the launch.
        """
        self._is_visiting = True
        try:
            self._visit(entity, context)
        except LinkwrightError as error:
            self.log.write_diagnostics(self._omissions.with_skip_command(error))
            self.fail(entity)
            self.host.discard_planned()
            self.shut_down("a launch action failed")
        except KeyboardInterrupt:
            self.interrupt("user interrupted with ctrl-c (SIGINT)")
        finally:
            self._is_visiting = False
            self._omissions.report()

    def report_start_failure(self, subject: object, error: LinkwrightError) -> None:
        """Report why a process or node could not be started.

        The launch continues without it.
        """
        if self._omissions.skip(error):
            self._omissions.report()
            return
        self.log.write_diagnostics(error.diagnostics)
        self.fail(subject)

    def fail(self, failure: object) -> None:
        """Record a failure.

        The launch exits with status 1 unless the failure is cleared.
        """
        self._failures.add(failure)

    def clear_failure(self, failure: object) -> None:
        """Clear a failure whose cause has been fixed."""
        self._failures.discard(failure)

    @property
    def isolates_nodes(self) -> bool:
        """Whether Linkwright's own nodes run in separate processes."""
        return self.options.isolate

    @property
    def has_processes(self) -> bool:
        """Whether any process is running."""
        return self.processes.is_busy

    def start_process(self, plan: ProcessPlan, name: str) -> None:
        """Start a process, monitor it until it ends, and respawn it if the plan requests a respawn."""
        self.processes.start(plan, name)

    def would_handle(self, event: events.Event) -> bool:
        """Return whether any handler accepts an event."""
        return self.context.would_handle_event(event)

    def report(self, description: object, findings: Sequence[Diagnostic]) -> None:
        """Report findings about a robot description in the log and the viewer."""
        self.reload.report(description, findings)

    def assign_process_name(self, base_name: str) -> str:
        """Return the name of a process in the log: its base name with the next number."""
        return f"{base_name}-{next(self._process_numbers)}"

    def call_later(
        self,
        seconds: float,
        event: events.Event,
        entities: Sequence[object],
        *,
        cancel_on_shutdown: bool = True,
        schedule: Schedule | None = None,
    ) -> Callable[[], None]:
        """Emit an event and visit entities with the current locals, after a delay.

        Args:
            seconds: the delay in seconds.
            event: the event to emit after the delay.
            entities: the entities to visit after the delay.
            cancel_on_shutdown: whether a shutdown of the launch cancels the event and the visit.
            schedule: the function that schedules the call; None for the event loop of the launch.

        Returns:
            A function that cancels the event and the visit.
        """
        assert self.loop is not None
        token = object()
        next_entities = as_entities(entities)
        local_values = self.context.get_locals_as_dict()

        def run_scheduled() -> None:
            self._scheduled_calls.pop(token, None)
            self.emit(event)
            self.context.push_locals()
            self.context.extend_locals(local_values)
            try:
                for entity in next_entities:
                    self.visit(entity, self.context)
            finally:
                self.context.pop_locals()
            self.spawn(self._start_hosted())

        def cancel() -> None:
            handle.cancel()
            self._scheduled_calls.pop(token, None)
            self._wake_event.set()

        handle = (schedule or self.loop.call_later)(seconds, run_scheduled)
        self._scheduled_calls[token] = cancel if cancel_on_shutdown else None
        return cancel

    # --- reports from the nodes of this process ---------------------------------------------------------------

    def postpones(self, plan: HostedPlan) -> bool:
        """Return whether a node waits for a file that a process is writing. Then the node is started later."""
        path = find_unwritten_file(plan, self.processes)
        if path is None:
            return False
        self.log.write_info(plan.process_name, f"waiting for '{path}', which another process may be writing")
        self.spawn(self._start_when_written(plan, path))
        return True

    async def _start_when_written(self, plan: HostedPlan, path: str) -> None:
        await wait_until_written(path, self.processes)
        self.host.schedule_node(plan)
        await self._start_hosted()

    def report_node_start(self, plan: HostedPlan) -> None:
        """Report that a node in the launcher's process is running."""
        plan.owner.process_details = plan.details
        self.emit(events.ProcessStarted(action=plan.owner, **plan.details))

    def report_node_end(self, plan: HostedPlan, status: int) -> None:
        """Report the exit status of a node in the launcher's process.

        The node has ended or could not start.
        """
        self.emit(events.ProcessExited(action=plan.owner, returncode=status, **plan.details))

    # --- shutdown -------------------------------------------------------------------------------------------

    def shut_down(self, reason: str) -> None:
        """End the launch after the events that are already queued have been handled.

        Only the first request has an effect: a handler of the shutdown that fails must not cause another shutdown.
        """
        if not self._is_shutdown_requested:
            self._is_shutdown_requested = True
            self.emit(events.Shutdown(reason=reason))

    def interrupt(self, reason: str) -> None:
        """End the launch because the user interrupted it.

        If the launch is already ending, its processes receive SIGTERM now, and SIGKILL half a second later.
        """
        self.log.write_warning("launch", reason)
        if self.is_ending:
            self.processes.escalate()
            return
        self.emit(events.Shutdown(reason=reason, due_to_sigint=True))
        if self.loop is not None:
            self.loop.call_later(_REPORT_DELAY_S, self._log_running_processes)

    def seconds_to_end(self) -> float:
        """Return the maximum time in seconds until the processes end."""
        return self.processes.seconds_to_end()

    def kill_all(self) -> None:
        """Kill the processes immediately.

        A signal handler may call this method.
        """
        self.processes.kill_all()

    def _log_running_processes(self) -> None:
        names = self.processes.names
        if names:
            self.log.write_info("launch", f"waiting for {', '.join(names)} to end; press Ctrl-C again to end them now")

    # --- visits ---------------------------------------------------------------------------------------------

    def _visit(self, entity: LaunchDescriptionEntity, context: LaunchContext, depth: int = 1) -> None:
        if depth > MAX_NESTING_DEPTH:
            raise endless_nesting_error(entity.source_location)
        try:
            next_entities = entity.visit(context)
        except DescriptionError as error:
            if not (error.is_missing or self.is_ending):
                self._retry_when_fixed(entity, context.snapshot(), error)
            elif not self._omissions.skip(with_location(error, entity.source_location)):
                raise
            return
        except (Exception, SystemExit) as error:
            name = type(entity).__name__
            explained_error = explain(error, phrase("launch action {name}", name=name), entity.source_location)
            if self._omissions.skip(explained_error):
                return
            raise explained_error from error
        future = entity.get_asyncio_future()
        if future is not None:
            self.keep_running_until(future)
        try:
            for next_entity in next_entities or ():
                self._visit(next_entity, context, depth + 1)
        except LinkwrightError as error:
            raise with_location(entity.explain_inside(error), entity.source_location) from error

    def _retry_when_fixed(
        self, entity: LaunchDescriptionEntity, context: LaunchContext, error: DescriptionError
    ) -> None:
        """Record a failure, and visit the entity again when its robot description can be expanded."""
        self.fail(error.call)

        def visit_again(_text: str) -> None:
            self.reload.unbind(error.call, visit_again)
            self.clear_failure(error.call)
            self.visit(entity, context)
            self.spawn(self._start_hosted())

        self.reload.bind(error.call, visit_again)
        self.reload.report(error.call, error.diagnostics)

    # --- events ---------------------------------------------------------------------------------------------

    async def _handle_events(self) -> None:
        while True:
            if self._exception is not None:
                raise self._exception
            while not self._queue.empty():
                self._handle(self._queue.get_nowait())
                await self._start_hosted()
            if not self._is_busy():
                if self.is_ending:
                    return
                if self.options.shutdown_when_idle:
                    self.shut_down("idle")
                    continue
            self._wake_event.clear()
            await self._wake_event.wait()

    def _is_busy(self) -> bool:
        return bool(
            self.processes.is_busy or self._tasks or self._scheduled_calls or self._awaited_futures or self.host.is_busy
        )

    def _handle(self, event: events.Event) -> None:
        self.log.write_debug("launch", f"processing event: '{event.name}'")
        context = self.context
        self._is_shutdown_requested |= isinstance(event, events.Shutdown)
        context.push_locals()
        try:
            entities: list[LaunchDescriptionEntity] = []
            for handler in context.matching_handlers(event):
                entities += as_entities(handler.handle(event, context))
            if isinstance(event, events.ProcessExited):
                context.extend_locals({"event": event})
                entities += event.action.record_exit(event, context)
            for entity in entities:
                self.visit(entity, context)
        except (Exception, SystemExit) as error:  # noqa: BLE001 - handlers are the launch file's code
            self.log.write_diagnostics(explain(error, phrase("an event handler")).diagnostics)
            self.fail(event)
            if not self.is_ending and not isinstance(event, events.Shutdown):
                self.shut_down("an event handler failed")
        finally:
            context.pop_locals()
        self._react(event)

    def _react(self, event: events.Event) -> None:
        """End the launch, or stop or signal processes, as the event requests."""
        if isinstance(event, events.Shutdown):
            if not self.is_ending:
                self._begin_shutdown(event)
        elif isinstance(event, events.ShutdownProcess):
            self.processes.stop_matching(event.process_matcher)
            self.host.stop_matching(event.process_matcher)
        elif isinstance(event, events.SignalProcess):
            self.processes.signal_matching(event.process_matcher, event.signal)
            self.host.stop_matching(event.process_matcher)

    def _begin_shutdown(self, event: events.Shutdown) -> None:
        self.is_ending = True
        for cancel in tuple(self._scheduled_calls.values()):
            if cancel is not None:
                cancel()
        self.reload.close()
        self.host.close_nodes()
        self.processes.stop_all(interrupted=event.due_to_sigint)

    def _visit_included(self) -> None:
        while self._included_descriptions:
            self.visit(self._included_descriptions.popleft(), self.context)
            self.spawn(self._start_hosted())

    async def _start_hosted(self) -> None:
        await self.host.start_planned()
        waits_for_fix = any(isinstance(failure, XacroCall) for failure in self._failures)
        if waits_for_fix and not self.host.has_viewer and not self.is_ending:
            self.shut_down("the robot description has errors, and there is no viewer that waits for a fix")

    def keep_running_until(self, future: asyncio.Future[Any]) -> None:
        """Keep the launch running until a future is done."""
        if future.done() or future in self._awaited_futures:
            return
        self._awaited_futures.add(future)

        def release_future(future: asyncio.Future[Any]) -> None:
            self._awaited_futures.discard(future)
            self._wake_event.set()

        future.add_done_callback(release_future)

    def spawn(self, coroutine: Coroutine[Any, Any, None]) -> None:
        """Run a coroutine in the background.

        The launch does not become idle until the coroutine has finished.
        """
        assert self.loop is not None
        task = self.loop.create_task(coroutine)
        self._tasks.add(task)

        def handle_task_end(task: asyncio.Task[Any]) -> None:
            self._tasks.discard(task)
            self._wake_event.set()
            if not task.cancelled() and task.exception() is not None:
                self._exception = task.exception()

        task.add_done_callback(handle_task_end)

    async def _close(self) -> None:
        self.reload.close()
        self.processes.kill_all()
        for task in tuple(self._tasks):
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        await self.host.close()
        self.processes.close()
        if self._scratch is not None:
            self._scratch.cleanup()
        self.log.close()
