"""turtlesim_node: turtles that draw on a canvas, which a panel of the page shows.

Topics, services, actions, parameters and log messages are those of turtlesim in Humble and Jazzy; if ``ROS_DISTRO`` is
Kilted or a later distribution, the interfaces are those of turtlesim_msgs. As in these distributions, turtles move
sideways in Humble, and from Iron only with the parameter ``holonomic``, which is declared in any distribution. A
deliberate difference: the y in the warning about a wall is that of the pose, and not the distance from the upper edge.
"""

from __future__ import annotations

import struct
from itertools import cycle
from random import Random
from typing import Any

from linkwright.diagnostics.translation import localized
from linkwright.graph import Clock, ClockType, Graph, InvalidTopicNameError, ParameterDescriptor
from linkwright.graph.parameters.parameter import Range
from linkwright.messages import get_service
from linkwright.messages.distribution import is_before_iron
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.turtlesim.canvas import EXTENT, Canvas, Color
from linkwright.nodes.turtlesim.interfaces import find_interface_package
from linkwright.nodes.turtlesim.turtle import Turtle

_PERIOD_S = 0.016
_BACKGROUND = {"background_r": ("Red", 69), "background_g": ("Green", 86), "background_b": ("Blue", 255)}

SHAPE_COUNT = 6
"""The number of drawings of turtles in the page."""


class Turtlesim(SingleNode):
    """The running turtlesim_node.

    Parameters: ``background_r``, ``background_g`` and ``background_b`` (0 to 255), and ``holonomic``.

    Args:
        graph: the graph to which the node is added.
        options: the options of the node.
        random: chooses the drawings of the turtles.

    Attributes:
        canvas: the lines that the turtles have drawn.
        turtles: the turtles by name, in the order in which they were spawned.
    """

    DEFAULT_NAME = "turtlesim"
    window_feature = "linkwright.panels.turtlesim:TurtlesimFeature"

    def __init__(self, graph: Graph, options: NodeOptions, random: Random | None = None) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        # Unlike turtlesim's, turtles look alike only if there are more than drawings.
        order = (random or Random()).sample(range(SHAPE_COUNT), SHAPE_COUNT)  # noqa: S311  # no secrets here
        self._shapes = cycle(order)
        self._interfaces = find_interface_package(options.environment)
        self._count = 0
        self.canvas = Canvas()
        self.turtles: dict[str, Turtle] = {}
        with handle_start_errors(self._node):
            self._start(moves_sideways=is_before_iron(options.environment))

    def _start(self, *, moves_sideways: bool) -> None:
        node = self._node
        for name, (channel, value) in _BACKGROUND.items():
            description = f"{channel} channel of the background color"
            node.declare_parameter(
                name, value, ParameterDescriptor(description=description, integer_range=[Range(0, 255, 1)])
            )
        node.declare_parameter(
            "holonomic", moves_sideways, ParameterDescriptor(description="If true, then turtles will be holonomic")
        )
        for service_type, name, callback in (
            ("std_srvs/srv/Empty", "clear", self._on_clear),
            ("std_srvs/srv/Empty", "reset", self._on_reset),
            (f"{self._interfaces}/srv/Spawn", "spawn", self._on_spawn),
            (f"{self._interfaces}/srv/Kill", "kill", self._on_kill),
        ):
            node.create_service(get_service(service_type), name, callback)
        node.get_logger().info(f"Starting turtlesim with node name {node.get_fully_qualified_name()}")
        self._spawn("", EXTENT / 2.0, EXTENT / 2.0, 0.0)
        # The time of the turtles does not depend on a simulated clock, as in turtlesim.
        clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=node.get_clock().timebase)
        node.create_timer(_PERIOD_S, self._update, clock=clock)

    @property
    def background(self) -> Color:
        """The color of the background."""
        red, green, blue = (self._node.get_parameter(name).value for name in _BACKGROUND)
        return red, green, blue

    def _update(self) -> None:
        for turtle in tuple(self.turtles.values()):
            turtle.update(_PERIOD_S)

    def _is_holonomic(self) -> bool:
        return bool(self._node.get_parameter("holonomic").value)

    # --- services ----------------------------------------------------------------------------------------------------

    def _on_clear(self, _request: Any, response: Any) -> Any:
        self._node.get_logger().info("Clearing turtlesim.")
        self.canvas.clear()
        return response

    def _on_reset(self, _request: Any, response: Any) -> Any:
        self._node.get_logger().info("Resetting turtlesim.")
        while self.turtles:
            self.turtles.popitem()[1].destroy()
        self._count = 0
        self._spawn("", EXTENT / 2.0, EXTENT / 2.0, 0.0)
        self.canvas.clear()
        return response

    def _on_spawn(self, request: Any, response: Any) -> Any:
        if request.name in self.turtles:
            self._node.get_logger().error(f"A turtle named [{request.name}] already exists")
        else:
            try:
                response.name = self._spawn(request.name, request.x, request.y, request.theta)
            except InvalidTopicNameError as error:  # turtlesim ends here
                self._node.get_logger().error(localized(error.diagnostics[0].message))
        return response

    def _on_kill(self, request: Any, response: Any) -> Any:
        turtle = self.turtles.pop(request.name, None)
        if turtle is None:
            self._node.get_logger().error(f"Tried to kill turtle [{request.name}], which does not exist")
        else:
            turtle.destroy()
        return response

    def _spawn(self, name: str, x: float, y: float, theta: float) -> str:
        """Add a turtle and return its name, which is generated if the given one is empty."""
        name = name or self._generate_name()
        x, y, theta = struct.unpack("3f", struct.pack("3f", x, y, theta))
        self.turtles[name] = Turtle(
            self._node, self._interfaces, name, (x, y, theta), next(self._shapes), self.canvas, self._is_holonomic
        )
        self._node.get_logger().info(f"Spawning turtle [{name}] at x=[{x:f}], y=[{y:f}], theta=[{theta:f}]")
        return name

    def _generate_name(self) -> str:
        while True:
            self._count += 1
            name = f"turtle{self._count}"
            if name not in self.turtles:
                return name
