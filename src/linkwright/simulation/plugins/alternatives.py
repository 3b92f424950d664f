"""Alternatives to plugins and sensors that are not simulated."""

from __future__ import annotations

from linkwright.diagnostics import Phrase, phrase
from linkwright.sdf.plugins import library_name

_AIR_SPEED_ALTERNATIVE = phrase("the velocity that gz-sim-odometry-publisher-system publishes, in still air")
_WIDE_CAMERA_ALTERNATIVE = phrase("a camera with a wide <horizontal_fov>")
_AUTOPILOT_ALTERNATIVE = phrase(
    "a ROS node in place of the autopilot: commands on the topics of the motors and joints, "
    "such as /MODEL/gazebo/command/motor_speed, and the topics of the sensors"
)
_TASK_ALTERNATIVE = phrase(
    "`ros2 topic pub --once /vrx/release std_msgs/msg/Empty` to release the boat, and a ROS node that computes "
    "the score"
)
_CAMERA_ALTERNATIVE = phrase("libgazebo_ros_camera.so in the <sensor>")
_LIDAR_ALTERNATIVE = phrase("libgazebo_ros_ray_sensor.so in a <sensor> of type ray")
_THERMAL_ALTERNATIVE = phrase("a <sensor> of type segmentation_camera, with a label for what is warm")
_RADIO_ALTERNATIVE = phrase(
    "libgazebo_ros_p3d.so for the true poses, and a ROS node that computes the signal from the distance"
)
_DISTANCE_ALTERNATIVE = phrase(
    "a <sensor> of type ray with libgazebo_ros_ray_sensor.so and <output_type>sensor_msgs/Range</output_type>"
)
_CAMERAS = ("RealSensePlugin", "gazebo_gst_camera_plugin", "realsense_gazebo_plugin", "uuv_gazebo_ros_camera_plugin")
_LIDARS = ("rmagine_embree_ros_gzplugin", "rmagine_optix_ros_gzplugin")
_TASKS = ("AcousticPerception", "AcousticTracking", "Gymkhana", "Navigation", "Perception", "ScanDock", "Wildlife")

_ALTERNATIVES = {
    "air_speed": _AIR_SPEED_ALTERNATIVE,
    "gazebo_ros_elevator": phrase("gz-sim-joint-position-controller-system for the joint of the cabin"),
    **dict.fromkeys((f"{task}ScoringPlugin" for task in _TASKS), _TASK_ALTERNATIVE),
    **dict.fromkeys(_CAMERAS, _CAMERA_ALTERNATIVE),
    **dict.fromkeys(_LIDARS, _LIDAR_ALTERNATIVE),
    "AdvancedLiftDragPlugin": phrase("libLiftDragPlugin.so for each wing"),
    "ArduPilotPlugin": _AUTOPILOT_ALTERNATIVE,
    "gazebo_mavlink_interface": _AUTOPILOT_ALTERNATIVE,
    "gz-sim-air-speed-system": _AIR_SPEED_ALTERNATIVE,
    "gz-sim-camera-video-recorder-system": phrase("`linkwright bag record` with the topic of the camera"),
    "gz-sim-follow-actor-system": phrase("an <actor> with the waypoints of a <script>"),
    "gz-sim-log-playback-system": phrase("`linkwright bag play`"),
    "gz-sim-log-system": phrase("`linkwright sim --record`, or `linkwright bag record`"),
    "gz-sim-model-photo-shoot-system": phrase("a camera in front of the model"),
    **dict.fromkeys(("wireless_receiver", "wireless_transmitter", "rfid", "rfidtag"), _RADIO_ALTERNATIVE),
    **dict.fromkeys(
        ("thermal", "thermal_camera", "gz-sim-thermal-system", "gz-sim-thermal-sensor-system"), _THERMAL_ALTERNATIVE
    ),
    "sonar": _DISTANCE_ALTERNATIVE,
    "wide_angle_camera": _WIDE_CAMERA_ALTERNATIVE,
    "wideanglecamera": _WIDE_CAMERA_ALTERNATIVE,
}


def find_alternative(name: str) -> Phrase | None:
    """Return the alternative to a plugin's library or a sensor type, or None."""
    return _ALTERNATIVES.get(library_name(name))
