"""The nav2 panel: the states of nav2's nodes and goal, and commands to the nodes."""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import PageMessage, ServerMessage

ManagerState = Literal["unknown", "inactive", "active"]
"""The state of the nodes of a lifecycle manager; ``unknown`` if there is no manager."""

GoalState = Literal["none", "active", "canceling", "succeeded", "canceled", "aborted"]

NavigationCommand = Literal["startup", "pause", "resume", "reset", "cancel"]


class WatchNavigation(PageMessage):
    """Whether the page shows its navigation panel."""

    open: bool


class CommandNavigation(PageMessage):
    """A command of the user: for both lifecycle managers, or to cancel all goals."""

    command: NavigationCommand


class NavigationState(ServerMessage):
    """The state of navigation for the panel.

    Attributes:
        navigation: the state of lifecycle_manager_navigation.
        localization: the state of lifecycle_manager_localization.
        goal: the state of the last goal of ``navigate_to_pose``.
        eta: the remaining time in seconds. This value and the next three are None if there is no feedback.
        distance: the remaining distance, meters.
        elapsed: the elapsed time, seconds.
        recoveries: the number of recoveries so far.
        busy: whether a command is being carried out.
        problem: the reason why the last command failed; empty if it succeeded.
    """

    navigation: ManagerState
    localization: ManagerState
    goal: GoalState
    eta: float | None
    distance: float | None
    elapsed: float | None
    recoveries: int | None
    busy: bool
    problem: str


class GoalOutcome(ServerMessage):
    """Whether the last goal failed. The page shows this over the scene.

    Attributes:
        reason: the last error of the node that aborted the goal, or the reason why it was not sent; empty if unknown.
        failed: whether the goal failed; false as soon as another goal is accepted.
    """

    reason: str
    failed: bool


NO_GOAL_FAILED = GoalOutcome("", failed=False)
