"""The examination of a record.

Each problem is found, and a graph without problems has no findings.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from linkwright.diagnostics import Severity
from linkwright.diagnostics.translation import translate
from linkwright.doctor import (
    FixedFrame,
    Observation,
    ObservedClock,
    ObservedCommanders,
    ObservedDescription,
    ObservedFrame,
    ObservedJoint,
    ObservedStamp,
    ObservedTransform,
    examine,
)
from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind
from linkwright.graph.names.rules import NodeIdentity
from linkwright.graph.qos.profile import DurabilityPolicy, QoSProfile, ReliabilityPolicy

ROBOT = """\
<robot name="mbot">
  <link name="base"/><link name="wheel"/><link name="mast"/><link name="copy"/>
  <joint name="spin" type="continuous"><parent link="base"/><child link="wheel"/></joint>
  <joint name="stand" type="fixed"><parent link="base"/><child link="mast"/></joint>
  <joint name="follow" type="continuous"><parent link="base"/><child link="copy"/><mimic joint="spin"/></joint>
</robot>
"""
RSP, JSP = "/robot_state_publisher", "/joint_state_publisher"
JOINT_STATE, TF = "sensor_msgs/msg/JointState", "tf2_msgs/msg/TFMessage"


def endpoint(kind: str, node: str, name: str, type_name: str, qos: QoSProfile | None = None) -> EndpointInfo:
    namespace, _, base_name = node.rpartition("/")
    identity = NodeIdentity(base_name, namespace or "/")
    return EndpointInfo(EndpointKind(kind), identity, name, type_name, qos or QoSProfile(10), bytes(16))


def publisher(node: str, name: str, type_name: str, qos: QoSProfile | None = None) -> EndpointInfo:
    return endpoint("publisher", node, name, type_name, qos)


def subscription(node: str, name: str, type_name: str, qos: QoSProfile | None = None) -> EndpointInfo:
    return endpoint("subscription", node, name, type_name, qos)


HEALTHY = Observation(
    seconds=3.0,
    nodes=(RSP, JSP),
    endpoints=(
        publisher(RSP, "/tf", TF),
        publisher(RSP, "/tf_static", TF),
        publisher(JSP, "/joint_states", JOINT_STATE),
        subscription(RSP, "/joint_states", JOINT_STATE),
    ),
    transforms=(
        ObservedTransform("base", "wheel", (RSP,)),
        ObservedTransform("base", "copy", (RSP,)),
        ObservedTransform("base", "mast", (RSP,), is_static=True),
    ),
    joints=(ObservedJoint("spin", (JSP,)),),
    descriptions=(ObservedDescription("/robot_description", RSP, ROBOT),),
    sim_time={RSP: False, JSP: False},
)


def codes(observation: Observation) -> list[str]:
    return [diagnostic.code for diagnostic in examine(observation)]


def only_diagnostic(observation: Observation, code: str):
    diagnostics = examine(observation)
    assert [diagnostic.code for diagnostic in diagnostics] == [code], diagnostics
    return diagnostics[0]


def without_frames(observation: Observation, *children: str) -> Observation:
    return replace(
        observation,
        transforms=tuple(transform for transform in observation.transforms if transform.child not in children),
    )


def with_endpoints(observation: Observation, *endpoints: EndpointInfo) -> Observation:
    return replace(observation, endpoints=(*observation.endpoints, *endpoints))


def test_healthy_graph_has_no_findings():
    assert examine(HEALTHY) == []


def test_empty_graph_report_names_domain_and_discovery_range():
    diagnostic = only_diagnostic(Observation(seconds=2.0, environment={"ROS_DOMAIN_ID": "7"}), "DOC801")
    assert "domain 7" in diagnostic.notes[0].message
    assert "ROS_AUTOMATIC_DISCOVERY_RANGE" in diagnostic.hint


def test_empty_graph_over_zenoh_hints_at_rmw_zenohd():
    diagnostic = only_diagnostic(
        Observation(seconds=2.0, environment={"ROS_DOMAIN_ID": "150"}, over_zenoh=True), "DOC801"
    )
    assert "rmw_zenohd" in diagnostic.hint


def test_domain_id_above_101_is_reported():
    assert codes(replace(HEALTHY, environment={"ROS_DOMAIN_ID": "150"})) == ["DOC803"]
    assert codes(replace(HEALTHY, environment={"ROS_DOMAIN_ID": "101"})) == []


# frames


def test_missing_transform_publisher_is_reported():
    observation = replace(HEALTHY, transforms=(), endpoints=())
    diagnostic = only_diagnostic(observation, "DOC301")
    assert (
        diagnostic.message
        == "there is no transform of 3 frames, 'wheel', 'mast', 'copy', because no node publishes transforms"
    )


def test_missing_joint_state_publisher_is_reported():
    observation = replace(
        without_frames(HEALTHY, "wheel", "copy"),
        joints=(),
        endpoints=tuple(endpoint for endpoint in HEALTHY.endpoints if endpoint.name != "/joint_states"),
    )
    diagnostic = only_diagnostic(observation, "DOC401")
    assert diagnostic.message == "no node publishes joint states, so there is no transform of 2 frames, 'wheel', 'copy'"
    assert "joint_state_publisher" in diagnostic.hint


def test_silent_joint_state_publisher_is_reported():
    diagnostic = only_diagnostic(replace(without_frames(HEALTHY, "wheel", "copy"), joints=()), "DOC402")
    assert diagnostic.message.startswith("'/joint_state_publisher' did not publish joint states in 3 s")


def test_joint_missing_from_joint_states_suggests_misspelled_name():
    observation = replace(without_frames(HEALTHY, "wheel", "copy"), joints=(ObservedJoint("spinn", (JSP,)),))
    diagnostics_by_code = {diagnostic.code: diagnostic for diagnostic in examine(observation)}
    assert set(diagnostics_by_code) == {"DOC403", "DOC405"}
    missing = diagnostics_by_code["DOC403"]
    assert (
        missing.message
        == "joint 'spin' is not in the joint states, so there is no transform of 2 frames, 'wheel', 'copy'"
    )
    assert missing.hint == "did you mean 'spinn'?"
    assert diagnostics_by_code["DOC405"].hint == "did you mean 'spin'?"


def test_missing_static_transform_is_reported():
    diagnostic = only_diagnostic(without_frames(HEALTHY, "mast"), "DOC304")
    assert diagnostic.message == "there is no transform of frame 'mast', because no static transform was published"
    assert "'stand'" in diagnostic.notes[0].message


def test_joint_states_on_unread_topic_hint_at_remapping():
    observation = replace(
        without_frames(HEALTHY, "wheel", "copy"),
        joints=(ObservedJoint("spin", (JSP,), ("/arm/joint_states",)),),
        endpoints=(*HEALTHY.endpoints, publisher(JSP, "/arm/joint_states", JOINT_STATE)),
    )
    diagnostic = only_diagnostic(observation, "DOC305")
    assert "remap joint_states of robot_state_publisher" in diagnostic.hint


def test_prefixed_frames_match_robot_links():
    transforms = tuple(
        replace(transform, parent=f"r1/{transform.parent}", child=f"r1/{transform.child}")
        for transform in HEALTHY.transforms
    )
    assert examine(replace(HEALTHY, transforms=transforms)) == []


def test_transform_from_two_publishers_is_reported():
    doubled = replace(HEALTHY.transforms[0], senders=("/driver", RSP))
    diagnostic = only_diagnostic(replace(HEALTHY, transforms=(doubled, *HEALTHY.transforms[1:])), "DOC302")
    assert diagnostic.message == ("2 nodes publish the transform of frame 'wheel': '/driver', '/robot_state_publisher'")


def test_frame_with_two_parents_is_reported():
    other = ObservedTransform("odom", "base", ("/a",)), ObservedTransform("map", "base", ("/b",))
    diagnostics = [
        diagnostic
        for diagnostic in examine(replace(HEALTHY, transforms=(*HEALTHY.transforms, *other)))
        if diagnostic.code == "DOC303"
    ]
    assert diagnostics[0].message == "frame 'base' has 2 parents, 'map', 'odom', and jumps between them"


def test_disconnected_frame_tree_is_reported():
    disconnected = ObservedTransform("camera", "lens", ("/camera_driver",))
    diagnostic = only_diagnostic(replace(HEALTHY, transforms=(*HEALTHY.transforms, disconnected)), "DOC308")
    assert "--frame-id base --child-frame-id camera" in diagnostic.hint


def test_frame_loop_is_reported():
    circle = ObservedTransform("a", "b", ("/x",)), ObservedTransform("b", "a", ("/y",))
    assert "DOC307" in codes(replace(HEALTHY, transforms=(*HEALTHY.transforms, *circle)))


def test_invalid_transform_is_reported():
    broken = replace(HEALTHY.transforms[0], is_valid=False)
    assert codes(replace(HEALTHY, transforms=(broken, *HEALTHY.transforms[1:]))) == ["DOC306"]


def test_missing_fixed_frame_is_reported():
    diagnostic = only_diagnostic(replace(HEALTHY, fixed_frames=(FixedFrame("map", "mbot.rviz"),)), "DOC309")
    assert diagnostic.message == "the fixed frame 'map' of mbot.rviz does not exist, so nothing is shown"
    assert diagnostic.hint == "choose another Fixed Frame; the root of all frames is 'base'"
    assert codes(replace(HEALTHY, fixed_frames=(FixedFrame("base", "mbot.rviz"),))) == []
    mapped = (*HEALTHY.transforms, ObservedTransform("map", "base", ("/localization",), is_static=True))
    diagnostic = only_diagnostic(replace(HEALTHY, transforms=mapped, fixed_frames=(FixedFrame("odom", "x"),)), "DOC309")
    assert diagnostic.hint == "choose another Fixed Frame; the root of all frames is 'map'"
    diagnostic = only_diagnostic(replace(HEALTHY, fixed_frames=(FixedFrame("bse", "x"),)), "DOC309")
    assert diagnostic.hint == "did you mean 'base'?"


def test_message_in_missing_frame_is_reported():
    lost = ObservedFrame("/scan", "/laser", "lazer")
    diagnostic = only_diagnostic(replace(HEALTHY, frames=(lost,)), "DOC310")
    assert diagnostic.message == "'/laser' publishes '/scan' in frame 'lazer', which does not exist"
    assert "static_transform_publisher" in diagnostic.hint
    diagnostic = only_diagnostic(replace(HEALTHY, frames=(ObservedFrame("/scan", "/laser", "whel"),)), "DOC310")
    rays = [ObservedFrame(topic, "/laser", "mbot::laser::lidar") for topic in ("/world_rays", "/world_rays/others")]
    assert not codes(replace(HEALTHY, frames=tuple(rays))), "frames of the simulated world are not reported"
    assert diagnostic.hint == "did you mean 'wheel'?"
    assert codes(replace(HEALTHY, frames=(ObservedFrame("/scan", "/laser", "base"),))) == []


def test_message_frame_is_not_reported_without_transforms():
    observation = Observation(seconds=3.0, nodes=("/laser",), frames=(ObservedFrame("/scan", "/laser", "laser"),))
    assert "DOC310" not in codes(observation)


def test_fixed_frame_does_not_matter_if_nothing_has_a_frame():
    empty = replace(HEALTHY, transforms=(), joints=(), descriptions=(), fixed_frames=(FixedFrame("map", "'/viewer'"),))
    assert codes(empty) == []
    assert "DOC309" in codes(replace(empty, frames=(ObservedFrame("/scan", "laser", "/lidar"),)))


def test_simulation_world_is_accepted_as_fixed_frame():
    shown = replace(HEALTHY, fixed_frames=(FixedFrame("world", "'/viewer'"),))
    assert codes(shown) == ["DOC309"]
    simulated = replace(shown, endpoints=(*shown.endpoints, publisher("/gazebo", "/world_poses", TF)))
    assert "DOC309" not in codes(simulated)


def test_root_of_single_link_robot_is_accepted_as_fixed_frame():
    description = ObservedDescription("/robot_description", RSP, '<robot name="r"><link name="only"/></robot>')
    observation = replace(
        HEALTHY, transforms=(), joints=(), descriptions=(description,), fixed_frames=(FixedFrame("only", "x"),)
    )
    assert examine(observation) == []


def test_missing_fixed_frame_hint_names_all_tree_roots():
    disconnected = (*HEALTHY.transforms, ObservedTransform("camera", "lens", ("/camera",)))
    diagnostics = examine(replace(HEALTHY, transforms=disconnected, fixed_frames=(FixedFrame("odom", "x"),)))
    (hint,) = [diagnostic.hint for diagnostic in diagnostics if diagnostic.code == "DOC309"]
    assert hint == "choose another Fixed Frame; the roots of the trees of frames are 'base', 'camera'"


def test_frame_list_has_chinese_quotes_in_chinese():
    joints = "".join(
        f'<link name="l{i}"/><joint name="j{i}" type="continuous"><parent link="base"/><child link="l{i}"/></joint>'
        for i in range(8)
    )
    robot = ObservedDescription("/robot_description", RSP, f'<robot name="r"><link name="base"/>{joints}</robot>')
    observation = replace(HEALTHY, descriptions=(robot,), joints=(), endpoints=(publisher(RSP, "/tf", TF),))
    (joints_diagnostic,) = [diagnostic for diagnostic in examine(observation) if diagnostic.code == "DOC401"]
    names = "“l0”、“l1”、“l2”、“l3”、“l4”、“l5”和另外 2 个"
    assert translate(joints_diagnostic, "zh").message == f"没有节点发布关节状态，所以 8 个坐标系（{names}）没有变换"


# descriptions and joints


def test_file_name_as_description_is_reported():
    description = ObservedDescription("/robot_description", RSP, "mbot.urdf")
    diagnostic = only_diagnostic(replace(HEALTHY, descriptions=(description,), joints=()), "DOC501")
    assert "not the name of a file" in diagnostic.hint


@pytest.mark.parametrize(("text", "severity"), [(ROBOT, Severity.WARNING), (ROBOT + " ", Severity.ERROR)])
def test_two_descriptions_on_one_topic_are_reported(text, severity):
    second = ObservedDescription("/robot_description", "/other", text)
    diagnostic = only_diagnostic(replace(HEALTHY, descriptions=(*HEALTHY.descriptions, second)), "DOC502")
    assert diagnostic.severity is severity


def test_joint_from_two_publishers_is_reported():
    diagnostic = only_diagnostic(replace(HEALTHY, joints=(ObservedJoint("spin", ("/driver", JSP)),)), "DOC404")
    assert diagnostic.message.startswith("2 nodes publish the state of joint 'spin' on '/joint_states'")


# topics, services, nodes


def test_duplicate_node_name_is_reported():
    diagnostic = only_diagnostic(replace(HEALTHY, nodes=(RSP, RSP, JSP)), "DOC101")
    assert diagnostic.message == "2 nodes have the name '/robot_state_publisher'"


def test_topic_with_two_types_is_reported():
    observation = with_endpoints(
        HEALTHY, publisher("/a", "/chat", "std_msgs/msg/String"), subscription("/b", "/chat", "std_msgs/msg/Int32")
    )
    diagnostic = only_diagnostic(observation, "DOC201")
    assert [note.message for note in diagnostic.notes] == [
        "std_msgs/msg/Int32 is subscribed to by '/b'",
        "std_msgs/msg/String is published by '/a'",
    ]


def test_twist_and_twist_stamped_mismatch_is_reported():
    observation = with_endpoints(
        HEALTHY,
        publisher("/teleop", "/cmd_vel", "geometry_msgs/msg/Twist"),
        subscription("/diff_drive", "/cmd_vel", "geometry_msgs/msg/TwistStamped"),
    )
    assert "stamped:=true" in only_diagnostic(observation, "DOC202").hint


TWIST = "geometry_msgs/msg/Twist"
SUBSCRIPTIONS_OF_BOTH_TYPES = tuple(
    subscription("/behavior_server", "/cmd_vel_teleop", kind) for kind in (TWIST, f"{TWIST}Stamped")
)


@pytest.mark.parametrize("kinds", [(), (TWIST,), (f"{TWIST}Stamped",), (TWIST, f"{TWIST}Stamped")])
def test_subscriber_to_both_velocity_types_matches_either_type(kinds):
    publishers = [publisher(f"/teleop_{number}", "/cmd_vel_teleop", kind) for number, kind in enumerate(kinds)]
    assert not {"DOC201", "DOC202"} & set(codes(with_endpoints(HEALTHY, *SUBSCRIPTIONS_OF_BOTH_TYPES, *publishers)))


def test_type_mismatch_is_reported_beside_subscriber_to_both_types():
    stamped_publisher = publisher("/teleop", "/cmd_vel_teleop", TWIST)
    other = subscription("/base", "/cmd_vel_teleop", f"{TWIST}Stamped")
    assert "DOC202" in codes(with_endpoints(HEALTHY, *SUBSCRIPTIONS_OF_BOTH_TYPES, stamped_publisher, other))


def test_velocity_topic_without_subscriber_is_reported():
    diagnostic = only_diagnostic(with_endpoints(HEALTHY, publisher("/teleop", "/cmd_vel", TWIST)), "DOC207")
    assert (
        diagnostic.message
        == "'/teleop' publishes velocities on '/cmd_vel', but no node subscribes to it, so nothing moves"
    )
    assert "controller runs in the same ROS_DOMAIN_ID" in diagnostic.hint


def test_unsubscribed_velocity_topic_suggests_remapping():
    observation = with_endpoints(
        HEALTHY,
        publisher("/teleop", "/cmd_vel", TWIST),
        subscription("/drive", "/base/command", "geometry_msgs/msg/TwistStamped"),
    )
    assert only_diagnostic(observation, "DOC207").hint.endswith("-r /cmd_vel:=/base/command")


@pytest.mark.parametrize(
    "more_endpoints",
    [
        [publisher("/teleop", "/cmd_vel", TWIST), subscription("/drive", "/cmd_vel", TWIST)],
        [publisher("/gps", "/vehicle/twist", TWIST)],
    ],
)
def test_subscribed_and_measured_velocities_have_no_findings(more_endpoints):
    assert examine(with_endpoints(HEALTHY, *more_endpoints)) == []


def test_misspelled_velocity_topic_is_reported_once():
    observation = with_endpoints(
        HEALTHY, publisher("/teleop", "/cmd_vel", TWIST), subscription("/drive", "/robot/cmd_vel", TWIST)
    )
    assert codes(observation) == ["DOC204"]


def test_contradictory_velocity_publishers_are_reported():
    observation = with_endpoints(
        HEALTHY, publisher("/teleop", "/cmd_vel", TWIST), subscription("/drive", "/cmd_vel", TWIST)
    )
    diagnostic = only_diagnostic(
        replace(observation, contradictory_velocities=(ObservedCommanders("/cmd_vel", ("/planner", "/teleop")),)),
        "DOC208",
    )
    assert (
        diagnostic.message
        == "two nodes drive the robot: '/planner', '/teleop' publish contradictory velocities on '/cmd_vel'"
    )
    assert codes(observation) == []


def test_qos_mismatch_report_names_policy_and_endpoints():
    observation = with_endpoints(
        HEALTHY,
        publisher("/lidar", "/scan", "sensor_msgs/msg/LaserScan", QoSProfile(5, ReliabilityPolicy.BEST_EFFORT)),
        subscription(
            "/rviz",
            "/scan",
            "sensor_msgs/msg/LaserScan",
            QoSProfile(5, ReliabilityPolicy.RELIABLE, DurabilityPolicy.TRANSIENT_LOCAL),
        ),
    )
    assert codes(replace(observation, over_zenoh=True)) == []  # over Zenoh, '/rviz' receives the messages
    diagnostic = only_diagnostic(observation, "DOC203")
    assert diagnostic.message == (
        "'/rviz' receives nothing from '/lidar' on topic '/scan', because their quality of service is incompatible"
    )
    assert [note.message for note in diagnostic.notes] == [
        "reliability: '/lidar' offers BEST_EFFORT, '/rviz' requests RELIABLE",
        "durability: '/lidar' offers VOLATILE, '/rviz' requests TRANSIENT_LOCAL",
    ]


def test_topic_of_same_node_is_not_suggested():
    text = "std_msgs/msg/String"
    observation = with_endpoints(
        HEALTHY, subscription("/voice", "/voice/text_input", text), publisher("/voice", "/voice/text", text)
    )
    assert codes(observation) == []


@pytest.mark.parametrize("published", ["/robot1/scan", "/scann"])
def test_unpublished_topic_suggests_remapping_to_similar_topic(published):
    scan = "sensor_msgs/msg/LaserScan"
    diagnostic = only_diagnostic(
        with_endpoints(HEALTHY, subscription("/slam", "/scan", scan), publisher("/lidar", published, scan)), "DOC204"
    )
    assert f"-r /scan:={published}" in diagnostic.hint


def test_unpublished_topic_alone_is_not_reported():
    assert examine(with_endpoints(HEALTHY, subscription("/slam", "/scan", "sensor_msgs/msg/LaserScan"))) == []


def test_missing_service_is_reported():
    observation = with_endpoints(
        HEALTHY,
        endpoint("client", "/planner", "/map_server/map", "nav_msgs/srv/GetMap"),
        endpoint("service", "/map_server", "/map", "nav_msgs/srv/GetMap"),
    )
    assert "service '/map' has the same type" in only_diagnostic(observation, "DOC206").hint


def test_service_type_mismatch_is_reported():
    observation = with_endpoints(
        HEALTHY,
        endpoint("client", "/a", "/go", "std_srvs/srv/Trigger"),
        endpoint("service", "/b", "/go", "std_srvs/srv/SetBool"),
    )
    assert codes(observation) == ["DOC205"]


# time


def test_mixed_use_sim_time_is_reported():
    clock = publisher("/gazebo", "/clock", "rosgraph_msgs/msg/Clock")
    observation = replace(
        with_endpoints(HEALTHY, clock), sim_time={RSP: True, JSP: False, "/gazebo": False}, clock=ObservedClock(9, 1, 9)
    )
    diagnostic = only_diagnostic(observation, "DOC601")
    assert diagnostic.message == (
        "use_sim_time is true for '/robot_state_publisher', but false for '/joint_state_publisher'"
    )


def test_hidden_nodes_and_clock_publisher_need_no_use_sim_time():
    observation = with_endpoints(HEALTHY, publisher("/gazebo", "/clock", "rosgraph_msgs/msg/Clock"))
    clock = ObservedClock(9, 5, 6)
    times = {RSP: True, JSP: True, "/gazebo": False, "/_gzclient": False}
    assert codes(replace(observation, sim_time=times, clock=clock)) == []


def test_use_sim_time_without_clock_is_reported():
    assert codes(replace(HEALTHY, sim_time={RSP: True, JSP: True})) == ["DOC602"]


@pytest.mark.parametrize("clock", [None, ObservedClock(9, 5, 5)])
def test_stopped_clock_is_reported(clock):
    observation = with_endpoints(HEALTHY, publisher("/gazebo", "/clock", "rosgraph_msgs/msg/Clock"))
    assert codes(replace(observation, sim_time={RSP: True, JSP: True}, clock=clock)) == ["DOC603"]


def test_two_clock_publishers_are_reported():
    kind = "rosgraph_msgs/msg/Clock"
    observation = with_endpoints(HEALTHY, publisher("/gazebo", "/clock", kind), publisher("/bag", "/clock", kind))
    assert codes(observation) == ["DOC604"]


@pytest.mark.parametrize(("behind_s", "message"), [(3600, "3600.0 s behind"), (-60, "60.0 s ahead of")])
def test_stamp_far_from_current_time_is_reported(behind_s, message):
    stamp = ObservedStamp("/scan", "/lidar", behind_s * 10**9)
    assert f"are {message} the clock here" in only_diagnostic(replace(HEALTHY, stamps=(stamp,)), "DOC605").message


def test_zero_stamp_is_reported():
    assert codes(replace(HEALTHY, stamps=(ObservedStamp("/joint_states", JSP, 0, is_zero=True),))) == ["DOC606"]


def test_inactive_managed_node_is_reported():
    diagnostic = only_diagnostic(replace(HEALTHY, lifecycle={"/camera": "inactive", "/lidar": "active"}), "DOC701")
    assert diagnostic.message == "managed node '/camera' is inactive, so it does nothing yet"
    assert diagnostic.hint == "request the next transition: ros2 lifecycle set /camera activate"


def test_errors_come_before_warnings():
    observation = replace(
        HEALTHY, nodes=(RSP, RSP), transforms=(replace(HEALTHY.transforms[0], is_valid=False), *HEALTHY.transforms[1:])
    )
    assert codes(observation) == ["DOC306", "DOC101"]
