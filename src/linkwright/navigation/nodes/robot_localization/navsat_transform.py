"""robot_localization's navsat_transform_node: satellite fixes to odometry, and back.

The node follows robot_localization 3.5 (ROS 2 Humble). The origin and rotation of the map on the earth come from a
datum, or from the first fix, the first odometry and the heading of an IMU (0 is east). Deliberate differences: the
offset of the receiver on the robot is removed with the orientation of the odometry instead of a lookup; ``delay`` does
not block.
"""

from __future__ import annotations

from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import rotation_matrix
from linkwright.geometry.single import (
    IDENTITY,
    Quaternion,
    Transform,
    Vector3,
    compose,
    invert,
    normalized,
    quaternion_from_rpy,
    quaternion_inverse,
    quaternion_multiply,
    rotate,
    rpy_from_quaternion,
)
from linkwright.graph import SENSOR_DATA_QOS, STATIC_TF_PUBLISHER_QOS, Graph, Parameter, ParameterType
from linkwright.messages import TFMessage, TransformBatch, get_message, get_service
from linkwright.navigation.estimation.geodesy import (
    TangentPlane,
    UtmZone,
    convergence,
    degrees_from_utm,
    utm_from_degrees,
    zone_from_degrees,
)
from linkwright.navigation.nodes.robot_localization.configuration import check_length
from linkwright.nodes.frame_poses import FramePoses
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import check_positive, invalid_value_error, log_unknown_parameters

_KNOWN_COVARIANCE, _GBAS_FIX, _NO_FIX = 3, 2, -1
_ZONE_LETTERS = "CDEFGHJKLMNPQRSTUVWXX"
"""The letters of UTM's latitude bands, each of 8 degrees, from -80 degrees to the north."""


