"""parameter_bridge and image_bridge.

They convert between topics whose names or types differ between gz and ROS.
"""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import DurabilityPolicy, QoSProfile
from linkwright.messages import get_message, get_service
from linkwright.nodes import NodeOptions
from linkwright.simulation.nodes.bridge import (
    BridgedTopic,
    ImageBridge,
    ParameterBridge,
    parse_bridge_argument,
    read_bridge_file,
)
from linkwright.simulation.plugins.bridged_topics import hidden_gz_topic
from tests.places import GAZEBO_PACKAGE
from tests.remote_publishers import RemotePublisher, RemoteTransport

SCAN = "/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan"


def record_messages(harness, message_type, topic):
    messages = []
    harness.node.create_subscription(get_message(message_type), topic, messages.append, 10)
    return messages


def create_publisher(harness, message_type, topic):
    return harness.node.create_publisher(get_message(message_type), topic, 10)


@pytest.mark.parametrize(
    ("argument", "topic"),
    [
        (SCAN, BridgedTopic("/scan", "/scan", "sensor_msgs/msg/LaserScan", "gz.msgs.LaserScan", "GZ_TO_ROS")),
        (
            "/a@geometry_msgs/Twist]ignition.msgs.Twist",
            BridgedTopic("/a", "/a", "geometry_msgs/msg/Twist", "gz.msgs.Twist", "ROS_TO_GZ"),
        ),
        (
            "/a@std_msgs/msg/String@gz.msgs.StringMsg",
            BridgedTopic("/a", "/a", "std_msgs/msg/String", "gz.msgs.StringMsg", "BIDIRECTIONAL"),
        ),
        (
            "/a@std_msgs/msg/String[gz.msgs.StringMsg@/gz/b",
            BridgedTopic("/a", "/gz/b", "std_msgs/msg/String", "gz.msgs.StringMsg", "GZ_TO_ROS"),
        ),
    ],
)
def test_bridge_argument_is_parsed(argument, topic):
    assert parse_bridge_argument(argument) == topic


@pytest.mark.parametrize("argument", ["", "/scan", "/scan@", "/scan@sensor_msgs/msg/LaserScan", "@a@b", "/scan@a["])
def test_malformed_bridge_argument_is_rejected(argument):
    with pytest.raises(LinkwrightError, match="does not describe a topic to bridge"):
        parse_bridge_argument(argument)


def test_shipped_bridge_file_is_read():
    topics = {entry.gz_topic: entry for entry in read_bridge_file(str(GAZEBO_PACKAGE / "config" / "bridge.yaml"))}
    assert topics["kinect/image"].ros_topic == "kinect/image_raw"
    assert topics["cmd_vel"].direction == "ROS_TO_GZ"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a: 1", "it is not a list"),
        ("- 1", "entry 1 is not a mapping"),
        ("- topic_name: a\n  ros_type_name: b", "entry 1 has no 'gz_type_name'"),
        ("- ros_type_name: a\n  gz_type_name: b", "entry 1 has no 'ros_topic_name'"),
        ("- topic_name: a\n  ros_type_name: b\n  gz_type_name: c\n  direction: UP", "the unknown direction 'UP'"),
        ("- [", "is not YAML"),
    ],
)
def test_malformed_bridge_file_is_rejected(text, message, tmp_path: Path):
    path = tmp_path / "bridge.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(LinkwrightError, match=message):
        read_bridge_file(str(path))
    with pytest.raises(LinkwrightError, match="cannot read"):
        read_bridge_file(str(tmp_path / "nothing.yaml"))


async def test_topic_of_same_name_is_not_duplicated(harness):
    scans = record_messages(harness, "sensor_msgs/msg/LaserScan", "/scan")
    ParameterBridge(harness.graph, NodeOptions(arguments=[SCAN]))
    create_publisher(harness, "sensor_msgs/msg/LaserScan", "/scan").publish(get_message("sensor_msgs/msg/LaserScan")())
    await harness.graph.settle()
    assert len(scans) == 1


