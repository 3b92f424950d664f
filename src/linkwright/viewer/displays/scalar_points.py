"""rviz_default_plugins/FluidPressure, Illuminance, RelativeHumidity, Temperature: one number as a coloured point."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from linkwright.viewer.clouds import Points
from linkwright.viewer.config.schema import topic_spec
from linkwright.viewer.displays.base.cloud_display import CloudDisplay
from linkwright.viewer.displays.properties.cloud import scalar_specs


class ScalarDisplay(CloudDisplay):
    """A point at the origin of the sensor's frame."""

    FIELD: ClassVar[str]
    """The field of the message with the number, and the channel of the point."""

    def points_of(self, message: Any) -> Points:
        """The one point."""
        value = np.array([getattr(message, self.FIELD)], np.float64)
        return Points(np.zeros((1, 3), np.float32), {self.FIELD: value})


class FluidPressureDisplay(ScalarDisplay):
    """The pressure of air or water, in pascal."""

    CLASS = "rviz_default_plugins/FluidPressure"
    MESSAGE = "sensor_msgs/msg/FluidPressure"
    FIELD = "fluid_pressure"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        *scalar_specs(FIELD, 98000.0, 105000.0),
    )


class IlluminanceDisplay(ScalarDisplay):
    """How bright it is, in lux."""

    CLASS = "rviz_default_plugins/Illuminance"
    MESSAGE = "sensor_msgs/msg/Illuminance"
    FIELD = "illuminance"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        *scalar_specs(FIELD, 0.0, 1000.0),
    )


class RelativeHumidityDisplay(ScalarDisplay):
    """The humidity of the air, 0 to 1."""

    CLASS = "rviz_default_plugins/RelativeHumidity"
    MESSAGE = "sensor_msgs/msg/RelativeHumidity"
    FIELD = "relative_humidity"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        *scalar_specs(FIELD, 0.0, 1.0),
    )


class TemperatureDisplay(ScalarDisplay):
    """The temperature, in degrees Celsius; cold is violet, hot is red."""

    CLASS = "rviz_default_plugins/Temperature"
    MESSAGE = "sensor_msgs/msg/Temperature"
    FIELD = "temperature"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        *scalar_specs(FIELD, 0.0, 100.0, inverted=True),
    )
