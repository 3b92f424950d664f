"""Code of nav2_bringup's launch files that start servers and their lifecycle manager.

Launch files import this module, and it imports the same launch modules as they do.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from launch_ros.actions import LoadComposableNodes, Node  # type: ignore[import-not-found, unused-ignore]
from launch_ros.descriptions import ComposableNode  # type: ignore[import-not-found, unused-ignore]
from launch_ros.parameter_descriptions import ParameterFile  # type: ignore[import-not-found, unused-ignore]
from nav2_common.launch import RewrittenYaml  # type: ignore[import-not-found, unused-ignore]

from launch import LaunchContext  # type: ignore[attr-defined, import-not-found, unused-ignore]

_TRUE_WORDS = ("true", "1", "yes", "on")
_TF_REMAPPINGS = (("/tf", "tf"), ("/tf_static", "tf_static"))
_RESPAWN_DELAY_S = 2.0

ARGUMENTS: Mapping[str, tuple[str, str]] = {
    "namespace": ("", "Namespace of all nodes"),
    "use_sim_time": ("false", "Whether to use simulated time"),
    "autostart": ("true", "Whether the servers are activated at the start"),
    "use_composition": ("False", "Whether the servers are composed in a container"),
    "container_name": ("nav2_container", "The name of the container"),
    "use_respawn": ("False", "Whether to restart a server that dies, unless it is composed"),
    "log_level": ("info", "The log level"),
}
"""The arguments of launch files that start servers: name -> default, description."""


@dataclass(frozen=True)
class Server:
    """A managed node of Nav2.

    Attributes:
        package: the package of the node.
        executable: the executable, which is also the default name of the node.
        plugin: the class of the node when it is composed.
        name: the node's name, if it differs from the executable's.
        remappings: pairs of the original and the new name.
    """

    package: str
    executable: str
    plugin: str
    name: str = ""
    remappings: tuple[tuple[str, str], ...] = ()

    @property
    def node_name(self) -> str:
        """The node's name: `name`, or the name of the executable if `name` is empty."""
        return self.name or self.executable

    @property
    def is_available(self) -> bool:
        """Whether Linkwright provides the executable."""
        from linkwright.nodes import EXECUTABLES

        return (self.package, self.executable) in EXECUTABLES


_MANAGER = Server("nav2_lifecycle_manager", "lifecycle_manager", "nav2_lifecycle_manager::LifecycleManager")


def is_true(context: LaunchContext, name: str) -> bool:
    """Return whether a launch configuration is true, in any of the usual spellings."""
    return str(context.launch_configurations.get(name, "")).strip().lower() in _TRUE_WORDS


def configure_parameters(context: LaunchContext) -> ParameterFile:
    """Return the file ``params_file`` with ``use_sim_time``, for nodes in ``namespace``.

    All three are launch configurations.
    """
    configurations = context.launch_configurations
    rewrites = {"use_sim_time": str(is_true(context, "use_sim_time"))}
    rewritten = RewrittenYaml(
        configurations["params_file"], rewrites, root_key=configurations["namespace"], convert_types=True
    )
    return ParameterFile(rewritten, allow_substs=True)


def make_server_actions(
    context: LaunchContext,
    manager: str,
    servers: Sequence[Server],
    parameters: Mapping[str, Mapping[str, Any]] | None = None,
) -> list[Any]:
    """Return the actions that start servers and their lifecycle manager.

    Servers that Linkwright does not provide are included, so that the launch reports them as skipped, but the manager
    does not wait for them.

    Args:
        context: a context with the launch configurations of `ARGUMENTS` and ``params_file``.
        manager: the name of the lifecycle manager.
        servers: the managed servers.
        parameters: parameters in addition to the parameter file, by node name; None for no more.
    """
    sim_time = {"use_sim_time": is_true(context, "use_sim_time")}
    file = configure_parameters(context)
    managed_names = [server.node_name for server in servers if server.is_available]
    manager_parameters: Mapping[str, Any] = {
        **sim_time,
        "autostart": is_true(context, "autostart"),
        "node_names": managed_names,
    }
    all_servers = [*servers, replace(_MANAGER, name=manager)]
    node_parameters: dict[str, list[Any]] = {
        server.node_name: [file, {**sim_time, **(parameters or {}).get(server.node_name, {})}] for server in servers
    }
    node_parameters[manager] = [manager_parameters]
    if is_true(context, "use_composition"):
        container = f"{context.launch_configurations['namespace']}/{context.launch_configurations['container_name']}"
        nodes = [_make_composable_node(server, node_parameters[server.node_name]) for server in all_servers]
        return [LoadComposableNodes(target_container=container, composable_node_descriptions=nodes)]
    respawn = is_true(context, "use_respawn")
    level = ["--ros-args", "--log-level", context.launch_configurations["log_level"]]
    return [
        Node(
            package=server.package,
            executable=server.executable,
            name=server.node_name,
            output="screen",
            parameters=node_parameters[server.node_name],
            remappings=[*_TF_REMAPPINGS, *server.remappings],
            arguments=level,
            respawn=respawn and server.node_name != manager,
            respawn_delay=_RESPAWN_DELAY_S,
        )
        for server in all_servers
    ]


def _make_composable_node(server: Server, parameters: list[Any]) -> ComposableNode:
    return ComposableNode(
        package=server.package,
        plugin=server.plugin,
        name=server.node_name,
        parameters=parameters,
        remappings=[*_TF_REMAPPINGS, *server.remappings],
    )
