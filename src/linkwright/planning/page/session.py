"""A planning session: the start and goal states that the user sets, and the motions between them."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Mapping
from functools import partial
from random import Random
from typing import Any

from linkwright.geometry.single import Transform, interpolate
from linkwright.page.protocol.motion_planning import (
    MotionCommand,
    PlanningActivity,
    PlanningOutcome,
    PlanningPipeline,
    PlanningSettings,
    QueryName,
)
from linkwright.planning.page.groups import PlanningGroup, Tip
from linkwright.planning.page.latest_job import LatestJob
from linkwright.planning.page.move_group import (
    MotionRequest,
    MoveGroupClient,
    PlanResult,
    get_duration_s,
    make_state,
)
from linkwright.rviz.displays.moveit.robot import JointPositions, PosableRobot

CURRENT, RANDOM, RANDOM_VALID = "<current>", "<random>", "<random valid>"
SAME_AS_START, SAME_AS_GOAL = "<same as start>", "<same as goal>"

QUERIES: tuple[QueryName, QueryName] = ("start", "goal")

_MAX_RANDOM_ATTEMPTS = 100
"""The number of random states that are checked for a valid one, as in RViz."""

_APPROXIMATION_STEPS = 5
"""How often the line to a pose that cannot be reached is halved."""


class Query:
    """A start or goal state.

    Attributes:
        choice: the user's choice; empty if the state was changed since.
        values: the positions of the group's joints in rad or m; empty while the state follows the current one.
        colliding: the links that collide in this state.
    """

    def __init__(self) -> None:
        self.choice = CURRENT
        self.values: dict[str, float] = {}
        self.colliding: frozenset[str] = frozenset()

    def set(self, values: Mapping[str, float], choice: str = "") -> None:
        """Replace the positions."""
        self.values, self.choice = dict(values), choice


class PlanningSession:
    """The states and motions of one display.

    Args:
        on_changed: called when something has changed that the page shows.
        read_settings: returns the current settings.
        read_workspace: returns the center and the size of the workspace, each as x, y, z in meters.
        on_released: called with the name of a handle that the user released, after the last pose was handled.
        random: the source of random states.

    Attributes:
        robot: the robot, or None.
        current: the current state of the robot.
        group: the planning group, or None.
        client: the clients of move_group, or None while the display is disabled.
        queries: the start and the goal state.
        pipelines: the planning pipelines of move_group.
        pipeline: the chosen pipeline; empty for the default.
        planner: the chosen planner; empty for the default.
        unreachable: the handles at poses that cannot be reached.
        activity: whether a motion is being planned or executed.
        outcome: the result of the last command.
        result: the last plan, or None if there is none to execute.
        error: the name of the error code of the last command; empty if it succeeded.
        planning_time_s: the time that the last planning took.
        duration_s: the duration of the last planned motion.
        fraction: the share of the last Cartesian path that was planned.
        is_refused: whether move_group did not accept the last change of the planning scene.
    """

    def __init__(
        self,
        on_changed: Callable[[], None],
        read_settings: Callable[[], PlanningSettings],
        read_workspace: Callable[[], tuple[list[float], list[float]]],
        on_released: Callable[[str], None],
        random: Random | None = None,
    ) -> None:
        self._on_changed, self._on_released = on_changed, on_released
        self._read_settings, self._read_workspace = read_settings, read_workspace
        self._random = random or Random()  # noqa: S311  # not for secrets
        self._ik = LatestJob(self._end_drags)
        self._released: set[str] = set()
        self._sampling, self._motion, self._listing = (LatestJob() for _ in range(3))
        self._editing = LatestJob(self._end_object_drags)
        self._released_objects: set[str] = set()
        self._differences: deque[tuple[Any, str]] = deque()
        self.is_refused = False
        self._validity: dict[QueryName, LatestJob] = {"start": LatestJob(), "goal": LatestJob()}
        self.robot: PosableRobot | None = None
        self.current = JointPositions()
        self.group: PlanningGroup | None = None
        self.client: MoveGroupClient | None = None
        self.queries: dict[QueryName, Query] = {name: Query() for name in QUERIES}
        self.pipelines: list[PlanningPipeline] = []
        self.pipeline = self.planner = ""
        self.unreachable: set[str] = set()
        self.activity: PlanningActivity = "idle"
        self.outcome: PlanningOutcome = "none"
        self.result: PlanResult | None = None
        self.error = ""
        self._is_stopped = False
        self.planning_time_s = self.duration_s = 0.0
        self.fraction = 1.0

    # --- lifecycle ---------------------------------------------------------------------------------------------

    def connect(self, client: MoveGroupClient) -> None:
        """Use the clients of a move_group instead of the previous ones."""
        self.disconnect()
        self.client = client
        self.list_pipelines()

    def disconnect(self) -> None:
        """Cancel all jobs, and close the clients."""
        for job in (self._ik, self._sampling, self._motion, self._listing, self._editing, *self._validity.values()):
            job.cancel()
        if self.client is not None:
            self.client.close()
            self.client = None
        self._differences.clear()
        self.pipelines, self.activity = [], "idle"

    def set_group(self, group: PlanningGroup | None) -> None:
        """Plan for another group; its start and goal state follow the current state."""
        self.group = group
        self.queries = {name: Query() for name in QUERIES}
        self.unreachable.clear()
        self.result, self.outcome, self.error = None, "none", ""
        for name in QUERIES:
            self.check_validity(name)

    def list_pipelines(self) -> None:
        """Request the planning pipelines, if they are not known and move_group is ready."""
        client = self.client
        if client is None or self.pipelines or not client.is_ready:
            return

        async def read() -> None:
            self.pipelines = await client.query_pipelines()
            self._on_changed()

        self._listing.request(read)

    # --- states ------------------------------------------------------------------------------------------------

    def state(self, name: QueryName) -> JointPositions:
        """Return the robot in the start or goal state."""
        state = self.current.copy()
        state.values.update(self.queries[name].values)
        return state

    def set_current(self, state: JointPositions) -> None:
        """Set the current state, which the start and goal states follow until they are set."""
        self.current = state
        for name, query in self.queries.items():
            if not query.values:
                self.check_validity(name)

    def choose(self, name: QueryName, choice: str) -> None:
        """Set the start or goal state to a choice of the panel; an unknown name is ignored."""
        group, query = self.group, self.queries[name]
        if group is None:
            return
        if choice == CURRENT:
            query.set({}, CURRENT)
        elif choice in (SAME_AS_START, SAME_AS_GOAL):
            other = self.state("start" if choice == SAME_AS_START else "goal")
            query.set(self._select(other.values), choice)
        elif choice == RANDOM:
            query.set(group.sample(self._random), choice)
        elif choice == RANDOM_VALID:
            self._sampling.request(partial(self._sample_valid, name, group))
            return
        elif choice in group.states:
            query.set({**self._select(self.state(name).values), **group.states[choice]}, choice)
        else:
            return
        self._after_change(name)

    def set_joint(self, name: QueryName, joint: str, position: float) -> None:
        """Set the position of a joint of the group, within its limits."""
        group = self.group
        found = next((item for item in group.joints if item.name == joint), None) if group else None
        if found is not None:
            values = self._select(self.state(name).values)
            values[joint] = min(max(position, found.lower), found.upper)
            self.queries[name].set(values)
            self._after_change(name)

    def drag(self, name: QueryName, tip: Tip, pose: Transform, handle: str) -> None:
        """Move the link of a handle to a pose in the robot's frame, if inverse kinematics finds a state for it."""
        self._ik.request(partial(self._solve, name, tip, pose, handle))

    def release(self, handle: str) -> None:
        """End the drag of a handle, after its last pose was handled."""
        self._released.add(handle)
        if not self._ik.is_running:
            self._end_drags()

    def _end_drags(self) -> None:
        released, self._released = self._released, set()
        self.unreachable -= released
        for handle in released:
            self._on_released(handle)

    def check_validity(self, name: QueryName) -> None:
        """Find the links that collide in the start or goal state."""
        if self.client is not None and self.group is not None:
            self._validity[name].request(partial(self._check, name))

    def _select(self, values: Mapping[str, float]) -> dict[str, float]:
        return {joint.name: values.get(joint.name, 0.0) for joint in (self.group.joints if self.group else ())}

    def _after_change(self, name: QueryName) -> None:
        self.unreachable = {handle for handle in self.unreachable if not handle.startswith(name)}
        self.check_validity(name)
        self._on_changed()

    async def _sample_valid(self, name: QueryName, group: PlanningGroup) -> None:
        for _ in range(_MAX_RANDOM_ATTEMPTS):
            values = group.sample(self._random)
            if self.client is None or group is not self.group:
                return
            is_valid, _ = await self.client.find_colliding_links(group.name, make_state(values))
            if is_valid:
                self.queries[name].set(values, RANDOM_VALID)
                self._after_change(name)
                return

    async def _check(self, name: QueryName) -> None:
        client, group = self.client, self.group
        if client is None or group is None:
            return
        _, links = await client.find_colliding_links(group.name, make_state(self.state(name).values))
        if self.queries[name].colliding != links:
            self.queries[name].colliding = frozenset(links)
            self._on_changed()

    async def _solve(self, name: QueryName, tip: Tip, pose: Transform, handle: str) -> None:
        settings = self._read_settings()
        values = await self._find_positions(name, tip, pose, settings)
        is_reached = values is not None
        if values is None and settings.approximate:
            values = await self._approach(name, tip, pose, settings)
        if values is not None:
            self.queries[name].set({**self._select(self.state(name).values), **values})
            self.check_validity(name)
        self.unreachable.discard(handle)
        if not is_reached:
            self.unreachable.add(handle)
        self._on_changed()

    async def _find_positions(
        self, name: QueryName, tip: Tip, pose: Transform, settings: PlanningSettings
    ) -> dict[str, float] | None:
        robot, client, group = self.robot, self.client, self.group
        if robot is None or client is None or group is None:
            return None
        state = self.state(name)
        solution = await client.solve_ik(
            tip.group,
            tip.link,
            pose,
            robot.frame_of(state),
            make_state(state.values),
            avoids_collisions=settings.collision_aware,
        )
        if solution is None:
            return None
        names = group.joint_names
        found = zip(solution.name, solution.position, strict=False)
        return {joint: float(position) for joint, position in found if joint in names}

    async def _approach(
        self, name: QueryName, tip: Tip, pose: Transform, settings: PlanningSettings
    ) -> dict[str, float] | None:
        """Return the positions for the last pose that can be reached on the line to a pose, or None.

        MoveIt's service has no approximate solutions, so the line is halved several times.
        """
        if self.robot is None:
            return None
        start = self.robot.link_poses(self.state(name))[tip.link]
        best: dict[str, float] | None = None
        reached, missed = 0.0, 1.0
        for _ in range(_APPROXIMATION_STEPS):
            ratio = (reached + missed) / 2.0
            values = await self._find_positions(name, tip, interpolate(start, pose, ratio), settings)
            if values is None:
                missed = ratio
            else:
                best, reached = values, ratio
        return best

    # --- planning scene ----------------------------------------------------------------------------------------

    def apply_scene(self, difference: Any, handle: str = "") -> None:
        """Apply a difference to the planning scene of move_group, after the differences before it.

        Args:
            difference: the moveit_msgs/msg/PlanningScene.
            handle: the handle that is dragged. The difference replaces an earlier one of this handle that still waits.
        """
        if handle and self._differences and self._differences[-1][1] == handle:
            self._differences.pop()
        self._differences.append((difference, handle))
        self._editing.request(self._apply_differences)

    def release_object(self, handle: str) -> None:
        """End the drag of an object's handle, which returns to the object if move_group did not move it."""
        self._released_objects.add(handle)
        if not self._editing.is_running:
            self._end_object_drags()

    async def _apply_differences(self) -> None:
        while self._differences and self.client is not None:
            difference, _ = self._differences.popleft()
            self.is_refused = not await self.client.apply_scene(difference)
            self._on_changed()

    def _end_object_drags(self) -> None:
        released, self._released_objects = self._released_objects, set()
        if self.is_refused:
            for handle in released:
                self._on_released(handle)

    # --- motions -----------------------------------------------------------------------------------------------

    def command(self, command: MotionCommand) -> None:
        """Carry out a command of the panel."""
        if command == "stop":
            self._is_stopped = True
            if self.client is not None:
                self.client.stop()
        elif not self._motion.is_running and self.client is not None and self.group is not None:
            self._motion.request(partial(self._run, command))

    async def _run(self, command: MotionCommand) -> None:
        self._is_stopped = False
        try:
            is_planned = command == "execute" or await self._plan()
            if is_planned and command != "plan":
                await self._execute()
        finally:
            self.activity = "idle"
            self._on_changed()

    async def _plan(self) -> bool:
        """Plan from the start to the goal state, and return whether there is a plan."""
        client, group, robot = self.client, self.group, self.robot
        if client is None or group is None or robot is None:
            return False
        self._show("planning", "none")
        self.result = None
        settings = self._read_settings()
        goal = self.state("goal")
        motion = MotionRequest(
            group.name,
            make_state(self.queries["start"].values),
            self._select(goal.values),
            robot.frame_of(goal),
            self._read_workspace(),
            settings,
            self.pipeline,
            self.planner,
        )
        started = asyncio.get_running_loop().time()
        if settings.cartesian and group.tips:
            link = group.tips[0].link
            pose = robot.link_poses(goal)[link]
            result = await client.plan_cartesian(motion, link, pose, avoids_collisions=settings.collision_aware)
        else:
            result = await client.plan(motion)
        self.planning_time_s = result.planning_time_s or asyncio.get_running_loop().time() - started
        self.fraction = result.fraction
        self.error = "PREEMPTED" if self._is_stopped else result.error
        if self.error:
            self.outcome = "stopped" if self.error == "PREEMPTED" else "planning_failed"
        elif result.fraction < 1.0:
            self.outcome = "path_cut"
        else:
            self.result, self.outcome = result, "planned"
            self.duration_s = get_duration_s(result.trajectory)
        return self.result is not None

    async def _execute(self) -> None:
        client, result = self.client, self.result
        if client is None or result is None:
            return
        self._show("executing", self.outcome)
        self.error = await client.execute(result.trajectory)
        self.result = None
        if not self.error:
            self.outcome = "executed"
        else:
            self.outcome = "stopped" if self.error == "PREEMPTED" else "execution_failed"

    def _show(self, activity: PlanningActivity, outcome: PlanningOutcome) -> None:
        self.activity, self.outcome, self.error = activity, outcome, ""
        self._on_changed()
