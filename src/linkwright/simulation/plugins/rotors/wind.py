"""Wind on multirotors of RotorS: ``librotors_gazebo_wind_plugin.so``.

A constant force and a gust push a link, and the speed of the wind acts on the rotors.

Source: rotors_simulator (parameters, defaults, topics). Its variances have no effect there, either. The speed is
published as ``geometry_msgs/msg/Vector3Stamped`` in place of ``mav_msgs/WindSpeed``, and it is the wind of the world.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Vector3
from linkwright.messages import Header, get_message
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.rotors.motors import name_topic
from linkwright.simulation.plugins.sensors.base import vector_to_message

_WRENCH_TYPE, _SPEED_TYPE = "geometry_msgs/msg/WrenchStamped", "geometry_msgs/msg/Vector3Stamped"


@dataclass(frozen=True, kw_only=True)
class RotorsWindParameters:
    """Parameters of ``librotors_gazebo_wind_plugin.so``: forces in N, speeds in m/s, times in s."""

    link_name: str = parameter("base_link", aliases=("linkName",))
    frame_id: str = parameter("world", aliases=("frameId",))
    xyz_offset: Vector3 = parameter((0.0, 0.0, 0.0), aliases=("xyzOffset",))
    force_topic: str = parameter("external_force", aliases=("windForcePubTopic", "windPubTopic"))
    speed_topic: str = parameter("wind_speed", aliases=("windSpeedPubTopic",))
    wind_force_mean: float = parameter(0.0, aliases=("windForceMean",))
    wind_speed_mean: float = parameter(0.0, aliases=("windSpeedMean",))
    wind_direction: Vector3 = parameter((1.0, 0.0, 0.0), aliases=("windDirection",))
    wind_gust_start: float = parameter(10.0, aliases=("windGustStart",))
    wind_gust_duration: float = parameter(0.0, aliases=("windGustDuration",))
    wind_gust_force_mean: float = parameter(0.0, aliases=("windGustForceMean",))
    wind_gust_direction: Vector3 = parameter((0.0, 1.0, 0.0), aliases=("windGustDirection",))
    use_custom_static_wind_field: bool = parameter(default=False, aliases=("useCustomStaticWindField",))


class RotorsWind(SimulatedPlugin[RotorsWindParameters]):
    """The substitute for ``librotors_gazebo_wind_plugin.so``."""

    PARAMETERS = RotorsWindParameters
    IGNORED = ("windForceVariance", "windGustForceVariance", "windSpeedVariance", "customWindFieldPath")

    def start(self) -> None:
        """Find the link, and create the topics.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, the wind is in a file.
        """
        parameters = self.parameters
        if parameters.use_custom_static_wind_field:
            message = phrase(
                "plugin '{plugin}': a wind field in a file is not simulated; set <useCustomStaticWindField> to false "
                "and <windSpeedMean> to the speed",
                plugin=self.context.name,
            )
            raise self.parameter_error(message)
        self._link = self.link(parameters.link_name)
        self.simulation.keep_awake(self._link)
        self._force_output = self.node.publisher(_WRENCH_TYPE, name_topic(self, parameters.force_topic))
        self._speed_output = self.node.publisher(_SPEED_TYPE, name_topic(self, parameters.speed_topic))
        self.every(0.0, self._update)

    def stop(self) -> None:
        """Restore the wind of the world."""
        self.simulation.wind = self.simulation.world.wind

    def _update(self) -> None:
        parameters, simulation = self.parameters, self.simulation
        simulation.refresh()
        direction = _normalize(parameters.wind_direction)
        force = parameters.wind_force_mean * direction
        if 0.0 <= simulation.seconds - parameters.wind_gust_start < parameters.wind_gust_duration:
            force = force + parameters.wind_gust_force_mean * _normalize(parameters.wind_gust_direction)
        body, data = simulation.body(self._link), simulation.data
        offset = data.xmat[body].reshape(3, 3) @ np.array(parameters.xyz_offset)
        self.push(self._link, force, at=data.xipos[body] + offset)
        speed = parameters.wind_speed_mean * direction
        x, y, z = speed.tolist()
        simulation.wind = (x, y, z)
        header = Header(stamp=self.stamp(), frame_id=parameters.frame_id)
        if self._force_output.is_wanted:
            wrench = get_message("geometry_msgs/msg/Wrench")(force=vector_to_message(force))
            self._force_output.publish(get_message(_WRENCH_TYPE)(header=header, wrench=wrench))
        if self._speed_output.is_wanted:
            self._speed_output.publish(get_message(_SPEED_TYPE)(header=header, vector=vector_to_message(speed)))


def _normalize(vector: Vector3) -> Array:
    array: Array = np.array(vector)
    return array / (float(np.linalg.norm(array)) or 1.0)
