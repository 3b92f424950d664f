"""Containers of the running graph: which there are, what they hold, and having them load and unload."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from linkwright.cli.calls import call, node_names
from linkwright.cli.lookup import absolute_or_given, unknown
from linkwright.cli.param.access import parameter_of
from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, joined, phrase

if TYPE_CHECKING:
    from linkwright.cli.session import Session

_SERVICES = {"load_node": "LoadNode", "unload_node": "UnloadNode", "list_nodes": "ListNodes"}
_APPEARS_WITHIN = 1.0


def containers(session: Session) -> list[str]:
    """Full names of the containers, sorted: the nodes with all three services of containers."""
    services = dict(session.node.get_service_names_and_types())
    return [
        name
        for name in dict.fromkeys(node_names(session))
        if all(
            f"composition_interfaces/srv/{kind}" in services.get(f"{name}/_container/{service}", ())
            for service, kind in _SERVICES.items()
        )
    ]


async def find_container(session: Session, name: str, timeout: float = _APPEARS_WITHIN) -> str:
    """The full name of a running container.

    Raises:
        LinkwrightError: CLI432, there is none of that name.
    """
    full = absolute_or_given(name)
    if not await session.until(lambda: full in containers(session), timeout):
        known = containers(session)
        nothing = phrase("there are: {known}", known=joined(known)) if known else phrase("no container is running")
        raise unknown("CLI432", phrase("Unable to find container node '{name}'", name=name), full, known, nothing)
    return full


async def held_nodes(session: Session, container: str) -> list[tuple[int, str]]:
    """The numbers and full names of the nodes in a container."""
    response = await _call(session, container, "list_nodes")
    return [(int(uid), str(name)) for uid, name in zip(response.unique_ids, response.full_node_names, strict=True)]


async def load(session: Session, container: str, arguments: argparse.Namespace) -> tuple[int, str]:
    """Have a container load a component as the command line says; the node's number and full name.

    Raises:
        LinkwrightError: CLI433, the container could not.
    """
    response = await _call(
        session,
        container,
        "load_node",
        package_name=arguments.package_name,
        plugin_name=arguments.plugin_name,
        node_name=arguments.node_name or "",
        node_namespace=arguments.node_namespace or "",
        log_level=_log_level(arguments.log_level),
        remap_rules=arguments.remap_rules or [],
        parameters=_assigned(arguments.parameters or []),
        extra_arguments=_assigned(arguments.extra_arguments or []),
    )
    if not response.success:
        said = response.error_message
        reason = foreign(said) if said else phrase("the container gives no reason")
        hint = phrase("`linkwright component types` lists what comes with Linkwright")
        raise LinkwrightError(
            Diagnostic("CLI433", phrase("Failed to load component: {reason}", reason=reason), hint=hint)
        )
    return int(response.unique_id), str(response.full_node_name)


async def unload(session: Session, container: str, uid: int) -> None:
    """Have a container unload a node.

    Raises:
        LinkwrightError: CLI434, the container could not.
    """
    response = await _call(session, container, "unload_node", unique_id=uid)
    if not response.success:
        message = phrase(
            "Failed to unload component {uid} from '{container}' container node: {error_message}",
            uid=uid,
            container=container,
            error_message=foreign(response.error_message),
        )
        there = ", ".join(f"{number} {name}" for number, name in await held_nodes(session, container))
        raise LinkwrightError(
            Diagnostic(
                "CLI434",
                message,
                hint=phrase("it holds: {there}", there=there) if there else phrase("the container is empty"),
            )
        )


def add_component_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the component and how its node is made."""
    parser.add_argument("package_name", metavar="PACKAGE", help="the package the component is in")
    parser.add_argument("plugin_name", metavar="COMPONENT", help="such as composition::Talker")
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
        help="say more to the container, such as use_intra_process_comms:=true",
    )


def _assigned(words: Sequence[str]) -> list[Any]:
    from linkwright.assignments import parse_assignments

    return [parameter_of(name, value) for name, value in parse_assignments(words).items()]


def _log_level(text: str | None) -> int:
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
                phrase("there is no log level '{text}'", text=text),
                hint=phrase("levels are {levels}", levels=levels),
            )
        ) from None


async def _call(session: Session, container: str, service: str, **fields: Any) -> Any:
    from linkwright.messages import get_service

    kind = f"composition_interfaces/srv/{_SERVICES[service]}"
    return await call(session, kind, f"{container}/_container/{service}", get_service(kind).Request(**fields))
