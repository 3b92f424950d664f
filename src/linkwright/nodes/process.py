"""One of our nodes as a process of its own: ``python -m linkwright.node_program PACKAGE EXECUTABLE ARGUMENTS``."""

from __future__ import annotations

import asyncio
import contextlib
import signal
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, print_diagnostics
from linkwright.event_loop import run_coroutine
from linkwright.interruption import raise_interrupts

if TYPE_CHECKING:
    from linkwright.graph.log.setup import Logging
    from linkwright.nodes.options import Factory

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


def main(package: str, executable: str, arguments: Sequence[str]) -> int:
    """Run a node until it is done, or told to end by SIGINT or SIGTERM, which end it cleanly with status 0.

    Args:
        package: its package.
        executable: its executable.
        arguments: its command line, ROS arguments and others.

    Returns:
        The exit status: 0, the node's own, or 1 when it could not start.
    """
    from linkwright.graph.log.setup import set_up
    from linkwright.graph.ros_arguments import parse

    try:
        factory = _factory(package, executable)
        logging = set_up(parse(arguments), executable)
    except LinkwrightError as error:
        print_diagnostics(error.diagnostics, sys.stderr)
        return 1
    try:
        return run_coroutine(lambda: _run(factory, list(arguments), logging), raise_interrupts)
    except LinkwrightError as error:
        print_diagnostics(error.diagnostics, sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 0
    finally:
        logging.close()


async def _run(factory: Factory, arguments: list[str], logging: Logging) -> int:
    from linkwright.graph import Graph
    from linkwright.nodes.options import NodeOptions

    loop = asyncio.get_running_loop()
    ended = asyncio.Event()
    for number in _SIGNALS:
        # Not every platform's loops have this; there KeyboardInterrupt ends the process.
        with contextlib.suppress(NotImplementedError):
            loop.add_signal_handler(number, ended.set)
    graph = Graph(on_log=logging.sink, levels=logging.levels)
    try:
        _join_network(graph)
        running = factory(graph, NodeOptions(arguments=arguments))
        finished: asyncio.Future[int] | None = getattr(running, "finished", None)
        waiting: list[asyncio.Future[object]] = [asyncio.ensure_future(ended.wait())]
        if finished is not None:
            waiting.append(finished)  # type: ignore[arg-type]  # a future of a status is one of an object
        await asyncio.wait(waiting, return_when=asyncio.FIRST_COMPLETED)
        waiting[0].cancel()
        status = finished.result() if finished is not None and finished.done() else 0
        running.close()
        return status
    finally:
        await graph.close()


def _join_network(graph: object) -> None:
    from linkwright.graph.dds import join

    join(graph)  # type: ignore[arg-type]


def _factory(package: str, executable: str) -> Factory:
    from linkwright.nodes.executables import EXECUTABLES

    factory = EXECUTABLES.get((package, executable))
    if factory is not None:
        return factory
    packages = sorted({name for name, _ in EXECUTABLES})
    if package not in packages:
        hint = did_you_mean(package, packages) or f"there is {', '.join(packages)}"
        raise LinkwrightError(Diagnostic("NODE001", f"package '{package}' has no node that comes with us", hint=hint))
    executables = sorted(name for owner, name in EXECUTABLES if owner == package)
    hint = did_you_mean(executable, executables) or f"there is {', '.join(executables)}"
    raise LinkwrightError(Diagnostic("NODE001", f"package '{package}' has no executable '{executable}'", hint=hint))
