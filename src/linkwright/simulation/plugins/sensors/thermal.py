"""Thermal cameras: the sensor ``thermal_camera`` of gz, with ``gz-sim-thermal-sensor-system``.

The plugin ``gz-sim-thermal-system`` gives a visual a ``<temperature>``. Everything else has the temperature of the
world's ``<atmosphere>``. A pixel is the temperature divided by the resolution.

Source: gz-sim and gz-sensors (parameters, defaults, formats, topics). A ``<heat_signature>`` is not read: its visual
has the middle of its temperatures. The temperature of the surroundings does not vary with their colors.
"""

from __future__ import annotations

from math import inf

import numpy as np

from linkwright.graph.stepped.node import Output
from linkwright.sdf.plugins import Plugin, library_name
from linkwright.simulation.plugins.parameters import NoParameters
from linkwright.simulation.plugins.sensors.camera import CAMERA_INFO_TYPE, IMAGE_TYPE, CameraPlugin
from linkwright.simulation.plugins.sensors.images import Pixels, fill_camera_info, fill_gray
from linkwright.simulation.plugins.sensors.part_values import find_part_values, get_closest_value
from linkwright.simulation.rendering.renderer import Channels
from linkwright.simulation.sensors.mount import GeomTable, get_part_name

_THERMAL_SYSTEM, _SENSOR_SYSTEM = "gz-sim-thermal-system", "gz-sim-thermal-sensor-system"
_RESOLUTION_K, _COARSE_RESOLUTION_K, _LEAST_COARSE_RESOLUTION_K = 0.01, 3.0, 1.0
"""The resolutions in K: the default, the default for 8 bits, and the least for 8 bits."""
_FORMATS_OF_8_BITS = ("L8", "L_INT8", "L_UINT8")


class GzThermal(CameraPlugin[NoParameters]):
    """The sensor ``thermal_camera`` of gz, which publishes temperatures as gray values of 16 or 8 bits."""

    def create_sensor(self) -> None:
        """Create the camera and the table of temperatures, and read the settings of the sensor."""
        super().create_sensor()
        self._temperatures = GeomTable(self.simulation, self._compute_temperatures)
        (camera, *_) = self.cameras
        self._frame = camera.description.optical_frame_id or self.gz_frame()
        has_8_bits = camera.description.image.format.upper() in _FORMATS_OF_8_BITS
        self._kind = np.uint8 if has_8_bits else np.uint16
        plugins = (item for item in self.sensor.sensor.plugins if library_name(item.filename) == _SENSOR_SYSTEM)
        settings = next((item.element for item in plugins), None)
        self._resolution = self.number_in(settings, "resolution", _RESOLUTION_K)
        if has_8_bits and self._resolution < _LEAST_COARSE_RESOLUTION_K:
            self._resolution = _COARSE_RESOLUTION_K
        self._coldest = self.number_in(settings, "min_temp", 0.0)
        self._hottest = self.number_in(settings, "max_temp", inf)

    def create_publishers(self) -> None:
        """Create the publishers of the images and the camera info."""
        topic = self.sensor.sensor.topic
        self._images = self.create_gz_output(IMAGE_TYPE, "image")
        parent_topic, slash, _ = topic.rpartition("/")
        info = self.cameras[0].description.camera_info_topic
        self._info = self.node.publisher(
            CAMERA_INFO_TYPE,
            info or (f"{parent_topic}{slash}camera_info" if topic else self.gz_topic("camera_info")),
            conventional_topic="" if topic else "/camera_info",
        )

    def is_wanted(self) -> bool:
        """Return whether a topic has a subscription."""
        return self._images.is_wanted or self._info.is_wanted

    def measure(self) -> None:
        """Render, and publish the temperatures and the camera info."""
        (camera, *_) = self.cameras
        if self._info.is_wanted:
            message = self.message(CAMERA_INFO_TYPE, self._frame)
            fill_camera_info(message, camera.optics, camera.description.distortion)
            self._info.publish(message)
        if self._images.is_wanted:
            rendered = self.render(camera, Channels.GEOMS)
            assert rendered.geoms is not None  # requested
            self._publish_temperatures(self._images, rendered.geoms)

    def _publish_temperatures(self, output: Output, geoms: Pixels) -> None:
        temperatures = np.where(geoms < 0, self._ambient, self._temperatures.array()[geoms])
        values = np.clip(temperatures, self._coldest, self._hottest) / self._resolution
        message = self.message(IMAGE_TYPE, self._frame)
        fill_gray(message, np.clip(np.rint(values), 0, np.iinfo(self._kind).max).astype(self._kind))
        output.publish(message)

    @property
    def _ambient(self) -> float:
        """The temperature of the atmosphere in K."""
        return self.context.world.atmosphere.temperature

    def _compute_temperatures(self, names: list[str]) -> list[float]:
        values = find_part_values(self.simulation, self._read_temperature)
        return [get_closest_value(values, get_part_name(name), self._ambient) for name in names]

    def _read_temperature(self, plugin: Plugin) -> float | None:
        """Return the temperature in K that a plugin gives its visual."""
        element = plugin.element
        if element is None or library_name(plugin.filename) != _THERMAL_SYSTEM:
            return None
        if element.first("heat_signature") is not None:
            ends = (self.number_in(element, tag, self._ambient) for tag in ("min_temp", "max_temp"))
            return sum(ends) / 2
        return self.number_in(element, "temperature") if element.first("temperature") is not None else None
