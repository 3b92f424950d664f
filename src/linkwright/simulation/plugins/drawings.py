"""Plugins that draw in the world: forces as lines, and the paths of links.

They are ``libForceVisual.so`` of PX4, ``libunitreeDrawForcePlugin.so``, and ``libLinkPlot3DPlugin.so``. They publish
markers, which `linkwright sim` shows.

Source: PX4-SITL_gazebo-classic, unitree_ros and Gazebo Classic (parameters, defaults, topics, scales). PX4 takes its
forces from topics of Gazebo's transport; here they are topics of ROS in the namespace of the model, with the type
``geometry_msgs/msg/WrenchStamped``. The lines have the colors of Gazebo's materials.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array, rotation_matrix
from linkwright.geometry.single import Transform, compose
from linkwright.messages import Header, get_message
from linkwright.sdf.frames import transform_of
from linkwright.sdf.plugins import library_name
from linkwright.sdf.poses import AT_ORIGIN, POSE, SEPARATOR
from linkwright.sdf.reader import read_element
from linkwright.sdf.report import SdfReport
from linkwright.sdf.worlds import World
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.particles import PARTICLES_TOPIC
from linkwright.simulation.plugins.plugin import P, SimulatedPlugin
from linkwright.xmltree import Element

_MARKERS_TYPE, _WRENCH_TYPE = "visualization_msgs/msg/MarkerArray", "geometry_msgs/msg/WrenchStamped"
_LIBRARIES = ("ForceVisual", "LightBuoyPlugin", "LinkPlot3DPlugin", "unitreeDrawForcePlugin")
_RATE_HZ = 20.0
_ADD, _ARROW, _LINE_STRIP = 0, 0, 4
_LINE_WIDTH_M = 0.01
_MAX_POINTS = 1000
"""The number of points of a path, after which it loses the oldest ones."""
_LEAST_DISTANCE_M = 0.002
_COLORS = {
    "Red": (1.0, 0.0, 0.0),
    "Green": (0.0, 1.0, 0.0),
    "Blue": (0.0, 0.0, 1.0),
    "Yellow": (1.0, 1.0, 0.0),
    "Purple": (1.0, 0.0, 1.0),
    "Turquoise": (0.0, 1.0, 1.0),
    "Orange": (1.0, 0.5, 0.0),
    "Black": (0.0, 0.0, 0.0),
    "White": (1.0, 1.0, 1.0),
}
"""The colors of Gazebo's materials by name."""


class DrawingPlugin(SimulatedPlugin[P]):
    """A plugin that draws markers in the world."""

    def create_output(self) -> None:
        """Create the topic of the markers."""
        self._output = self.node.publisher(_MARKERS_TYPE, PARTICLES_TOPIC)

    @property
    def is_wanted(self) -> bool:
        """Whether the markers have a subscription."""
        return self._output.is_wanted

    def draw(
        self, name: str, kind: int, scale: Sequence[float], color: Sequence[float], points: Sequence[Array] = ()
    ) -> None:
        """Publish a marker in the frame of the world.

        Args:
            name: the name of the marker in the model.
            kind: the type of ``visualization_msgs/msg/Marker``.
            scale: the size of the marker.
            color: red, green and blue.
            points: the points of a line, or the ends of an arrow.
        """
        marker = self.create_marker(name, kind, scale, color)
        point_class = get_message("geometry_msgs/msg/Point")
        marker.points = [point_class(x=x, y=y, z=z) for x, y, z in (point.tolist() for point in points)]
        self.publish_markers([marker])

    def create_marker(self, name: str, kind: int, scale: Sequence[float], color: Sequence[float]) -> Any:
        """Return a marker at the origin of the world."""
        marker = get_message("visualization_msgs/msg/Marker")(
            ns=f"{self.context.path}{SEPARATOR}{name}", id=0, type=kind, action=_ADD
        )
        marker.header = Header(stamp=self.stamp(), frame_id="world")
        marker.pose.orientation.w = 1.0
        x, y, z = scale
        marker.scale = get_message("geometry_msgs/msg/Vector3")(x=x, y=y, z=z)
        red, green, blue = color
        marker.color = get_message("std_msgs/msg/ColorRGBA")(r=red, g=green, b=blue, a=1.0)
        return marker

    def publish_markers(self, markers: list[Any]) -> None:
        """Publish markers."""
        self._output.publish(get_message(_MARKERS_TYPE)(markers=markers))


class _ForceDrawing(DrawingPlugin[P]):
    """A plugin that draws the last force of a topic, in the axes of a link."""

    def start_forces(self, topic: str, pose: Transform, link: str, scale: float, material: str) -> None:
        """Subscribe to the forces.

        Args:
            topic: the topic of the forces in N.
            pose: the pose in the frame of the link of the point where the line starts.
            link: the full name of the link.
            scale: the length in m of a force of 1 N.
            material: the name of the material of Gazebo.
        """
        self._pose, self._link, self._scale = pose, link, scale
        self._color = find_color(material)
        self._name = self.context.name if self.context.visual is None else self.context.visual.name
        self.reset()
        self.create_output()
        self.node.subscribe(_WRENCH_TYPE, topic, self._on_force)
        self.every(_RATE_HZ, self._draw)

    def reset(self) -> None:
        """Forget the force."""
        self._force: Array = np.zeros(3)

    def _on_force(self, message: Any) -> None:
        force = message.wrench.force
        self._force = np.array((force.x, force.y, force.z))

    def _draw(self) -> None:
        if not self.is_wanted:
            return
        pose = compose(self.simulation.link_pose(self._link), self._pose)
        start = np.array(pose[:3])
        end = start + rotation_matrix(np.array(pose[3:])) @ (self._scale * self._force)
        self.draw(self._name, _ARROW, (_LINE_WIDTH_M, 2.0 * _LINE_WIDTH_M, 0.0), self._color, (start, end))


