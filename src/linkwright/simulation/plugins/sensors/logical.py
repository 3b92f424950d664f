"""The logical camera of gz, which publishes the models in its view instead of an image.

Source: gz-sensors (topic, view frustum), ros_gz (messages). A model is in view if the origin of its frame is in view.
"""

from __future__ import annotations

from math import tan

from linkwright.geometry.single import Transform, compose, invert
from linkwright.messages import get_message
from linkwright.sdf.sensors import LogicalCamera
from linkwright.simulation.plugins.entities import pose_to_message
from linkwright.simulation.plugins.parameters import NoParameters
from linkwright.simulation.plugins.sensors.base import SingleTopicSensor

_IMAGE_TYPE, _MODEL_TYPE = "ros_gz_interfaces/msg/LogicalCameraImage", "ros_gz_interfaces/msg/LogicalCameraImageModel"


class GzLogicalCamera(SingleTopicSensor[NoParameters]):
    """The sensor ``logical_camera`` of gz, which publishes names and poses of models."""

    def create_sensor(self) -> None:
        """Read the view frustum from the sensor's element."""
        self._view = self.sensor.sensor.logical_camera or LogicalCamera()

    def create_publishers(self) -> None:
        """Create the publisher of ``ros_gz_interfaces/msg/LogicalCameraImage``."""
        self.output = self.create_gz_output(_IMAGE_TYPE, "logical_camera")

    def measure(self) -> None:
        """Publish the names and poses of the models in view."""
        camera = compose(self.simulation.link_pose(self.sensor.link), self.sensor.pose)
        message = self.message(_IMAGE_TYPE, self.gz_frame())
        message.pose = pose_to_message(camera)
        world_to_camera = invert(camera)
        for name in self.simulation.scene.models:
            pose = compose(world_to_camera, self.simulation.model_pose(name))
            if is_in_view(self._view, pose):
                message.model.append(get_message(_MODEL_TYPE)(name=name, pose=pose_to_message(pose)))
        self.output.publish(message)


def is_in_view(view: LogicalCamera, pose: Transform) -> bool:
    """Return whether the origin of a frame is in the view frustum of a logical camera.

    `pose` is the pose of this frame in the frame of the camera, which looks along x.
    """
    x, y, z = pose[:3]
    half_width_ratio = tan(view.horizontal_fov / 2)
    return (
        view.near <= x <= view.far
        and abs(y) <= x * half_width_ratio
        and abs(z) <= x * half_width_ratio / view.aspect_ratio
    )
