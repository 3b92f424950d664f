"""move_group on a graph, with clients and a controller, and messages for tests."""

from __future__ import annotations

import asyncio
from copy import copy
from typing import Any

from linkwright.graph import ActionClient, ActionServer
from linkwright.graph.actions.server import CancelResponse
from linkwright.messages import get_action, get_message, get_service
from linkwright.nodes import NodeOptions
from linkwright.planning.nodes.move_group import MoveGroup
from tests.planning.arms import LIMITS, SRDF, urdf
from tests.waiting import TIMEOUT_S

PARAMETERS: dict[str, Any] = {
    "robot_description": urdf(),
    "robot_description_semantic": SRDF,
    "robot_description_planning": {"joint_limits": LIMITS, "default_velocity_scaling_factor": 0.5},
    "planning_pipelines": ["ompl", "pilz_industrial_motion_planner", "chomp"],
    "default_planning_pipeline": "ompl",
    "ompl": {
        "planner_configs": {
            "RRTConnectkConfigDefault": {"type": "geometric::RRTConnect", "range": 0.0},
            "Unknown": {"type": "geometric::LazyPRMstar"},
        },
        "arm": {"planner_configs": ["RRTConnectkConfigDefault"]},
    },
    "chomp": {"planning_plugins": ["chomp_interface/CHOMPPlanner"]},
    "moveit_simple_controller_manager": {
        "controller_names": ["arm_controller", "gripper_controller"],
        "arm_controller": {
            "type": "FollowJointTrajectory",
            "action_ns": "follow_joint_trajectory",
            "joints": ["pan", "lift", "elbow", "roll", "bend", "twist"],
            "default": True,
        },
        "gripper_controller": {"type": "GripperCommand", "action_ns": "gripper_cmd", "joints": ["left"]},
    },
}
START = {"lift": 0.6, "elbow": 1.2, "bend": 1.0}


class Bench:
    """move_group, its clients, and a controller that records its goals."""

    def __init__(self, graph: Any, **parameters: Any) -> None:
        self.graph = graph
        self.node = graph.create_node("client")
        self.received: list[Any] = []
        self.fails = False
        self.motion_started = asyncio.Event()
        self.end_of_motion: asyncio.Event | None = None
        self.server = ActionServer(
            self.node,
            "control_msgs/action/FollowJointTrajectory",
            "arm_controller/follow_joint_trajectory",
            self._follow,
            cancel_callback=self._cancel,
        )
        self.gripper = ActionServer(
            self.node, "control_msgs/action/GripperCommand", "gripper_controller/gripper_cmd", self._grip
        )
        self.move_group = MoveGroup(graph, NodeOptions(parameters={**PARAMETERS, **parameters}))
        self.state_publisher = self.node.create_publisher("sensor_msgs/msg/JointState", "joint_states", 10)

    async def set_state(self, **joints: float) -> None:
        message = get_message("sensor_msgs/msg/JointState")()
        message.name, message.position = list(joints), list(joints.values())
        self.state_publisher.publish(message)
        await self.graph.settle()

    async def wait(self, future: Any) -> Any:
        for _ in range(round(TIMEOUT_S / 0.01)):
            await self.graph.settle()
            if future.done():
                return future.result()
            await asyncio.sleep(0.01)
        raise AssertionError("there was no response in time")

    async def call(self, kind: str, name: str, **fields: Any) -> Any:
        service = get_service(f"moveit_msgs/srv/{kind}")
        client = self.node.create_client(service, name)
        return await self.wait(client.call_async(service.Request(**fields)))

    async def send(self, kind: str, name: str, **fields: Any) -> tuple[int, Any]:
        return await self.end(await self.start(kind, name, **fields))

    async def start(self, kind: str, name: str, **fields: Any) -> Any:
        """Send a goal, and return its handle."""
        action = get_action(f"moveit_msgs/action/{kind}")
        self.client = ActionClient(self.node, action, name)
        return await self.wait(self.client.send_goal_async(action.Goal(**fields)))

    async def end(self, handle: Any) -> tuple[int, Any]:
        """Return the status and the result of a goal, when it ends."""
        response = await self.wait(handle.get_result_async())
        return response.status, response.result

    async def _follow(self, goal: Any) -> Any:
        self.received.append(goal.request.trajectory)
        self.motion_started.set()
        if self.end_of_motion is not None:
            await self.end_of_motion.wait()
        if goal.is_cancel_requested:
            goal.canceled()
        elif self.fails:
            goal.abort()
        else:
            goal.succeed()
        return get_action("control_msgs/action/FollowJointTrajectory").Result()

    def _cancel(self, _: Any) -> CancelResponse:
        if self.end_of_motion is not None:
            self.end_of_motion.set()
        return CancelResponse.ACCEPT

    def _grip(self, goal: Any) -> Any:
        self.received.append(goal.request.command)
        goal.succeed()
        return get_action("control_msgs/action/GripperCommand").Result()


