"""The services of slam_toolbox's nodes, and the topic ``/initialpose``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from linkwright.diagnostics import LinkwrightError, render
from linkwright.geometry.single import normalized, rpy_from_quaternion
from linkwright.messages import get_message, get_service
from linkwright.navigation.maps.map_files import MapSaveSettings, save_map
from linkwright.navigation.nodes.slam_toolbox.toolbox import Toolbox
from linkwright.navigation.slam.storage import graph_path, save_graph
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND


class ToolboxServices:
    """The services of a node while it is configured.

    Args:
        toolbox: executes the requests.
        has_queue: whether to offer ``clear_queue``.
        can_switch: whether to offer ``set_localization_mode``.
    """

    def __init__(self, toolbox: Toolbox, *, has_queue: bool, can_switch: bool) -> None:
        self._toolbox = toolbox
        self._logger = toolbox.node.get_logger()
        services = [
            ("dynamic_map", "nav_msgs/srv/GetMap", self._on_get_map),
            ("pause_new_measurements", "slam_toolbox/srv/Pause", self._on_pause),
            ("serialize_map", "slam_toolbox/srv/SerializePoseGraph", self._on_serialize),
            ("deserialize_map", "slam_toolbox/srv/DeserializePoseGraph", self._on_deserialize),
            ("save_map", "slam_toolbox/srv/SaveMap", self._on_save),
            ("reset", "slam_toolbox/srv/Reset", self._on_reset),
            ("clear_changes", "slam_toolbox/srv/Clear", self._on_clear_changes),
        ]
        if has_queue:
            services.append(("clear_queue", "slam_toolbox/srv/ClearQueue", self._on_clear_queue))
        if can_switch:
            services.append(("set_localization_mode", "std_srvs/srv/SetBool", self._on_switch))
        node = toolbox.node
        self._endpoints: list[Any] = [
            node.create_service(get_service(service_type), f"slam_toolbox/{name}", callback)
            for name, service_type, callback in services
        ]
        if toolbox.localizes or can_switch:
            pose_class = get_message("geometry_msgs/msg/PoseWithCovarianceStamped")
            self._endpoints.append(node.create_subscription(pose_class, "/initialpose", self._on_initial_pose, 1))

    def close(self) -> None:
        """Remove the services and the subscription."""
        for endpoint in self._endpoints:
            endpoint.destroy()

    def _refuse(self, reason: str) -> None:
        self._logger.error(reason)

    def _report(self, error: LinkwrightError) -> None:
        self._refuse("\n".join(render(diagnostic) for diagnostic in error.diagnostics))

    def _on_get_map(self, _request: Any, response: Any) -> Any:
        message = self._toolbox.make_map_message()
        if message is not None:
            response.map = message
        return response

    def _on_pause(self, _request: Any, response: Any) -> Any:
        is_paused = not self._toolbox.node.get_parameter("paused_new_measurements").value
        self._toolbox.set_paused(is_paused)
        state_text = "pause taking new measurements." if is_paused else "actively taking new measurements."
        self._logger.info(f"SlamToolbox: Toggled to {state_text}")
        response.status = True
        return response

    def _on_serialize(self, request: Any, response: Any) -> Any:
        path = graph_path(request.filename)
        try:
            save_graph(self._toolbox.mapper, path)
        except OSError as error:
            self._refuse(f"serialize_map: '{path}' cannot be written: {error.strerror or error}")
            response.result = response.RESULT_FAILED_TO_WRITE_FILE
            return response
        self._logger.info(f"wrote {len(self._toolbox.mapper.scans)} scans and their graph to {path.absolute()}")
        response.result = response.RESULT_SUCCESS
        return response

    def _on_deserialize(self, request: Any, response: Any) -> Any:
        toolbox = self._toolbox
        requests_localization = request.match_type == request.LOCALIZE_AT_POSE
        if request.match_type == request.UNSET:
            self._logger.error("deserialize_map: match_type is not set; nothing was read")
        elif requests_localization != toolbox.localizes:
            mode = "localization" if toolbox.localizes else "non-localization"
            self._logger.error(f"deserialize_map: match_type {request.match_type} is not valid in {mode} mode")
        elif not request.filename:
            self._logger.warning("deserialize_map: no filename is given; nothing was read")
        else:
            pose = request.initial_pose
            starts_at_first_node = request.match_type == request.START_AT_FIRST_NODE
            try:
                toolbox.load(request.filename, None if starts_at_first_node else np.array((pose.x, pose.y, pose.theta)))
            except LinkwrightError as error:
                self._report(error)
        return response

    def _on_save(self, request: Any, response: Any) -> Any:
        grid = self._toolbox.grid()
        if grid is None:
            self._logger.warning(
                f"Map Saver: Cannot save map, no map yet received on topic {self._toolbox.settings.map_name}."
            )
            response.result = response.RESULT_NO_MAP_RECEIEVD
            return response
        name = request.name.data or f"map_{self._toolbox.node.get_clock().now_ns() // NANOSECONDS_PER_SECOND}"
        self._logger.info(f"SlamToolbox: Saving map as {Path(name).absolute()}.")
        try:
            save_map(grid, MapSaveSettings(name=name), self._logger.warning)
            response.result = response.RESULT_SUCCESS
        except LinkwrightError as error:
            self._report(error)
            response.result = response.RESULT_UNDEFINED_FAILURE
        return response

    def _on_reset(self, request: Any, response: Any) -> Any:
        self._toolbox.reset()
        self._toolbox.set_paused(bool(request.pause_new_measurements))
        self._logger.info("Reset SLAM")
        response.result = response.RESULT_SUCCESS
        return response

    def _on_clear_changes(self, _request: Any, response: Any) -> Any:
        self._logger.info("clear_changes: scans cannot be moved by hand, so there are no changes")
        return response

    def _on_clear_queue(self, _request: Any, response: Any) -> Any:
        self._logger.info("SynchronousSlamToolbox: Clearing all queued scans to add to map.")
        self._toolbox.queue.clear()
        response.status = True
        return response

    def _on_switch(self, request: Any, response: Any) -> Any:
        self._toolbox.localizes = bool(request.data)
        response.success = True
        response.message = f"{'Localization' if request.data else 'Mapping'} mode is set"
        self._logger.info(response.message)
        return response

    def _on_initial_pose(self, message: Any) -> None:
        if not self._toolbox.localizes:
            self._logger.error("LocalizePoseCallback: Cannot process localization command if not in localization mode.")
            return
        frame, expected = message.header.frame_id.removeprefix("/"), self._toolbox.settings.map_frame
        if frame not in ("", expected):
            self._logger.error(f"initialpose: the pose is in frame '{frame}' and must be in '{expected}'")
            return
        position, orientation = message.pose.pose.position, message.pose.pose.orientation
        yaw = rpy_from_quaternion(normalized(orientation.x, orientation.y, orientation.z, orientation.w))[2]
        pose = np.array((position.x, position.y, yaw))
        if not np.isfinite(pose).all():
            self._logger.error("initialpose: the pose has values that are not finite, so it is ignored")
            return
        self._toolbox.start_session(pose)
        self._logger.info(f"LocalizePoseCallback: Localizing to: ({pose[0]:.2f} {pose[1]:.2f}), theta={pose[2]:.2f}")
