"""The service that runs launches from a user's program (``launch.LaunchService``)."""

from __future__ import annotations

import asyncio
import os
import sys
import threading
from collections.abc import Coroutine, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.launch.model import events
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.model.event_handlers import OnIncludeLaunchDescription
from linkwright.launch.model.launch_utilities import get_loop

if TYPE_CHECKING:
    from linkwright.launch.engine.session import LaunchSession

_DEFAULT_LOG_NAME = "launch.log"


class LaunchService:
    """A runner of launch descriptions.

    Args:
        argv: the command-line arguments, which entities can read from the launch context.
        noninteractive: whether there is no terminal. Without one, Ctrl-C does not reach the processes directly.
        debug: whether to log details.
        log_file_name: the name of the log file.

    Descriptions and events that are added before a run are handled when the run starts. Event handlers remain
    registered for the next run.
    """

    _isolates_nodes = False
    """Whether Linkwright's own nodes run in separate processes."""

    def __init__(
        self,
        *,
        argv: Iterable[str] | None = None,
        noninteractive: bool = False,
        debug: bool = False,
        log_file_name: str = _DEFAULT_LOG_NAME,
    ) -> None:
        self._log_file_name = log_file_name if log_file_name.endswith(".log") else f"{log_file_name}.log"
        self._logger_name = self._log_file_name.removesuffix(".log")
        self._debug = debug
        self.__context = LaunchContext(argv=argv, noninteractive=noninteractive)
        self.__context.register_event_handler(OnIncludeLaunchDescription())
        self.__session: LaunchSession | None = None
        self.__task: asyncio.Task[Any] | None = None
        self.__lock = threading.RLock()

    @property
    def context(self) -> LaunchContext:
        """The context of the launch."""
        return self.__context

    @property
    def event_loop(self) -> asyncio.AbstractEventLoop | None:
        """The event loop of the launch, or None if the launch is not running."""
        return None if self.__session is None else self.__session.loop

    @property
    def task(self) -> asyncio.Task[Any] | None:
        """The task of the current run, or None if the launch is not running."""
        return self.__task

    def include_launch_description(self, launch_description: LaunchDescription) -> None:
        """Queue a description to be visited.

        This method may be called from any thread.
        """
        self.emit_event(events.IncludeLaunchDescription(launch_description))

    def emit_event(self, event: Any) -> None:
        """Queue an event to be handled.

        This method may be called from any thread, also before the run.
        """
        with self.__lock:
            loop = self.event_loop
            if loop is None or threading.current_thread() is threading.main_thread():
                self.__context.emit_event_sync(event)
            else:
                loop.call_soon_threadsafe(self.__context.emit_event_sync, event)

    def shutdown(self, force_sync: bool = False) -> Coroutine[Any, Any, None] | None:
        """Shut the launch down.

        This method may be called from any thread, and has no effect if the launch is not running.

        Returns:
            An awaitable if the caller is on the launch's event loop or between two runs of that loop, and `force_sync`
            is not set. Otherwise None.
        """
        if self.__session is None:
            return None
        self.emit_event(events.Shutdown(reason="LaunchService.shutdown() called"))
        return asyncio.sleep(0) if self.__is_thread_of_loop() and not force_sync else None

    def __is_thread_of_loop(self) -> bool:
        """Return whether the caller is on the thread of the launch's event loop."""
        try:
            return asyncio.get_running_loop() is self.event_loop
        except RuntimeError:
            loop = self.event_loop
            return loop is not None and not loop.is_running()

    def run(self, *, shutdown_when_idle: bool = True) -> int:
        """Run the launch until it is idle, and return its exit status.

        Args:
            shutdown_when_idle: whether the launch ends when it is idle. If False, only `shutdown` and signals end it.

        Returns:
            0 if the launch succeeded, and 1 if something in it failed.

        Raises:
            RuntimeError: the service is already running, or the caller is not on the main thread.
        """
        loop = get_loop()
        asyncio.set_event_loop(loop)  # the loop stays set for the thread, as in ROS
        try:
            return loop.run_until_complete(self.run_async(shutdown_when_idle=shutdown_when_idle))
        finally:
            _end_tasks(loop)

    async def run_async(self, *, shutdown_when_idle: bool = True) -> int:
        """Run the launch as a coroutine on the running event loop. See `run`."""
        from linkwright.hosting.launch_log import LaunchLog
        from linkwright.hosting.signals import SignalWatch
        from linkwright.hosting.xacro_calls import Descriptions, use_descriptions
        from linkwright.launch.engine.session import LaunchSession
        from linkwright.launch.engine.supervisor import SessionOptions
        from linkwright.packages import PackageFinder, use_finder

        if threading.current_thread() is not threading.main_thread():
            raise RuntimeError("LaunchService can only be run in the main thread.")
        with self.__lock:
            if self.__session is not None:
                raise RuntimeError("LaunchService cannot be run multiple times concurrently.")
            finder = PackageFinder(start=_find_starting_folders())
            options = SessionOptions(
                open_browser=False, isolate=self._isolates_nodes, shutdown_when_idle=shutdown_when_idle
            )
            session = LaunchSession(finder, options, LaunchLog(debug=self._debug), self.__context)
            session.loop = asyncio.get_running_loop()
            self.__session = session
        self.__task = asyncio.current_task()
        try:
            with SignalWatch() as signals, use_finder(finder), use_descriptions(Descriptions(finder)):
                signals.session = session
                succeeded = await session.run(LaunchDescription())
        finally:
            with self.__lock:
                self.__session = None
                self.__task = None
                self.__context.detach()
        return 0 if succeeded else 1


def _end_tasks(loop: asyncio.AbstractEventLoop) -> None:
    """Cancel the remaining tasks of an event loop, unless the loop is still running."""
    if loop.is_running():
        return
    remaining_tasks = asyncio.all_tasks(loop)
    for task in remaining_tasks:
        task.cancel()
    loop.run_until_complete(asyncio.gather(*remaining_tasks, return_exceptions=True))
    loop.run_until_complete(loop.shutdown_asyncgens())


class ProcessLaunchService(LaunchService):
    """A launch service that runs every node as a process.

    Tests can therefore observe the output and exit status of each node.
    """

    _isolates_nodes = True


def _find_starting_folders() -> list[Path]:
    """Return the folders where the search for packages starts.

    These are the folder of the program and the current folder.
    """
    program = Path(sys.argv[0]).absolute().parent if sys.argv and sys.argv[0] else Path.cwd()
    return [program, Path(os.getcwd())]  # noqa: PTH109 - the folder may no longer exist