def message(type_name: str, **fields: Any) -> Any:
    return get_message(type_name)(**fields)


def short_trajectory() -> Any:
    """Return a trajectory of 0.1 s that stays at `START`."""
    result = message("moveit_msgs/msg/RobotTrajectory")
    result.joint_trajectory.joint_names = ["pan", *START, "roll", "twist"]
    point = message("trajectory_msgs/msg/JointTrajectoryPoint", positions=[0.0, *START.values(), 0.0, 0.0])
    point.time_from_start.nanosec = 100_000_000
    result.joint_trajectory.points = [point]
    return result


def stamped(x: float, y: float, z: float, frame: str = "base") -> Any:
    result = message("geometry_msgs/msg/PoseStamped")
    result.header.frame_id = frame
    result.pose.position.x, result.pose.position.y, result.pose.position.z = x, y, z
    result.pose.orientation.y, result.pose.orientation.w = 1.0, 0.0
    return result


def box(name: str, x: float, y: float, z: float, *, size: tuple[float, float, float], frame: str = "base") -> Any:
    result = message("moveit_msgs/msg/CollisionObject", id=name)
    result.header.frame_id = frame
    result.pose.position.x, result.pose.position.y, result.pose.position.z = x, y, z
    result.primitives = [message("shape_msgs/msg/SolidPrimitive", type=1, dimensions=list(size))]
    return result


def endless_request() -> Any:
    """Return a request for a motion that does not exist, which is searched for an hour."""
    start = {"pan": 1.5, "lift": 1.2, "elbow": 0.6}
    goal = joint_constraints(**start | {"pan": -1.5})
    return motion_request(goal, start_state=state(**start), allowed_planning_time=3600.0)


def closed_room() -> Any:
    """Return a scene with two walls on both sides of the arm and a ceiling, for `endless_request`."""
    scene = message("moveit_msgs/msg/PlanningScene", is_diff=True)
    scene.world.collision_objects = [
        box("front", 1.05, 0.0, 0.0, size=(1.9, 0.02, 3.0)),
        box("back", -1.05, 0.0, 0.0, size=(1.9, 0.02, 3.0)),
        box("ceiling", 0.0, 0.0, 0.75, size=(4.0, 4.0, 0.02)),
    ]
    return scene


def joint_constraints(**joints: float) -> Any:
    names = ("pan", "lift", "elbow", "roll", "bend", "twist")
    constraints = [
        message("moveit_msgs/msg/JointConstraint", joint_name=name, position=joints.get(name, 0.0)) for name in names
    ]
    return message("moveit_msgs/msg/Constraints", joint_constraints=constraints)


def motion_request(*goals: Any, **fields: Any) -> Any:
    return message("moveit_msgs/msg/MotionPlanRequest", group_name="arm", goal_constraints=list(goals), **fields)


def position_constraint(pose: Any, y: float, z: float) -> Any:
    """Return a constraint without a shape for the tool, at an offset in y and z from a pose."""
    region = message("moveit_msgs/msg/BoundingVolume")
    region.primitive_poses = [message("geometry_msgs/msg/Pose", position=copy(pose.position))]
    region.primitive_poses[0].position.y += y
    region.primitive_poses[0].position.z += z
    constraint = message("moveit_msgs/msg/PositionConstraint", link_name="tool", constraint_region=region)
    constraint.header.frame_id = "base"
    return constraint


def state(**joints: float) -> Any:
    result = message("moveit_msgs/msg/RobotState", is_diff=True)
    result.joint_state.name, result.joint_state.position = list(joints), list(joints.values())
    return result
