"""Wind of PX4's worlds: ``libgazebo_wind_plugin.so``.

The speed and each component of the direction are drawn from normal distributions. A gust adds to the wind for some
time, and so does a vector that rises linearly to its full length.

Source: PX4-SITL_gazebo-classic (parameters, defaults, formulas). The topic of Gazebo's transport is a topic of ROS in
the namespace of the plugin. As there, the components of a drawn direction are not normalized again.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Vector3
from linkwright.messages import Header, get_message
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.sensors.base import vector_to_message

_WIND_TYPE = "geometry_msgs/msg/Vector3Stamped"


@dataclass(frozen=True, kw_only=True)
class Px4WindParameters:
    """Parameters of ``libgazebo_wind_plugin.so``: speeds in m/s, variances in m2/s2, times in s."""

    topic_name: str = parameter("world_wind", aliases=("windPubTopic",))
    update_rate: float = parameter(2.0, aliases=("publishRate",))
    frame_id: str = parameter("world", aliases=("frameId",))
    wind_velocity_mean: float = parameter(0.0, aliases=("windVelocityMean",))
    wind_velocity_max: float = parameter(100.0, aliases=("windVelocityMax",))
    wind_velocity_variance: float = parameter(0.0, aliases=("windVelocityVariance",))
    wind_direction_mean: Vector3 = parameter((1.0, 0.0, 0.0), aliases=("windDirectionMean",))
    wind_direction_variance: float = parameter(0.0, aliases=("windDirectionVariance",))
    wind_gust_start: float = parameter(10.0, aliases=("windGustStart",))
    wind_gust_duration: float = parameter(0.0, aliases=("windGustDuration",))
    wind_gust_velocity_mean: float = parameter(0.0, aliases=("windGustVelocityMean",))
    wind_gust_velocity_max: float = parameter(10.0, aliases=("windGustVelocityMax",))
    wind_gust_velocity_variance: float = parameter(0.0, aliases=("windGustVelocityVariance",))
    wind_gust_direction_mean: Vector3 = parameter((0.0, 1.0, 0.0), aliases=("windGustDirectionMean",))
    wind_gust_direction_variance: float = parameter(0.0, aliases=("windGustDirectionVariance",))
    wind_ramp_start: float = parameter(0.0, aliases=("windRampStart",))
    wind_ramp_duration: float = parameter(0.0, aliases=("windChangeRampDuration",))
    wind_ramp_vector: Vector3 = parameter((0.0, 0.0, 0.0), aliases=("windRampWindVectorComponents",))


class Px4Wind(SimulatedPlugin[Px4WindParameters]):
    """The substitute for ``libgazebo_wind_plugin.so``, which sets the wind of the world."""

    PARAMETERS = Px4WindParameters

    def start(self) -> None:
        """Create the topic of the wind."""
        namespace = self.text_in(self.context.element, "robotNamespace").strip("/")
        topic = self.parameters.topic_name.lstrip("/")
        self._output = self.node.publisher(_WIND_TYPE, f"/{namespace}/{topic}" if namespace else f"/{topic}")
        self.reset()
        if self.parameters.update_rate > 0.0:
            self.every(self.parameters.update_rate, self._update)

    def reset(self) -> None:
        """Restart the random numbers."""
        self._random = self.random

    def stop(self) -> None:
        """Restore the wind of the world."""
        self.simulation.wind = self.simulation.world.wind

    def _update(self) -> None:
        """Draw the wind, and publish it."""
        parameters, seconds = self.parameters, self.simulation.seconds
        wind = self._draw(
            parameters.wind_velocity_mean,
            parameters.wind_velocity_max,
            parameters.wind_velocity_variance,
            parameters.wind_direction_mean,
            parameters.wind_direction_variance,
        )
        if 0.0 <= seconds - parameters.wind_gust_start < parameters.wind_gust_duration:
            wind += self._draw(
                parameters.wind_gust_velocity_mean,
                parameters.wind_gust_velocity_max,
                parameters.wind_gust_velocity_variance,
                parameters.wind_gust_direction_mean,
                parameters.wind_gust_direction_variance,
            )
        if parameters.wind_ramp_duration > 0.0:
            fraction = (seconds - parameters.wind_ramp_start) / parameters.wind_ramp_duration
            wind += min(max(fraction, 0.0), 1.0) * np.array(parameters.wind_ramp_vector)
        x, y, z = wind.tolist()
        self.simulation.wind = (x, y, z)
        header = Header(stamp=self.stamp(), frame_id=parameters.frame_id)
        self._output.publish(get_message(_WIND_TYPE)(header=header, vector=vector_to_message(wind)))

    def _draw(
        self, mean: float, maximum: float, variance: float, direction: Vector3, direction_variance: float
    ) -> Array:
        speed = min(abs(float(self._random.normal(mean, sqrt(variance)))), maximum)
        axis = np.array(direction) / (float(np.linalg.norm(direction)) or 1.0)
        wind: Array = speed * self._random.normal(axis, sqrt(direction_variance))
        return wind
