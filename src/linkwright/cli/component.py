"""``linkwright component``: list, load and unload components in the running graph."""

from __future__ import annotations

import argparse
import asyncio
import os
import sys
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from functools import partial
from typing import TYPE_CHECKING, Any

from linkwright.cli.calls import call, list_node_names
from linkwright.cli.lookup import add_leading_slash, unknown_name_error
from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.cli.remote_parameters import parse_parameter
from linkwright.cli.session import add_session_arguments, run_in_graph
from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, foreign, joined, phrase
from linkwright.process.interruption import interrupt

if TYPE_CHECKING:
    from asyncio.subprocess import Process

    from linkwright.cli.session import Session


_START_TIMEOUT_S = 10.0
_EXIT_TIMEOUT_S = 5.0
_SERVICES = {"load_node": "LoadNode", "unload_node": "UnloadNode", "list_nodes": "ListNodes"}
_DISCOVERY_TIMEOUT_S = 1.0


def configure_list(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``component list``."""
    add_session_arguments(parser)
    parser.add_argument(
        "container_node_name", metavar="CONTAINER", nargs="?", help="list only the nodes of this container"
    )
    parser.add_argument("--containers-only", action="store_true", help="list only the containers")


def run_list(arguments: argparse.Namespace) -> int:
    """Print the containers and their components, in the format of ros2."""

    async def job(session: Session) -> int:
        if arguments.container_node_name is not None:
            container = await find_container(session, arguments.container_node_name)
            for uid, name in [] if arguments.containers_only else await list_loaded_nodes(session, container):
                print(f"{uid}  {name}")
            return 0
        for container in find_containers(session):
            print(container)
            for uid, name in [] if arguments.containers_only else await list_loaded_nodes(session, container):
                print(f"  {uid}  {name}")
        return 0

    return run_in_graph(arguments, job)


def configure_types(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``component types``."""
    parser.add_argument("package_name", metavar="PACKAGE", nargs="?", help="list only the components of this package")


def run_types(arguments: argparse.Namespace) -> int:
    """Print the names of the components, grouped by package, as ros2 does."""
    from linkwright.nodes.options import COMPONENTS

    by_package: dict[str, list[str]] = {}
    for package, plugin in sorted(COMPONENTS):
        by_package.setdefault(package, []).append(plugin)
    package_name = arguments.package_name
    if package_name is None:
        for package, plugins in by_package.items():
            print("\n  ".join([package, *plugins]))
        return 0
    if package_name not in by_package:
        hint = did_you_mean(package_name, by_package) or phrase(
            "packages with components: {by_package}", by_package=joined(by_package)
        )
        raise LinkwrightError(
            Diagnostic(
                "CLI436", phrase("No component types found in package '{package}'", package=package_name), hint=hint
            )
        )
    print("\n".join(by_package[package_name]))
    return 0


def configure_load(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``component load``."""
    add_session_arguments(parser)
    parser.add_argument("container_node_name", metavar="CONTAINER", help="the container, such as /ComponentManager")
    add_component_arguments(parser)
    parser.add_argument("-q", "--quiet", action="store_true", help="print only the number and name of the node")


def run_load(arguments: argparse.Namespace) -> int:
    """Load a component, and print the unique ID and the name of its node."""

    async def job(session: Session) -> int:
        container = await find_container(session, arguments.container_node_name)
        uid, name = await _load_component(session, container, arguments)
        if arguments.quiet:
            print(f"{uid}  {name}")
        else:
            print(f"Loaded component {uid} into '{container}' container node as '{name}'")
        return 0

    return run_in_graph(arguments, job)


def configure_unload(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``component unload``."""
    add_session_arguments(parser)
    parser.add_argument("container_node_name", metavar="CONTAINER", help="the container, such as /ComponentManager")
    parser.add_argument(
        "component_uid", metavar="NUMBER", type=int, nargs="+", help="the node's number, as `component list` prints it"
    )
    parser.add_argument("-q", "--quiet", action="store_true", help="print only the numbers")


def run_unload(arguments: argparse.Namespace) -> int:
    """Unload components from a container."""

    async def job(session: Session) -> int:
        container = await find_container(session, arguments.container_node_name)
        for uid in arguments.component_uid:
            await _unload_component(session, container, uid)
            print(uid if arguments.quiet else f"Unloaded component {uid} from '{container}' container node")
        return 0

    return run_in_graph(arguments, job)


def configure_standalone(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``component standalone``."""
    add_session_arguments(parser)
    add_component_arguments(parser)
    parser.add_argument(
        "-c", "--container-node-name", metavar="NAME", help="the container's name (default: a generated name)"
    )


def run_standalone(arguments: argparse.Namespace) -> int:
    """Run a component in a separate container until the user interrupts the command.

    Returns:
        The container's exit status.
    """
    name = arguments.container_node_name or f"standalone_container_{os.urandom(6).hex()}"

    async def job(session: Session) -> int:
        async with _container_process(name) as process:
            container = await find_container(session, name, _START_TIMEOUT_S)
            await _load_component(session, container, arguments)
            return await process.wait()

    return run_in_graph(arguments, job)


@asynccontextmanager
async def _container_process(name: str) -> AsyncIterator[Process]:
    """Run a process with an empty container for the duration of the context."""
    program_arguments = ("-m", "linkwright.node_program", "rclcpp_components", "component_container")
    process = await asyncio.create_subprocess_exec(
        sys.executable, *program_arguments, "--ros-args", "-r", f"__node:={name}"
    )
    try:
        yield process
    finally:
        for request_end in (interrupt, type(process).terminate):
            if process.returncode is None:
                request_end(process)
                try:
                    await asyncio.wait_for(process.wait(), _EXIT_TIMEOUT_S)
                except asyncio.TimeoutError:
                    continue
        if process.returncode is None:
            process.kill()
            await process.wait()


def find_containers(session: Session) -> list[str]:
    """Return the sorted full names of the component containers.

    A container is a node with the three services for loading, unloading and listing components.
    """
    services = dict(session.node.get_service_names_and_types())
    return [
        name
        for name in dict.fromkeys(list_node_names(session))
        if all(
            f"composition_interfaces/srv/{kind}" in services.get(f"{name}/_container/{service}", ())
            for service, kind in _SERVICES.items()
        )
    ]


async def find_container(session: Session, name: str, timeout: float = _DISCOVERY_TIMEOUT_S) -> str:
    """Return the full name of a running container.

    Raises:
        LinkwrightError: CLI432, there is no container with that name.
    """
    full_name = add_leading_slash(name)
    if not await session.wait_until(lambda: full_name in find_containers(session), timeout):
        container_names = find_containers(session)
        hint = (
            phrase("running nodes: {nodes}", nodes=joined(container_names))
            if container_names
            else phrase("no container is running")
        )
        raise unknown_name_error(
            "CLI432", phrase("Unable to find container node '{name}'", name=name), full_name, container_names, hint
        )
    return full_name


async def list_loaded_nodes(session: Session, container: str) -> list[tuple[int, str]]:
    """Return the unique ID and the full name of each node in a container."""
    response = await _call_service(session, container, "list_nodes")
    return [(int(uid), str(name)) for uid, name in zip(response.unique_ids, response.full_node_names, strict=True)]


async def _load_component(session: Session, container: str, arguments: argparse.Namespace) -> tuple[int, str]:
    """Load a component, and return the unique ID and the full name of its node.

    Raises:
        LinkwrightError: CLI433, the container could not load the component.
    """
    response = await _call_service(
        session,
        container,
        "load_node",
        package_name=arguments.package_name,
        plugin_name=arguments.plugin_name,
        node_name=arguments.node_name or "",
        node_namespace=arguments.node_namespace or "",
        log_level=_parse_log_level(arguments.log_level),
        remap_rules=arguments.remap_rules or [],
        parameters=_parse_parameters(arguments.parameters or []),
        extra_arguments=_parse_parameters(arguments.extra_arguments or []),
    )
    if not response.success:
        error_message = response.error_message
        reason = foreign(error_message) if error_message else phrase("the container did not report a reason")
        hint = phrase("run `linkwright component types` to list the components that come with Linkwright")
        raise LinkwrightError(
            Diagnostic("CLI433", phrase("Failed to load component: {reason}", reason=reason), hint=hint)
        )
    return int(response.unique_id), str(response.full_node_name)


async def _unload_component(session: Session, container: str, uid: int) -> None:
    """Unload a node from a container.

    Raises:
        LinkwrightError: CLI434, the container could not unload the node.
    """
    response = await _call_service(session, container, "unload_node", unique_id=uid)
    if not response.success:
        message = phrase(
            "Failed to unload component {uid} from '{container}' container node: {error_message}",
            uid=uid,
            container=container,
            error_message=foreign(response.error_message),
        )
        nodes = ", ".join(f"{number} {name}" for number, name in await list_loaded_nodes(session, container))
        raise LinkwrightError(
            Diagnostic(
                "CLI434",
                message,
                hint=phrase("the container's nodes are {nodes}", nodes=nodes)
                if nodes
                else phrase("the container is empty"),
            )
        )


def add_component_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments for a component and the options of its node."""
    parser.add_argument("package_name", metavar="PACKAGE", help="the package of the component")
    parser.add_argument("plugin_name", metavar="COMPONENT", help="the component, such as composition::Talker")
    parser.add_argument("-n", "--node-name", metavar="NAME", help="the node's name")
    parser.add_argument("--node-namespace", metavar="NAMESPACE", help="the node's namespace")
    parser.add_argument("--log-level", metavar="LEVEL", help="the node's log level, such as debug")
    parser.add_argument(
        "-r", "--remap-rule", metavar="FROM:=TO", action="append", dest="remap_rules", help="remap a name of the node"
    )
    parser.add_argument(
        "-p", "--parameter", metavar="NAME:=VALUE", action="append", dest="parameters", help="set a parameter"
    )
    parser.add_argument(
        "-e",
        "--extra-argument",
        metavar="NAME:=VALUE",
        action="append",
        dest="extra_arguments",
        help="pass an extra argument to the container, such as use_intra_process_comms:=true",
    )


def _parse_parameters(words: Sequence[str]) -> list[Any]:
    from linkwright.process.assignments import parse_assignments

    return [parse_parameter(name, value) for name, value in parse_assignments(words).items()]


def _parse_log_level(text: str | None) -> int:
    if text is None:
        return 0
    from linkwright.graph import LogLevel

    if text.isdigit():
        return int(text)
    try:
        return int(LogLevel[text.upper()])
    except KeyError:
        levels = ", ".join(level.name.lower() for level in LogLevel)
        raise LinkwrightError(
            Diagnostic(
                "CLI435",
                phrase("there is no log level '{level}'", level=text),
                hint=phrase("the levels are {levels}", levels=levels),
            )
        ) from None


async def _call_service(session: Session, container: str, service: str, **fields: Any) -> Any:
    from linkwright.messages import get_service

    service_type = f"composition_interfaces/srv/{_SERVICES[service]}"
    return await call(
        session, service_type, f"{container}/_container/{service}", get_service(service_type).Request(**fields)
    )


VERBS = {
    "list": SubVerb(configure_list, run_list, help="list containers and their nodes"),
    "load": SubVerb(configure_load, run_load, help="load a component into a running container"),
    "standalone": SubVerb(configure_standalone, run_standalone, help="run a component in its own container"),
    "types": SubVerb(configure_types, run_types, help="list the components that come with Linkwright"),
    "unload": SubVerb(configure_unload, run_unload, help="unload nodes from a running container"),
}

configure = partial(configure_nested, verbs=VERBS)
run = run_nested
