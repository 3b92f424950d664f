"""Broadcasters of sensors."""

from __future__ import annotations

from math import nan
from types import SimpleNamespace

import pytest

from linkwright.control.controllers.controller import ControllerError
from linkwright.control.controllers.registry import controller_class
from linkwright.control.controllers.sensor_broadcasters import (
    ForceTorqueBroadcaster,
    GpsBroadcaster,
    ImuBroadcaster,
    MagnetometerBroadcaster,
    PoseBroadcaster,
    RangeBroadcaster,
)
from linkwright.diagnostics import LinkwrightError

WRENCH = [f"{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz"]
POSE = [*(f"position.{axis}" for axis in "xyz"), *(f"orientation.{axis}" for axis in "xyzw")]


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("imu_sensor_broadcaster/IMUSensorBroadcaster", ImuBroadcaster),
        ("force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster", ForceTorqueBroadcaster),
        ("range_sensor_broadcaster/RangeSensorBroadcaster", RangeBroadcaster),
        ("pose_broadcaster/PoseBroadcaster", PoseBroadcaster),
        ("gps_sensor_broadcaster/GPSSensorBroadcaster", GpsBroadcaster),
        ("magnetometer_broadcaster/MagnetometerBroadcaster", MagnetometerBroadcaster),
    ],
)
def test_broadcasters_are_found_by_type(name, kind):
    assert controller_class(name) is kind


async def test_imu_is_published(bench):
    names = [*(f"orientation.{axis}" for axis in "xyzw")]
    names += [f"{quantity}.{axis}" for quantity in ("angular_velocity", "linear_acceleration") for axis in "xyz"]
    bench.joint("imu", **{quantity: float(number) for number, quantity in enumerate(reversed(names))})
    covariance = [0.5, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.5]
    broadcaster = bench.start(
        ImuBroadcaster, sensor_name="imu", frame_id="imu_link", static_covariance_orientation=covariance
    )
    imu_messages = bench.record("sensor_msgs/msg/Imu", "/controller/imu")
    await bench.step(broadcaster)
    (message,) = imu_messages
    assert message.header.frame_id == "imu_link"
    assert message.header.stamp.nanosec == 10_000_000
    assert (message.orientation.x, message.orientation.w) == (9.0, 6.0)
    assert (message.angular_velocity.x, message.linear_acceleration.z) == (5.0, 0.0)
    assert list(message.orientation_covariance) == covariance
    assert list(message.angular_velocity_covariance) == [0.0] * 9


async def test_wrench_is_published(bench):
    bench.joint("tcp", **{interface: float(number) for number, interface in enumerate(WRENCH)})
    broadcaster = bench.start(ForceTorqueBroadcaster, sensor_name="tcp", frame_id="tool0")
    wrenches = bench.record("geometry_msgs/msg/WrenchStamped", "/controller/wrench")
    await bench.step(broadcaster)
    assert (wrenches[0].header.frame_id, wrenches[0].wrench.force.y, wrenches[0].wrench.torque.z) == ("tool0", 1.0, 5.0)


async def test_filter_chain_of_wrench_is_reported_once_as_not_supported(bench, logged):
    bench.joint("tcp", **dict.fromkeys(WRENCH, 1.0))
    low_pass = {"name": "low_pass", "type": "control_filters/LowPassFilterWrench", "params": {"damping_intensity": 5.0}}
    bench.start(ForceTorqueBroadcaster, sensor_name="tcp", frame_id="tool0", sensor_filter_chain={"filter1": low_pass})
    (warning,) = logged("WARN")
    assert warning.startswith("'sensor_filter_chain' is not supported, so the wrench is not filtered")


async def test_wrench_axes_can_be_renamed_or_missing(bench):
    bench.joint("cell", pull=3.0, twist=4.0)
    broadcaster = bench.start(
        ForceTorqueBroadcaster,
        frame_id="tool0",
        interface_names={"force": {"z": "cell/pull"}, "torque": {"x": "cell/twist"}},
    )
    wrenches = bench.record("geometry_msgs/msg/WrenchStamped", "/controller/wrench")
    await bench.step(broadcaster)
    wrench = wrenches[0].wrench
    assert (wrench.force.x, wrench.force.z, wrench.torque.x) == (0.0, 3.0, 4.0)


async def test_wrench_offset_is_applied_before_multiplier(bench):
    bench.joint("tcp", **dict.fromkeys(WRENCH, 1.0))
    broadcaster = bench.start(
        ForceTorqueBroadcaster,
        sensor_name="tcp",
        frame_id="tool0",
        offset={"force": {"z": 2.0}},
        multiplier={"force": {"z": -1.0}, "torque": {"x": 0.5}},
    )
    wrenches = bench.record("geometry_msgs/msg/WrenchStamped", "/controller/wrench")
    await bench.step(broadcaster)
    wrench = wrenches[0].wrench
    assert (wrench.force.x, wrench.force.z, wrench.torque.x) == (1.0, -3.0, 0.5)


