"""Replacements for programs of packages that Linkwright does not replace."""

from __future__ import annotations

from linkwright.diagnostics import LinkwrightError, Phrase, joined, phrase
from linkwright.packages import PackageNotFoundError

_LASER = phrase(
    "it drives a laser scanner, so build and start it on the robot; without the robot, a simulated `gpu_lidar` or"
    " `linkwright bag play` publishes its topics"
)
_CAMERA = phrase(
    "it drives a camera, so build and start it on the robot; without the robot, a simulated camera, `usb_cam` with a"
    " video file or `linkwright bag play` publishes its topics"
)
_RECEIVER = phrase(
    "it drives a satellite receiver or an IMU, so build and start it on the robot; without the robot, a simulated"
    " `navsat` or `imu` sensor or `linkwright bag play` publishes its topics"
)
_ROBOT = phrase(
    "it drives the robot's motors, so build and start it on the robot; without the robot, a simulation of its"
    " description or ros2_control with `mock_components/GenericSystem` takes its place"
)
_HARDWARE = phrase(
    "it drives hardware, so build and start it on the robot; without the robot, a simulated sensor or"
    " `linkwright bag play` publishes its topics"
)
_DRIVERS = {
    _LASER: (
        *("hls_lfcd_lds_driver", "ld08_driver", "ldlidar", "ldlidar_ros2", "ldlidar_stl_ros2", "livox_ros_driver2"),
        *("lms1xx", "ouster_ros", "rplidar_ros", "rslidar_sdk", "sick_safetyscanners2", "sick_scan2", "sick_scan_xd"),
        *("sick_tim", "sllidar_ros2", "urg_node", "urg_node2", "velodyne_driver", "velodyne_laserscan"),
        *("velodyne_pointcloud", "xv_11_driver", "ydlidar_ros2_driver"),
    ),
    _CAMERA: (
        *("astra_camera", "axis_camera", "camera_ros", "depthai_ros_driver", "flir_camera_driver", "openni2_camera"),
        *("orbbec_camera", "raspicam2", "realsense2_camera", "spinnaker_camera_driver", "zed_wrapper"),
    ),
    _RECEIVER: (
        *("bno055", "duro_gps_driver", "microstrain_inertial_driver", "nmea_navsat_driver", "novatel_gps_driver"),
        *("phidgets_spatial", "rt_usb_9axisimu_driver", "septentrio_gnss_driver", "ublox_gps", "um7", "umx_driver"),
        *("witmotion_ros", "xsens_mti_ros2_driver"),
    ),
    _ROBOT: (
        *("interbotix_xs_sdk", "kobuki_node", "raspimouse", "turtlebot3_node", "turtlebot4_node", "ur_robot_driver"),
        *("vesc_ackermann", "vesc_driver", "xarm_api"),
    ),
    _HARDWARE: ("micro_ros_agent", "motion_capture_tracking", "serial_driver", "spacenav"),
}
"""The packages of drivers that public launch files start most often, by the hardware that they drive."""
_RTABMAP = phrase(
    "Linkwright maps with laser scans: use `slam_toolbox` or `cartographer_ros`; `depthimage_to_laserscan` makes a scan"
    " from a depth image"
)
_AUTOPILOT = phrase(
    "it needs the autopilot, so install that; without it, the plugin `gz-sim-multicopter-control-system` flies a"
    " simulated multicopter with velocities on `cmd_vel`"
)
_ROUTE = phrase("Linkwright plans over the map instead of a graph: use `planner_server` of `nav2_planner`")
_SUBSTITUTES = {
    _RTABMAP: ("rtabmap_odom", "rtabmap_ros", "rtabmap_slam", "rtabmap_sync", "rtabmap_util", "rtabmap_viz"),
    _AUTOPILOT: ("ardupilot_sitl", "mavros"),
    _ROUTE: ("nav2_route",),
}
"""Packages whose programs Linkwright does not have, by the text that names their substitutes."""
_ALTERNATIVES = {
    **{package: text for texts in (_DRIVERS, _SUBSTITUTES) for text, packages in texts.items() for package in packages},
    "moveit_setup_assistant": phrase("`linkwright arm init` writes the MoveIt configuration of an arm"),
}


def find_alternative(package: str) -> Phrase | None:
    """Return what to use instead of the programs of a package, or None if there is nothing."""
    return _ALTERNATIVES.get(package)


def name_alternative(error: LinkwrightError) -> None:
    """Add what to use instead to the message of an error about a missing package, if there is something."""
    alternative = find_alternative(error.name) if isinstance(error, PackageNotFoundError) else None
    if alternative is not None:
        error.diagnostics = tuple(
            diagnostic.with_changes(message=joined((diagnostic.message, alternative), "; "))
            for diagnostic in error.diagnostics
        )
