"""The panels Controllers and Joint trajectory: ros2_control's controllers, and motions of their joints."""

from __future__ import annotations

from typing import ClassVar, Literal

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage

ControllerAction = Literal["load", "configure", "activate", "deactivate", "unload"]
HardwareState = Literal["unconfigured", "inactive", "active"]


class ControllerRow(Record):
    """A controller that is loaded, or named in the manager's parameters (state ``not loaded``)."""

    name: str
    kind: str
    state: str
    claimed: list[str]


class HardwareRow(Record):
    """A hardware component, with its command interfaces."""

    name: str
    kind: str
    plugin: str
    state: str
    commands: list[str]


class ControllerManagers(ServerMessage):
    """The full names of the controller managers."""

    managers: list[str]


class ControllerList(ServerMessage):
    """The controllers and the hardware of a manager, sent once per second if they change.

    `error` is the reason why they are not known, or None.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("manager",)

    manager: str
    controllers: list[ControllerRow]
    hardware: list[HardwareRow]
    error: str | None


class ControllerResult(ServerMessage):
    """The outcome of a change. `text` is empty if the change succeeded."""

    manager: str
    name: str
    text: str


class WatchControllers(PageMessage):
    """Whether the page receives the list of managers from now on, and whose controllers it shows."""

    wants_list: bool
    manager: str | None


class ChangeController(PageMessage):
    """A change of a controller's state."""

    manager: str
    name: str
    action: ControllerAction


class ChangeHardware(PageMessage):
    """A change of the state of a hardware component."""

    manager: str
    name: str
    state: HardwareState


class TrajectoryJoint(Record):
    """A joint of a trajectory controller, in rad or m.

    The limits are None if the description does not contain them.
    """

    name: str
    position: float | None
    lower: float | None
    upper: float | None
    velocity: float | None


class TrajectoryControllers(ServerMessage):
    """The full names of the controllers that accept trajectories."""

    controllers: list[str]


class TrajectoryController(ServerMessage):
    """The joints of a controller, sent a few times per second while the page watches it.

    `topic` is where trajectories are sent. `error` is the reason why the joints are not known, or None.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("controller",)

    controller: str
    topic: str
    joints: list[TrajectoryJoint]
    error: str | None


class WatchTrajectory(PageMessage):
    """Whether the page receives the list of controllers from now on, and whose joints it shows."""

    wants_list: bool
    controller: str | None


class MoveJoints(PageMessage):
    """A motion of a controller's joints to positions, in rad or m, within some seconds."""

    controller: str
    positions: list[float]
    seconds: float
