"""``linkwright component standalone``."""

from __future__ import annotations

import argparse
import asyncio
import os
import signal
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

from linkwright.cli.component.containers import add_component_arguments, find_container, load
from linkwright.cli.session import add_session_arguments, run_in_graph

if TYPE_CHECKING:
    from asyncio.subprocess import Process

    from linkwright.cli.session import Session

HELP = "run a component in a container of its own"

_STARTS_WITHIN = 10.0
_ENDS_WITHIN = 5.0


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_session_arguments(parser)
    add_component_arguments(parser)
    parser.add_argument(
        "-c", "--container-node-name", metavar="NAME", help="the container's name (default: one of its own)"
    )


def run(arguments: argparse.Namespace) -> int:
    """Run it until the user ends it; the container's exit status."""
    name = arguments.container_node_name or f"standalone_container_{os.urandom(6).hex()}"

    async def job(session: Session) -> int:
        async with _container(name) as process:
            container = await find_container(session, name, _STARTS_WITHIN)
            await load(session, container, arguments)
            return await process.wait()

    return run_in_graph(arguments, job)


@asynccontextmanager
async def _container(name: str) -> AsyncIterator[Process]:
    """A process with an empty container, which ends with the block."""
    words = ("-m", "linkwright.node_program", "rclcpp_components", "component_container")
    process = await asyncio.create_subprocess_exec(sys.executable, *words, "--ros-args", "-r", f"__node:={name}")
    try:
        yield process
    finally:
        for number in (signal.SIGINT, signal.SIGTERM):
            if process.returncode is None:
                process.send_signal(number)
                try:
                    await asyncio.wait_for(process.wait(), _ENDS_WITHIN)
                except asyncio.TimeoutError:
                    continue
        if process.returncode is None:
            process.kill()
            await process.wait()
