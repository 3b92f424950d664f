"""The entry of MoveIt's Python library (``moveit.planning.MoveItPy``)."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

from linkwright.moveit_py.execution import ExecutionStatus, TrajectoryExecutionManager
from linkwright.moveit_py.planning_component import PlanningComponent
from linkwright.moveit_py.planning_scene import PlanningScene
from linkwright.moveit_py.robot_model import RobotModel
from linkwright.moveit_py.robot_trajectory import RobotTrajectory
from linkwright.moveit_py.session import Session


class PlanningSceneMonitor:
    """The planning scene, which topics, services and the program change.

    Args:
        session: the session with the scene.

    Attributes:
        name: the name of the monitor.
    """

    def __init__(self, session: Session) -> None:
        self._session, self.name = session, session.monitor_name
        self._lock = threading.RLock()

    @contextmanager
    def read_only(self) -> Iterator[PlanningScene]:
        """Give the current scene for reading, in a ``with`` statement."""
        with self._lock:
            yield self._scene()

    @contextmanager
    def read_write(self) -> Iterator[PlanningScene]:
        """Give the current scene for changes, in a ``with`` statement, and publish it at the end."""
        with self._lock:
            yield self._scene()
            self._session.monitor.announce_change()

    def process_collision_object(self, collision_object_msg: Any, color_msg: Any = None) -> bool:
        """Apply a moveit_msgs/msg/CollisionObject, and return whether that was possible."""
        with self.read_write() as scene:
            return scene.apply_collision_object(collision_object_msg, color_msg)

    def process_attached_collision_object(self, attached_collision_object_msg: Any) -> bool:
        """Apply a moveit_msgs/msg/AttachedCollisionObject, and return whether that was possible."""
        with self.read_write() as scene:
            return scene.process_attached_collision_object(attached_collision_object_msg)

    def new_planning_scene_message(self, scene: Any) -> bool:
        """Apply a moveit_msgs/msg/PlanningScene, and return whether all of it could be applied."""
        monitor = self._session.monitor
        with self._lock:
            is_applied = monitor.scene.apply(scene, monitor.frame_lookup(self._session.current_state().positions))
            monitor.announce_change()
        return is_applied

    def wait_for_current_robot_state(self, wait_seconds: float = 1.0) -> bool:
        """Wait for the state of the robot, and return whether it was received."""
        return self._session.wait_for_state(wait_seconds)

    def start_scene_monitor(self) -> None:
        """Do nothing, because the monitor always receives changes."""

    def start_state_monitor(self) -> None:
        """Do nothing, because the monitor always receives the state of the robot."""

    def update_frame_transforms(self) -> None:
        """Do nothing, because frames are looked up when they are used."""

    def _scene(self) -> PlanningScene:
        session = self._session
        state = session.current_state()
        return PlanningScene(session.model, session.monitor, session.monitor.scene, state, session.log_warning)


class MoveItPy:
    """A node that plans and executes motions in the program's own process.

    Args:
        node_name: the name of the node, which the command line can change.
        name_space: the namespace of the node.
        launch_params_filepaths: parameter files; those on the command line always apply.
        config_dict: parameters, such as those of ``MoveItConfigs.to_dict``.
        provide_planning_service: accepted for compatibility.
        remappings: new names of topics by their names.

    Attributes:
        session: the node, the robot, the scene and the controllers.

    Raises:
        LinkwrightError: ARM104, a parameter with a description is missing; or the description has errors.
    """

    def __init__(
        self,
        node_name: str = "moveit_py",
        name_space: str = "",
        launch_params_filepaths: Sequence[str] = (),
        config_dict: Mapping[str, Any] | None = None,
        provide_planning_service: bool = True,
        remappings: Mapping[str, str] | None = None,
    ) -> None:
        arguments = [word for path in launch_params_filepaths for word in ("--params-file", str(path))]
        arguments += [word for pair in (remappings or {}).items() for word in ("-r", ":=".join(pair))]
        self.session = Session(node_name, name_space, arguments, config_dict or {})
        self._scene_monitor = PlanningSceneMonitor(self.session)

    def get_planning_component(self, planning_component_name: str) -> PlanningComponent:
        """Return the plans of a group.

        Raises:
            ValueError: there is no such group.
        """
        return PlanningComponent(planning_component_name, self)

    def get_planning_scene_monitor(self) -> PlanningSceneMonitor:
        """Return the monitor of the planning scene."""
        return self._scene_monitor

    def get_trajectory_execution_manager(self) -> TrajectoryExecutionManager:
        """Return the manager of executions."""
        return self.session.execution

    def get_robot_model(self) -> RobotModel:
        """Return the robot."""
        return self.session.model

    def execute(
        self, *arguments: Any, robot_trajectory: RobotTrajectory | None = None, controllers: Sequence[str] = ()
    ) -> ExecutionStatus:
        """Execute a trajectory, and return the result.

        Args:
            arguments: the trajectory. In Humble the name of the group precedes it.
            robot_trajectory: the trajectory, as a keyword.
            controllers: accepted for compatibility; the joints decide which controllers move.

        Raises:
            ValueError: there is no trajectory.
        """
        trajectories = [item for item in arguments if isinstance(item, RobotTrajectory)]
        trajectory = robot_trajectory if robot_trajectory is not None else next(iter(trajectories), None)
        if trajectory is None:
            raise ValueError("there is no trajectory to execute")
        if not self.session.execution.push(trajectory.get_robot_trajectory_msg()):
            return ExecutionStatus("FAILED")
        return self.session.execution.execute_and_wait()

    def shutdown(self) -> None:
        """Stop the execution and destroy the node."""
        self.session.close()
