"""Sensor plugins of PX4's models for air speed and distance.

They are ``libgazebo_airspeed_plugin.so`` and ``libgazebo_lidar_plugin.so``.

Source: PX4-SITL_gazebo-classic (parameters, defaults, rates, formulas). Topics of Gazebo's transport are topics of ROS
in the namespace of the model, with messages of ROS in its units. The quality of the signal is left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.px4.sensors import ModelSensor
from linkwright.simulation.plugins.sensors.base import SENSOR_QOS, SingleTopicSensor
from linkwright.simulation.plugins.sensors.lidar import SingleTopicLidar
from linkwright.simulation.sensors.air_speed import measure_dynamic_pressure
from linkwright.simulation.sensors.lidar import Scan
from linkwright.simulation.sensors.mount import Mount

_PASCAL_PER_HECTOPASCAL = 100.0
_AIRSPEED_RATE_HZ = 10.0
_LEAST_DISTANCE_M, _GREATEST_DISTANCE_M = 0.06, 35.0
"""The limits of the parameters of the distance sensor."""
_FIELD_OF_VIEW_RAD = 0.0523598776
_FOG_DISTANCE_M, _FOG_DEVIATION_M = 2.0, 0.1


@dataclass(frozen=True, kw_only=True)
class Px4AirspeedParameters:
    """Parameters of ``libgazebo_airspeed_plugin.so``."""

    topic_name: str = parameter("", aliases=("topic",))
    pressure_deviation: float = parameter(0.01, aliases=("DiffPressureStdev",))


class Px4Airspeed(ModelSensor[Px4AirspeedParameters], SingleTopicSensor[Px4AirspeedParameters]):
    """The substitute for ``libgazebo_airspeed_plugin.so``: the dynamic pressure in Pa of the air along x.

    The pressure is negative if the air comes from behind.
    """

    PARAMETERS = Px4AirspeedParameters
    IGNORED = ("linkName",)

    @property
    def rate(self) -> float:
        """Ten measurements per simulated second."""
        return _AIRSPEED_RATE_HZ

    @property
    def mount(self) -> Mount:
        """The mount at the origin of the link with the sensor."""
        return Mount(self.simulation, self.sensor.link)

    def create_sensor(self) -> None:
        """Create the noise."""
        self._generator = self.random
        self._deviation_pa = self.parameters.pressure_deviation * _PASCAL_PER_HECTOPASCAL

    def create_publishers(self) -> None:
        """Create the publisher of ``sensor_msgs/msg/FluidPressure``."""
        topic = self.sensor_topic(self.parameters.topic_name)
        self.output = self.node.publisher("sensor_msgs/msg/FluidPressure", topic, SENSOR_QOS)

    def measure(self) -> None:
        """Measure, and publish the dynamic pressure."""
        message = self.message("sensor_msgs/msg/FluidPressure", self.frame)
        message.fluid_pressure = self.measure_pressure()
        message.variance = self._deviation_pa**2
        self.output.publish(message)

    def measure_pressure(self) -> float:
        """Return the dynamic pressure in Pa, with noise."""
        pressure = measure_dynamic_pressure(self.mount, elevation=self.home.elevation)
        return pressure + float(self._generator.normal(0.0, self._deviation_pa))


@dataclass(frozen=True, kw_only=True)
class Px4LidarParameters:
    """Parameters of ``libgazebo_lidar_plugin.so``."""

    topic_name: str = parameter("", aliases=("topic",))
    min_distance: float = 0.2
    max_distance: float = 15.0
    simulate_fog: bool = False


class Px4Lidar(SingleTopicLidar[Px4LidarParameters], ModelSensor[Px4LidarParameters]):
    """The substitute for ``libgazebo_lidar_plugin.so``: the distance that the first ray measures.

    The distance is at least the minimum, and 0 beyond the maximum. Fog hides everything beyond 2 m.
    """

    PARAMETERS = Px4LidarParameters

    @property
    def rate(self) -> float:
        """The number of measurements per simulated second, which is that of the sensor."""
        return self.sensor.sensor.update_rate

    @property
    def mount(self) -> Mount:
        """The link to which the sensor is fixed, and the pose of the sensor on this link."""
        return Mount(self.simulation, self.sensor.link, self.sensor.pose)

    def create_sensor(self) -> None:
        """Create the lidar, and the noise of the fog."""
        super().create_sensor()
        self._generator = self.random
        self._least = max(self.parameters.min_distance, _LEAST_DISTANCE_M)
        self._greatest = min(self.parameters.max_distance, _GREATEST_DISTANCE_M)

    def create_publishers(self) -> None:
        """Create the publisher of ``sensor_msgs/msg/Range``."""
        topic = self.sensor_topic(self.parameters.topic_name)
        self.output = self.node.publisher("sensor_msgs/msg/Range", topic, SENSOR_QOS)

    def publish(self, scan: Scan) -> None:
        """Publish the distance that the first ray of a scan measures."""
        message = self.create_range_message(self.frame, scan, "infrared")
        message.field_of_view = _FIELD_OF_VIEW_RAD
        message.min_range, message.max_range = self._least, self._greatest
        message.range = self._limit(float(scan.ranges[0, 0]))
        self.output.publish(message)

    def _limit(self, distance: float) -> float:
        """Return the distance that the sensor tells in its range and in fog."""
        if self.parameters.simulate_fog and distance > _FOG_DISTANCE_M:
            return _FOG_DISTANCE_M + self._generator.normal(0.0, _FOG_DEVIATION_M)
        if distance < self._least:
            return self._least
        return 0.0 if distance > self._greatest or distance == inf else distance
