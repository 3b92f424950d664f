"""The state of planning, as the panel shows it."""

from __future__ import annotations

from linkwright.page.protocol.motion_planning import (
    MissingPart,
    MotionPlanningState,
    PlannedJoint,
    PlanningSettings,
)
from linkwright.planning.page.scene_edits import describe_objects
from linkwright.planning.page.session import PlanningSession
from linkwright.rviz.displays.moveit.scene import Scene


def make_panel_state(
    session: PlanningSession,
    scene: Scene,
    groups: tuple[str, ...],
    settings: PlanningSettings,
    *,
    has_state: bool,
    shows_goal: bool,
) -> MotionPlanningState:
    """Return the content for the panel.

    Args:
        session: the planning session.
        scene: the planning scene.
        groups: the names of the planning groups.
        settings: the settings of requests.
        has_state: whether the state of the robot is known.
        shows_goal: whether the goal state is drawn.
    """
    group, goal = session.group, session.state("goal")
    return MotionPlanningState(
        missing=_find_missing_part(session, has_state=has_state),
        robot=session.robot.description.name if session.robot is not None else "",
        groups=list(groups),
        group=group.name if group else "",
        states=list(group.states) if group else [],
        start=session.queries["start"].choice,
        goal=session.queries["goal"].choice,
        pipelines=session.pipelines,
        pipeline=session.pipeline,
        planner=session.planner,
        settings=settings,
        draggable=shows_goal and group is not None and bool(group.tips),
        joints=[
            PlannedJoint(joint.name, joint.kind, joint.lower, joint.upper, goal.values.get(joint.name, 0.0))
            for joint in (group.joints if group else ())
        ],
        unreachable=sorted(session.unreachable),
        colliding=sorted(session.queries["goal"].colliding),
        activity=session.activity,
        outcome=session.outcome,
        error=session.error,
        planning_time=session.planning_time_s,
        duration=session.duration_s,
        fraction=session.fraction,
        executable=session.result is not None,
        objects=describe_objects(scene),
        links=_list_links(session),
        refused=session.is_refused,
    )


def _list_links(session: PlanningSession) -> list[str]:
    """Return the links of the robot, those with handles first."""
    if session.robot is None:
        return []
    tips = [tip.link for tip in session.group.tips] if session.group is not None else []
    return list(dict.fromkeys((*tips, *session.robot.link_names)))


def _find_missing_part(session: PlanningSession, *, has_state: bool) -> MissingPart:
    if session.robot is None:
        return "description"
    if session.group is None:
        return "semantics"
    if session.client is None or not session.client.is_ready:
        return "move_group"
    return "none" if has_state else "state"
