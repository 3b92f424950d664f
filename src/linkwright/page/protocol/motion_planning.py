"""The MotionPlanning display and panel of MoveIt: requests of pages, and the state of planning."""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import DataContent, PageMessage, Record

QueryName = Literal["start", "goal"]

MotionCommand = Literal["plan", "execute", "plan_and_execute", "stop"]

PlanningActivity = Literal["idle", "planning", "executing"]

PlanningOutcome = Literal["none", "planned", "executed", "planning_failed", "execution_failed", "stopped", "path_cut"]
"""The result of the last command; ``path_cut`` is a Cartesian path that ends before the goal."""

MissingPart = Literal["none", "description", "semantics", "state", "move_group"]
"""The part that planning needs and that is not available."""

JointKind = Literal["revolute", "continuous", "prismatic"]


class CommandMotion(PageMessage):
    """A command of the user: plan, execute the plan, both, or stop."""

    display: str
    command: MotionCommand


class ChooseQueryState(PageMessage):
    """The choice of a start or goal state.

    `choice` is ``<current>``, ``<random valid>``, ``<random>``, ``<same as start>``, ``<same as goal>``, or the name of
    a state in the SRDF.
    """

    display: str
    query: QueryName
    choice: str


class SetQueryJoint(PageMessage):
    """The position of a joint in the start or goal state, rad or m."""

    display: str
    query: QueryName
    joint: str
    position: float


class ChoosePlanner(PageMessage):
    """The choice of a planning pipeline and one of its planners. Empty names leave the choice to move_group."""

    display: str
    pipeline: str
    planner: str


ObjectShape = Literal["box", "sphere", "cylinder", "cone"]


class AddSceneObject(PageMessage):
    """A new object in the planning scene, in front of the robot.

    `size` is x, y, z of a box, the radius of a sphere, or the height and the radius of a cylinder or cone, in meters.
    """

    display: str
    name: str
    shape: ObjectShape
    size: list[float]


class MoveSceneObject(PageMessage):
    """A new pose of an object in its frame: `position` in meters, and roll, pitch, yaw in rad."""

    display: str
    name: str
    position: list[float]
    rpy: list[float]


class SelectSceneObject(PageMessage):
    """The object of the planning scene that gets a handle; an empty name takes the handle away."""

    display: str
    name: str


class RemoveSceneObject(PageMessage):
    """The removal of an object from the planning scene."""

    display: str
    name: str


class AttachSceneObject(PageMessage):
    """The attachment of an object to a link, or its detachment if `link` is empty."""

    display: str
    name: str
    link: str


class PlanningObject(Record):
    """An object of the planning scene with its pose in `frame`: meters, and roll, pitch, yaw in rad.

    `link` is the link to which it is attached, or empty.
    """

    name: str
    link: str
    frame: str
    position: list[float]
    rpy: list[float]


class PlanningPipeline(Record):
    """A planning pipeline with the names of its planners."""

    id: str
    title: str
    planners: list[str]


class PlannedJoint(Record):
    """A joint of the planning group with its limits and its position in the goal state, rad or m."""

    name: str
    kind: JointKind
    lower: float
    upper: float
    position: float


class PlanningSettings(Record):
    """The values of the display's hidden properties that the panel sets, with their paths as keys of the file."""

    planning_time: float
    attempts: int
    velocity_scaling: float
    acceleration_scaling: float
    cartesian: bool
    collision_aware: bool
    approximate: bool


class MotionPlanningState(DataContent):
    """The state of planning, for the panel and for the handles.

    Attributes:
        missing: the part that planning needs and that is not available yet.
        robot: the name of the robot; empty if its description is missing.
        groups: the planning groups of the SRDF.
        group: the current planning group.
        states: the named states of the group.
        start: the choice of the start state; empty if it was changed since.
        goal: the choice of the goal state; empty if it was changed since.
        pipelines: the planning pipelines.
        pipeline: the chosen pipeline; empty for the default.
        planner: the chosen planner; empty for the default.
        settings: the settings of requests.
        draggable: whether the goal state has a handle.
        joints: the joints of the group with their positions in the goal state.
        unreachable: the names of the handles at poses that cannot be reached.
        colliding: the links of the goal state that collide.
        activity: whether a motion is being planned or executed.
        outcome: the result of the last command.
        error: the name of the error code of the last command; empty if it succeeded.
        planning_time: the time that the last planning took, s.
        duration: the duration of the planned motion, s.
        fraction: the share of a Cartesian path that was planned.
        executable: whether there is a plan to execute.
        objects: the objects of the planning scene, sorted by name.
        links: the links of the robot, to which objects can be attached; those with handles first.
        refused: whether move_group did not accept the last change of the planning scene.
    """

    missing: MissingPart
    robot: str
    groups: list[str]
    group: str
    states: list[str]
    start: str
    goal: str
    pipelines: list[PlanningPipeline]
    pipeline: str
    planner: str
    settings: PlanningSettings
    draggable: bool
    joints: list[PlannedJoint]
    unreachable: list[str]
    colliding: list[str]
    activity: PlanningActivity
    outcome: PlanningOutcome
    error: str
    planning_time: float
    duration: float
    fraction: float
    executable: bool
    objects: list[PlanningObject]
    links: list[str]
    refused: bool
