"""The simulation bar of the page, and requests to add, delete, drag or push models.

The feature uses only topics and services.

Source of the topic and service names: gazebo_ros and simulation_interfaces.
"""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from itertools import count
from math import isfinite
from pathlib import Path
from typing import Any

from msgspec.structs import replace

from linkwright.descriptions import examine, examine_world, is_world
from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.graph import LATCHED_QOS, EndpointKind
from linkwright.messages import from_values, get_message
from linkwright.page.audience import Page
from linkwright.page.protocol.message import ServerMessage
from linkwright.page.protocol.simulation import (
    NO_SIMULATION,
    ControlSimulation,
    DeleteModel,
    DragModel,
    ModelAdded,
    PushLink,
    SimulationNotice,
    SimulationStatus,
    SpawnModel,
)
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.simulation.page.services import SimulationServices, refuse

_STATE_TOPIC = "/simulation_state"
_PAUSED_STATE = 2
"""The value of simulation_interfaces/msg/SimulationState for a paused simulation."""
_VELOCITY_TYPES = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
_PUSH_DURATION_NS = 50_000_000
"""The duration of a push in nanoseconds. Pages repeat the push while the user pulls."""

_EMPTY_SERVICE = "std_srvs/srv/Empty"
_SERVICE_BY_ACTION = {
    "play": (_EMPTY_SERVICE, "/unpause_physics"),
    "pause": (_EMPTY_SERVICE, "/pause_physics"),
    "reset": (_EMPTY_SERVICE, "/reset_simulation"),
    "step": ("simulation_interfaces/srv/StepSimulation", "/step_simulation"),
}


@dataclass(slots=True)
class _Drag:
    """A model that a page drags.

    Attributes:
        model: the name of the model.
        initial_state: the state of the model when the drag began; None until the simulator has returned it.
        pending_offset: the newest offset that was not sent yet, in meters; None if all were sent.
        is_calling: whether a request to move the model is in progress.
    """

    model: str
    initial_state: Any = None
    pending_offset: Sequence[float] | None = None
    is_calling: bool = False


