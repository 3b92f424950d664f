"""The services of cartographer_node."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.single import rpy_from_quaternion
from linkwright.graph import Node
from linkwright.messages import Time, get_message, get_service
from linkwright.navigation.nodes.cartographer.configuration import CartographerOptions, load_configuration
from linkwright.navigation.nodes.cartographer.mapping import Mapping
from linkwright.navigation.nodes.cartographer.submaps import make_texture_message
from linkwright.navigation.nodes.cartographer.trajectories import ACTIVE, STATE_NAMES, Trajectories
from linkwright.navigation.slam.poses import FloatArray, compose

_UNIT_TOLERANCE = 1e-3


class TrajectoryOwner(Protocol):
    """The node that executes the requests of the services."""

    @property
    def node(self) -> Node:
        """The node in the graph."""

    @property
    def mapping(self) -> Mapping:
        """The map and the pose of the robot."""

    @property
    def trajectories(self) -> Trajectories:
        """The trajectories of the map."""

    @property
    def map_frame(self) -> str:
        """The frame of the map."""

    def start_trajectory(self, options: CartographerOptions, pose: FloatArray | None) -> int:
        """Start a trajectory at a pose in the map, of shape (3,), or None, and return its number."""

    def finish_trajectory(self) -> None:
        """Finish the active trajectory."""


class CartographerServices:
    """The services of a node.

    Args:
        owner: executes the requests.
    """

    def __init__(self, owner: TrajectoryOwner) -> None:
        self._owner = owner
        self._logger = owner.node.get_logger()
        self._codes = get_message("cartographer_ros_msgs/msg/StatusCode")
        self._texture: tuple[int, Any] | None = None
        for name, service, callback in (
            ("submap_query", "SubmapQuery", self._on_submap_query),
            ("trajectory_query", "TrajectoryQuery", self._on_trajectory_query),
            ("start_trajectory", "StartTrajectory", self._on_start),
            ("finish_trajectory", "FinishTrajectory", self._on_finish),
            ("write_state", "WriteState", self._on_write_state),
            ("get_trajectory_states", "GetTrajectoryStates", self._on_get_states),
            ("read_metrics", "ReadMetrics", self._on_read_metrics),
        ):
            owner.node.create_service(get_service(f"cartographer_ros_msgs/srv/{service}"), name, callback)

    def _set_status(self, response: Any, code: int, text: str) -> Any:
        response.status.code, response.status.message = code, text
        return response

    def _refuse(self, response: Any, code: int, text: str, prefix: str = "") -> Any:
        self._logger.error(f"{prefix}{text}")
        return self._set_status(response, code, text)

    def _find_problem(self, trajectory: int, valid_states: tuple[int, ...] | None = None) -> tuple[int, str] | None:
        """Return the code and text of the problem with a trajectory, or None."""
        states = self._owner.trajectories.states
        if not 0 <= trajectory < len(states):
            return self._codes.NOT_FOUND, f"Trajectory {trajectory} doesn't exist."
        state = states[trajectory]
        if valid_states is not None and state not in valid_states:
            return self._codes.INVALID_ARGUMENT, f"Trajectory {trajectory} is in '{STATE_NAMES[state]}' state."
        return None

    def _on_submap_query(self, request: Any, response: Any) -> Any:
        mapping = self._owner.mapping
        grid = mapping.mapper.occupancy.grid()
        if request.trajectory_id or request.submap_index or grid is None:
            text = f"Requested submap {request.submap_index} from trajectory {request.trajectory_id} does not exist."
            return self._refuse(response, self._codes.NOT_FOUND, text)
        if self._texture is None or self._texture[0] != mapping.version:
            self._texture = mapping.version, make_texture_message(grid)
        response.submap_version, texture = self._texture
        response.textures = [texture]
        return self._set_status(response, self._codes.OK, "Success.")

    def _on_trajectory_query(self, request: Any, response: Any) -> Any:
        problem = self._find_problem(request.trajectory_id)
        if problem is not None:
            return self._refuse(response, *problem, "Can't query trajectory from pose graph: ")
        mapper = self._owner.mapping.mapper
        number = request.trajectory_id
        poses = self._owner.trajectories.split(mapper.graph.poses)
        first = sum(len(part) for part in poses[:number])
        for pose, scan in zip(poses[number].tolist(), mapper.scans[first:], strict=False):
            message = get_message("geometry_msgs/msg/PoseStamped")()
            message.header.frame_id = self._owner.map_frame
            message.header.stamp = Time.from_nanoseconds(scan.stamp_ns)
            message.pose.position.x, message.pose.position.y = pose[:2]
            message.pose.orientation.z, message.pose.orientation.w = np.sin(pose[2] / 2), np.cos(pose[2] / 2)
            response.trajectory.append(message)
        return self._set_status(response, self._codes.OK, f"Retrieved {len(response.trajectory)} trajectory nodes.")

    def _on_start(self, request: Any, response: Any) -> Any:
        codes, owner = self._codes, self._owner
        pose: FloatArray | None = None
        if request.use_initial_pose:
            position, orientation = request.initial_pose.position, request.initial_pose.orientation
            quaternion = (orientation.x, orientation.y, orientation.z, orientation.w)
            if abs(np.linalg.norm(quaternion) - 1.0) > _UNIT_TOLERANCE:
                text = "Invalid pose argument. Orientation quaternion must be normalized."
                return self._refuse(response, codes.INVALID_ARGUMENT, text)
            problem = self._find_problem(request.relative_to_trajectory_id)
            if problem is not None:
                return self._refuse(response, *problem, "Can't start a trajectory with initial pose: ")
            relative = np.array((position.x, position.y, rpy_from_quaternion(quaternion)[2]))
            starts = owner.trajectories.split(owner.mapping.mapper.graph.poses)[request.relative_to_trajectory_id]
            pose = compose(starts[0], relative) if len(starts) else relative
        if owner.trajectories.active is not None:
            text = "Topics are already used by another trajectory."
            return self._refuse(response, codes.INVALID_ARGUMENT, text)
        try:
            options = load_configuration(request.configuration_directory, request.configuration_basename)
        except LinkwrightError as error:
            return self._refuse(response, codes.INVALID_ARGUMENT, f"Invalid trajectory options. {error}")
        response.trajectory_id = owner.start_trajectory(options, pose)
        return self._set_status(response, codes.OK, "Success.")

    def _on_finish(self, request: Any, response: Any) -> Any:
        problem = self._find_problem(request.trajectory_id, (ACTIVE,))
        if problem is not None:
            return self._refuse(response, *problem, "Can't finish trajectory: ")
        self._owner.finish_trajectory()
        return self._set_status(response, self._codes.OK, f"Finished trajectory {request.trajectory_id}.")

    def _on_write_state(self, request: Any, response: Any) -> Any:
        text = (
            f"Failed to write '{request.filename}': Linkwright does not write .pbstream files. Save the map with"
            " `ros2 run nav2_map_server map_saver_cli -f NAME`."
        )
        return self._refuse(response, self._codes.UNIMPLEMENTED, text)

    def _on_get_states(self, _request: Any, response: Any) -> Any:
        states = self._owner.trajectories.states
        message = response.trajectory_states
        message.header.stamp = self._owner.node.get_clock().now().to_msg()
        message.trajectory_id = list(range(len(states)))
        message.trajectory_state = states
        return self._set_status(response, self._codes.OK, "")

    def _on_read_metrics(self, _request: Any, response: Any) -> Any:
        response.timestamp = self._owner.node.get_clock().now().to_msg()
        text = "Collection of runtime metrics is not activated."
        return self._set_status(response, self._codes.UNAVAILABLE, text)
