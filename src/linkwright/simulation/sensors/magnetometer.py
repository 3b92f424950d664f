"""A magnetometer: the magnetic field of the world, in the axes of the sensor."""

from __future__ import annotations

from linkwright.geometry.single import compose, quaternion_inverse, rotate
from linkwright.messages import Header, Vector3, get_message
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.parameters import NoParameters
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_TYPE = "sensor_msgs/msg/MagneticField"


class Magnetometer(SimulatedPlugin[NoParameters]):
    """Publishes ``sensor_msgs/msg/MagneticField`` in tesla, which is what a bridge makes of gz's message."""

    def start(self) -> None:
        """Make the topic, that of gz where none is written."""
        sensor = self.sensor.sensor
        model, *inside = self.sensor.name.split(SEPARATOR)
        usual = f"/world/{self.place.world.name}/model/{model}/link/{'/'.join(inside[:-1])}/sensor/{inside[-1]}"
        self._frame = sensor.frame_id or self.sensor.name.replace(SEPARATOR, "/")
        self._output = self.node.publisher(_TYPE, sensor.topic or f"{usual}/magnetometer")
        self.every(sensor.update_rate, self._measure)

    def _measure(self) -> None:
        if not self._output.is_wanted:
            return
        pose = compose(self.simulation.link_pose(self.sensor.link), self.sensor.pose)
        field = rotate(quaternion_inverse(pose[3:]), self.place.world.magnetic_field)
        message = get_message(_TYPE)(header=Header(stamp=self.stamp(), frame_id=self._frame))
        message.magnetic_field = Vector3(*field)
        self._output.publish(message)
