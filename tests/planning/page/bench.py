"""A viewer with a MotionPlanning display beside move_group and a controller; for tests."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Any

from linkwright.graph import ActionServer
from linkwright.graph.actions.goal import CancelResponse
from linkwright.graph.loop.node_handle import ReentrantCallbackGroup
from linkwright.messages import get_action, get_message
from linkwright.nodes import NodeOptions
from linkwright.page.protocol.markers import MarkerFeedback
from linkwright.page.protocol.motion_planning import ChooseQueryState, CommandMotion, SetQueryJoint
from linkwright.planning.nodes.move_group import MoveGroup
from tests.planning.arms import urdf
from tests.planning.nodes.test_move_group import PARAMETERS, START
from tests.rviz.displays.moveit.arm import make_config
from tests.viewer.contents import shown_markers, unpack
from tests.viewer.scene import World, open_world
from tests.waiting import TIMEOUT_S

HANDLE = "goal tool"


class PlanningBench:
    """The viewer, its display, and what it shows."""

    def __init__(self, world: World) -> None:
        self.world = world
        self.display = world.display("MotionPlanning")
        self.session = self.display._session
        self.followed: list[Any] = []
        self.is_slow = False
        node = world.graph.create_node("controllers")
        self._server = ActionServer(
            node,
            "control_msgs/action/FollowJointTrajectory",
            "arm_controller/follow_joint_trajectory",
            self._follow,
            callback_group=ReentrantCallbackGroup(),
            cancel_callback=lambda _goal: CancelResponse.ACCEPT,
        )
        self._states = node.create_publisher("sensor_msgs/msg/JointState", "joint_states", 10)
        self.move_group: MoveGroup | None = None

    def start_move_group(self, **parameters: Any) -> None:
        options = NodeOptions(parameters={**PARAMETERS, **parameters})
        self.move_group = MoveGroup(self.world.graph, options)
        self.publish_joints(**START)

    def publish_joints(self, **joints: float) -> None:
        message = get_message("sensor_msgs/msg/JointState")()
        message.name, message.position = list(joints), list(joints.values())
        self._states.publish(message)

    async def until(self, condition: Callable[[], Any]) -> None:
        """Wait until a condition holds, while the graph works."""
        for _ in range(round(TIMEOUT_S / 0.01)):
            await self.world.settle()
            if condition():
                return
            await asyncio.sleep(0.01)
        raise AssertionError(f"not in time: {self.panel()}")

    def contents(self) -> dict[str, dict[str, Any]]:
        """Return what a page that opens now receives besides the markers, by key."""
        return {content.key: content.fields for content in map(unpack, self.display.data()[1:])}

    def panel(self) -> dict[str, Any]:
        return self.contents().get("planning", {})

    def markers(self) -> dict[str, dict[str, Any]]:
        return shown_markers(self.display)

    def joints(self) -> dict[str, float]:
        return {joint["name"]: joint["position"] for joint in self.panel()["joints"]}

    def handle_pose(self, handle: str = HANDLE) -> list[float]:
        contents = self.contents()
        return contents.get(f"pose {handle}", contents[f"marker {handle}"])["pose"]

    def drag(self, pose: list[float], event: str = "pose_update", handle: str = HANDLE) -> None:
        self.display.receive(MarkerFeedback(self.display.id, handle, "move_x", event, pose, 0, []))

    def choose(self, query: str, choice: str) -> None:
        self.display.receive(ChooseQueryState(self.display.id, query, choice))

    def set_joint(self, joint: str, position: float) -> None:
        self.display.receive(SetQueryJoint(self.display.id, "goal", joint, position))

    def command(self, command: str) -> None:
        self.display.receive(CommandMotion(self.display.id, command))

    async def _follow(self, goal: Any) -> Any:
        trajectory = goal.request.trajectory
        self.followed.append(trajectory)
        while self.is_slow:
            await asyncio.sleep(0.01)
            if goal.is_cancel_requested:
                goal.canceled()
                return get_action("control_msgs/action/FollowJointTrajectory").Result()
        self.publish_joints(**dict(zip(trajectory.joint_names, trajectory.points[-1].positions, strict=True)))
        goal.succeed()
        return get_action("control_msgs/action/FollowJointTrajectory").Result()


@asynccontextmanager
async def open_bench(
    extra: str = "", *, with_move_group: bool = True, **parameters: Any
) -> AsyncIterator[PlanningBench]:
    """Open a display whose planning scene is drawn at once."""
    config = make_config("MotionPlanning", f", Scene Geometry: {{Scene Display Time: 0.0001}}{extra}")
    async with open_world(config) as world:
        bench = PlanningBench(world)
        world.describe(urdf())
        if with_move_group:
            bench.start_move_group(**parameters)
            await bench.until(lambda: bench.panel().get("missing") == "none")
        try:
            yield bench
        finally:
            if bench.move_group is not None:
                bench.move_group.close()
