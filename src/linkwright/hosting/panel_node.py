"""The nodes of rqt's programs, whose windows are panels of the page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import count
from typing import Any

from linkwright.diagnostics import Diagnostic, phrase
from linkwright.graph import Graph
from linkwright.hosting.plans import HostedPlan, NodeWithPanel
from linkwright.hosting.rqt_arguments import read_rqt_arguments
from linkwright.hosting.rqt_programs import PanelProgram
from linkwright.nodes.options import NodeOptions, SingleNode, create_node
from linkwright.panels.panel_request import PanelRequest

_NUMBERS = count(1)
_DEFAULT_VELOCITY_TOPIC = "/cmd_vel"


class PanelNode(SingleNode, NodeWithPanel):
    """The node of a program of rqt that opens a panel.

    The panel itself belongs to the viewer. The node has the name, parameters and remappings of the program.

    Args:
        graph: the graph to which the node is added.
        plan: the plan of the program; its `panel_program` is not None.
        options: the options of the node.

    Attributes:
        requests: the panels to open; empty if the page opens as it is.
        findings: the findings about arguments without an effect.

    Raises:
        LinkwrightError: a name, a remapping or a ROS argument is not valid.
    """

    def __init__(self, graph: Graph, plan: HostedPlan, options: NodeOptions) -> None:
        program = plan.panel_program
        assert program is not None
        default_name = f"rqt_gui_node_{next(_NUMBERS)}"  # the Node graph panel hides this name, as rqt_graph does
        self._node, own_arguments = create_node(graph, options, default_name, any_parameters=True)
        arguments = read_rqt_arguments(plan.executable, program, own_arguments)
        self.findings: list[Diagnostic] = arguments.findings
        if arguments.program.positional_kind == "recordings" and arguments.values:
            arguments.warn(
                phrase("{program} ignores '{value}'", program=plan.executable, value=arguments.values[0]),
                phrase("open a recording with `linkwright view FILE`"),
            )
        panels = [(arguments.program, arguments.values), *arguments.perspective]
        requests = (self._create_panel_request(*panel) for panel in panels)
        self.requests = tuple(request for request in requests if request is not None)

    def _create_panel_request(self, program: PanelProgram, values: Sequence[str]) -> PanelRequest | None:
        if program.panel == "teleop":
            topic = self._read_parameter("default_topic", str, str) or _DEFAULT_VELOCITY_TOPIC
            return PanelRequest(
                program.panel,
                topic=self._node.resolve_topic_name(topic),
                stamped=self._read_parameter("default_stamped", bool, bool),
                linear=self._read_parameter("default_vx_max", (int, float), float),
                angular=self._read_parameter("default_vw_max", (int, float), float),
            )
        topic = program.default_topic or (values[0] if program.positional_kind == "topic" and values else "")
        if program.positional_kind == "topic" and not topic:  # the user chooses the topic in the list of displays
            return PanelRequest("displays", program.display_class)
        return (
            PanelRequest(
                program.panel,
                program.display_class,
                topic=self._node.resolve_topic_name(topic) if topic else "",
                fields=tuple(map(self._make_absolute, values)) if program.positional_kind == "fields" else (),
                node=self._make_absolute(values[0]) if program.positional_kind == "node" and values else "",
            )
            if program.panel
            else None
        )

    def _make_absolute(self, name: str) -> str:
        """Return a name with the namespace of the node, unless it begins with a slash."""
        return name if name.startswith("/") else f"{self._node.get_namespace().rstrip('/')}/{name}"

    def _read_parameter(self, name: str, types: type | tuple[type, ...], convert: Callable[[Any], Any]) -> Any:
        """Return the value of a parameter, or None if it is not set or has another type."""
        value = self._node.get_parameter(name).value if self._node.has_parameter(name) else None
        return convert(value) if isinstance(value, types) else None