async def test_topics_exist_before_simulation(harness):
    arguments = (SCAN, "/odom@nav_msgs/msg/Odometry[gz.msgs.Odometry", "/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist")
    ParameterBridge(harness.graph, NodeOptions(arguments=[*arguments, "/both@std_msgs/msg/String@gz.msgs.StringMsg"]))
    topics = dict(harness.graph.get_topic_names_and_types())
    assert {"/scan", "/odom", "/cmd_vel", "/both"} <= topics.keys()
    counts = {name: (harness.node.count_publishers(name), harness.node.count_subscribers(name)) for name in topics}
    assert [counts[name] for name in ("/scan", "/cmd_vel", "/both")] == [(1, 0), (0, 1), (1, 1)]


TILT = "std_msgs/msg/Float64]gz.msgs.Double@/model/arm/joint/tilt/0/cmd_pos"


async def test_gz_topic_whose_name_is_invalid_in_ros_is_bridged(harness):
    commands = record_messages(harness, "std_msgs/msg/Float64", "/model/arm/joint/tilt/_0/cmd_pos")
    ParameterBridge(harness.graph, NodeOptions(arguments=[f"/tilt@{TILT}"]))
    create_publisher(harness, "std_msgs/msg/Float64", "/tilt").publish(get_message("std_msgs/msg/Float64")(data=0.5))
    await harness.graph.settle()
    assert [command.data for command in commands] == [0.5]


async def test_bridge_that_fails_to_start_leaves_no_node(harness):
    nodes = harness.graph.node_names()
    with pytest.raises(LinkwrightError, match="must not start with a number"):
        ParameterBridge(harness.graph, NodeOptions(arguments=[SCAN, f"/tilt/0@{TILT}"]))
    assert harness.graph.node_names() == nodes


CONTROL, CONTROL_TYPE = "/world/empty/control", "ros_gz_interfaces/srv/ControlWorld"


@pytest.mark.parametrize("types", ["", "@gz.msgs.WorldControl@gz.msgs.Boolean"])
async def test_service_is_offered_under_remapped_name(harness, logged, types):
    def handle(request, response):
        response.success = request.world_control.multi_step == 3
        return response

    harness.node.create_service(CONTROL_TYPE, CONTROL, handle)
    options = NodeOptions(arguments=[f"{CONTROL}@{CONTROL_TYPE}{types}", SCAN], remappings=[(CONTROL, "/steps")])
    ParameterBridge(harness.graph, options)
    request = get_service(CONTROL_TYPE).Request()
    request.world_control.multi_step = 3
    assert (await harness.node.create_client(CONTROL_TYPE, "/steps").call_async(request)).success
    assert "/scan" in harness.graph.topics()
    assert not logged("WARN")


async def test_service_of_same_name_is_left_to_simulator(harness, logged):
    ParameterBridge(harness.graph, NodeOptions(arguments=[f"{CONTROL}@{CONTROL_TYPE}"]))
    assert CONTROL not in dict(harness.graph.get_service_names_and_types())
    assert not logged("WARN")


async def test_unsupported_service_is_reported_and_topics_are_bridged(harness, logged):
    ParameterBridge(harness.graph, NodeOptions(arguments=["/gui/camera@std_srvs/srv/Empty", SCAN]))
    assert "/scan" in harness.graph.topics()
    assert logged("WARN") == ["/gui/camera is not bridged: services of type std_srvs/srv/Empty are not supported"]


async def test_remapped_topic_is_bridged(harness):
    message_type = "nav_msgs/msg/Odometry"
    odometry = record_messages(harness, message_type, "/odom")
    argument = f"/model/mbot/odometry@{message_type}[gz.msgs.Odometry"
    ParameterBridge(harness.graph, NodeOptions(arguments=[argument], remappings=[("/model/mbot/odometry", "/odom")]))
    create_publisher(harness, message_type, "/model/mbot/odometry").publish(
        get_message(message_type)(child_frame_id="base")
    )
    await harness.graph.settle()
    assert [message.child_frame_id for message in odometry] == ["base"]