async def test_range_is_published(bench):
    bench.joint("sonar", range=1.5)
    broadcaster = bench.start(RangeBroadcaster, sensor_name="sonar", frame_id="sonar_link", max_range=3.0)
    ranges = bench.record("sensor_msgs/msg/Range", "/controller/range")
    await bench.step(broadcaster)
    assert (ranges[0].range, ranges[0].max_range, ranges[0].radiation_type) == (1.5, 3.0, 0)
    assert ranges[0].field_of_view == pytest.approx(0.52)


async def test_pose_and_transform_are_published(bench):
    bench.joint("tcp", **dict(zip(POSE, (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0), strict=True)))
    broadcaster = bench.start(
        PoseBroadcaster, pose_name="tcp", frame_id="base", tf={"child_frame_id": "tool", "publish_rate": 20.0}
    )
    poses = bench.record("geometry_msgs/msg/PoseStamped", "/controller/pose")
    transforms = bench.record("tf2_msgs/msg/TFMessage", "/tf")
    await bench.step(broadcaster, count=10)
    assert (len(poses), len(transforms)) == (10, 2)
    assert (poses[0].pose.position.z, poses[0].pose.orientation.w) == (3.0, 1.0)
    (transform,) = transforms[0].transforms
    assert (transform.header.frame_id, transform.child_frame_id) == ("base", "tool")
    assert transform.transform.translation.y == 2.0
    bench.states["tcp/position.x"].value = nan
    await bench.step(broadcaster, count=10)
    assert (len(poses), len(transforms)) == (20, 2)
    bench.states["tcp/position.x"].value = 1.0
    published: list[object] = []
    broadcaster._transforms = SimpleNamespace(is_wanted=True, publish=published.append)
    for time_ns in (10**12, 10**6, 2 * 10**6):  # simulated time is reset after the first update
        broadcaster.update(time_ns, 0.01)
    assert [message.transforms[0].header.stamp.sec for message in published] == [1000, 0]


async def test_position_is_published_with_its_covariance(bench):
    position = {"status": 0.0, "service": 1.0, "latitude": 48.1, "longitude": 11.6, "altitude": 520.0}
    bench.joint("gps", **position, latitude_covariance=1.0, longitude_covariance=2.0, altitude_covariance=3.0)
    fixed = [4.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 9.0]
    broadcaster = bench.start(GpsBroadcaster, sensor_name="gps", frame_id="gps_link", static_position_covariance=fixed)
    messages = bench.record("sensor_msgs/msg/NavSatFix", "/controller/gps/fix")
    await bench.step(broadcaster)
    fix = messages[-1]
    assert (fix.status.status, fix.status.service, fix.latitude, fix.altitude) == (0, 1, 48.1, 520.0)
    assert (list(fix.position_covariance), fix.position_covariance_type) == (fixed, fix.COVARIANCE_TYPE_KNOWN)
    bench.states["gps/status"].value = nan
    measured = bench.start(GpsBroadcaster, "b", sensor_name="gps", frame_id="g", read_covariance_from_interface=True)
    messages = bench.record("sensor_msgs/msg/NavSatFix", "/b/gps/fix")
    await bench.step(measured)
    fix = messages[-1]
    assert list(fix.position_covariance) == [1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0]
    assert (fix.status.status, fix.position_covariance_type) == (-1, fix.COVARIANCE_TYPE_DIAGONAL_KNOWN)


async def test_magnetic_field_is_published(bench):
    bench.joint(
        "compass", **{f"magnetic_field.{axis}": value for axis, value in zip("xyz", (1e-5, 2e-5, -4e-5), strict=True)}
    )
    broadcaster = bench.start(MagnetometerBroadcaster, sensor_name="compass", frame_id="compass_link")
    messages = bench.record("sensor_msgs/msg/MagneticField", "/controller/magnetic_field")
    await bench.step(broadcaster)
    assert (messages[-1].header.frame_id, messages[-1].magnetic_field.z) == ("compass_link", -4e-5)


@pytest.mark.parametrize(("kind", "name"), [(ForceTorqueBroadcaster, "sensor_name"), (PoseBroadcaster, "pose_name")])
async def test_sensor_and_interface_names_are_mutually_exclusive(bench, kind, name):
    names = {"force": {"x": "a/b"}} if kind is ForceTorqueBroadcaster else {"position": {"x": "a/b"}}
    with pytest.raises(ControllerError, match="has to be specified"):
        bench.make(kind, "first", frame_id="base").on_configure()
    with pytest.raises(ControllerError, match="specified together"):
        bench.make(kind, "second", frame_id="base", interface_names=names, **{name: "tcp"}).on_configure()


@pytest.mark.parametrize(
    ("kind", "parameters", "message"),
    [
        (ImuBroadcaster, {"sensor_name": "imu"}, "Parameter 'frame_id' cannot be empty"),
        (RangeBroadcaster, {"frame_id": "base"}, "Parameter 'sensor_name' cannot be empty"),
        (
            ImuBroadcaster,
            {"sensor_name": "imu", "frame_id": "base", "static_covariance_orientation": [1.0]},
            "parameter 'static_covariance_orientation' must have 9 numbers, but it has 1",
        ),
    ],
)
async def test_missing_or_invalid_parameters_are_rejected(bench, kind, parameters, message):
    with pytest.raises(LinkwrightError, match=message):
        bench.make(kind, **parameters)
