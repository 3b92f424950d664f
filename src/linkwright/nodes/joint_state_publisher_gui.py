"""joint_state_publisher_gui: joint_state_publisher with sliders, which the viewer draws."""

from __future__ import annotations

from linkwright.graph import Graph
from linkwright.nodes.joint_panel import JointPanel
from linkwright.nodes.joint_state_publisher import JointStatePublisher
from linkwright.nodes.options import NodeOptions


class JointStatePublisherGui(JointStatePublisher):
    """The running node. As in ROS its default name is ``joint_state_publisher``.

    A moved slider is published at once; moves in the same iteration of the event loop share one message. Messages on
    the topics of ``source_list`` move the sliders.
    """

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        super().__init__(graph, options)
        self._panel = JointPanel(self.node, self.joints, self.publish_soon)
        self._panel.rebuild()
        self.watch(self._panel)

    @property
    def panel(self) -> JointPanel:
        """The sliders."""
        return self._panel