@dataclass(frozen=True, kw_only=True)
class ForceVisualParameters:
    """Parameters of ``libForceVisual.so``: the scale is in m/N."""

    topic_name: str
    link_name: str = ""
    scale: float = 1.0
    color: str = "Gazebo/Blue"
    material: str = ""


class ForceVisual(_ForceDrawing[ForceVisualParameters]):
    """The substitute for ``libForceVisual.so``."""

    PARAMETERS = ForceVisualParameters

    def start(self) -> None:
        """Find the link, and subscribe to its forces.

        Raises:
            LinkwrightError: SIM133, there is no such link.
        """
        parameters, visual = self.parameters, self.context.visual
        link = self.link(parameters.link_name) if parameters.link_name or visual is None else visual.link
        pose = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0) if parameters.link_name or visual is None else visual.pose
        model = self.context.path.partition(SEPARATOR)[0]
        topic = f"/{model}/{parameters.topic_name.lstrip('/')}"
        self.start_forces(topic, pose, link, parameters.scale, parameters.material or parameters.color)


@dataclass(frozen=True, kw_only=True)
class DrawForceParameters:
    """Parameters of ``libunitreeDrawForcePlugin.so``."""

    topic_name: str = parameter("/default_force_draw", aliases=("topicName",))


class DrawForce(_ForceDrawing[DrawForceParameters]):
    """The substitute for ``libunitreeDrawForcePlugin.so``, for ``/visual/TOPIC/the_force``; 20 N are 1 m."""

    PARAMETERS = DrawForceParameters

    def start(self) -> None:
        """Subscribe to the forces.

        Raises:
            LinkwrightError: SIM160, the plugin is not in a visual.
        """
        visual = self.context.visual
        link, pose = (
            (self.first_link, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)) if visual is None else (visual.link, visual.pose)
        )
        topic = f"/visual/{self.parameters.topic_name.strip('/')}/the_force"
        self.start_forces(topic, pose, link, 1.0 / 20.0, "Gazebo/Purple")


@dataclass(frozen=True, kw_only=True)
class LinkPlotParameters:
    """Parameters of ``libLinkPlot3DPlugin.so``: the rate in Hz."""

    frequency: float = 30.0


@dataclass(slots=True)
class _Path:
    """The path of a point of a link.

    Attributes:
        link: the full name of the link.
        pose: the pose of the point in the frame of the link.
        color: the color.
        points: the last points of the path in the world.
    """

    link: str
    pose: Transform
    color: tuple[float, float, float]
    points: deque[Array]


class LinkPlot(DrawingPlugin[LinkPlotParameters]):
    """The substitute for ``libLinkPlot3DPlugin.so``: draws the last 1,000 points of the paths of links."""

    PARAMETERS = LinkPlotParameters
    IGNORED = ("plot",)
    CARRIED = ("_paths",)

    def start(self) -> None:
        """Find the links.

        Raises:
            LinkwrightError: SIM133, there is no such link.
        """
        element = self.context.element
        self._paths = [self._read_path(plot) for plot in (() if element is None else element.elements("plot"))]
        self.create_output()
        self.every(self.parameters.frequency, self._update)

    def reset(self) -> None:
        """Forget the paths."""
        for path in self._paths:
            path.points.clear()

    def _read_path(self, plot: Element) -> _Path:
        pose_element = plot.first("pose")
        raw_pose = AT_ORIGIN if pose_element is None else read_element(pose_element, POSE, SdfReport())
        color = find_color(self.text_in(plot, "material"))
        return _Path(
            self.link(self.text_in(plot, "link")), transform_of(raw_pose.pose), color, deque(maxlen=_MAX_POINTS)
        )

    def _update(self) -> None:
        for path in self._paths:
            position: Array = np.array(compose(self.simulation.link_pose(path.link), path.pose)[:3])
            if not path.points or float(np.linalg.norm(position - path.points[-1])) >= _LEAST_DISTANCE_M:
                path.points.append(position)
            if self.is_wanted and len(path.points) > 1:
                self.draw(
                    path.link.rpartition(SEPARATOR)[2],
                    _LINE_STRIP,
                    (_LINE_WIDTH_M, 0.0, 0.0),
                    path.color,
                    tuple(path.points),
                )


def find_color(material: str) -> tuple[float, float, float]:
    """Return the color of a material of Gazebo, such as ``Gazebo/RedTransparent``; gray for an unknown one."""
    name = material.rpartition("/")[2]
    for color, values in _COLORS.items():
        if color.lower() in name.lower():
            return values
    return 0.7, 0.7, 0.7


def has_drawings(world: World, model_text: str = "") -> bool:
    """Return whether a model of a world draws, or a model given as text."""
    plugins = (library_name(plugin.filename) for plugin in _iterate_plugins(world))
    return any(library in model_text for library in _LIBRARIES) or any(name in _LIBRARIES for name in plugins)


def _iterate_plugins(world: World) -> Iterator[Any]:
    """Yield the plugins of the models of a world and their visuals."""
    models = list(world.models)
    for model in models:
        models.extend(model.models)
        yield from model.plugins
        for link in model.links:
            for visual in link.visuals:
                yield from visual.plugins
