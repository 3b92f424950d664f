"""The executables of slam_toolbox: async, sync, localization, map_and_localization, and lifelong.

``ROS_DISTRO`` selects the version that the nodes follow: slam_toolbox 2.6 (Humble) or 2.8 (Jazzy). Nodes of 2.6 work as
soon as they start; nodes of 2.8 are managed, and activate themselves if ``autostart_node`` is true, as in Linkwright's
launch files. The mapper is `linkwright.navigation.slam`. Differences:

- One solver replaces all solver plugins: Gauss-Newton on sparse matrices. Each match is refined by least squares, so
  ``fine_search_angle_offset`` has no effect. Neither has ``use_scan_barycenter``.
- A rotation by ``minimum_travel_heading`` is enough to process a scan, as the parameter's name suggests.
- Moving scans by hand (``enable_interactive_mode``) and merging maps are not supported. The motion of the robot during
  a scan is ignored.
- The lifelong node maps and continues saved graphs, but does not remove old scans from the graph.
- A graph is saved in one file, in a format of Linkwright; files of slam_toolbox cannot be read.
- When simulated time jumps back, such as on the reset of a world, the map starts from scratch.
"""

from __future__ import annotations

from typing import ClassVar

from linkwright.graph import Graph, Node
from linkwright.messages.distribution import is_before_iron
from linkwright.navigation.nodes.managed import ManagedNode
from linkwright.navigation.nodes.plugins import get_or_declare
from linkwright.navigation.nodes.slam_toolbox.parameters import read_settings
from linkwright.navigation.nodes.slam_toolbox.services import ToolboxServices
from linkwright.navigation.nodes.slam_toolbox.toolbox import Toolbox
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, create_node_with_class, handle_start_errors
from linkwright.nodes.settings import log_unknown_parameters

_LIFELONG_PARAMETERS: dict[str, bool | float] = {
    "lifelong_search_use_tree": False,
    "lifelong_minimum_score": 0.1,
    "lifelong_iou_match": 0.85,
    "lifelong_node_removal_score": 0.04,
    "lifelong_overlap_score_scale": 0.06,
    "lifelong_constraint_multiplier": 0.08,
    "lifelong_nearby_penalty": 0.001,
    "lifelong_candidates_scale": 0.03,
}
"""The parameters of the lifelong node, which have no effect."""


class _ManagedToolbox(ManagedNode):
    """A slam_toolbox node as a managed node, as in Jazzy."""

    kind: type[AsyncSlamToolbox]

    def declare(self) -> None:
        """Declare ``use_lifecycle_manager``, and disable the bond if its value is false."""
        if not self.declare_parameter("use_lifecycle_manager", False).value:
            self._heartbeat_period = 0.0

    def configure(self) -> None:
        """Read the parameters, and create the toolbox and its services.

        Raises:
            LinkwrightError: see `AsyncSlamToolbox`.
        """
        self._toolbox, self._services = self.kind.open(self)

    def activate(self) -> None:
        """Start mapping."""
        self._toolbox.start()

    def deactivate(self) -> None:
        """Stop mapping."""
        self._toolbox.stop()

    def cleanup(self) -> None:
        """Drop the map."""
        if hasattr(self, "_toolbox"):
            self._services.close()
            self._toolbox.close()
            del self._services, self._toolbox


class AsyncSlamToolbox(SingleNode):
    """The running async node, which drops scans that arrive while it is busy.

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433, GRAPH201), SciPy is not installed (NAV101), or the
            initial map cannot be read (NAV501).
    """

    DEFAULT_NAME: ClassVar[str] = "slam_toolbox"
    KEEPS_ALL_SCANS: ClassVar[bool] = False
    LOCALIZES: ClassVar[bool] = False
    CAN_SWITCH: ClassVar[bool] = False

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._work: tuple[Toolbox, ToolboxServices] | None = None
        if not is_before_iron():
            kind = type("Managed", (_ManagedToolbox,), {"kind": type(self)})
            node, _ = create_node_with_class(kind, graph, options, self.DEFAULT_NAME)
            self._node = node
            node.autostart()
            return
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            for name in ("use_lifecycle_manager", "autostart_node"):  # Jazzy's parameters, which have no effect here.
                self._node.declare_parameter(name, False)
            self._work = self.open(self._node)
            log_unknown_parameters(self._node)
        self._work[0].start()

    @classmethod
    def open(cls, node: Node) -> tuple[Toolbox, ToolboxServices]:
        """Read the parameters of a node, and create its toolbox and services."""
        toolbox = Toolbox(node, read_settings(node), keeps_all_scans=cls.KEEPS_ALL_SCANS, localizes=cls.LOCALIZES)
        return toolbox, ToolboxServices(toolbox, has_queue=cls.KEEPS_ALL_SCANS, can_switch=cls.CAN_SWITCH)

    def close(self) -> None:
        """Close the node."""
        if self._work is not None:
            self._work[0].stop()
        elif isinstance(self._node, ManagedNode):
            self._node.shut_down()
        super().close()


class SyncSlamToolbox(AsyncSlamToolbox):
    """The running sync node, which queues scans and processes all of them."""

    KEEPS_ALL_SCANS = True


class LocalizationSlamToolbox(AsyncSlamToolbox):
    """The running localization node, which localizes the robot in a saved map."""

    LOCALIZES = True


class LifelongSlamToolbox(AsyncSlamToolbox):
    """The running lifelong node, which continues a saved graph and keeps all of its scans."""

    @classmethod
    def open(cls, node: Node) -> tuple[Toolbox, ToolboxServices]:
        """Read the parameters of a node, and create its toolbox and services."""
        for name, default in _LIFELONG_PARAMETERS.items():
            get_or_declare(node, name, default)
        node.get_logger().info("scans are not removed from the graph: the lifelong_* parameters have no effect")
        return super().open(node)


class MapAndLocalizationSlamToolbox(AsyncSlamToolbox):
    """The running map_and_localization node, which a service switches to localization."""

    CAN_SWITCH = True
