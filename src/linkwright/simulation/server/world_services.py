"""The services of gz below ``/world/NAME``, with the types to which ros_gz_bridge converts them.

As topics of gz are topics of the graph here, its services are services of the graph.

Source: gz-sim (``UserCommands``, ``SimulationRunner``) and ros_gz_interfaces. In gz, ``create``, ``remove`` and
``set_pose`` always return true, because they are carried out later; here they return whether they succeeded.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.geometry.single import Transform
from linkwright.graph.stepped.node import SteppedNode
from linkwright.simulation.description_files import read_model_file
from linkwright.simulation.gz_services import CONTROL, CREATE, REMOVE, SET_POSE, has_pose
from linkwright.simulation.plugins.entities import Entities, choose_free_name, describe_refusal, transform_from_message
from linkwright.simulation.plugins.node import to_ros_name
from linkwright.simulation.server.server import SimulationServer


class Runner(Protocol):
    """The controls of a running simulation that `WorldServices` needs."""

    def pause(self) -> None:
        """Pause the simulation."""

    def resume(self) -> None:
        """Resume the simulation."""

    def step(self, count: int) -> None:
        """Run a number of steps."""


class WorldServices:
    """The services ``/world/NAME/control``, ``create``, ``remove`` and ``set_pose`` of the running world.

    They are handled in the simulation's thread, and follow the name of the world when another world is loaded.

    Args:
        server: the simulation to which the services apply.
        runner: advances the simulation.
        node: the simulator's node, which offers the services.
        spawn: adds a model, given its description, its name, and the pose that replaces its own or None.
    """

    def __init__(
        self,
        server: SimulationServer,
        runner: Runner,
        node: SteppedNode,
        spawn: Callable[[str, str, Transform | None], object],
    ) -> None:
        self._server = server
        self._runner = runner
        self._spawn = spawn
        self._graph_node = node.graph_node
        self._entities = Entities(server.simulation)
        self._world_name: str | None = None
        self._node: SteppedNode | None = None
        self._offer()
        server.on_change.append(self._offer)

    def _offer(self) -> None:
        """Offer the services below the name of the running world, if its name is new."""
        world_name = self._server.simulation.world.name
        if world_name == self._world_name:
            return
        if self._node is not None:
            self._node.close()
        self._world_name = world_name
        self._node = SteppedNode(self._graph_node, self._server.exchange, owned=False)
        for service, handle in (
            (CONTROL, self._control),
            (CREATE, self._create),
            (REMOVE, self._remove),
            (SET_POSE, self._set_pose),
        ):
            name = to_ros_name(f"/world/{world_name}/{service.name}")
            self._node.service(service.ros_type, name, _Handler(handle, name, self._log_error))

    def _log_error(self, text: Any) -> None:
        self._server.node.get_logger().error(text)

    def _control(self, request: Any) -> None:
        """Pause or resume; a paused simulation can also make steps. Then reset, if this is requested."""
        control = request.world_control
        step_count = control.multi_step or int(control.step)
        if control.pause:
            self._runner.pause()
            if step_count:
                self._runner.step(step_count)
        else:
            self._runner.resume()
        if control.reset.all or control.reset.time_only:
            self._server.reset()
        elif control.reset.model_only:
            raise _unsupported_error("model_only")
        if control.seed:
            raise _unsupported_error("seed")
        if control.run_to_sim_time.sec or control.run_to_sim_time.nanosec:
            raise _unsupported_error("run_to_sim_time")

    def _create(self, request: Any) -> None:
        """Add a model at the pose of the request, or at its own pose if the request has none."""
        factory = request.entity_factory
        if factory.sdf:
            description = factory.sdf
        elif factory.sdf_filename:
            description = read_model_file(factory.sdf_filename, self._server.simulation.finder)
        else:
            raise _unsupported_error("clone_name" if factory.clone_name else "light")
        name = factory.name
        if name and factory.allow_renaming:
            name = choose_free_name(name, tuple(self._server.simulation.scene.models))
        self._spawn(description, name, transform_from_message(factory.pose) if has_pose(factory) else None)

    def _remove(self, request: Any) -> None:
        self._server.delete(_read_name(request.entity))

    def _set_pose(self, request: Any) -> None:
        name = self._entities.model(_read_name(request.entity))
        self._server.simulation.set_model_pose(name, transform_from_message(request.pose))


class _Handler:
    """A service callback that calls a function, and logs the reason for a failure.

    Args:
        function: called with the request.
        service: the name of the service.
        log: logs an error.
    """

    def __init__(self, function: Callable[[Any], None], service: str, log: Callable[[Any], object]) -> None:
        self._function, self._service, self._log = function, service, log

    def __call__(self, request: Any, response: Any) -> Any:
        try:
            self._function(request)
            response.success = True
        except LinkwrightError as error:
            response.success = False
            self._log(describe_refusal(self._service, error))
        return response


def _read_name(entity: Any) -> str:
    """Return the name of an entity in a request.

    Raises:
        LinkwrightError: SIM147, the request has no name; models have no numeric IDs here.
    """
    if not entity.name:
        message = phrase("the request does not name a model")
        raise LinkwrightError(Diagnostic("SIM147", message, hint=phrase("set its 'name'; models have no numeric IDs")))
    return str(entity.name)


def _unsupported_error(field: str) -> LinkwrightError:
    return LinkwrightError(Diagnostic("SIM147", phrase("'{field}' is not supported", field=field)))
