"""Light buoys: ``libLightBuoyPlugin.so``.

The panels of a buoy show three colors for a second each, followed by two seconds without light. Cameras see the colors,
and the page draws the panels.

Source: VRX (parameters, colors, times).
"""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.diagnostics import phrase
from linkwright.geometry.shapes import Box, Cylinder, Sphere
from linkwright.geometry.single import Transform, compose
from linkwright.messages import Quaternion, from_values, get_message
from linkwright.sdf.frames import Frames
from linkwright.sdf.poses import SEPARATOR
from linkwright.sdf.shapes import Shape
from linkwright.simulation.plugins.drawings import DrawingPlugin

_COLORS = {
    "red": (1.0, 0.0, 0.0),
    "green": (0.0, 1.0, 0.0),
    "blue": (0.0, 0.0, 1.0),
    "yellow": (1.0, 1.0, 0.0),
    "off": (0.0, 0.0, 0.0),
}
_DARK_SECONDS = 2
_CUBE, _SPHERE, _CYLINDER = 1, 2, 3
_RATE_HZ = 20.0
_MARGIN_M = 0.004
"""The margin by which a drawn panel is larger than its visual, which it covers."""
_VISUAL_MARK = "#visual"


@dataclass(frozen=True, kw_only=True)
class LightBuoyParameters:
    """Parameters of ``libLightBuoyPlugin.so``: red, green, blue, yellow or off."""

    color_1: str
    color_2: str
    color_3: str


@dataclass(frozen=True, slots=True)
class _Panel:
    """A visual that shows the colors.

    Attributes:
        name: the full name of the visual.
        link: the full name of its link.
        pose: the pose in the frame of the link.
        shape: the shape.
    """

    name: str
    link: str
    pose: Transform
    shape: Shape


class LightBuoy(DrawingPlugin[LightBuoyParameters]):
    """The substitute for ``libLightBuoyPlugin.so``."""

    PARAMETERS = LightBuoyParameters
    IGNORED = ("visuals",)

    def start(self) -> None:
        """Find the panels.

        Raises:
            LinkwrightError: SIM160, a color is not known, or there is no such visual.
        """
        parameters = self.parameters
        names = [color.strip().lower() for color in (parameters.color_1, parameters.color_2, parameters.color_3)]
        for name in names:
            if name not in _COLORS:
                message = phrase(
                    "plugin '{plugin}': the color '{color}' must be one of {names}",
                    plugin=self.context.name,
                    color=name,
                    names=", ".join(_COLORS),
                )
                raise self.parameter_error(message)
        self._pattern = [_COLORS[name] for name in [*names, *["off"] * _DARK_SECONDS]]
        element = None if self.context.element is None else self.context.element.first("visuals")
        self._panels = [
            self._find_panel(child.text().strip()) for child in (() if element is None else element.elements("visual"))
        ]
        self._shown: tuple[int, tuple[float, float, float]] | None = None
        self.create_output()
        self.every(_RATE_HZ, self._update)

    def _find_panel(self, name: str) -> _Panel:
        """Return the panel for a name that may contain the model and the link.

        Raises:
            LinkwrightError: SIM160, there is no such visual.
        """
        assert self.context.model is not None
        short_name = name.replace("/", SEPARATOR).rpartition(SEPARATOR)[2]
        frames = Frames(self.context.model)
        for link in self.context.model.links:
            full_link = f"{self.context.path}{SEPARATOR}{link.name}"
            for visual in link.visuals:
                if visual.name == short_name:
                    pose = frames.in_link(visual.pose, link.name)
                    return _Panel(f"{full_link}{SEPARATOR}{visual.name}", full_link, pose, visual.geometry)
        raise self.parameter_error(
            phrase("plugin '{plugin}': there is no visual '{name}'", plugin=self.context.name, name=name)
        )

    @property
    def color(self) -> tuple[float, float, float]:
        """Red, green and blue of the panels at this time."""
        return self._pattern[int(self.simulation.seconds + 1e-9) % len(self._pattern)]

    def _update(self) -> None:
        simulation, color = self.simulation, self.color
        simulation.refresh()
        if self._shown != (simulation.revision, color):
            self._shown = simulation.revision, color
            model = simulation.model
            prefixes = tuple(f"{panel.name}{_VISUAL_MARK}" for panel in self._panels)
            for geom in range(model.ngeom):
                if model.geom(geom).name.startswith(prefixes):
                    model.geom_rgba[geom] = (*color, 1.0)
        if self.is_wanted:
            self._draw(color)

    def _draw(self, color: tuple[float, float, float]) -> None:
        """Draw the panels that are boxes, cylinders or spheres."""
        markers = []
        for panel in self._panels:
            kind, size = _get_marker_size(panel.shape)
            if not kind:
                continue
            marker = self.create_marker(panel.name, kind, [length + _MARGIN_M for length in size], color)
            x, y, z, *orientation = compose(self.simulation.link_pose(panel.link), panel.pose)
            marker.pose.position = get_message("geometry_msgs/msg/Point")(x=x, y=y, z=z)
            marker.pose.orientation = from_values(Quaternion, tuple(orientation))
            markers.append(marker)
        self.publish_markers(markers)


def _get_marker_size(shape: Shape) -> tuple[int, tuple[float, float, float]]:
    """Return the type and the size of the marker for a shape; the type is 0 if there is none."""
    if isinstance(shape, Box):
        return _CUBE, shape.size
    if isinstance(shape, Sphere):
        return _SPHERE, (2.0 * shape.radius,) * 3
    if isinstance(shape, Cylinder):
        return _CYLINDER, (2.0 * shape.radius, 2.0 * shape.radius, shape.length)
    return 0, (0.0, 0.0, 0.0)