async def test_bidirectional_bridge_does_not_loop(harness):
    message_type = "std_msgs/msg/String"
    ros, gz = record_messages(harness, message_type, "/ros"), record_messages(harness, message_type, "/gz")
    argument = f"/gz@{message_type}@gz.msgs.StringMsg"
    ParameterBridge(harness.graph, NodeOptions(arguments=[argument], remappings=[("/gz", "/ros")]))
    to_ros, to_gz = create_publisher(harness, message_type, "/gz"), create_publisher(harness, message_type, "/ros")
    for number in range(3):
        to_ros.publish(get_message(message_type)(data=f"up {number}"))
        to_gz.publish(get_message(message_type)(data=f"down {number}"))
        await harness.graph.settle()
    expected = sorted(f"{way} {number}" for way in ("up", "down") for number in range(3))
    assert sorted(message.data for message in ros) == expected
    assert sorted(message.data for message in gz) == expected


async def test_twist_stamped_is_converted_to_twist(harness, tmp_path: Path):
    twists = record_messages(harness, "geometry_msgs/msg/Twist", hidden_gz_topic("/cmd_vel"))
    path = tmp_path / "bridge.yaml"
    path.write_text(
        "- topic_name: cmd_vel\n  ros_type_name: geometry_msgs/msg/TwistStamped\n"
        "  gz_type_name: gz.msgs.Twist\n  direction: ROS_TO_GZ\n",
        encoding="utf-8",
    )
    ParameterBridge(harness.graph, harness.options({"config_file": str(path)}))
    stamped = get_message("geometry_msgs/msg/TwistStamped")()
    stamped.twist.linear.x = 0.25
    create_publisher(harness, "geometry_msgs/msg/TwistStamped", "/cmd_vel").publish(stamped)
    await harness.graph.settle()
    assert [message.linear.x for message in twists] == [0.25]
    assert harness.graph.topics()["/cmd_vel"] == ["geometry_msgs/msg/TwistStamped"]


async def test_unknown_type_is_reported_and_other_topics_are_bridged(harness, logged):
    message_type = "std_msgs/msg/String"
    ros = record_messages(harness, message_type, "/ros")
    arguments = ["/a@strange_msgs/msg/Thing[gz.msgs.Thing", f"/gz@{message_type}[gz.msgs.StringMsg"]
    ParameterBridge(harness.graph, NodeOptions(arguments=arguments, remappings=[("/gz", "/ros")]))
    create_publisher(harness, message_type, "/gz").publish(get_message(message_type)(data="hello"))
    await harness.graph.settle()
    assert logged("WARN") == ["/a is not bridged: there is no type strange_msgs/msg/Thing"]
    assert [message.data for message in ros] == ["hello"]


async def test_image_bridge_forwards_images(harness):
    message_type = "sensor_msgs/msg/Image"
    images = record_messages(harness, message_type, "/camera/color")
    bridge = ImageBridge(harness.graph, NodeOptions(arguments=["/camera"], remappings=[("/camera", "/camera/color")]))
    create_publisher(harness, message_type, "/camera").publish(get_message(message_type)(width=4))
    await harness.graph.settle()
    assert [message.width for message in images] == [4]
    bridge.close()


async def test_lazy_bridge_subscribes_only_while_it_has_subscribers(harness, tmp_path: Path):
    message_type = "std_msgs/msg/String"
    path = tmp_path / "bridge.yaml"
    path.write_text(
        f"- ros_topic_name: ros\n  gz_topic_name: gz\n  ros_type_name: {message_type}\n"
        "  gz_type_name: gz.msgs.StringMsg\n"
        "  direction: GZ_TO_ROS\n  lazy: true\n  publisher_queue: 3\n  subscriber_queue: 4\n",
        encoding="utf-8",
    )
    ParameterBridge(harness.graph, harness.options({"config_file": str(path)}))
    source = create_publisher(harness, message_type, "/gz")
    await harness.graph.settle()
    assert source.get_subscription_count() == 0
    subscription = harness.node.create_subscription(get_message(message_type), "/ros", lambda message: None, 10)
    await harness.graph.settle()
    assert source.get_subscription_count() == 1
    (result,) = harness.node.get_publishers_info_by_topic("/ros")
    assert result.qos_profile.depth == 3
    harness.node.destroy_subscription(subscription)
    await harness.graph.settle()
    assert source.get_subscription_count() == 0