class NavsatTransformNode(SingleNode):
    """The running navsat_transform_node.

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433, GRAPH201), or a datum does not have three values
            (NODE441).
    """

    DEFAULT_NAME = "navsat_transform_node"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            datum = self._declare_parameters()
            log_unknown_parameters(self._node)
        self._poses = FramePoses(self._node, "Could not obtain transform:")
        self._zone: UtmZone | None = None
        self._plane: TangentPlane | None = None
        self._grid_in_map: Transform | None = None
        """The pose of the earth's grid in the map, or None until it is known."""
        self._first_fix: Vector3 | None = None
        self._first_pose: Transform | None = None
        self._heading: Quaternion | None = None
        self._fix: Any = None
        self._odometry: Any = None
        self._has_new_fix = self._has_new_odometry = False
        self._world_frame, self._base_frame = "odom", "base_link"
        self._create_interfaces()
        if self._has_datum and datum is not None:
            self._set_datum(datum[0], datum[1], 0.0, quaternion_from_rpy((0.0, 0.0, datum[2])))

    def _declare_parameters(self) -> list[float] | None:
        node, declare = self._node, self._node.declare_parameter
        self._yaw_offset: float = declare("magnetic_declination_radians", 0.0).value + declare("yaw_offset", 0.0).value
        old_broadcast: bool = declare("broadcast_utm_transform", False).value
        old_parent: bool = declare("broadcast_utm_transform_as_parent_frame", False).value
        self._broadcasts_transform: bool = declare("broadcast_cartesian_transform", old_broadcast).value
        self._grid_is_parent: bool = declare("broadcast_cartesian_transform_as_parent_frame", old_parent).value
        self._zero_altitude: bool = declare("zero_altitude", False).value
        self._publishes_fixes: bool = declare("publish_filtered_gps", True).value
        self._uses_odometry_yaw: bool = declare("use_odometry_yaw", False).value
        self._uses_local_cartesian: bool = declare("use_local_cartesian", False).value
        self._has_datum: bool = declare("wait_for_datum", False).value
        self._frequency = check_positive(node, "frequency", declare("frequency", 10.0).value)
        for name in ("delay", "transform_timeout"):
            declare(name, 0.0)
        node.declare_parameter("datum", ParameterType.DOUBLE_ARRAY)
        datum = node.get_parameter_or("datum", Parameter("datum")).value
        if datum is None:
            return None
        check_length("datum", len(datum), (3,))
        if not (abs(datum[0]) <= 90.0 and abs(datum[1]) <= 360.0):
            raise invalid_value_error("datum", list(datum), node.get_name())
        return [float(number) for number in datum]

    def _create_interfaces(self) -> None:
        node = self._node
        self._publisher = node.create_publisher(get_message("nav_msgs/msg/Odometry"), "odometry/gps", 10)
        if self._publishes_fixes:
            fix_class = get_message("sensor_msgs/msg/NavSatFix")
            self._fix_publisher = node.create_publisher(fix_class, "gps/filtered", 10)
        if self._broadcasts_transform:
            self._tf_publisher = node.create_publisher(TFMessage, "/tf_static", STATIC_TF_PUBLISHER_QOS)
        node.create_subscription(get_message("nav_msgs/msg/Odometry"), "odometry/filtered", self._on_odometry, 10)
        node.create_subscription(get_message("sensor_msgs/msg/NavSatFix"), "gps/fix", self._on_fix, SENSOR_DATA_QOS)
        if not self._uses_odometry_yaw and not self._has_datum:
            node.create_subscription(get_message("sensor_msgs/msg/Imu"), "imu", self._on_imu, SENSOR_DATA_QOS)
        for name, service, callback in (
            ("datum", "SetDatum", self._on_datum),
            ("fromLL", "FromLL", self._on_from_ll),
            ("fromLLArray", "FromLLArray", self._on_from_ll_array),
            ("toLL", "ToLL", self._on_to_ll),
            ("setUTMZone", "SetUTMZone", self._on_zone),
        ):
            node.create_service(get_service(f"robot_localization/srv/{service}"), name, callback)
        node.create_timer(1.0 / self._frequency, self._update)

    # --- input -------------------------------------------------------------------------------------------------------

    def _on_odometry(self, message: Any) -> None:
        self._world_frame = message.header.frame_id or self._world_frame
        self._base_frame = message.child_frame_id or self._base_frame
        self._odometry, self._has_new_odometry = message, True
        if self._grid_in_map is None and not self._has_datum:
            self._first_pose = _pose_from_odometry(message)
            if self._uses_odometry_yaw:
                self._heading = self._first_pose[3:]

    def _on_fix(self, message: Any) -> None:
        position = (message.latitude, message.longitude, message.altitude)
        if message.status.status == _NO_FIX or not all(isfinite(number) for number in position):
            return
        if not message.header.frame_id:
            self._node.get_logger().error(
                "NavSatFix message has empty frame_id. Will assume navsat device is mounted at robot's origin.",
                once=True,
            )
        self._fix, self._has_new_fix = message, True
        if self._grid_in_map is None and not self._has_datum:
            self._first_fix = position

    def _on_imu(self, message: Any) -> None:
        if self._grid_in_map is not None or self._odometry is None:  # Odometry provides the body frame.
            return
        mounting = self._poses.pose(
            self._base_frame, message.header.frame_id or self._base_frame, message.header.stamp.nanoseconds
        )
        if mounting is not None:
            self._heading = quaternion_multiply(
                _orientation_from_message(message.orientation), quaternion_inverse(mounting[3:])
            )

    # --- georeferencing ----------------------------------------------------------------------------------------------

    def _set_datum(self, latitude: float, longitude: float, altitude: float, heading: Quaternion) -> None:
        self._has_datum = True
        self._grid_in_map = None
        self._first_fix, self._first_pose, self._heading = (latitude, longitude, altitude), IDENTITY, heading
        self._locate_map()

    def _locate_map(self) -> None:
        """Compute the pose of the earth's grid in the map if all inputs are known.

        The inputs are the first fix, the first odometry and the heading.
        """
        if self._first_fix is None or self._first_pose is None or self._heading is None:
            return
        latitude, longitude, altitude = self._first_fix
        yaw_correction = self._yaw_offset
        if self._uses_local_cartesian:
            self._plane = TangentPlane(latitude, longitude, altitude)
        else:
            self._zone = self._zone or zone_from_degrees(latitude, longitude)
            yaw_correction += convergence(latitude, longitude, self._zone)
        x, y, z = self._grid_from_geodetic(self._first_fix)
        roll, pitch, yaw = rpy_from_quaternion(self._heading)
        if not self._has_datum:
            ox, oy, oz = rotate(
                quaternion_from_rpy((roll, pitch, yaw + yaw_correction)), self._find_receiver_position()
            )
            x, y, z = x - ox, y - oy, z - oz
        base_in_grid: Transform = (x, y, z, *quaternion_from_rpy((0.0, 0.0, yaw + yaw_correction)))
        self._grid_in_map = compose(self._first_pose, invert(base_in_grid))
        self._node.get_logger().info(
            f"Datum (latitude, longitude, altitude) is ({latitude:.6f}, {longitude:.6f}, {altitude:.2f}); "
            f"the heading is {yaw + yaw_correction:.4f} rad from the east"
        )
        if self._broadcasts_transform:
            self._send_transform()

    def _send_transform(self) -> None:
        assert self._grid_in_map is not None, "the map was placed on the earth"
        parent, child, pose = self._world_frame, "local_enu" if self._uses_local_cartesian else "utm", self._grid_in_map
        if self._grid_is_parent:
            parent, child, pose = child, parent, invert(pose)
        x, y, z, *rotation = pose
        row = np.array([[x, y, 0.0 if self._zero_altitude else z, *rotation]])
        batch = TransformBatch((parent,), (child,), self._node.get_clock().now_ns(), row)
        self._tf_publisher.publish(TFMessage(batch=batch))

    def _find_receiver_position(self) -> Vector3:
        """Return the position of the receiver in the body frame, or the origin if it is unknown."""
        frame = self._fix.header.frame_id if self._fix is not None else ""
        if not frame:
            return 0.0, 0.0, 0.0
        pose = self._poses.pose(self._base_frame, frame, self._fix.header.stamp.nanoseconds)
        return (0.0, 0.0, 0.0) if pose is None else pose[:3]

    def _grid_from_geodetic(self, geodetic: Vector3) -> Vector3:
        """Convert a geodetic position (degrees and meters) to a point of the grid, in meters."""
        if self._plane is not None:
            return self._plane.point_from_geodetic(*geodetic)
        assert self._zone is not None, "`_locate_map` sets it"
        easting, northing = utm_from_degrees(geodetic[0], geodetic[1], self._zone)
        return easting, northing, geodetic[2]

    def _geodetic_from_grid(self, point: Vector3) -> Vector3:
        """Convert a point of the grid, in meters, to a geodetic position (degrees and meters)."""
        if self._plane is not None:
            return self._plane.geodetic_from_point(point)
        assert self._zone is not None, "`_locate_map` sets it"
        latitude, longitude = degrees_from_utm(point[0], point[1], self._zone)
        return latitude, longitude, point[2]

    def _map_from_geodetic(self, geodetic: Vector3) -> Vector3:
        assert self._grid_in_map is not None, "the map was placed on the earth"
        return compose(self._grid_in_map, (*self._grid_from_geodetic(geodetic), 0.0, 0.0, 0.0, 1.0))[:3]

    def _geodetic_from_map(self, point: Vector3) -> Vector3:
        assert self._grid_in_map is not None, "the map was placed on the earth"
        return self._geodetic_from_grid(compose(invert(self._grid_in_map), (*point, 0.0, 0.0, 0.0, 1.0))[:3])

    # --- output ------------------------------------------------------------------------------------------------------

    def _update(self) -> None:
        if self._grid_in_map is None:
            self._locate_map()
            return
        if self._has_new_fix and self._has_new_odometry:
            self._publisher.publish(self._odometry_from_fix(self._grid_in_map))
        if self._publishes_fixes and self._has_new_odometry:
            self._fix_publisher.publish(self._fix_from_odometry(self._grid_in_map))
            self._has_new_odometry = False
        self._has_new_fix = False

    def _odometry_from_fix(self, grid_in_map: Transform) -> Any:
        fix = self._fix
        x, y, z = self._map_from_geodetic((fix.latitude, fix.longitude, fix.altitude))
        ox, oy, oz = rotate(_pose_from_odometry(self._odometry)[3:], self._find_receiver_position())
        message = get_message("nav_msgs/msg/Odometry")()
        message.header.stamp, message.header.frame_id = fix.header.stamp, self._world_frame
        position = message.pose.pose.position
        position.x, position.y, position.z = x - ox, y - oy, 0.0 if self._zero_altitude else z - oz
        message.pose.pose.orientation.w = 1.0
        covariance = np.zeros((6, 6))
        covariance[:3, :3] = _rotate_covariance(
            grid_in_map, np.asarray(fix.position_covariance, dtype=np.float64).reshape(3, 3)
        )
        message.pose.covariance = covariance.reshape(36)
        return message

    def _fix_from_odometry(self, grid_in_map: Transform) -> Any:
        odometry = self._odometry
        message = get_message("sensor_msgs/msg/NavSatFix")()
        message.header.stamp, message.header.frame_id = odometry.header.stamp, self._base_frame
        message.latitude, message.longitude, message.altitude = self._geodetic_from_map(
            _pose_from_odometry(odometry)[:3]
        )
        covariance = np.asarray(odometry.pose.covariance, dtype=np.float64).reshape(6, 6)[:3, :3]
        message.position_covariance = _rotate_covariance(invert(grid_in_map), covariance).reshape(9)
        message.position_covariance_type = _KNOWN_COVARIANCE
        message.status.status = _GBAS_FIX
        return message

    # --- services ----------------------------------------------------------------------------------------------------

    def _on_datum(self, request: Any, response: Any) -> Any:
        position = request.geo_pose.position
        self._zone = None
        heading = _orientation_from_message(request.geo_pose.orientation)
        self._set_datum(position.latitude, position.longitude, position.altitude, heading)
        return response

    def _on_from_ll(self, request: Any, response: Any) -> Any:
        response.map_point = self._point_message_from_geodetic(request.ll_point)
        return response

    def _on_from_ll_array(self, request: Any, response: Any) -> Any:
        response.map_points = [self._point_message_from_geodetic(ll_point) for ll_point in request.ll_points]
        return response

    def _point_message_from_geodetic(self, geodetic: Any) -> Any:
        point = get_message("geometry_msgs/msg/Point")()
        if self._check_transform():
            point.x, point.y, point.z = self._map_from_geodetic(
                (geodetic.latitude, geodetic.longitude, geodetic.altitude)
            )
        return point

    def _on_to_ll(self, request: Any, response: Any) -> Any:
        if self._check_transform():
            point, position = request.map_point, response.ll_point
            position.latitude, position.longitude, position.altitude = self._geodetic_from_map(
                (point.x, point.y, point.z)
            )
        return response

    def _on_zone(self, request: Any, response: Any) -> Any:
        zone = _parse_zone(request.utm_zone)
        response.status = zone is not None
        if zone is not None:
            self._zone = zone
            if self._grid_in_map is not None:
                self._grid_in_map = None
                self._locate_map()
        else:
            self._node.get_logger().error(f"'{request.utm_zone}' is not a UTM zone, such as 31U")
        return response

    def _check_transform(self) -> bool:
        if self._grid_in_map is None:
            self._node.get_logger().error("No transform available (yet)", throttle_duration_sec=5.0)
        return self._grid_in_map is not None


def _parse_zone(text: str) -> UtmZone | None:
    number, letter = text[:-1], text[-1:].upper()
    if not number.isdecimal() or not 1 <= int(number) <= 60 or letter not in _ZONE_LETTERS or not letter:
        return None
    return UtmZone(int(number), letter >= "N")


def _pose_from_odometry(odometry: Any) -> Transform:
    position = odometry.pose.pose.position
    return (position.x, position.y, position.z, *_orientation_from_message(odometry.pose.pose.orientation))


def _orientation_from_message(message: Any) -> Quaternion:
    return normalized(message.x, message.y, message.z, message.w)


def _rotate_covariance(pose: Transform, covariance: NDArray[np.float64]) -> NDArray[np.float64]:
    rotation = rotation_matrix(pose[3:])
    rotated: NDArray[np.float64] = rotation @ covariance @ rotation.T
    return rotated
