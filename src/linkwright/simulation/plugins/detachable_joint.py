"""A joint that holds another model's link: ``gz-sim-detachable-joint-system``.

Source: gz-sim (parameters, topic names; the state is published when it changes). As in gz, an attached link does not
collide with the model that holds it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.geometry.single import compose, invert
from linkwright.messages import get_message
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_SEARCH_RATE_HZ = 100.0
"""The rate at which the plugin searches for the child model, in Hz of simulated time."""
_OWN_MODEL = "__model__"


@dataclass(frozen=True, kw_only=True)
class DetachableJointParameters:
    """Parameters of ``gz-sim-detachable-joint-system``."""

    parent_link: str
    child_model: str
    child_link: str
    topic: str = ""
    detach_topic: str = ""
    attach_topic: str = ""
    output_topic: str = ""
    initial_attach: bool = True
    suppress_child_warning: bool = False


class GzDetachableJoint(SimulatedPlugin[DetachableJointParameters]):
    """The substitute for ``gz-sim-detachable-joint-system``.

    The plugin attaches a link of another model to a link of its own model, and detaches the link on request.
    """

    PARAMETERS = DetachableJointParameters

    def start(self) -> None:
        """Find the parent link, attach the child if it exists, and subscribe to the topics.

        Raises:
            LinkwrightError: SIM133, the model does not have this link.
        """
        parameters, topic_prefix = self.parameters, f"/model/{self.context.path}/detachable_joint"
        self._is_attached, self._should_attach = False, parameters.initial_attach
        self._parent, self._child = self.link(parameters.parent_link), ""
        self._has_warned = parameters.suppress_child_warning
        state_topic = parameters.output_topic or f"/model/{parameters.child_model}/detachable_joint/state"
        self._output = self.node.publisher("std_msgs/msg/String", state_topic)
        detach_topic = parameters.detach_topic or parameters.topic or f"{topic_prefix}/detach"
        self.node.subscribe("std_msgs/msg/Empty", detach_topic, self._on_detach)
        self.node.subscribe("std_msgs/msg/Empty", parameters.attach_topic or f"{topic_prefix}/attach", self._on_attach)
        if self._should_attach and self._find_child():
            self._attach()
        self.every(_SEARCH_RATE_HZ, self._attach_if_found)

    def reset(self) -> None:
        """Restore the initial state, attached or detached."""
        self._detach()
        self._should_attach = self.parameters.initial_attach
        if self._should_attach and self._find_child():
            self._attach()

    def resume(self, previous: SimulatedPlugin[DetachableJointParameters]) -> None:
        """Attach the child if the previous instance held or awaited it, and detach it otherwise."""
        assert isinstance(previous, GzDetachableJoint)
        if previous._is_attached or previous._should_attach:
            self._on_attach(None)
        else:
            self._detach()

    def stop(self) -> None:
        """Detach the child without publishing the state, because the model may be removed next."""
        self._unweld()

    def _on_attach(self, _: Any) -> None:
        if not self._is_attached:
            self._should_attach = True
            self._attach_if_found()

    def _on_detach(self, _: Any) -> None:
        self._detach()

    def _attach_if_found(self) -> None:
        """Attach the child if this was requested, or warn once if the child is not in the world.

        If an attached child was replaced by a new instance, the new instance is attached.
        """
        if self._is_attached and not self.simulation.scene.is_welded(self._parent, self._child):
            self._is_attached, self._should_attach = False, True
        if not self._should_attach:
            return
        if self._find_child():
            self._attach()
        elif not self._has_warned:
            self._has_warned = True
            name = f"{self.parameters.child_model}{SEPARATOR}{self.parameters.child_link}"
            message = phrase("plugin '{plugin}': there is no link '{name}'", plugin=self.context.name, name=name)
            self.node.logger.warning(message)

    def _find_child(self) -> bool:
        """Store the name of the child link, and return whether the link exists.

        The link may be in a nested model.
        """
        parameters, bodies = self.parameters, self.simulation.scene.bodies
        model = self.context.path if parameters.child_model == _OWN_MODEL else parameters.child_model
        link = f"{model}{SEPARATOR}{parameters.child_link}"
        candidates = (link, f"{self.context.path}{SEPARATOR}{link}")
        self._child = next(
            (candidate for candidate in candidates if candidate in bodies and candidate != self._parent), ""
        )
        return bool(self._child)

    def _attach(self) -> None:
        simulation = self.simulation
        parent_pose, child_pose = (simulation.link_pose(link) for link in (self._parent, self._child))
        simulation.scene.weld(self._parent, self._child, compose(invert(parent_pose), child_pose))
        self._apply_change()
        self._publish_state(attached=True)

    def _detach(self) -> None:
        self._should_attach = False
        if self._is_attached:
            self._unweld()
            self._publish_state(attached=False)

    def _unweld(self) -> None:
        if self._is_attached:
            self.simulation.scene.unweld(self._parent, self._child)
            self._apply_change()

    def _apply_change(self) -> None:
        self.simulation.mark_changed()
        self.simulation.refresh()

    def _publish_state(self, *, attached: bool) -> None:
        self._is_attached, self._should_attach = attached, False
        self._output.publish(get_message("std_msgs/msg/String")(data="attached" if attached else "detached"))
