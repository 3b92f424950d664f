"""A program with a ``main``, which runs in lockstep with a stepped graph."""

from __future__ import annotations

import importlib
import os
import random
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any, cast

from linkwright.graph import Graph
from linkwright.graph.faults import ExternalShutdownException, RclError
from linkwright.standins.rclpy_api.signals import SignalHandlerOptions
from linkwright.standins.rclpy_api.state import RclpyState, use_state
from linkwright.testing.programs.graphs import ProgramGraph
from linkwright.testing.programs.threads import EndedByTest, LockstepThread, Turns

Main = str | Path | Callable[[], object]


class Program:
    """A program that runs in a stepped graph, created by `SteppedGraph.start_program`.

    Attributes:
        exit_code: None while the program runs. Then 0, 1 after an exception, the argument of ``sys.exit`` (1 if it is a
            text), or a negated signal number: of SIGINT after `interrupt`, of SIGTERM if the test ended the program.
        error: the exception that ended the program, or None.
    """

    def __init__(self, main: Main, arguments: Sequence[str], graph: Graph, turns: Turns, seed: int) -> None:
        self.name, self._main_function = _find_main(main)
        self.exit_code: int | None = None
        self.error: BaseException | None = None
        self.is_interrupted = False
        self._module = ModuleType("__main__")
        self._folders = _find_module_folders(Path(self.name)) if _is_path(main) else []
        self._arguments = [self.name, *arguments]
        self._graphs: list[ProgramGraph] = []
        self._state = RclpyState(partial(self._create_graph, graph))
        self._seed = seed
        self._signal_handlers: dict[int, Any] = {signal.SIGINT: signal.default_int_handler}
        self._main_thread = LockstepThread(turns, self, is_daemon=False)
        self._threads = [self._main_thread]
        thread = threading.Thread(target=self._run, name=self.name, daemon=True)
        thread.start()
        self._main_thread.wake()

    @property
    def is_running(self) -> bool:
        """Whether the program is still running."""
        return any(not thread.ended.ended() and not thread.is_daemon for thread in self._threads)

    @property
    def has_threads(self) -> bool:
        """Whether any thread of the program is still running."""
        return any(not thread.ended.ended() for thread in self._threads)

    @property
    def node_names(self) -> list[tuple[str, str]]:
        """The name and the namespace of each current node of the program."""
        return [names for graph in self._graphs for names in graph.node_names]

    def interrupt(self) -> None:
        """Interrupt the program like Ctrl-C.

        rclpy shuts down, and the main thread gets a KeyboardInterrupt. rclpy does not shut down if the program disabled
        this with ``signal_handler_options`` of ``rclpy.init``.
        """
        self.is_interrupted = True
        if self._state.signal_options & SignalHandlerOptions.SIGINT:
            for context in tuple(self._state.open_contexts):
                context.shutdown_by_signal()
        handler = self._signal_handlers[signal.SIGINT]
        if callable(handler):
            self._main_thread.interrupt(partial(handler, signal.SIGINT, None))

    def kill(self) -> None:
        """End all threads of the program in their current waits."""
        for thread in self._threads:
            if not thread.ended.ended():
                thread.kill()

    # --- called by the threads ---------------------------------------------------------------------------------------

    @contextmanager
    def surroundings(self) -> Iterator[None]:
        """Set up the program's environment for a turn of a thread, as a context manager.

        The environment consists of the arguments, the main module, the imported modules and rclpy.
        """
        argv, main_module, path = sys.argv, sys.modules["__main__"], list(sys.path)
        sys.argv, sys.modules["__main__"] = self._arguments, self._module
        sys.path[:0] = self._folders
        try:
            with use_state(self._state):
                yield
        finally:
            sys.argv, sys.modules["__main__"] = argv, main_module
            if self._folders:
                sys.path[:] = path

    def add(self, thread: LockstepThread) -> None:
        """Register a thread that the program starts."""
        self._threads = [thread for thread in self._threads if not thread.ended.ended()]
        self._threads.append(thread)
        thread.ended.add_waiter(self._end_if_done)

    def set_signal_handler(self, number: int, handler: Any) -> Any:
        """Set the handler of a signal, and return the previous one."""
        previous_handler = self._signal_handlers.get(number, signal.SIG_DFL)
        self._signal_handlers[number] = handler
        return previous_handler

    def _create_graph(self, graph: Graph) -> Graph:
        self._graphs.append(ProgramGraph(graph))
        return cast("Graph", self._graphs[-1])

    # --- running -----------------------------------------------------------------------------------------------------

    def run_file(self, path: Path, source: bytes) -> None:
        """Run a file like ``python FILE``.

        If the file only defines ``main``, the function is called as by ``ros2 run``.
        """
        self._module.__file__ = str(path)
        code = compile(source, str(path), "exec")
        exec(code, vars(self._module))  # noqa: S102  # the user's program
        main = vars(self._module).get("main")
        if callable(main) and "__name__" not in code.co_names and not self._graphs:
            main()

    def _run(self) -> None:
        thread = self._main_thread
        thread.begin()
        try:
            self._call_main()
        finally:
            thread.ended.add_waiter(self._end_if_done)
            thread.end()

    def _call_main(self) -> None:
        try:
            _seed_random_numbers(self._seed)
            self._main_function(self)
            self.exit_code = 0
        except EndedByTest:
            self.exit_code = -signal.SIGTERM
        except SystemExit as end:
            self.exit_code = end.code if isinstance(end.code, int) else int(end.code is not None)
        except BaseException as error:  # noqa: BLE001  # the test raises it
            is_interruption = self.is_interrupted and isinstance(error, (KeyboardInterrupt, ExternalShutdownException))
            self.exit_code = -signal.SIGINT if is_interruption else 1
            if self.is_interrupted and isinstance(error, RclError):  # rclpy was used after the final Ctrl-C
                traceback.print_exception(error)
            elif not is_interruption:
                self.error = error

    def _end_if_done(self) -> None:
        """End the daemon threads and the context after the last other thread, as in a process."""
        if self.is_running:
            return
        with use_state(self._state):
            for context in tuple(self._state.open_contexts):
                context.try_shutdown()
        self.kill()


def _seed_random_numbers(seed: int) -> None:
    random.seed(seed)
    with suppress(ImportError):
        import numpy as np  # Seed these modules now, because the program may import them later.

        np.random.seed(seed)  # These generators serve programs that do not create their own.


def _is_path(main: Main) -> bool:
    return isinstance(main, Path) or (isinstance(main, str) and (main.endswith(".py") or os.sep in main))


def _find_module_folders(path: Path) -> list[str]:
    """Return the folders of the modules that a file can import.

    They are the folder of the file, and the parent folder of its Python package.
    """
    folder = path.parent
    package_folder = folder
    while (package_folder / "__init__.py").is_file():
        package_folder = package_folder.parent
    return list(dict.fromkeys(map(str, (folder, package_folder))))


def _find_main(main: Main) -> tuple[str, Callable[[Program], object]]:
    """Return the name of a program, and a function that runs it."""
    if isinstance(main, (str, Path)) and _is_path(main):
        path = Path(main).resolve()
        source = path.read_bytes()
        return str(path), lambda program: program.run_file(path, source)
    if isinstance(main, str):
        return main, lambda _: importlib.import_module(main).main()
    function = cast("Callable[[], object]", main)
    return getattr(function, "__name__", type(function).__name__), lambda _: function()