async def test_parameters_override_qos(harness):
    message_type = "tf2_msgs/msg/TFMessage"
    argument = f"/model/robot/pose_static@{message_type}[gz.msgs.Pose_V"
    overrides = {"qos_overrides": {"/tf_static": {"publisher": {"durability": "transient_local"}}}}
    options = NodeOptions(
        arguments=[argument], remappings=[("/model/robot/pose_static", "/tf_static")], parameters=overrides
    )
    ParameterBridge(harness.graph, options)
    create_publisher(harness, message_type, "/model/robot/pose_static").publish(get_message(message_type)())
    await harness.graph.settle()
    messages = []
    latched = QoSProfile(1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    harness.node.create_subscription(get_message(message_type), "/tf_static", messages.append, latched)
    await harness.graph.settle()
    assert len(messages) == 1


async def test_poses_are_converted_to_requested_type(harness, logged):
    transform = get_message("geometry_msgs/msg/TransformStamped")()
    transform.header.frame_id, transform.transform.translation.x = "robot", 2.0
    type_names = ("Pose", "PoseStamped", "Transform", "PoseArray")
    results = {
        type_name: record_messages(harness, f"geometry_msgs/msg/{type_name}", f"/{type_name}")
        for type_name in type_names
    }
    arguments = [f"/one@geometry_msgs/msg/{type_name}[gz.msgs.Pose" for type_name in type_names[:3]]
    for type_name, argument in zip(type_names[:3], arguments, strict=True):
        name = f"bridge_{type_name.lower()}"
        ParameterBridge(
            harness.graph, NodeOptions(name=name, arguments=[argument], remappings=[("/one", f"/{type_name}")])
        )
    argument = "/many@geometry_msgs/msg/PoseArray[gz.msgs.Pose_V"
    ParameterBridge(harness.graph, NodeOptions(arguments=[argument], remappings=[("/many", "/PoseArray")]))
    create_publisher(harness, "geometry_msgs/msg/TransformStamped", "/one").publish(transform)
    create_publisher(harness, "tf2_msgs/msg/TFMessage", "/many").publish(
        get_message("tf2_msgs/msg/TFMessage")(transforms=[transform])
    )
    await harness.graph.settle()
    assert results["Pose"][0].position.x == results["PoseStamped"][0].pose.position.x == 2.0
    assert results["Transform"][0].translation.x == results["PoseArray"][0].poses[0].position.x == 2.0
    assert results["PoseStamped"][0].header.frame_id == results["PoseArray"][0].header.frame_id == "robot"
    argument = "/one@geometry_msgs/msg/Twist]gz.msgs.Pose"
    ParameterBridge(harness.graph, NodeOptions(name="back", arguments=[argument]))
    assert logged("WARN") == [
        "/one is not bridged: geometry_msgs/msg/Twist cannot be converted to geometry_msgs/msg/TransformStamped"
    ]


@pytest.mark.parametrize(
    ("ros_type", "gz_type", "simulated_type"),
    [
        ("geometry_msgs/msg/Pose", "gz.msgs.Pose", "geometry_msgs/msg/TransformStamped"),
        ("geometry_msgs/msg/PoseStamped", "gz.msgs.Pose", "geometry_msgs/msg/TransformStamped"),
        ("geometry_msgs/msg/PoseArray", "gz.msgs.Pose_V", "tf2_msgs/msg/TFMessage"),
    ],
)
async def test_poses_of_same_name_are_converted_in_both_directions(harness, logged, ros_type, gz_type, simulated_type):
    point = get_message("geometry_msgs/msg/Point")(x=1.0, y=2.0, z=3.0)
    turn = get_message("geometry_msgs/msg/Quaternion")(x=1.0, w=0.0)
    pose = get_message("geometry_msgs/msg/Pose")(position=point, orientation=turn)
    header = get_message("std_msgs/msg/Header")(frame_id="world")
    message = {
        "geometry_msgs/msg/Pose": lambda: pose,
        "geometry_msgs/msg/PoseStamped": lambda: get_message(ros_type)(header=header, pose=pose),
        "geometry_msgs/msg/PoseArray": lambda: get_message(ros_type)(header=header, poses=[pose]),
    }[ros_type]()
    ParameterBridge(harness.graph, NodeOptions(arguments=[f"/pose@{ros_type}@{gz_type}"]))
    simulated = record_messages(harness, simulated_type, hidden_gz_topic("/pose"))
    create_publisher(harness, ros_type, "/pose").publish(message)
    await harness.graph.settle()
    received = record_messages(harness, ros_type, "/pose")
    create_publisher(harness, simulated_type, "/pose").publish(simulated[0])
    await harness.graph.settle()
    assert received == [message]
    assert len(simulated) == 1
    assert not logged("WARN")


async def test_gz_topic_names_can_be_expanded_with_namespace(harness):
    message_type = "std_msgs/msg/String"
    ros = record_messages(harness, message_type, "/ros")
    options = NodeOptions(
        arguments=[f"chatter@{message_type}[gz.msgs.StringMsg"],
        namespace="/demo",
        parameters={"expand_gz_topic_names": True},
        remappings=[("chatter", "/ros")],
    )
    ParameterBridge(harness.graph, options)
    create_publisher(harness, message_type, "/demo/chatter").publish(get_message(message_type)(data="hello"))
    await harness.graph.settle()
    assert [message.data for message in ros] == ["hello"]


@pytest.mark.parametrize(("encoding", "pixel"), [("rgb8", [200, 100, 50]), ("bgr8", [50, 100, 200]), ("mono8", [120])])
async def test_compressed_images_are_published_while_subscribed(harness, encoding, pixel):
    images = pytest.importorskip("PIL.Image")
    message_type = "sensor_msgs/msg/Image"
    ImageBridge(harness.graph, NodeOptions(arguments=["/camera"]))
    camera = create_publisher(harness, message_type, "/camera")
    await harness.graph.settle()
    assert camera.get_subscription_count() == 0
    compressed = record_messages(harness, "sensor_msgs/msg/CompressedImage", "/camera/compressed")
    await harness.graph.settle()
    step = 8 * len(pixel)
    camera.publish(get_message(message_type)(width=8, height=8, encoding=encoding, step=step, data=pixel * 64))
    await harness.graph.settle()
    camera.publish(get_message(message_type)(width=8, height=8, encoding="16UC1", step=16, data=[0] * 128))
    await harness.graph.settle()
    (frame,) = compressed
    assert frame.format.startswith(f"{encoding}; jpeg compressed")
    decoded = images.open(BytesIO(bytes(frame.data)))
    decoded_pixel = decoded.getpixel((4, 4))
    expected = [120] if encoding == "mono8" else [200, 100, 50]
    assert list(decoded_pixel if isinstance(decoded_pixel, tuple) else (decoded_pixel,)) == pytest.approx(
        expected, abs=6
    )


@pytest.mark.parametrize(
    ("setting", "message"),
    [("publisher_queue: many", "'publisher_queue' is not an integer of 0 or more"), ("lazy: 3", "'lazy' is neither")],
)
def test_invalid_topic_settings_are_rejected(setting, message, tmp_path: Path):
    path = tmp_path / "bridge.yaml"
    path.write_text(f"- topic_name: a\n  ros_type_name: b/msg/C\n  gz_type_name: c\n  {setting}\n", encoding="utf-8")
    with pytest.raises(LinkwrightError, match=message):
        read_bridge_file(str(path))


@pytest.mark.parametrize("ros_type", ["geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"])
async def test_lost_publisher_stops_drive_behind_bridge(harness, ros_type):
    argument = f"/cmd_vel@{ros_type}]gz.msgs.Twist"
    bridge = ParameterBridge(harness.graph, NodeOptions(arguments=[argument, "--ros-args", "-r", "/cmd_vel:=/drive"]))
    commands = record_messages(harness, "geometry_msgs/msg/Twist", "/cmd_vel")
    driver = RemotePublisher(RemoteTransport(harness.graph), "/drive", msg_type=ros_type)
    message = get_message(ros_type)()
    getattr(message, "twist", message).linear.x = 0.3
    driver.send(message)
    driver.disappear()
    await harness.graph.settle()
    assert [twist.linear.x for twist in commands] == [0.3, 0.0]
    bridge.close()
