"""Alternatives to plugins and sensors that are not simulated."""

from __future__ import annotations

from linkwright.diagnostics import Phrase, phrase
from linkwright.sdf.plugins import library_name

_WIDE_CAMERA_ALTERNATIVE = phrase("a camera with a wide <horizontal_fov>")
_TASK_ALTERNATIVE = phrase(
    "`ros2 topic pub --once /vrx/release std_msgs/msg/Empty` to release the boat, and a ROS node that computes "
    "the score"
)
_CAMERA_ALTERNATIVE = phrase("libgazebo_ros_camera.so in the <sensor>")
_LIDAR_ALTERNATIVE = phrase("libgazebo_ros_ray_sensor.so in a <sensor> of type ray")
_THERMAL_ALTERNATIVE = phrase(
    "a <sensor> of type thermal_camera, with gz-sim-thermal-system in the visuals that are warm"
)
_VIDEO_ALTERNATIVE = phrase(
    "a texture in the <material> of the visual, which does not change, or the display Image of the page"
)
_PROJECTOR_ALTERNATIVE = phrase("a <sensor> of type depth_camera, which needs no projected pattern")
_WAVES_ALTERNATIVE = phrase("libPolyhedraBuoyancyDrag.so or libSurface.so, which float on the waves of VRX")
_VELOCITY_ALTERNATIVE = phrase("libuuv_gazebo_ros_dvl_plugin.so")
_LIFT_ALTERNATIVE = phrase("gz-sim-lift-drag-system")
_AIR_ALTERNATIVE = phrase("a <sensor> of type air_speed, and gz-sim-wind-effects-system for the wind")
_HIDING_ALTERNATIVE = phrase(
    "a model of its own for the visual, which the service /set_entity_state of libgazebo_ros_state.so moves out of view"
)
_FINGER_ALTERNATIVE = phrase("libroboticsgroup_gazebo_mimic_joint_plugin.so, so that joints follow the driven one")
_SONAR_ALTERNATIVE = phrase("a <sensor> of type gpu_lidar with many rows")
_MESSAGES_ALTERNATIVE = phrase("ROS topics between the nodes of the robots")
_RADIO_ALTERNATIVE = phrase(
    "libgazebo_ros_p3d.so for the true poses, and a ROS node that computes the signal from the distance"
)
_DISTANCE_ALTERNATIVE = phrase(
    "a <sensor> of type ray with libgazebo_ros_ray_sensor.so and <output_type>sensor_msgs/Range</output_type>"
)
_TASKS = ("AcousticPerception", "AcousticTracking", "Gymkhana", "Navigation", "Perception", "ScanDock", "Wildlife")
_CONTACT_ALTERNATIVE = phrase("libgazebo_ros_bumper.so in a <sensor> of type contact")
_POSE_ALTERNATIVE = phrase("libgazebo_ros_p3d.so, which publishes the true pose and velocity of a link")
_MOTION_ALTERNATIVE = phrase("libgazebo_ros_planar_move.so, or gz-sim-velocity-control-system")
_POSITION_ALTERNATIVE = phrase("gz-sim-joint-position-controller-system for each joint, or controllers of ros2_control")
_BATTERY_ALTERNATIVE = phrase("gz-sim-linearbatteryplugin-system")
_BELT_ALTERNATIVE = phrase("gz-sim-track-controller-system for the link of the belt")
_RELEASE_ALTERNATIVE = phrase("gz-sim-detachable-joint-system, which lets a model go")
_WATER_ALTERNATIVE = phrase("gz-sim-buoyancy-system and gz-sim-hydrodynamics-system")
_ROTOR_ALTERNATIVE = phrase("gz-sim-multicopter-motor-model-system for each rotor")
_CONTROL_ALTERNATIVE = phrase("gz_ros2_control-system, with <ros2_control> in the description")
_LIGHT_ALTERNATIVE = phrase("a <material> of one color, because colors do not change in time")
_IMU_ALTERNATIVE = phrase("a <sensor> of type imu")
_WALK_ALTERNATIVE = phrase("an <actor> with the waypoints of a <script>")
_STEERING_ALTERNATIVE = phrase("libgazebo_ros_ackermann_drive.so, or controllers of ros2_control")
_DRIVE_ALTERNATIVE = phrase("libgazebo_ros_diff_drive.so")
_VIEW_ALTERNATIVE = phrase("the camera of the page")
_TRANSFORM_ALTERNATIVE = phrase("robot_state_publisher, or static_transform_publisher of tf2_ros")
_FORCE_ALTERNATIVE = phrase("libgazebo_ros_ft_sensor.so, which publishes the force and torque in a joint")
_BREAKING_ALTERNATIVE = phrase(
    "gz-sim-detachable-joint-system, and a ROS node that detaches the joint when the force of "
    "libgazebo_ros_ft_sensor.so is too great"
)
_TRACKS_ALTERNATIVE = phrase("gz-sim-tracked-vehicle-system, with gz-sim-track-controller-system for each track")
_REGION_ALTERNATIVE = phrase("libContainPlugin.so")
_SPRING_ALTERNATIVE = phrase("<spring_stiffness> and <spring_reference> in the <dynamics> of the joint")
_COUPLING_ALTERNATIVE = phrase("libroboticsgroup_gazebo_mimic_joint_plugin.so with the multiplier -1")
_ATTACHING_ALTERNATIVE = phrase("libgazebo_ros_link_attacher.so")
_ROTOR_SPEEDS_ALTERNATIVE = phrase("libgazebo_multirotor_base_plugin.so, which publishes the speeds of the rotors")
_LOGICAL_CAMERA_ALTERNATIVE = phrase("a <sensor> of type logical_camera")
_GROUPS = {
    _AIR_ALTERNATIVE: ("asv_sim2-anemometer-system", "asv_sim2-wind-system"),
    _ATTACHING_ALTERNATIVE: ("MRSGazeboLinkAttacherPlugin",),
    _BATTERY_ALTERNATIVE: (
        *("gazebo_ros_power_monitor", "LinearBatteryConsumerPlugin", "LinearBatteryPlugin"),
        "battery_consumer_ros_plugin",
        "custom_battery_consumer_ros_plugin",
        "linear_battery_ros_plugin",
    ),
    _BELT_ALTERNATIVE: ("ROSConveyorBeltPlugin", "ros2_conveyorbelt_plugin"),
    _BREAKING_ALTERNATIVE: ("breakable_joint",),
    _CAMERA_ALTERNATIVE: (
        *("hsrb_gazebo_ros_camera", "recorder_camera_plugin"),
        *("GstCameraPlugin", "RealSensePlugin", "gazebo_geotagged_images_plugin", "gazebo_gst_camera_plugin"),
        *("gazebo_camera_manager_plugin", "gazebo_ros_realsense", "gazebo_ros_triggered_multicamera", "multicamera"),
        *("uuv_gazebo_ros_camera_plugin", "MrsGazeboCommonResources_CameraPlugin"),
        *("MrsGazeboCommonResources_RealsensePlugin", "MrsGazeboCommonResources_ServoCameraPlugin"),
        *("CameraZoomPlugin", "MRSGazeboRealsensePlugin"),
    ),
    _CONTACT_ALTERNATIVE: (
        "hsrb_gazebo_ros_bumper",
        *("RobotFootContactPlugin", "contact_plugin", "gazebo_ros_contact"),
    ),
    _CONTROL_ALTERNATIVE: (
        *("gazebo_ros_controller_manager", "fetch_gazebo_plugin"),
        "IOBPlugin",
        "xbot2_gz_joint_server",
    ),
    _COUPLING_ALTERNATIVE: ("leo_gz_differential_plugin",),
    _DISTANCE_ALTERNATIVE: (
        *("MrsGazeboCommonResources_RangefinderPlugin", "gazebo_sonar_plugin"),
        "sonar",
    ),
    _DRIVE_ALTERNATIVE: ("husky_gazebo_plugins", "diffdrive_plugin_multi_wheel", "gazebo_ros_diffdrive_uos"),
    _FINGER_ALTERNATIVE: ("gazebo_underactuated_finger",),
    _FORCE_ALTERNATIVE: ("ForceTorquePlugin", "gazebo_ros_f3d"),
    _HIDING_ALTERNATIVE: ("ToggleVisualPlugin",),
    _IMU_ALTERNATIVE: (
        *("realsense_gazebo_accel_sensor", "realsense_gazebo_gyro_sensor"),
        "xbot2_gz_imu_server",
    ),
    _LIDAR_ALTERNATIVE: (
        *("MrsGazeboCommonResources_2DLidarPlugin", "MrsGazeboCommonResources_LivoxLaserSimulationPlugin"),
        *("rmagine_embree_ros_gzplugin", "rmagine_optix_ros_gzplugin", "ray"),
        *("MrsGazeboCommonResources_3DLidarPlugin",),
    ),
    _LIFT_ALTERNATIVE: ("asv_sim2-foil-lift-drag-system", "asv_sim2-sail-lift-drag-system"),
    _LIGHT_ALTERNATIVE: (
        *("BlinkVisualPlugin", "LedPlugin", "LEDStrip"),
        *("LightIndicator", "PlacardPlugin", "traffic_light_plugin"),
        *("MrsGazeboCommonResources_LightPlugin", "MrsGazeboCommonResources_SafetyLedPlugin"),
    ),
    _LOGICAL_CAMERA_ALTERNATIVE: ("ROSLogicalCameraPlugin", "gazebo_irlock_plugin"),
    _MESSAGES_ALTERNATIVE: (
        *(f"gz-sim-{name}-system" for name in ("acoustic-comms", "comms-endpoint", "perfect-comms", "rf-comms")),
    ),
    _MOTION_ALTERNATIVE: (
        "FollowerPlugin",
        "gz-sim-drive-to-pose-controller-system",
        "ridgeback_ros_force_based_move",
        *("robotnik_force_based_move", "slotcar"),
        *("SetVelPlugin", "gazebo_random_velocity_plugin", "gazebo_ros_force_based_move"),
        "tuw_gazebo_ros_diff_drive",
    ),
    _POSE_ALTERNATIVE: (
        "robotnik_gazebo_ground_truth_odom",
        *("rotors_gazebo_optical_flow_plugin", "gazebo_aruco_plugin"),
        *("PubTfPlugin", "gazebo_opticalflow_plugin", "gazebo_opticalFlow_plugin", "gazebo_opticalflow_mockup_plugin"),
        *(
            "gazebo_vision_plugin",
            "gazebo_ros_create_docking_status",
            "gazebo_ros_create_ir_opcode",
            "xbot2_gz_link_state_sensor",
        ),
    ),
    _POSITION_ALTERNATIVE: (
        *("JointControlPlugin", "JointTrajectoryPlugin", "asv_sim2-sail-position-controller-system"),
        *("GimbalSmall2dPlugin",),
        *("gazebo_gimbal_controller_plugin", "hector_servo_plugin", "rotors_gazebo_gimbal_controller_plugin"),
    ),
    _PROJECTOR_ALTERNATIVE: ("gazebo_ros_projector",),
    _RADIO_ALTERNATIVE: ("wireless_receiver", "wireless_transmitter", "rfid", "rfidtag", "uwb_range"),
    _REGION_ALTERNATIVE: ("RegionEventBoxPlugin", "SimEventsPlugin"),
    _RELEASE_ALTERNATIVE: (
        "MrsGazeboCommonResources_ParachutePlugin",
        "ParachutePlugin",
        "SuctionGripper",
        "gazebo_parachute_plugin",
        "gazebo_catapult_plugin",
        "gazebo_drop_plugin",
    ),
    _ROTOR_SPEEDS_ALTERNATIVE: ("MrsGazeboCommonResources_MotorSpeedRepublisherPlugin",),
    _ROTOR_ALTERNATIVE: ("hector_gazebo_quadrotor_propulsion",),
    _SONAR_ALTERNATIVE: ("image_sonar_ros_plugin",),
    _SPRING_ALTERNATIVE: ("spring_joint",),
    _STEERING_ALTERNATIVE: (
        *("VehiclePlugin", "ackermann_steering_controller"),
        "gazebo_ros_steer_drive",
        "gazebo_ros_steerbot",
    ),
    _TASK_ALTERNATIVE: (
        *(f"{task}ScoringPlugin" for task in _TASKS),
        *("navigation_scoring_plugin", "perception_scoring_plugin", "scan_dock_scoring_plugin"),
        *("gymkhana_scoring_plugin", "wildlife_scoring_plugin"),
    ),
    _THERMAL_ALTERNATIVE: (
        *("MRSGazeboThermalCameraPlugin", "gazebo_ros_thermal_camera", "gazebo_ros_thermal_camera_pink"),
    ),
    _TRACKS_ALTERNATIVE: ("SimpleTrackedVehiclePlugin", "TrackedVehiclePlugin", "WheelTrackedVehiclePlugin"),
    _TRANSFORM_ALTERNATIVE: ("MrsGazeboCommonResources_LinkStaticTFPublisher",),
    _VELOCITY_ALTERNATIVE: ("dsros_ros_dvl", "gz-sim-dvl-system"),
    _VIDEO_ALTERNATIVE: ("gazebo_ros_video",),
    _VIEW_ALTERNATIVE: ("MRSGazeboRvizCameraSynchronizer", "MrsGazeboCommonResources_RvizCameraSynchronizer"),
    _WALK_ALTERNATIVE: ("gazebo_ros_actor_command", "gazebo_ros_actor_plugin"),
    _WAVES_ALTERNATIVE: (
        *("gz-waves1-hydrodynamics-system", "gz-waves1-waves-model-system", "gz-waves1-waves-visual-system"),
        "gz-waves1-dynamic-geometry-system",
        "usv_gazebo_dynamics_plugin",
    ),
    _WATER_ALTERNATIVE: (
        "BuoyancySystemPlugin",
        "freebuoyancy_gazebo",
        "freefloating_gazebo_fluid",
        "gazebo_usv_dynamics_plugin",
    ),
    _WIDE_CAMERA_ALTERNATIVE: ("wide_angle_camera", "wideanglecamera"),
}
"""Libraries and types of sensors, by their alternative."""

ALTERNATIVES = {
    **{name: alternative for alternative, names in _GROUPS.items() for name in names},
    "RosGzPointCloud": phrase("a <sensor> of type rgbd_camera or gpu_lidar, which publishes its points"),
    "gazebo_ros_grasp_fix": phrase("libgazebo_grasp_fix.so"),
    "gazebo_ros_elevator": phrase("gz-sim-joint-position-controller-system for the joint of the cabin"),
    "gz-sim-camera-video-recorder-system": phrase("`linkwright bag record` with the topic of the camera"),
    "gz-sim-follow-actor-system": _WALK_ALTERNATIVE,
    "gz-sim-log-playback-system": phrase("`linkwright bag play`"),
    "gz-sim-log-system": phrase("`linkwright sim --record`, or `linkwright bag record`"),
    "rotors_gazebo_bag_plugin": phrase("`linkwright sim --record`, or `linkwright bag record`"),
    "gz-sim-model-photo-shoot-system": phrase("a camera in front of the model"),
}
"""The alternatives to plugins and types of sensors that are not simulated."""


def find_alternative(name: str) -> Phrase | None:
    """Return the alternative to a plugin's library or a sensor type, or None."""
    return ALTERNATIVES.get(library_name(name))
