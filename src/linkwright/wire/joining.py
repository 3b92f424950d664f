"""Choose the transport of a process, DDS or Zenoh.

``RMW_IMPLEMENTATION=rmw_zenoh_cpp`` selects Zenoh, as in ROS 2, and any other value selects DDS. If the variable is not
set, DDS is used, or Zenoh if only Zenoh is installed.
"""

from __future__ import annotations

import os
import platform
from collections.abc import Mapping
from importlib.util import find_spec
from typing import TYPE_CHECKING

from linkwright.diagnostics import Phrase, install_hint, phrase, render
from linkwright.wire import dds, zenoh
from linkwright.wire.background import log_no_transport
from linkwright.wire.switch import is_switched_off
from linkwright.wire.unsupported_settings import (
    CYCLONE,
    MIDDLEWARE_VARIABLE,
    ZENOH,
    find_new_unsupported_settings,
    refuse_enforced_security,
)
from linkwright.wire.zenoh.joining import is_installed as zenoh_is_installed

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from linkwright.graph.node import Graph
    from linkwright.wire.background import BackgroundTransport, JoinOptions


def select_middleware(environment: Mapping[str, str] | None = None) -> str:
    """Return the middleware that this process is compatible with: `ZENOH` or `CYCLONE`.

    Args:
        environment: the environment variables; by default, the variables of this process.
    """
    environment = os.environ if environment is None else environment
    requested = environment.get(MIDDLEWARE_VARIABLE, "").strip()
    if requested:
        return ZENOH if requested == ZENOH else CYCLONE
    return ZENOH if find_spec("cyclonedds") is None and zenoh_is_installed() else CYCLONE


def unavailable_reason(environment: Mapping[str, str] | None = None) -> Phrase:
    """Return the reason why this process does not communicate with others.

    Return an empty phrase if it does.

    Args:
        environment: the environment variables; by default, the variables of this process.
    """
    environment = os.environ if environment is None else environment
    if select_middleware(environment) == ZENOH:
        return zenoh.unavailable_reason(environment)
    reason = dds.unavailable_reason(environment)
    if reason and find_spec("cyclonedds") is None and not environment.get(MIDDLEWARE_VARIABLE, "").strip():
        return phrase(
            "neither DDS nor Zenoh is installed: {hint}, or with 'dds' in place of 'zenoh' for DDS, the "
            "default of ROS 2 (DDS has wheels for Linux x86_64, Windows and macOS arm64, up to Python 3.13; "
            "this is {system} {machine} with Python {version})",
            hint=install_hint("zenoh"),
            system=platform.system(),
            machine=platform.machine(),
            version=platform.python_version(),
        )
    return reason


def is_available(environment: Mapping[str, str] | None = None) -> bool:
    """Return whether this process can communicate with others."""
    return not unavailable_reason(environment)


def check_security(environment: Mapping[str, str] | None = None) -> None:
    """Raise an error if only nodes with DDS security may join.

    If communication with other processes is switched off, no error is raised.

    Raises:
        LinkwrightError: DDS121, security is enforced.
    """
    if not is_switched_off(environment):
        refuse_enforced_security(environment)


def check_settings(environment: Mapping[str, str] | None = None) -> None:
    """Read the settings that joining would use, to report errors in them.

    Raises:
        LinkwrightError: DDS101, ROS_DOMAIN_ID is not a valid domain; DDS111, a setting of Zenoh is malformed.
    """
    if select_middleware(environment) == ZENOH:
        from linkwright.wire.zenoh.settings import read_settings as read_zenoh_settings

        read_zenoh_settings(environment)
    else:
        from linkwright.wire.dds.settings import read_settings

        read_settings(environment)


def join(graph: Graph, **options: Unpack[JoinOptions]) -> BackgroundTransport | None:
    """Connect a graph to the graphs of other processes, in the background.

    Problems are logged, and the graph continues without the network. Unsupported ROS 2 settings are logged once in a
    process.

    Args:
        graph: the graph, to which the transport is attached.
        options: see `JoinOptions`.

    Returns:
        The transport; None if no transport is available, communication is switched off, or the settings are wrong.

    Raises:
        LinkwrightError: DDS121, security is enforced.
    """
    environment = options.get("environment")
    check_security(environment)
    reason = unavailable_reason(environment)
    if reason:
        if not is_switched_off(environment):
            log_no_transport(graph.get_logger("wire"), reason)
        return None
    for finding in find_new_unsupported_settings(environment):
        graph.get_logger("wire").warning(render(finding))
    join_selected_transport = zenoh.join if select_middleware(environment) == ZENOH else dds.join
    return join_selected_transport(graph, **options)
