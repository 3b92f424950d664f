"""The program that runs one of Linkwright's nodes as a separate process.

Usage: ``python -m linkwright.node_program PACKAGE EXECUTABLE ARGUMENTS``.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, joined, phrase, print_diagnostics
from linkwright.process.event_loop import run_coroutine
from linkwright.process.interruption import raise_interrupts
from linkwright.process.standard_streams import accept_any_text

if TYPE_CHECKING:
    from linkwright.graph import Graph
    from linkwright.graph.command_line.log_setup import LoggingSetup
    from linkwright.nodes.options import Factory

_GRAPHLESS_PROGRAMS = {("rmw_zenoh_cpp", "rmw_zenohd")}
"""Programs that forward messages of other nodes, and do not join the graph."""

_END_SIGNALS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
"""The signals that end a node: from Ctrl-C, from another program, and from a closed terminal."""


def main(package: str, executable: str, arguments: Sequence[str]) -> int:
    """Run a node until it ends or a signal arrives.

    SIGINT, SIGTERM and SIGHUP close the node and end the program with status 0.

    Args:
        package: the package of the node.
        executable: the executable of the node.
        arguments: the command line, with ROS arguments and others.

    Returns:
        The exit status: 0, the status of the node, or 1 if the node could not start.
    """
    from linkwright.graph.command_line.log_setup import set_up_logging
    from linkwright.graph.command_line.ros_arguments import parse

    accept_any_text()
    try:
        factory = _find_factory(package, executable)
        ros_arguments = parse(arguments)
        print_diagnostics([finding for _, finding in ros_arguments.parameters.skipped_findings], sys.stderr)
        logging = set_up_logging(ros_arguments, executable)
    except LinkwrightError as error:
        print_diagnostics(error.diagnostics, sys.stderr)
        return 1
    joins_graph = (package, executable) not in _GRAPHLESS_PROGRAMS
    try:
        return run_coroutine(lambda: _run(factory, list(arguments), logging, joins=joins_graph), raise_interrupts)
    except LinkwrightError as error:
        print_diagnostics(error.diagnostics, sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 0
    finally:
        logging.close()


async def _run(factory: Factory, arguments: list[str], logging: LoggingSetup, *, joins: bool) -> int:
    from linkwright.graph import Graph
    from linkwright.nodes.options import FinishingNode, NodeOptions

    loop = asyncio.get_running_loop()
    end_event = asyncio.Event()
    for signal_number in _END_SIGNALS:
        if signal_number == getattr(signal, "SIGHUP", None) and signal.getsignal(signal_number) is signal.SIG_IGN:
            continue  # keep ignoring the signal, as nohup requests
        # The event loops of some platforms do not support signal handlers; KeyboardInterrupt then ends the process.
        with contextlib.suppress(NotImplementedError):
            loop.add_signal_handler(signal_number, end_event.set)
    graph = Graph(on_log=logging.sink, levels=logging.levels)
    try:
        if joins:
            _join_network(graph)
        node = factory(graph, NodeOptions(arguments=arguments, terminal=_find_terminal_descriptor()))
        if isinstance(node, FinishingNode):
            node.finished.add_done_callback(lambda _: end_event.set())
        await end_event.wait()
        status = node.finished.result() if isinstance(node, FinishingNode) and node.finished.done() else 0
        node.close()
        return status
    finally:
        await graph.close()


def _find_terminal_descriptor() -> int | None:
    """Return the file descriptor of standard input if it is a terminal, otherwise None."""
    try:
        descriptor = sys.stdin.fileno()
    except (AttributeError, OSError, ValueError):
        return None
    return descriptor if os.isatty(descriptor) else None


def _join_network(graph: Graph) -> None:
    from linkwright.wire.joining import join

    join(graph)


def _find_factory(package: str, executable: str) -> Factory:
    from linkwright.nodes.options import EXECUTABLES

    factory = EXECUTABLES.get((package, executable))
    if factory is not None:
        return factory
    packages = sorted({name for name, _ in EXECUTABLES})
    if package not in packages:
        hint = did_you_mean(package, packages) or phrase("choose from {names}", names=joined(packages))
        raise LinkwrightError(
            Diagnostic(
                "NODE001",
                phrase("Linkwright provides no nodes of the package '{package}'", package=package),
                hint=hint,
            )
        )
    executables = sorted(name for owner, name in EXECUTABLES if owner == package)
    hint = did_you_mean(executable, executables) or phrase("choose from {names}", names=joined(executables))
    raise LinkwrightError(
        Diagnostic(
            "NODE001",
            phrase("package '{package}' has no executable '{name}'", package=package, name=executable),
            hint=hint,
        )
    )
