"""Wind on boats: ``libUSVWind.so``.

The speed of the wind is a mean with a variation of first order: ``dv/dt = (-v + K sqrt(2 T) n) / T`` with white noise
n, so that the variation has the standard deviation K and the time constant T. Each ``<wind_obj>`` is a link with
coefficients for its axes x and y and for its yaw:

    Fx = cx vx |vx|,    Fy = cy vy |vy|,    Tz = -2 cz vx vy

with the wind v past the link in the link's axes.

Source: VRX (parameters, topics, defaults, formulas); T. I. Fossen, *Handbook of Marine Craft Hydrodynamics and Motion
Control*, 2011, section 8.1. VRX takes the axes of the world, so that the wind turns a boat whatever its heading.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, radians, sin, sqrt

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array
from linkwright.messages import get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.xmltree import Element

_FLOAT_TYPE = "std_msgs/msg/Float32"


@dataclass(frozen=True, kw_only=True)
class BoatWindParameters:
    """Parameters of ``libUSVWind.so``: the direction in degrees, velocities in m/s, times in s."""

    wind_direction: float | None = None
    wind_mean_velocity: float = 0.0
    var_wind_gain_constants: float = 0.0
    var_wind_time_constants: float = 0.1
    random_seed: int = 0
    update_rate: float = 10.0
    topic_wind_speed: str = "/vrx/debug/wind/speed"
    topic_wind_direction: str = "/vrx/debug/wind/direction"


@dataclass(frozen=True, slots=True)
class _Sail:
    """A link that the wind pushes.

    Attributes:
        model: the name of the model.
        link: the name of the link in the model.
        coefficients: the coefficients for x, y and yaw, shape (3,).
    """

    model: str
    link: str
    coefficients: Array


class BoatWind(SimulatedPlugin[BoatWindParameters]):
    """The substitute for ``libUSVWind.so``."""

    PARAMETERS = BoatWindParameters
    IGNORED = ("wind_obj",)
    CARRIED = ("_variation", "_random")

    def start(self) -> None:
        """Read the links, and create the topics.

        Raises:
            LinkwrightError: SIM160, a link has no valid coefficients, or the time constant is not positive.
        """
        parameters, element = self.parameters, self.context.element
        self._sails = [self._read_sail(child) for child in (() if element is None else element.elements("wind_obj"))]
        if parameters.var_wind_time_constants <= 0.0:
            raise self.parameter_error(
                phrase("plugin '{plugin}': <var_wind_time_constants> must be greater than 0", plugin=self.context.name)
            )
        direction = parameters.wind_direction
        angle = radians(direction or 0.0)
        self._direction = np.zeros(3) if direction is None else np.array((cos(angle), sin(angle), 0.0))
        self._revision = -1
        self.reset()
        self._speed_output = self.node.publisher(_FLOAT_TYPE, parameters.topic_wind_speed)
        self._direction_output = self.node.publisher(_FLOAT_TYPE, parameters.topic_wind_direction)
        self.every(0.0, self._apply_wind)
        self.every(parameters.update_rate, self._publish)

    def reset(self) -> None:
        """Restart the variation of the wind."""
        self._variation = 0.0
        seed = self.parameters.random_seed
        self._random = np.random.default_rng(seed) if seed > 0 else self.random

    def _read_sail(self, element: Element) -> _Sail:
        try:
            x, y, z = (float(word) for word in self.text_in(element, "coeff_vector").split())
        except ValueError as error:
            message = phrase(
                "plugin '{plugin}': <wind_obj> needs three numbers in <coeff_vector>", plugin=self.context.name
            )
            raise self.parameter_error(message, element) from error
        return _Sail(self.text_in(element, "name"), self.text_in(element, "link_name"), np.array((x, y, z)))

    def _apply_wind(self) -> None:
        simulation, parameters = self.simulation, self.parameters
        simulation.refresh()
        if self._revision != simulation.revision:
            self._revision = simulation.revision
            self._links = {link: sail for sail in self._sails for link in self._find_links(sail)[:1]}
            self.stop_pushing(except_links=self._links)
            for link in self._links:
                simulation.keep_awake(link)
        step = simulation.step / NANOSECONDS_PER_SECOND
        time_constant = parameters.var_wind_time_constants
        gain = parameters.var_wind_gain_constants * sqrt(2.0 * time_constant)
        noise = float(self._random.standard_normal()) / sqrt(step)
        self._variation += (gain * noise - self._variation) * step / time_constant
        wind = self._direction * self._speed
        for link, sail in self._links.items():
            self._push(link, sail.coefficients, wind)

    @property
    def _speed(self) -> float:
        return self.parameters.wind_mean_velocity + self._variation

    def _find_links(self, sail: _Sail) -> list[str]:
        """Return the full names of the links of a sail; its own model comes first."""
        suffix = SEPARATOR + sail.link
        links = [link for link in self.simulation.scene.bodies if link.endswith(suffix)]
        return sorted(links, key=lambda link: not link.startswith(sail.model + SEPARATOR))

    def _push(self, link: str, coefficients: Array, wind: Array) -> None:
        simulation = self.simulation
        body, data = simulation.body(link), simulation.data
        axes = np.eye(3) if self.gazebo_mistakes else data.xmat[body].reshape(3, 3)
        linear, _ = simulation.link_velocity(link)
        x, y, _ = ((wind - linear) @ axes).tolist()
        force_x, force_y, turning = coefficients.tolist()
        force = axes @ np.array((force_x * x * abs(x), force_y * y * abs(y), 0.0))
        torque = axes @ np.array((0.0, 0.0, -2.0 * turning * x * y))
        self.push(link, force, torque, at=data.xpos[body])

    def _publish(self) -> None:
        message_class = get_message(_FLOAT_TYPE)
        self._speed_output.publish(message_class(data=self._speed))
        self._direction_output.publish(message_class(data=self.parameters.wind_direction or 0.0))
