"""Reload the files of a running simulation when any program saves them."""

from __future__ import annotations

import asyncio
from functools import partial

from linkwright.diagnostics import Diagnostic, Severity, foreign, phrase
from linkwright.graph import Node
from linkwright.messages import get_service
from linkwright.nodes.watched_files import FileWatcher
from linkwright.simulation.server.server import SimulationServer
from linkwright.simulation.server.services import Services
from linkwright.simulation.server.worlds import load_world

_LOAD_WORLD = "simulation_interfaces/srv/LoadWorld"


def watch_files(node: Node, server: SimulationServer, services: Services, host: FileWatcher) -> None:
    """Reload the world and the spawned robots when their files are saved.

    The viewers show the errors of the robots' models. A robot is reloaded only if this process expanded its
    description from a file.

    Args:
        node: the simulator's node.
        server: the simulation that runs in the node.
        services: the services that replace worlds and robots.
        host: watches the files and shows the findings.
    """
    loop, world = asyncio.get_running_loop(), services.worlds.loaded
    subject = f"simulation of {node.get_fully_qualified_name()}"

    def show_findings() -> None:
        if not node.handle.is_destroyed:
            host.show(subject, server.findings)

    def replace_robot(name: str, text: str) -> None:
        """Replace a robot at its current pose, if it still exists."""
        if not node.handle.is_destroyed and name in server.simulation.scene.models:
            services.replace_model(text, name)

    def watch_description(name: str, text: str) -> None:
        host.watch_text(text, name, partial(replace_robot, name))

    server.on_findings.append(lambda: loop.call_soon_threadsafe(show_findings))
    show_findings()
    if world.path.is_file():
        host.watch_world(world, load_world, lambda path: _load_world(path, host.launcher_node, services))
    services.on_spawned.append(lambda name, text: loop.call_soon_threadsafe(watch_description, name, text))


async def _load_world(path: str, launcher: Node, services: Services) -> list[Diagnostic]:
    """Load a saved world file, unless the page has unsaved changes.

    Returns findings if the world was not loaded.
    """
    if services.worlds.is_unsaved:
        message = phrase("'{path}' has changed; the simulation continues with the edited world instead", path=path)
        hint = phrase("save the edited world to another file, or undo its changes")
        return [Diagnostic("SIM154", message, severity=Severity.WARNING, hint=hint)]
    client = launcher.create_client(get_service(_LOAD_WORLD), "/load_world")
    request = client.srv_type.Request(ignore_missing_or_unsupported_assets=True)
    request.world_resource.uri = path
    response = await client.call_async(request)
    if response is not None and response.result.result != response.result.RESULT_OK:
        message = phrase(
            "the changed world was not loaded: {reason}; the simulation continues unchanged",
            reason=foreign(response.result.error_message),
        )
        return [Diagnostic("SIM153", message)]
    return []
