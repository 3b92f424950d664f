"""Contact forces of feet: ``libunitreeFootContactPlugin.so``.

The mean force of the contacts of a foot is published, in the axes of its link.

Source: unitree_ros (topic, type, mean). Without a contact, the force is 0; a port for ROS 2 publishes
3 N for each axis.
"""

from __future__ import annotations

import numpy as np

from linkwright.simulation.plugins.parameters import NoParameters
from linkwright.simulation.plugins.sensors.base import SENSOR_QOS, vector_to_message
from linkwright.simulation.plugins.sensors.contact import ContactPlugin

_WRENCH_TYPE = "geometry_msgs/msg/WrenchStamped"


class FootContact(ContactPlugin[NoParameters]):
    """The substitute for ``libunitreeFootContactPlugin.so``: the force on ``/visual/SENSOR/the_force``."""

    def create_publishers(self) -> None:
        """Create the publisher of ``geometry_msgs/msg/WrenchStamped``."""
        name = self.sensor.sensor.name
        self.output = self.node.publisher(_WRENCH_TYPE, f"/visual/{name}/the_force", SENSOR_QOS)

    def measure(self) -> None:
        """Measure, and publish the mean force."""
        contacts = self.contacts.measure()
        forces = [contact.forces.sum(axis=0) for contact in contacts]
        force = np.mean(forces, axis=0) if forces else np.zeros(3)
        simulation = self.simulation
        axes = simulation.data.xmat[simulation.body(self.sensor.link)].reshape(3, 3)
        message = self.message(_WRENCH_TYPE, self.classic_frame())
        message.wrench.force = vector_to_message(force @ axes)
        self.output.publish(message)
