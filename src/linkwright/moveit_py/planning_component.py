"""Plans for a group (``moveit.planning.PlanningComponent``)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import copy
from time import perf_counter
from typing import Any

from linkwright.diagnostics import LinkwrightError, render
from linkwright.messages import get_message
from linkwright.moveit_py.constraints import construct_joint_constraint, construct_link_constraint
from linkwright.moveit_py.parameters import MultiPipelinePlanRequestParameters, PlanRequestParameters
from linkwright.moveit_py.planning_scene import PlanningScene
from linkwright.moveit_py.robot_model import JointModelGroup
from linkwright.moveit_py.robot_state import RobotState, robot_state_to_message
from linkwright.moveit_py.robot_trajectory import RobotTrajectory
from linkwright.moveit_py.session import HasSession
from linkwright.planning.nodes.conversions import RequestError
from linkwright.planning.planner import MotionPlanner, PlanError, PlanRequest
from linkwright.planning.robot_model import RobotModel as MovedRobot

_POSITION_TOLERANCE_M = 1e-3
_ORIENTATION_TOLERANCE_RAD = 1e-2
_JOINT_TOLERANCE = 1e-4


class MotionPlanResponse:
    """The result of a plan, which is true if a trajectory was found.

    Attributes:
        trajectory: the trajectory; None if there is none.
        error_code: the moveit_msgs/msg/MoveItErrorCodes.
        planning_time: the time in s that planning took.
        start_state: the state at the start (moveit_msgs/msg/RobotState).
        planner_id: the requested planner.
    """

    def __init__(
        self, start: RobotState, planner: str, code: str, seconds: float, trajectory: RobotTrajectory | None
    ) -> None:
        self.trajectory = trajectory
        self.error_code = get_message("moveit_msgs/msg/MoveItErrorCodes")()
        self.error_code.val = getattr(self.error_code, code)
        self.planning_time = seconds
        self.start_state = robot_state_to_message(start)
        self.planner_id = planner

    def __bool__(self) -> bool:
        return self.trajectory is not None


class PlanningComponent:
    """The plans of a group.

    Args:
        joint_model_group_name: the group.
        moveit_py_instance: the instance that plans.

    Raises:
        ValueError: there is no such group.
    """

    def __init__(self, joint_model_group_name: str, moveit_py_instance: HasSession) -> None:
        self._moveit, self._session = moveit_py_instance, moveit_py_instance.session
        self._model = self._session.model
        self._group = self._model.group(joint_model_group_name)
        self._start: RobotState | None = None
        self._goals: list[Any] = []
        self._path_constraints: Any = get_message("moveit_msgs/msg/Constraints")()

    @property
    def planning_group_name(self) -> str:
        """The name of the group."""
        return self._group.name

    @property
    def named_target_states(self) -> list[str]:
        """The names of the group's states in the SRDF."""
        return list(self._model.semantics.states.get(self._group.name, ()))

    def get_named_target_state_values(self, name: str) -> dict[str, float]:
        """Return the positions of a named state in rad or m, by joint; empty if there is no such state."""
        return dict(self._model.semantics.states.get(self._group.name, {}).get(name, {}))

    def set_start_state_to_current_state(self) -> bool:
        """Start plans where the robot is at the time of the plan."""
        self._start = None
        return True

    def set_start_state(self, configuration_name: str | None = None, robot_state: RobotState | None = None) -> bool:
        """Start plans at a named state of the SRDF, or at a state.

        Raises:
            ValueError: not exactly one of the two is given.
        """
        if (configuration_name is None) == (robot_state is None):
            raise ValueError("give either 'configuration_name' or 'robot_state'")
        state = self._named_state(configuration_name) if robot_state is None else copy(robot_state)
        if state is not None:
            self._start = state
        return state is not None

    def get_start_state(self) -> RobotState:
        """Return the state at the start of plans."""
        return self._session.current_state() if self._start is None else copy(self._start)

    def set_goal_state(
        self,
        configuration_name: str | None = None,
        robot_state: RobotState | None = None,
        pose_stamped_msg: Any = None,
        pose_link: str | None = None,
        motion_plan_constraints: Sequence[Any] | None = None,
    ) -> bool:
        """Set the goal of plans.

        Args:
            configuration_name: a named state of the SRDF.
            robot_state: the state to reach.
            pose_stamped_msg: the pose of a link to reach (geometry_msgs/msg/PoseStamped).
            pose_link: the link of the pose.
            motion_plan_constraints: the goals (moveit_msgs/msg/Constraints); one of them is reached.

        Returns:
            Whether the goal can be used.

        Raises:
            ValueError: not exactly one goal is given, or a pose without its link.
        """
        given = (configuration_name, robot_state, pose_stamped_msg, motion_plan_constraints)
        if sum(item is not None for item in given) != 1:
            raise ValueError(
                "give one of 'configuration_name', 'robot_state', 'pose_stamped_msg', 'motion_plan_constraints'"
            )
        if motion_plan_constraints is not None:
            self._goals = list(motion_plan_constraints)
            return bool(self._goals)
        if pose_stamped_msg is not None:
            if not pose_link:
                raise ValueError("a pose needs 'pose_link', the link that reaches it")
            self._goals = [_pose_goal(pose_stamped_msg, pose_link)]
            return True
        state = robot_state if configuration_name is None else self._named_state(configuration_name)
        if state is None:
            return False
        self._goals = [construct_joint_constraint(state, JointModelGroup(self._group, ""), _JOINT_TOLERANCE)]
        return True

    def set_path_constraints(self, path_constraints: Any) -> bool:
        """Set what must hold along plans (moveit_msgs/msg/Constraints)."""
        self._path_constraints = path_constraints
        return True

    def set_workspace(self, min_x: float, min_y: float, min_z: float, max_x: float, max_y: float, max_z: float) -> None:
        """Accept a workspace; it limits the base of mobile robots only, which is not planned for."""

    def unset_workspace(self) -> None:
        """Accept the end of a workspace. See `set_workspace`."""

    def plan(
        self,
        single_plan_parameters: PlanRequestParameters | None = None,
        multi_plan_parameters: MultiPipelinePlanRequestParameters | None = None,
        planning_scene: PlanningScene | None = None,
        solution_selection_function: Callable[[list[MotionPlanResponse]], MotionPlanResponse] | None = None,
        stopping_criterion_callback: Callable[..., bool] | None = None,
    ) -> MotionPlanResponse:
        """Plan a motion to the goal.

        Args:
            single_plan_parameters: the parameters; by default those of all plans.
            multi_plan_parameters: the parameters of several plans, which are made one after the other.
            planning_scene: the scene; by default the current one.
            solution_selection_function: returns one of the results; by default the one with the shortest path.
            stopping_criterion_callback: called with the results and the parameters after each plan; the plans after a
                call that returns True are not made.

        Raises:
            ValueError: both parameters are given, or no goal was set.
        """
        if single_plan_parameters is not None and multi_plan_parameters is not None:
            raise ValueError("give either 'single_plan_parameters' or 'multi_plan_parameters'")
        if not self._goals:
            raise ValueError("set a goal with 'set_goal_state' first")
        if multi_plan_parameters is None:
            return self._plan_once(single_plan_parameters or PlanRequestParameters(self._moveit), planning_scene)
        requests = multi_plan_parameters.multi_plan_request_parameters
        responses: list[MotionPlanResponse] = []
        for parameters in requests:
            responses.append(self._plan_once(parameters, planning_scene))
            if stopping_criterion_callback is not None and stopping_criterion_callback(responses, requests):
                break
        return (solution_selection_function or _select_shortest)(responses)

    def _plan_once(self, parameters: PlanRequestParameters, scene: PlanningScene | None) -> MotionPlanResponse:
        session, group = self._session, self._group
        start = self.get_start_state()
        started = perf_counter()
        trajectory, code = None, "SUCCESS"
        try:
            choice = session.pipelines.choose(parameters.planning_pipeline, parameters.planner_id, group.name)
            if choice.notice:
                session.log_warning(choice.notice)
            path_constraint, arc = session.monitor.read_path_constraints(
                choice.method, self._path_constraints, start.positions, group.tip
            )
            request = PlanRequest(
                group,
                start.positions,
                [session.monitor.read_goal(goal, start.positions, group.tip) for goal in self._goals],
                path_constraint,
                choice.method,
                choice.planner,
                choice.parameters,
                parameters.planning_time,
                parameters.max_velocity_scaling_factor,
                parameters.max_acceleration_scaling_factor,
                arc=arc,
            )
            scene_state = session.monitor.scene_with(
                robot_state_to_message(start), start.positions, None if scene is None else scene.scene
            )
            planner = MotionPlanner(MovedRobot(self._model.robot), session.monitor.compile(scene_state))
            trajectory = RobotTrajectory.from_plan(start, group.name, planner.plan(request))
        except RequestError as error:
            code = error.code
            session.log_error(str(error))
        except PlanError as error:
            code = error.failure.name
            session.log_error(str(error))
        except LinkwrightError as error:  # OMPL is not installed.
            code = "FAILURE"
            session.log_error(render(error.diagnostics[0]))
        response = MotionPlanResponse(start, parameters.planner_id, code, perf_counter() - started, trajectory)
        if trajectory is not None:
            session.show(trajectory, response.start_state)
        return response

    def _named_state(self, name: str | None) -> RobotState | None:
        state = self._session.current_state()
        if name is None or not state.set_to_default_values(self._group.name, name):
            self._session.log_error(f"The group '{self._group.name}' has no state '{name}'")
            return None
        return state


def _pose_goal(stamped: Any, link: str) -> Any:
    position, rotation = stamped.pose.position, stamped.pose.orientation
    return construct_link_constraint(
        link,
        stamped.header.frame_id,
        (position.x, position.y, position.z),
        _POSITION_TOLERANCE_M,
        (rotation.x, rotation.y, rotation.z, rotation.w),
        _ORIENTATION_TOLERANCE_RAD,
    )


def _select_shortest(responses: list[MotionPlanResponse]) -> MotionPlanResponse:
    """Return the result with the shortest path, or the last failure."""
    found = [(item.trajectory.path_length(), index) for index, item in enumerate(responses) if item.trajectory]
    return responses[min(found)[1]] if found else responses[-1]
