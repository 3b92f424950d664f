"""Topics, frames and messages of sensors, as in Gazebo classic, in ROS 1 and in gz."""

from __future__ import annotations

from contextlib import asynccontextmanager
from math import inf, pi, tan

import numpy as np
import pytest

from linkwright.graph import Graph, LogRecord
from linkwright.messages import get_message
from linkwright.simulation.server.server import SimulationServer
from linkwright.testing import Recording
from tests.simulation.sensors.rooms import block
from tests.simulation.worlds import GROUND, box, make_simulation

SECOND_NS = 1_000_000_000
WALL = block("wall", "2.5 0 0 0 0 0", "1 20 20")
RAYS = (
    "<scan><horizontal><samples>3</samples><min_angle>-1.5707963267948966</min_angle><max_angle>1.5707963267948966"
    "</max_angle></horizontal></scan><range><min>0.1</min><max>10</max></range>"
)
CAMERA = (
    f"<camera><horizontal_fov>{pi / 2}</horizontal_fov><image><width>64</width><height>48</height></image>"
    "<clip><near>0.05</near><far>50</far></clip></camera>"
)


def robot_with(*elements: str, link: str = "head", extra: str = "") -> str:
    """Return a fixed robot whose link has these elements."""
    return f'<model name="robot"><static>true</static><link name="{link}">{"".join(elements)}</link>{extra}</model>'


def sensor(kind: str, text: str, name: str = "sensor", rate: float = 10) -> str:
    return f'<sensor name="{name}" type="{kind}"><update_rate>{rate}</update_rate>{text}</sensor>'


def plugin(library: str, text: str = "", name: str = "driver") -> str:
    return f'<plugin name="{name}" filename="{library}">{text}</plugin>'


@asynccontextmanager
async def running_server(*parts: str):
    """Run a simulation on a graph; yield the server, the graph and the log."""
    log: list[LogRecord] = []
    graph = Graph(on_log=log.append)
    server = SimulationServer(make_simulation(*parts), graph.create_node("gazebo"))
    server.start()
    yield server, graph, log
    server.close()
    await graph.close()


