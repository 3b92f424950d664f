"""The page's Joints panel: shows and moves the sliders of a joint_state_publisher_gui."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, cast, runtime_checkable

from linkwright.nodes import RunningNode
from linkwright.page.audience import Page
from linkwright.page.protocol.message import ServerMessage
from linkwright.page.protocol.robot import (
    CenterJoints,
    JointControl,
    JointPositions,
    Joints,
    RandomizeJoints,
    SetJoint,
    SetJoints,
)
from linkwright.panels.page_feature import FeatureHost, PageFeature

if TYPE_CHECKING:
    from linkwright.nodes.joint_state_publisher_gui import JointPanel

_SEND_DELAY_S = 0.01
"""The delay in s between a change and the sending of positions, so that transforms are sent first."""


@runtime_checkable
class NodeWithSliders(RunningNode, Protocol):
    """A node whose joints can be moved by sliders."""

    @property
    def panel(self) -> JointPanel:
        """The sliders of the node."""


class JointsFeature(PageFeature):
    """The feature that connects the Joints panel with the sliders of a node that moves joints."""

    RECEIVES: ClassVar[tuple[type, ...]] = (SetJoint, SetJoints, RandomizeJoints, CenterJoints)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._panel: JointPanel | None = None
        self._unsubscribe: Callable[[], None] | None = None
        self._send_timer: asyncio.TimerHandle | None = None

    def attach(self, panel: JointPanel | None) -> None:
        """Show the sliders of a node instead of the previous ones.

        None closes the panel in pages.
        """
        if self._unsubscribe is not None:
            self._unsubscribe()
        if self._send_timer is not None:
            self._send_timer.cancel()
            self._send_timer = None
        self._panel = panel
        self._unsubscribe = None if panel is None else panel.subscribe(self._on_panel_change)
        for message in self.opening_messages():
            self.context.pages.publish(message)

    def opening_messages(self) -> list[ServerMessage]:
        """Return the sliders and their values."""
        if self._panel is None:
            return [Joints(None)]
        return [self._make_joints_message(self._panel), JointPositions(self._panel.positions())]

    def receive(self, page: Page, message: SetJoint | SetJoints | RandomizeJoints | CenterJoints) -> None:
        """Move joints.

        Unknown joints, and joints that mimic another joint, are ignored.
        """
        panel = self._panel
        if panel is None:
            return
        if isinstance(message, RandomizeJoints):
            panel.randomize()
        elif isinstance(message, CenterJoints):
            panel.center()
        elif isinstance(message, SetJoints):
            for name, position in message.positions.items():
                panel.set_position(name, position)
        else:
            panel.set_position(message.name, message.position)

    def close(self) -> None:
        """Disconnect from the sliders of the node."""
        self.attach(None)

    def _on_panel_change(self, kind: str) -> None:
        if self._panel is not None and kind == "sliders":
            self.context.pages.publish(self._make_joints_message(self._panel))
        if self._send_timer is None:
            self._send_timer = asyncio.get_running_loop().call_later(_SEND_DELAY_S, self._send_positions)

    def _send_positions(self) -> None:
        self._send_timer = None
        if self._panel is not None:
            self.context.pages.publish(JointPositions(self._panel.positions()))

    @staticmethod
    def _make_joints_message(panel: JointPanel) -> Joints:
        return Joints(
            [
                JointControl(
                    name=slider.name,
                    kind=cast("Any", slider.kind),  # All movable joints have one of these kinds.
                    lower=slider.lower,
                    upper=slider.upper,
                    zero=slider.zero,
                    mimic=slider.mimic,
                    multiplier=slider.multiplier,
                    offset=slider.offset,
                )
                for slider in panel.sliders()
            ]
        )
