"""joint_state_publisher_gui: joint_state_publisher with sliders in the viewer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite
from random import Random
from typing import Literal

from linkwright.graph import Graph, Node, log_failure
from linkwright.nodes.joint_layout import Dependence
from linkwright.nodes.joint_state_publisher import JointPositions, JointStatePublisher
from linkwright.nodes.options import NodeOptions
from linkwright.urdf import JointType

PanelChange = Literal["sliders", "positions"]
PanelCallback = Callable[[PanelChange], object]


@dataclass(frozen=True, slots=True)
class JointSlider:
    """A slider of the panel.

    Attributes:
        name: the name of the joint.
        kind: revolute, continuous or prismatic.
        lower: the lower end of the slider, in rad or m; finite.
        upper: the upper end of the slider, in rad or m; finite.
        zero: the position that "Center" sets, in rad or m.
        mimic: the joint that this joint mimics directly, in which case the slider cannot be moved; None for a free
            joint.
        multiplier: the factor of a mimic joint: position = multiplier * position of `mimic` + offset.
        offset: the offset of a mimic joint, in rad or m.
    """

    name: str
    kind: JointType
    lower: float
    upper: float
    zero: float
    mimic: str | None = None
    multiplier: float = 1.0
    offset: float = 0.0


class JointPanel:
    """The sliders of joint_state_publisher_gui.

    Args:
        node: the node whose executor runs the callbacks of subscribers.
        joints: the positions that the sliders set.
        publish_soon: called after the panel has changed a position.
        random: the random generator for `randomize`.
    """

    def __init__(
        self, node: Node, joints: JointPositions, publish_soon: Callable[[], None], random: Random | None = None
    ) -> None:
        self._joints = joints
        self._publish_soon = publish_soon
        self._random = random or Random()  # noqa: S311  # no secrets here
        self._sliders: list[JointSlider] = []
        self._subscribers: list[PanelCallback] = []
        self._logger = node.get_logger()
        self._sliders_changed = node.create_guard_condition(lambda: self._notify("sliders"))
        self._positions_changed = node.create_guard_condition(lambda: self._notify("positions"))

    def sliders(self) -> list[JointSlider]:
        """Return the sliders, in the order of the description's file.

        A joint with equal limits does not have a slider, and neither does a joint that mimics such a joint.
        """
        return list(self._sliders)

    def positions(self) -> dict[str, float]:
        """Return the position of each joint with a slider by name, in rad or m."""
        published_positions = dict(
            zip(self._joints.layout.ranges, self._joints.published_positions().tolist(), strict=True)
        )
        return {slider.name: published_positions[slider.name] for slider in self._sliders}

    def set_position(self, name: str, value: float) -> bool:
        """Set the position of a joint, clamped to its limits.

        Args:
            name: the name of the joint.
            value: the position in rad or m.

        Returns:
            Whether the joint was moved. The result is False for a joint that has no slider or mimics another joint, and
            for a value that is not a finite number.
        """
        slider = next(
            (candidate for candidate in self._sliders if candidate.name == name and candidate.mimic is None), None
        )
        if slider is None or not isfinite(value):
            return False
        self._joints.set_position(name, value)
        self._publish_move()
        return True

    def randomize(self) -> None:
        """Set every free joint to a random position within its limits."""
        self._logger.info("Randomizing")
        for slider in self._find_free_sliders():
            self._joints.set_position(slider.name, self._random.uniform(slider.lower, slider.upper))
        self._publish_move()

    def center(self) -> None:
        """Set every free joint to its zero position, which need not be the middle of its range."""
        self._logger.info("Centering")
        for slider in self._find_free_sliders():
            self._joints.set_position(slider.name, slider.zero)
        self._publish_move()

    def subscribe(self, callback: PanelCallback) -> Callable[[], None]:
        """Register a callback for changes.

        The callback is called with ``"sliders"`` when the sliders change, and with ``"positions"`` when joints move.
        Several changes in one iteration of the event loop are reported once.

        Returns:
            A function that removes the callback.
        """
        self._subscribers.append(callback)

        def unsubscribe() -> None:
            if callback in self._subscribers:
                self._subscribers.remove(callback)

        return unsubscribe

    def rebuild(self) -> None:
        """Rebuild the sliders for the current layout of the joints."""
        layout = self._joints.layout
        movable_names = {joint.name for joint in layout.free if joint.lower != joint.upper}
        free_joints = layout.free
        master_names = [free_joints[master].name if master >= 0 else "" for master in layout.master_indices.tolist()]
        zeros = [free_joints[master].zero if master >= 0 else 0.0 for master in layout.master_indices.tolist()]
        no_dependence = Dependence("")
        dependences = [layout.dependent.get(name, no_dependence) for name in layout.ranges]
        self._sliders = [
            JointSlider(
                joint.name,
                joint.kind,
                joint.lower,
                joint.upper,
                factor * zero + offset,
                dependence.parent or None,
                dependence.factor,
                dependence.offset,
            )
            for joint, dependence, master, zero, factor, offset in zip(
                layout.ranges.values(),
                dependences,
                master_names,
                zeros,
                layout.factor.tolist(),
                layout.offset.tolist(),
                strict=True,
            )
            if master in movable_names
        ]
        self._sliders_changed.trigger()
        self.update_positions()

    def update_positions(self) -> None:
        """Notify the subscribers that joints have moved."""
        self._positions_changed.trigger()

    def _find_free_sliders(self) -> list[JointSlider]:
        return [slider for slider in self._sliders if slider.mimic is None]

    def _publish_move(self) -> None:
        self._publish_soon()
        self.update_positions()

    def _notify(self, change: PanelChange) -> None:
        for callback in tuple(self._subscribers):
            try:
                callback(change)
            except Exception as error:  # noqa: BLE001, PERF203 - an error must not affect other subscribers
                log_failure(self._logger, "joint panel callback", error)


class JointStatePublisherGui(JointStatePublisher):
    """The running joint_state_publisher_gui node.

    As in ROS, its default name is ``joint_state_publisher``.

    When sliders move, one message is published in the next iteration of the event loop. Messages on the topics of
    ``source_list`` also move the sliders.
    """

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        super().__init__(graph, options)
        self._panel = JointPanel(self.node, self.joints, self.publish_soon)
        self._panel.rebuild()
        self.watch(self._panel)

    @property
    def panel(self) -> JointPanel:
        """The panel with the sliders."""
        return self._panel