class SimulationFeature(PageFeature):
    """The feature that sends the state of a simulation to pages, and forwards their requests.

    The topics are subscribed only while pages are open.
    """

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._is_listening = False
        self._shows_recording = False
        self._subscriptions: list[Any] = []
        self._services = SimulationServices(self.context)
        self._status = NO_SIMULATION
        self._drags: dict[Page, _Drag] = {}
        self._spawn_tasks: set[asyncio.Task[None]] = set()

    def opening_messages(self) -> list[ServerMessage]:
        """Return the state of the simulation for a new page.

        The method also begins to watch the graph for a simulator, unless a recording is shown.
        """
        if not self._is_listening and not self._shows_recording:
            self._is_listening = True
            self.context.graph_changes.watch(self._update_presence)
            self._update_presence()
        return [self._status]

    def on_recording_shown(self) -> None:
        """Hide the simulation bar, because a recorded simulation cannot be controlled."""
        self._shows_recording = True
        self._stop()

    def remove_page(self, page: Page) -> None:
        """End the drag of the page, and unsubscribe after the last page has closed."""
        self._drags.pop(page, None)
        if self._is_listening and len(self.context.pages) == 0:
            self._stop()

    def close(self) -> None:
        """Stop the feature permanently."""
        self._stop()
        for task in self._spawn_tasks:
            task.cancel()

    def receive(self, page: Page, message: Any) -> None:
        """Carry out the request of a page."""
        match message:
            case ControlSimulation(action):
                service_type, name = _SERVICE_BY_ACTION[action]
                fields = {"steps": 1} if action == "step" else {}
                self._services.call_service(page, service_type, name, fields)
            case SpawnModel(address, position):
                task = asyncio.get_running_loop().create_task(self._spawn(page, address, position))
                self._spawn_tasks.add(task)
                task.add_done_callback(self._spawn_tasks.discard)
            case DeleteModel(model):
                self._services.call_service(page, "gazebo_msgs/srv/DeleteEntity", "/delete_entity", {"name": model})
            case DragModel():
                self._drag(page, message)
            case PushLink():
                self._push(page, message)

    # --- state of the simulation -------------------------------------------------------------------------------

    def _update_presence(self) -> None:
        is_present = bool(self.context.node.get_publishers_info_by_topic(_STATE_TOPIC))
        if is_present and not self._subscriptions:
            node = self.context.node
            self._subscriptions = [
                node.create_subscription(
                    "simulation_interfaces/msg/SimulationState", _STATE_TOPIC, self._on_state, LATCHED_QOS
                ),
                node.create_subscription(
                    "gazebo_msgs/msg/PerformanceMetrics", "/performance_metrics", self._on_metrics, 10
                ),
            ]
        elif not is_present:
            self._unsubscribe()
        status = self._status if is_present == self._status.present else replace(NO_SIMULATION, present=is_present)
        self._publish(replace(status, drivable=is_present and self._is_drivable()))

    def _is_drivable(self) -> bool:
        endpoints = self.context.node.graph.endpoints()
        return any(
            endpoint.kind is EndpointKind.SUBSCRIPTION and endpoint.type_name in _VELOCITY_TYPES
            for endpoint in endpoints
        )

    def _on_state(self, message: Any) -> None:
        self._publish(replace(self._status, present=True, paused=message.state == _PAUSED_STATE))

    def _on_metrics(self, message: Any) -> None:
        stamp = message.header.stamp
        time = stamp.sec + stamp.nanosec / 1e9
        factor = message.real_time_factor if isfinite(message.real_time_factor) else None
        self._publish(replace(self._status, present=True, time=time, real_time_factor=factor))

    def _publish(self, status: SimulationStatus) -> None:
        if status != self._status:
            self._status = status
            self.context.pages.publish(status)

    def _stop(self) -> None:
        self._is_listening = False
        self.context.graph_changes.unwatch(self._update_presence)
        self._unsubscribe()
        self._status = NO_SIMULATION

    def _unsubscribe(self) -> None:
        with suppress(ValueError):  # the node may have been destroyed before
            for subscription in self._subscriptions:
                self.context.node.destroy_subscription(subscription)
        self._services.close()
        self._subscriptions.clear()
        self._drags.clear()

    # --- requests of pages ------------------------------------------------------------------------------------

    async def _spawn(self, page: Page, address: str, position: list[float]) -> None:
        try:
            model = await asyncio.to_thread(self._read_model, address.strip())
        except LinkwrightError as error:
            refuse(page, error.diagnostics[0].located_message)
            return
        if model is None:
            refuse(page, phrase("there is no model in '{address}'", address=address))
            return
        name, text = model
        fields: dict[str, Any] = {"xml": text}
        if _is_vector(position):
            fields["initial_pose"] = _create_pose(position)

        def on_models_listed(response: Any) -> None:
            existing_names = () if response is None else response.model_names
            if name in existing_names:
                free_name = next(
                    candidate for number in count(2) if (candidate := f"{name}_{number}") not in existing_names
                )
                fields.update(name=free_name, robot_namespace=f"/{free_name}")
                request_spawn(partial(_report_added, page, name, free_name))
            else:
                request_spawn(partial(_report_added, page, name, name))

        request_spawn = partial(
            self._services.call_service, page, "gazebo_msgs/srv/SpawnEntity", "/spawn_entity", fields
        )
        self._services.call_service(page, "gazebo_msgs/srv/GetModelList", "/get_model_list", {}, on_models_listed)

    def _read_model(self, address: str) -> tuple[str, str] | None:
        """Return the name and description of the model at an address.

        Returns None if the file is a world without a model.

        Raises:
            LinkwrightError: there is no file at the address, or the file cannot be read.
        """
        from linkwright.sdf.resources import ResourceFinder  # imported here, because few viewers show a world
        from linkwright.sdf.writer import save

        finder = self.context.finder
        resource = ResourceFinder(finder).model(address, Path.cwd())
        path = resource if isinstance(resource, Path) else finder.resolve(address)
        if not is_world(path.name):
            description = examine(path, packages=finder, xacro=True)
            name = "" if description.robot is None else description.robot.name
            return name, self.context.library.store(description)
        sdf = examine_world(path, packages=finder).sdf
        return (sdf.models[0].name, save(sdf.models[0])) if sdf is not None and sdf.models else None

    def _drag(self, page: Page, message: DragModel) -> None:
        if message.begins:
            drag = self._drags[page] = _Drag(message.model)
            fields = {"name": message.model, "reference_frame": "world"}
            self._services.call_service(
                page,
                "gazebo_msgs/srv/GetEntityState",
                "/get_entity_state",
                fields,
                partial(self._on_drag_state, page, drag),
            )
        active_drag = self._drags.get(page)
        if active_drag is not None and active_drag.model == message.model and _is_vector(message.offset):
            active_drag.pending_offset = message.offset
            self._send_pose(page, active_drag)

    def _on_drag_state(self, page: Page, drag: _Drag, response: Any) -> None:
        if response is not None and response.success:
            drag.initial_state = response.state
            self._send_pose(page, drag)

    def _send_pose(self, page: Page, drag: _Drag) -> None:
        """Send the newest pose, or wait until the simulation has answered the previous request."""
        if drag.initial_state is None or drag.pending_offset is None or drag.is_calling:
            return
        start = drag.initial_state.pose.position
        drag.is_calling = True
        offset, drag.pending_offset = drag.pending_offset, None
        state = type(drag.initial_state)(name=drag.model, reference_frame="world")
        state.pose = _create_pose([start.x + offset[0], start.y + offset[1], start.z + offset[2]])
        state.pose.orientation = drag.initial_state.pose.orientation

        def on_pose_set(_: Any) -> None:
            drag.is_calling = False
            self._send_pose(page, drag)

        failure_message = phrase(
            "'{model}' cannot be moved: it is fixed to the world, or no longer exists", model=drag.model
        )
        self._services.call_service(
            page, "gazebo_msgs/srv/SetEntityState", "/set_entity_state", {"state": state}, on_pose_set, failure_message
        )

    def _push(self, page: Page, message: PushLink) -> None:
        if not (_is_vector(message.point) and _is_vector(message.force)):
            return
        wrench = get_message("geometry_msgs/msg/Wrench")()
        point = from_values(get_message("geometry_msgs/msg/Point"), message.point)
        wrench.force.x, wrench.force.y, wrench.force.z = message.force
        fields = {"link_name": message.link, "reference_frame": "world", "reference_point": point, "wrench": wrench}
        fields["duration"] = get_message("builtin_interfaces/msg/Duration")(sec=0, nanosec=_PUSH_DURATION_NS)
        self._services.call_service(page, "gazebo_msgs/srv/ApplyLinkWrench", "/apply_link_wrench", fields)


def _report_added(page: Page, name: str, actual_name: str, response: Any) -> None:
    """Notify a page that a model was added.

    The notice contains the new name if the original name was in use.
    """
    if response is None or not response.success:
        return
    page.send(ModelAdded(actual_name))
    if actual_name != name:
        notice = phrase(
            "A model '{name}' already exists: the new one is named '{free_name}', and the topics of its "
            "plugins begin with /{free_name}. The frames of both models have the same names.",
            name=name,
            free_name=actual_name,
        )
        page.send(SimulationNotice(notice))


def _is_vector(numbers: Sequence[float]) -> bool:
    return len(numbers) == 3 and all(map(isfinite, numbers))


def _create_pose(position: Sequence[float]) -> Any:
    pose = get_message("geometry_msgs/msg/Pose")()
    pose.position.x, pose.position.y, pose.position.z = position
    pose.orientation.w = 1.0
    return pose
