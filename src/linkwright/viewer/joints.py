"""The Joints panel of the page, on the panel of a joint_state_publisher_gui."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal, Protocol

from linkwright.viewer.protocol import (
    CenterJoints,
    JointControl,
    JointPositions,
    Joints,
    RandomizeJoints,
    ServerMessage,
    SetJoint,
)


class Slider(Protocol):
    """What a panel says of one joint; rad or m."""

    @property
    def name(self) -> str: ...  # noqa: D102
    @property
    def kind(self) -> Literal["revolute", "continuous", "prismatic"]: ...  # noqa: D102
    @property
    def lower(self) -> float: ...  # noqa: D102
    @property
    def upper(self) -> float: ...  # noqa: D102
    @property
    def zero(self) -> float: ...  # noqa: D102
    @property
    def mimic(self) -> str | None: ...  # noqa: D102


class Panel(Protocol):
    """What the page's Joints panel needs; `linkwright.nodes.JointPanel` has it."""

    def sliders(self) -> Sequence[Slider]:
        """The joints, in the order to show them."""

    def positions(self) -> dict[str, float]:
        """Their positions, rad or m, mimicking joints included."""

    def set_position(self, name: str, value: float) -> None:
        """Move a joint, rad or m; clamped into its limits."""

    def randomize(self) -> None:
        """Move every joint to anywhere within its limits."""

    def center(self) -> None:
        """Move every joint to its zero."""

    def subscribe(self, callback: Callable[[str], None]) -> Callable[[], None]:
        """Have changes told, as ``sliders`` or ``positions``; calling the result ends it."""


class JointBridge:
    """Between the page's Joints panel and the one that moves the joints, once there is one."""

    def __init__(self, publish: Callable[[ServerMessage], None]) -> None:
        self._publish = publish
        self._panel: Panel | None = None
        self._unsubscribe: Callable[[], None] | None = None

    def attach(self, panel: Panel | None) -> None:
        """Show a panel in place of the one before; None closes it in the page."""
        if self._unsubscribe is not None:
            self._unsubscribe()
        self._panel = panel
        self._unsubscribe = None if panel is None else panel.subscribe(self._told)
        for message in self.messages():
            self._publish(message)

    def messages(self) -> list[ServerMessage]:
        """What a page must be told that opens now."""
        if self._panel is None:
            return [Joints(None)]
        return [self._controls(self._panel), JointPositions(self._panel.positions())]

    def receive(self, message: SetJoint | RandomizeJoints | CenterJoints) -> None:
        """Do what a page asks for. Joints that are not, or only follow another, are passed over."""
        panel = self._panel
        if panel is None:
            return
        if isinstance(message, RandomizeJoints):
            panel.randomize()
        elif isinstance(message, CenterJoints):
            panel.center()
        elif any(slider.name == message.name and slider.mimic is None for slider in panel.sliders()):
            panel.set_position(message.name, message.position)

    def _told(self, kind: str) -> None:
        if self._panel is None:
            return
        if kind == "sliders":
            self._publish(self._controls(self._panel))
        self._publish(JointPositions(self._panel.positions()))

    @staticmethod
    def _controls(panel: Panel) -> Joints:
        return Joints(
            [
                JointControl(slider.name, slider.kind, slider.lower, slider.upper, slider.zero, slider.mimic)
                for slider in panel.sliders()
            ]
        )
