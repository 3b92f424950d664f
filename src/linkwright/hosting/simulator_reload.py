"""The files of a running simulation, whoever started it: the simulator loads them when they are saved."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, Severity, foreign, phrase
from linkwright.hosting.plans import Supervisor

if TYPE_CHECKING:
    from linkwright.graph import Node
    from linkwright.hosting.xacro_calls import WorldCall, XacroCall
    from linkwright.nodes import RunningNode
    from linkwright.simulation.nodes.simulator import Simulator

_LOAD_WORLD = "simulation_interfaces/srv/LoadWorld"


def follow_files(running: RunningNode, session: Supervisor, launcher: Callable[[], Node]) -> None:
    """Have a simulator reload its world, and robots that were spawned, when their files are saved.

    The viewers show errors in their models.

    A robot is followed where its description is a text that this process has expanded from a file.

    Args:
        running: a node that has started; nothing happens if it is not a simulator.
        session: what it runs in.
        launcher: gives the node that calls services.
    """
    from linkwright.simulation.nodes.simulator import Simulator

    if not isinstance(running, Simulator):
        return
    loop, world, server = asyncio.get_running_loop(), running.services.worlds.loaded, running.server
    about = f"simulation of {running.node.get_fully_qualified_name()}"

    def show() -> None:
        if not running.node.handle.is_destroyed:
            session.reload.show(about, server.findings)

    server.on_findings.append(lambda: loop.call_soon_threadsafe(show))
    show()
    if world.path.is_file():
        call = session.descriptions.begin_with(world)
        session.reload.bind(call, lambda path: session.spawn(_load_world(call, path, session, launcher(), running)))
    followed: set[tuple[XacroCall, str]] = set()

    def follow(name: str, text: str) -> None:
        call = session.descriptions.call_of(text)
        if call is not None and (call, name) not in followed:
            followed.add((call, name))
            session.reload.bind(call, partial(_renew, running, name))

    running.services.on_spawned.append(lambda name, text: loop.call_soon_threadsafe(follow, name, text))


def _renew(simulator: Simulator, name: str, text: str) -> None:
    """Replace a robot at its current pose, if it still exists.

    Raises:
        LinkwrightError: its description is wrong.
    """
    if not simulator.node.handle.is_destroyed and name in simulator.server.simulation.scene.models:
        simulator.services.renew(text, name)


async def _load_world(call: WorldCall, path: str, session: Supervisor, node: Node, simulator: Simulator) -> None:
    """Have the simulator load a saved world file, unless the page has unsaved changes."""
    from linkwright.messages import get_service

    if simulator.services.worlds.is_unsaved:
        message = phrase("'{path}' has changed; the simulation continues with the edited world instead", path=path)
        hint = phrase("save the edited world as another file, or undo its changes")
        session.reload.report(call, [Diagnostic("SIM154", message, severity=Severity.WARNING, hint=hint)])
        return
    client = node.create_client(get_service(_LOAD_WORLD), "/load_world")
    request = client.srv_type.Request(ignore_missing_or_unsupported_assets=True)
    request.world_resource.uri = path
    answer = await client.call_async(request)
    if answer is not None and answer.result.result != answer.result.RESULT_OK:
        message = phrase("the simulation continues unchanged: {reason}", reason=foreign(answer.result.error_message))
        session.reload.report(call, [Diagnostic("SIM153", message)])