async def last_messages(server: SimulationServer, graph: Graph, *topics: str, duration: int = SECOND_NS // 10) -> list:
    """Advance the simulation, and return the last message of each topic."""
    recordings = [Recording(graph, server.node, topic) for topic in topics]
    server.advance(duration)
    await graph.settle()
    return [recording.last for recording in recordings]


async def test_classic_ray_sensor_publishes_scan():
    ros = "<ros><remapping>~/out:=scan</remapping></ros><output_type>sensor_msgs/LaserScan</output_type>"
    text = robot_with(sensor("ray", f"<ray>{RAYS}</ray>" + plugin("libgazebo_ros_ray_sensor.so", ros)))
    async with running_server(WALL, text) as (server, graph, log):
        (scan,) = await last_messages(server, graph, "/scan")
        assert (scan.header.stamp.sec, scan.header.stamp.nanosec) == (0, SECOND_NS // 10)
        assert scan.header.frame_id == "head"
        assert list(scan.ranges) == [inf, 2.0, inf]
        assert (scan.angle_min, scan.angle_increment) == (pytest.approx(-pi / 2), pytest.approx(pi / 2))
        assert (scan.range_min, scan.range_max) == (pytest.approx(0.1), 10.0)
        assert (scan.time_increment, scan.scan_time) == (0.0, 0.0)
        assert list(scan.intensities) == [0.0, 0.0, 0.0]
        assert not log


async def test_ray_sensor_does_not_publish_without_subscribers():
    text = robot_with(sensor("ray", f"<ray>{RAYS}</ray>" + plugin("libgazebo_ros_ray_sensor.so")))
    async with running_server(WALL, text) as (server, graph, _):
        server.advance(SECOND_NS)
        recording = Recording(graph, server.node, "/driver/out")
        server.advance(SECOND_NS)
        await graph.settle()
        assert len(recording) == 10


@pytest.mark.parametrize(("visualize", "topic"), [("true", "/world_rays"), ("false", "/world_rays/others")])
async def test_displayed_rays_and_scan_share_one_measurement(visualize: str, topic: str):
    two_rows = RAYS.replace(
        "</horizontal>",
        "</horizontal><vertical><samples>2</samples><min_angle>0</min_angle><max_angle>0</max_angle></vertical>",
    )
    text = sensor("gpu_lidar", f"<visualize>{visualize}</visualize><topic>scan</topic><lidar>{two_rows}</lidar>")
    async with running_server(WALL, robot_with(text)) as (server, graph, _):
        (lidar,) = server.plugins("robot")
        measurements = []
        measure = lidar.lidar.measure
        lidar.lidar.measure = lambda: measurements.append(None) or measure()
        server.advance(SECOND_NS)
        assert not measurements
        rays, scan = await last_messages(server, graph, topic, "/scan")
        assert len(measurements) == 1
        assert rays.header.frame_id == "robot::head::sensor"
        assert list(rays.ranges) == [inf, 2.0, inf] * 2
        assert list(scan.ranges) == [inf, 2.0, inf]


async def test_lidar_measures_while_only_its_rays_are_displayed():
    text = robot_with(sensor("ray", f"<ray>{RAYS}</ray>" + plugin("libgazebo_ros_ray_sensor.so")))
    async with running_server(WALL, text) as (server, graph, _):
        (rays,) = await last_messages(server, graph, "/world_rays/others")
        assert list(rays.ranges) == [inf, 2.0, inf]


@pytest.mark.parametrize("kind", ["PointCloud2", "PointCloud", "Range"])
async def test_ray_sensor_output_types(kind: str):
    element = plugin(
        "libgazebo_ros_ray_sensor.so", f"<output_type>sensor_msgs/{kind}</output_type><frame_name>l</frame_name>"
    )
    async with running_server(WALL, robot_with(sensor("ray", f"<ray>{RAYS}</ray>" + element))) as (server, graph, _):
        (message,) = await last_messages(server, graph, "/driver/out")
        assert message.header.frame_id == "l"
        if kind == "Range":
            assert (message.range, message.field_of_view) == (2.0, pytest.approx(pi))
        elif kind == "PointCloud":
            assert [(point.x, point.y, point.z) for point in message.points] == [pytest.approx((2.0, 0.0, 0.0))]
        else:
            assert (message.point_step, message.width, message.height, message.is_dense) == (16, 1, 1, True)
            assert np.frombuffer(bytes(message.data), np.float32) == pytest.approx([2.0, 0.0, 0.0, 0.0], abs=1e-6)


async def test_invalid_output_type_is_reported():
    element = plugin("libgazebo_ros_ray_sensor.so", "<output_type>sensor_msgs/Imu</output_type>")
    async with running_server(robot_with(sensor("ray", f"<ray>{RAYS}</ray>" + element))) as (server, _, log):
        assert server.plugins("robot") == ()
        assert "is not an output type" in str(log[0].text)


async def test_ros_1_laser_has_its_topic_and_frame():
    element = plugin("libgazebo_ros_laser.so", "<topicName>/laser</topicName><frameName>hokuyo</frameName>")
    async with running_server(WALL, robot_with(sensor("ray", f"<ray>{RAYS}</ray>" + element))) as (server, graph, log):
        (scan,) = await last_messages(server, graph, "/laser")
        assert (scan.header.frame_id, scan.ranges[1]) == ("hokuyo", 2.0)
        assert not log


@pytest.mark.parametrize(
    "library",
    ["block_laser", "range", "velodyne_laser"],
)
async def test_ros_1_laser_plugins_publish_their_message_types(library: str):
    element = plugin(f"libgazebo_ros_{library}.so", "<topicName>/scan</topicName><frameName>hokuyo</frameName>")
    async with running_server(WALL, robot_with(sensor("ray", f"<ray>{RAYS}</ray>" + element))) as (server, graph, log):
        (message,) = await last_messages(server, graph, "/scan")
        assert message.header.frame_id == "hokuyo"
        if library == "range":
            assert (message.range, message.radiation_type) == (2.0, message.ULTRASOUND)
        elif library == "block_laser":
            assert [(point.x, point.y, point.z) for point in message.points] == [pytest.approx((2.0, 0.0, 0.0))]
        else:
            names = ["x", "y", "z", "intensity", "ring", "time"]
            assert (message.width, message.point_step, [field.name for field in message.fields]) == (1, 22, names)
        assert not log


def point_rows(cloud) -> np.ndarray:
    """Return the points of a cloud as an array with the names of its fields."""
    types = {4: np.uint16, 7: np.float32}
    layout = np.dtype(
        {
            "names": [field.name for field in cloud.fields],
            "formats": [types[field.datatype] for field in cloud.fields],
            "offsets": [field.offset for field in cloud.fields],
            "itemsize": cloud.point_step,
        }
    )
    return np.frombuffer(bytes(cloud.data), layout)


LASERS = RAYS.replace(
    "</horizontal>",
    "</horizontal><vertical><samples>2</samples><min_angle>-0.1</min_angle><max_angle>0.1</max_angle></vertical>",
)


async def test_velodyne_points_have_ring():
    element = plugin("libgazebo_ros_velodyne_laser.so", "<topicName>/points</topicName>")
    async with running_server(WALL, robot_with(sensor("ray", f"<ray>{LASERS}</ray>" + element))) as (
        server,
        graph,
        log,
    ):
        (message,) = await last_messages(server, graph, "/points")
        rows = point_rows(message)
        assert (message.height, message.width, message.is_dense) == (1, 2, True)
        assert rows["ring"].tolist() == [0, 1]
        assert rows["z"].tolist() == pytest.approx([-2 * tan(0.1), 2 * tan(0.1)])
        assert not rows["time"].any()
        assert not log


async def test_organized_velodyne_cloud_has_row_per_firing():
    settings = "<topicName>/points</topicName><organize_cloud>true</organize_cloud><max_range>5</max_range>"
    element = plugin("libgazebo_ros_velodyne_laser.so", settings)
    async with running_server(WALL, robot_with(sensor("ray", f"<ray>{LASERS}</ray>" + element))) as (
        server,
        graph,
        log,
    ):
        (message,) = await last_messages(server, graph, "/points")
        rows = point_rows(message).reshape(message.height, message.width)
        assert (message.height, message.width, message.is_dense) == (3, 2, False)
        assert rows["ring"].tolist() == [[0, 1]] * 3
        assert np.isfinite(rows["x"]).tolist() == [[False, False], [True, True], [False, False]]
        assert not log


async def test_gz_lidar_publishes_points_beside_scan():
    text = robot_with(sensor("gpu_lidar", f"<topic>lidar</topic><lidar>{RAYS}</lidar>"))
    async with running_server(WALL, text) as (server, graph, log):
        scan, cloud = await last_messages(server, graph, "/lidar", "/lidar/points")
        assert scan.header.frame_id == "robot/head/sensor"
        assert list(scan.ranges) == [inf, 2.0, inf]
        assert (cloud.width, cloud.height, cloud.is_dense) == (3, 1, False)
        assert [(field.name, field.offset) for field in cloud.fields][3:] == [("intensity", 16), ("ring", 24)]
        assert cloud.point_step == 32
        assert not log


async def test_gz_sensor_without_topic_has_default_gz_name():
    async with running_server(WALL, robot_with(sensor("gpu_lidar", f"<lidar>{RAYS}</lidar>"))) as (server, graph, _):
        (scan,) = await last_messages(server, graph, "/world/test/model/robot/link/head/sensor/sensor/scan")
        assert scan.ranges[1] == 2.0


@pytest.mark.parametrize(
    ("library", "text", "topic"),
    [
        ("libgazebo_ros_imu_sensor.so", "", "/driver/out"),
        (None, "<topic>imu</topic>", "/imu"),
        ("ignition-gazebo-imu-system", "<topic>imu</topic>", "/imu"),
    ],
)
async def test_imu_plugins_publish_gravity_and_noise(library: str | None, text: str, topic: str):
    noise = '<angular_velocity><z><noise type="gaussian"><stddev>0.1</stddev></noise></z></angular_velocity>'
    shown = sensor("imu", f"{text}<imu>{noise}</imu>" + (plugin(library) if library else ""), rate=100)
    async with running_server(GROUND, box("one", "0 0 0.5 0 0 0").replace("</link>", shown + "</link>")) as (
        server,
        graph,
        log,
    ):
        (message,) = await last_messages(server, graph, topic, duration=SECOND_NS)
        assert message.linear_acceleration.z == pytest.approx(9.81, abs=1e-3)
        assert message.angular_velocity_covariance[8] == pytest.approx(0.01)
        assert message.angular_velocity.z != 0
        assert not message.orientation_covariance.any()
        assert message.header.frame_id == ("link" if topic == "/driver/out" else "one/link/sensor")
        assert not log


async def test_ros_1_imu_plugin_names_its_link():
    element = plugin(
        "libgazebo_ros_imu.so", "<bodyName>link</bodyName><topicName>/imu</topicName><updateRate>10</updateRate>"
    )
    async with running_server(GROUND, box("one", "0 0 0.5 0 0 0").replace("</model>", element + "</model>")) as (
        server,
        graph,
        log,
    ):
        (message,) = await last_messages(server, graph, "/imu", duration=SECOND_NS)
        assert message.linear_acceleration.z == pytest.approx(9.81, abs=1e-3)
        assert not log


async def test_gz_contacts_are_published_while_touching():
    element = sensor("contact", "<contact><collision>collision</collision><topic>/touched</topic></contact>", rate=100)
    text = box("crate", "0 0 0.7 0 0 0", "1 1 1", 2.0).replace("</link>", f"{element}</link>")
    async with running_server(GROUND, text) as (server, graph, log):
        recording = Recording(graph, server.node, "/touched")
        server.advance(SECOND_NS // 10)
        await graph.settle()
        assert len(recording) == 0
        server.advance(2 * SECOND_NS)
        await graph.settle()
        (contact,) = recording.last.contacts
        assert (contact.collision1.name, contact.collision1.type) == ("crate::link::collision", 5)
        assert contact.collision2.name == "ground::link::collision"
        assert len(contact.wrenches) == len(contact.depths) == len(contact.positions) == len(contact.normals)
        upward_force = sum(wrench.body_1_wrench.force.z for wrench in contact.wrenches)
        assert upward_force == pytest.approx(2.0 * 9.81, rel=0.02)
        assert sum(wrench.body_2_wrench.force.z for wrench in contact.wrenches) == pytest.approx(-upward_force)
        assert not log


async def test_gz_altimeter_and_air_pressure_are_published():
    noise = (
        '<air_pressure><reference_altitude>100</reference_altitude><pressure><noise type="gaussian"><stddev>2</stddev>'
    )
    sensors = (
        sensor("altimeter", "<topic>height</topic>"),
        sensor("air_pressure", f"<topic>air</topic>{noise}</noise></pressure></air_pressure>", name="baro"),
    )
    text = box("crate", "0 0 50 0 0 0", "1 1 1", 2.0).replace("</link>", "".join(sensors) + "</link>")
    async with running_server(text) as (server, graph, log):
        height, air = await last_messages(server, graph, "/height", "/air", duration=SECOND_NS)
        assert (height.vertical_position, height.vertical_velocity) == pytest.approx((-4.905, -9.81), abs=0.01)
        assert (height.vertical_reference, height.header.frame_id) == (50.0, "crate/link/sensor")
        assert air.fluid_pressure == pytest.approx(99606.0, abs=20.0)
        assert air.variance == 4.0
        assert not log


async def test_bumper_publishes_contacts():
    element = sensor(
        "contact", "<contact><collision>collision</collision></contact>" + plugin("libgazebo_ros_bumper.so")
    )
    async with running_server(GROUND, box("one", "0 0 0.5 0 0 0").replace("</link>", element + "</link>")) as (
        server,
        graph,
        log,
    ):
        (message,) = await last_messages(server, graph, "/bumper_states", duration=SECOND_NS)
        (state,) = message.states
        assert message.header.frame_id == "world"
        assert state.collision2_name == "ground::link::collision"
        assert state.total_wrench.force.z == pytest.approx(9.81, abs=0.05)
        assert len(state.wrenches) == len(state.depths) == len(state.contact_normals)
        assert not log


EARTH = (
    "<spherical_coordinates><surface_model>EARTH_WGS84</surface_model><latitude_deg>47.5</latitude_deg>"
    "<longitude_deg>8.5</longitude_deg><elevation>430</elevation><heading_deg>0</heading_deg></spherical_coordinates>"
)


@pytest.mark.parametrize(("kind", "library", "topic"), [
    ("gps", "libgazebo_ros_gps_sensor.so", "/driver/out"), ("navsat", None, "/gps/fix"),
])  # fmt: skip
async def test_navsat_sensors_publish_position(kind: str, library: str | None, topic: str):
    element = sensor(kind, plugin(library) if library else "<topic>/gps/fix</topic>")
    async with running_server(EARTH, robot_with(element)) as (server, graph, log):
        (fix,) = await last_messages(server, graph, topic)
        assert (fix.latitude, fix.longitude, fix.altitude) == pytest.approx((47.5, 8.5, 430.0))
        assert not log


async def test_magnetometer_publishes_field_in_its_axes():
    element = sensor("magnetometer", f"<pose>0 0 0 0 0 {pi / 2}</pose><topic>mag</topic>")
    async with running_server("<magnetic_field>1 2 3</magnetic_field>", robot_with(element)) as (server, graph, _):
        (message,) = await last_messages(server, graph, "/mag")
        field = message.magnetic_field
        assert (field.x, field.y, field.z) == pytest.approx((2.0, -1.0, 3.0))


ARM = """
<model name="arm"><link name="post"><inertial><mass>1</mass></inertial></link>
  <link name="bob"><pose>1 0 0 0 0 0</pose><inertial><mass>2</mass></inertial></link>
  <joint name="held" type="fixed"><parent>world</parent><child>post</child></joint>
  <joint name="wrist" type="revolute"><pose>-1 0 0 0 0 0</pose><parent>post</parent><child>bob</child><axis>
    <xyz>0 0 1</xyz></axis>{inside}</joint>{extra}
</model>"""


async def test_force_torque_sensors_publish_wrench():
    classic = plugin("libgazebo_ros_ft_sensor.so", "<joint_name>wrist</joint_name><update_rate>10</update_rate>")
    gz = sensor("force_torque", "<topic>ft</topic>", name="ft")
    async with running_server(ARM.format(inside=gz, extra=classic)) as (server, graph, log):
        first, second = await last_messages(server, graph, "/wrench", "/ft")
        assert (first.header.frame_id, second.header.frame_id) == ("bob", "arm/wrist/ft")
        for message in (first, second):
            assert message.wrench.force.z == pytest.approx(-2 * 9.81, abs=1e-3)
            assert message.wrench.torque.y == pytest.approx(2 * 9.81, abs=1e-3)
        assert not log


def image_pixels(message) -> np.ndarray:
    channels = message.step // message.width
    return np.frombuffer(bytes(message.data), np.uint8).reshape(message.height, message.width, channels)


async def test_classic_camera_publishes_image_and_camera_info():
    settings = "<camera_name>front</camera_name><frame_name>optical</frame_name><hack_baseline>0.07</hack_baseline>"
    text = robot_with(sensor("camera", CAMERA + plugin("libgazebo_ros_camera.so", settings)))
    async with running_server(WALL, text) as (server, graph, log):
        image, info = await last_messages(server, graph, "/front/image_raw", "/front/camera_info")
        assert (image.width, image.height, image.encoding, image.step) == (64, 48, "rgb8", 192)
        assert image.header.frame_id == info.header.frame_id == "optical"
        red = image_pixels(image)[24, 32]
        assert red[0] > 50
        assert red[1] == red[2] == 0
        focal = 64 / (2 * tan(pi / 4))
        assert list(info.k) == pytest.approx([focal, 0, 32.5, 0, focal, 24.5, 0, 0, 1])
        assert list(info.p)[3] == pytest.approx(-focal * 0.07)
        assert (info.distortion_model, list(info.d)) == ("plumb_bob", [0.0] * 5)
        assert [record.text for record in log if "camera images are rendered by" in record.text]


@pytest.mark.parametrize(
    ("image_format", "encoding", "step"),
    [("L8", "mono8", 64), ("B8G8R8", "bgr8", 192), ("R16G16B16", "rgb16", 384), ("BAYER_RGGB8", "bayer_rggb8", 64)],
)
async def test_image_format_sets_encoding(image_format: str, encoding: str, step: int):
    camera = CAMERA.replace("</height>", f"</height><format>{image_format}</format>")
    async with running_server(WALL, robot_with(sensor("camera", camera + plugin("libgazebo_ros_camera.so")))) as (
        server,
        graph,
        _,
    ):
        (image,) = await last_messages(server, graph, "/sensor/image_raw")
        assert (image.encoding, image.step, len(image.data)) == (encoding, step, 48 * step)


@pytest.mark.parametrize("library", ["libgazebo_ros_camera.so", "libgazebo_ros_openni_kinect.so"])
async def test_depth_camera_measures_along_optical_axis(library: str):
    element = plugin(library, "<camera_name>depth</camera_name><max_depth>3</max_depth>")
    near_block = block("near", "0.35 0.2 0 0 0 0", "0.1 0.1 0.1")
    async with running_server(WALL, near_block, robot_with(sensor("depth", CAMERA + element))) as (server, graph, _):
        depth, cloud = await last_messages(server, graph, "/depth/depth/image_raw", "/depth/points")
        meters = np.frombuffer(bytes(depth.data), np.float32).reshape(48, 64)
        assert (depth.encoding, depth.step) == ("32FC1", 256)
        assert meters[24, 60] == pytest.approx(2.0, abs=1e-3)
        assert meters[24, 10] == -inf
        points = np.frombuffer(bytes(cloud.data), np.float32).reshape(48, 64, 8)
        assert (cloud.point_step, cloud.height, cloud.width) == (32, 48, 64)
        assert points[24, 60, :3] == pytest.approx([28.5 / 32 * 2, 0.5 / 32 * 2, 2.0], abs=1e-2)
        blue, green, red = bytes(cloud.data)[(24 * 64 + 60) * 32 + 16 :][:3]
        assert red > 50
        assert green == blue == 0


async def test_triggered_camera_waits_for_trigger():
    element = plugin("libgazebo_ros_camera.so", "<triggered>true</triggered>")
    async with running_server(WALL, robot_with(sensor("camera", CAMERA + element))) as (server, graph, _):
        recording = Recording(graph, server.node, "/sensor/image_raw")
        server.advance(SECOND_NS)
        await graph.settle()
        assert len(recording) == 0
        trigger = server.node.create_publisher("std_msgs/msg/Empty", "/sensor/image_trigger", 1)
        trigger.publish(get_message("std_msgs/msg/Empty")())
        await graph.settle()
        server.advance(SECOND_NS)
        await graph.settle()
        assert len(recording) == 1


async def test_multicamera_has_topic_per_camera():
    cameras = CAMERA.replace("<camera>", '<camera name="left">') + CAMERA.replace("<camera>", '<camera name="right">')
    element = plugin("libgazebo_ros_camera.so", "<camera_name>stereo</camera_name>")
    async with running_server(WALL, robot_with(sensor("multicamera", cameras + element))) as (server, graph, _):
        left, right = await last_messages(server, graph, "/stereo/left/image_raw", "/stereo/right/camera_info")
        assert (left.width, right.width) == (64, 64)


async def test_gz_camera_publishes_camera_info_beside_image():
    camera = CAMERA.replace("</camera>", "<optical_frame_id>optical</optical_frame_id></camera>")
    async with running_server(WALL, robot_with(sensor("camera", f"<topic>front/image</topic>{camera}"))) as (
        server,
        graph,
        _,
    ):
        image, info = await last_messages(server, graph, "/front/image", "/front/camera_info")
        assert image.header.frame_id == info.header.frame_id == "optical"
        assert list(info.k)[2] == 32.0


async def test_gz_rgbd_camera_points_have_x_forward():
    text = robot_with(sensor("rgbd_camera", f"<topic>rgbd</topic>{CAMERA}"))
    async with running_server(WALL, text) as (server, graph, log):
        image, depth, cloud, info = await last_messages(
            server, graph, "/rgbd/image", "/rgbd/depth_image", "/rgbd/points", "/rgbd/camera_info"
        )
        assert (image.encoding, depth.encoding, info.width) == ("rgb8", "32FC1", 64)
        points = np.frombuffer(bytes(cloud.data), np.float32).reshape(48, 64, 8)
        assert points[24, 60, :3] == pytest.approx([2.0, -28.5 / 32 * 2, -0.5 / 32 * 2], abs=1e-2)
        assert [record.text for record in log] == [record.text for record in log if "camera images" in record.text]


LABEL = '<plugin filename="gz-sim-label-system" name="gz::sim::systems::Label"><label>{}</label></plugin>'


def labeled_block(name: str, pose: str, label: int) -> str:
    return block(name, pose, "0.1 0.4 0.4").replace("</visual>", LABEL.format(label) + "</visual>")


async def test_segmentation_camera_shows_labels_and_background():
    world = labeled_block("cup", "2 0.5 0 0 0 0", 7), labeled_block("other", "2 -0.5 0 0 0 0", 7), WALL
    text = robot_with(sensor("segmentation_camera", f"<topic>seg</topic>{CAMERA}"))
    async with running_server(*world, text) as (server, graph, _):
        maps, colored = await last_messages(server, graph, "/seg/labels_map", "/seg/colored_map")
        assert set(image_pixels(maps).reshape(-1).tolist()) == {0, 7}
        assert image_pixels(colored)[24, 24].any()
        assert not image_pixels(colored)[0, 0].any()


async def test_bounding_boxes_enclose_labeled_models():
    world = labeled_block("cup", "1.55 0.5 0 0 0 0", 7), labeled_block("ball", "1.55 -0.5 0 0 0 0", 9), WALL
    text = robot_with(sensor("boundingbox_camera", f"<topic>boxes</topic>{CAMERA}"))
    async with running_server(*world, text) as (server, graph, _):
        boxes, image = await last_messages(server, graph, "/boxes", "/boxes_image")
        bounding_boxes = {detection.results[0].hypothesis.class_id: detection.bbox for detection in boxes.detections}
        assert sorted(bounding_boxes) == ["7", "9"]
        # The boxes are 0.4 m wide and 1.5 m away. With a focal length of 32 pixels, they are 8.5 pixels wide, and 10.7
        # pixels from the center of the image.
        left, right = bounding_boxes["7"], bounding_boxes["9"]
        assert (left.center.position.x, left.size_x) == (pytest.approx(21.3, abs=1), pytest.approx(8.5, abs=1))
        assert (right.center.position.x, right.size_y) == (pytest.approx(42.7, abs=1), pytest.approx(8.5, abs=1))
        assert ((image_pixels(image) == (0, 255, 0)).all(axis=-1)).sum() > 20


async def test_image_noise_is_reproducible_for_same_seed():
    noise = "<noise><type>gaussian</type><mean>0</mean><stddev>0.02</stddev></noise>"
    text = robot_with(
        sensor("camera", CAMERA.replace("</camera>", noise + "</camera>") + plugin("libgazebo_ros_camera.so"))
    )
    images = []
    for _ in range(2):
        async with running_server(WALL, text) as (server, graph, _log):
            (image,) = await last_messages(server, graph, "/sensor/image_raw")
            images.append(image_pixels(image).astype(float))
    assert (images[0] == images[1]).all()
    assert np.std(images[0][:, :, 0]) == pytest.approx(0.02 * 255, rel=0.2)


POSITIONS = {
    "ahead": "0.5 2 1",
    "near": "0 0.4 1",
    "far": "0 4.5 1",
    "left": "-1.2 2 1",
    "above": "0 2 1.6",
    "behind": "0 -2 1",
}


async def test_logical_camera_lists_models_in_view():
    view = "<near>0.5</near><far>4</far><horizontal_fov>1.0</horizontal_fov><aspect_ratio>2</aspect_ratio>"
    camera = f"<pose>0 0 1 0 0 {pi / 2}</pose><topic>seen</topic><logical_camera>{view}</logical_camera>"
    boxes = [
        box(name, f"{position} 0 0 0", "0.1 0.1 0.1").replace("<link", "<static>true</static><link", 1)
        for name, position in POSITIONS.items()
    ]
    async with running_server(robot_with(sensor("logical_camera", camera)), *boxes) as (server, graph, log):
        (image,) = await last_messages(server, graph, "/seen")
        (image_model,) = image.model
        assert image_model.name == "ahead"
        assert (image_model.pose.position.x, image_model.pose.position.y) == pytest.approx((2.0, -0.5))
        assert image.pose.position.z == pytest.approx(1.0)
        assert image.header.frame_id == "robot/head/sensor"
        assert not log
