"""`robot_state_publisher`: link poses, topics and changed descriptions."""

from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.descriptions import DescriptionLibrary
from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.arrays import compose, quaternion_from_rpy
from linkwright.graph import DESCRIPTION_QOS, QoSProfile, ReliabilityPolicy
from linkwright.kinematics import KinematicTree
from linkwright.messages import Header, JointState, String, TFMessage, Time
from linkwright.nodes import NodeOptions
from linkwright.nodes.robot_state_publisher import JointMotion, RobotStatePublisher
from linkwright.urdf import Joint, Limit, Pose
from tests.geometry.rotations import quaternion_about
from tests.nodes.harness import joint, mimic, robot
from tests.places import TUTORIAL_PACKAGES

TWO_JOINTS = robot(joint("a"), joint("b", xyz="1 0 0", parent="a_link"))
MIMICS = robot(
    joint("master"),
    joint("follower", content=mimic("master", "multiplier='-2' offset='0.5'")),
    joint("second", content=mimic("follower")),
)

angles = st.floats(-10, 10)
vectors = st.tuples(*[st.floats(-2, 2)] * 3)


@given(
    st.lists(
        st.tuples(
            st.sampled_from(["revolute", "continuous", "prismatic", "fixed", "planar"]),
            vectors,
            st.tuples(angles, angles, angles),
            vectors.filter(lambda axis: sum(c * c for c in axis) > 1e-6),
            angles,
        ),
        max_size=8,
    )
)
def test_joint_motion_computes_link_poses(cases):
    joints = [
        Joint(str(number), kind, "p", "c", Pose(xyz, rpy), axis, Limit())
        for number, (kind, xyz, rpy, axis, _) in enumerate(cases)
    ]
    positions = np.array([position for *_, position in cases])
    poses = JointMotion(joints).poses(positions)
    assert poses.shape == (len(cases), 7)
    for row, (kind, xyz, rpy, axis, position) in zip(poses, cases, strict=True):
        origin = np.array([*xyz, *quaternion_from_rpy(rpy)])
        motion = np.array([0, 0, 0, 0, 0, 0, 1.0])
        if kind in ("revolute", "continuous"):
            motion[3:] = quaternion_about(axis, position)
        elif kind == "prismatic":
            motion[:3] = np.array(axis) / np.linalg.norm(axis) * position
        np.testing.assert_allclose(row, compose(origin, motion), atol=1e-9)


def test_joint_with_zero_axis_does_not_move():
    joints = [Joint("j", kind, "p", "c", axis=(0.0, 0.0, 0.0)) for kind in ("revolute", "prismatic")]
    np.testing.assert_array_equal(JointMotion(joints).poses(np.ones(2)), [[0, 0, 0, 0, 0, 0, 1]] * 2)


async def test_description_static_and_moving_transforms_are_published(harness, clock, logged):
    text = robot(joint("wheel", axis="0 1 0", xyz="0 0.19 -0.05"), joint("camera", "fixed", xyz="0.2 0 0"))
    start = clock.now_ns()
    harness.robot_state_publisher(text)
    await harness.graph.settle()
    assert harness.descriptions == [text]
    (static,) = harness.tf_static
    (transform,) = static.transforms
    assert (transform.header.frame_id, transform.child_frame_id) == ("base", "camera_link")
    assert transform.header.stamp.nanoseconds == start
    assert transform.transform.translation.x == 0.2
    assert harness.tf == []
    await clock.advance(1.0)
    await harness.move({"wheel": pi / 2})
    (message,) = harness.tf
    (transform,) = message.transforms
    assert transform.header.stamp.nanoseconds == start + 1_000_000_000
    assert transform.transform.translation.y == 0.19
    assert transform.transform.rotation.y == pytest.approx(sin(pi / 4))
    assert transform.transform.rotation.w == pytest.approx(cos(pi / 4))
    await clock.advance(10.0)
    assert len(harness.tf_static) == 1
    assert logged("INFO") == ["Robot initialized"]


async def test_topics_have_expected_qos(harness, log):
    harness.robot_state_publisher(TWO_JOINTS)
    listener = harness.graph.create_node("listener")
    listener.create_subscription(JointState, "/joint_states", print, 1)
    late_messages = []
    listener.create_subscription(String, "/robot_description", late_messages.append, DESCRIPTION_QOS)
    sensor = listener.create_publisher(
        JointState, "/joint_states", QoSProfile(5, reliability=ReliabilityPolicy.BEST_EFFORT)
    )
    await harness.graph.settle()
    assert [message.data for message in late_messages] == [TWO_JOINTS]
    # The other subscriptions request reliable joint states, but robot_state_publisher matches best effort too.
    assert sensor.get_subscription_count() == 1
    topics_of_all_nodes = ("/parameter_events", "/rosout")
    assert {name: types for name, types in harness.graph.topics().items() if name not in topics_of_all_nodes} == {
        "/joint_states": ["sensor_msgs/msg/JointState"],
        "/robot_description": ["std_msgs/msg/String"],
        "/tf": ["tf2_msgs/msg/TFMessage"],
        "/tf_static": ["tf2_msgs/msg/TFMessage"],
    }
    assert harness.graph.count_publishers("/tf") == 1


async def test_only_movable_joints_in_message_are_published(harness):
    harness.robot_state_publisher(robot(joint("a"), joint("b"), joint("f", "fixed")))
    await harness.move({"b": 0.5, "f": 1.0, "unknown": 2.0})
    assert harness.moved_frames() == [["b_link"]]
    await harness.move({"unknown": 1.0})
    assert len(harness.tf) == 1


async def test_floating_joints_are_skipped_and_planar_joints_are_fixed(harness, logged):
    text = robot(joint("float", "floating"), joint("plane", "planar", xyz="1 2 3"), joint("fix", "fixed"))
    harness.robot_state_publisher(text)
    await harness.graph.settle()
    batch = harness.tf_static[0].batch
    assert batch.children == ("plane_link", "fix_link")
    assert batch.poses[0, :3].tolist() == [1, 2, 3]
    assert logged("WARN") == [
        "Converting unknown joint type of joint 'float' into a fixed joint",
        "Converting unknown joint type of joint 'plane' into a fixed joint",
    ]
    assert harness.log[0].node == "kdl_parser"


async def test_root_link_inertia_is_reported_like_kdl_parser(harness, logged):
    inertia = "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>"
    harness.robot_state_publisher(
        f"<robot name='r'><link name='base'><inertial><mass value='1'/>{inertia}</inertial></link></robot>"
    )
    assert logged("WARN")[0].startswith("The root link base has an inertia specified in the URDF, but KDL does not")


async def test_frame_prefix_is_prepended_unchanged(harness):
    publisher = harness.robot_state_publisher(robot(joint("a"), joint("f", "fixed")), frame_prefix="left_")
    await harness.move({"a": 0.0})
    assert harness.tf_static[0].batch.parents == ("left_base",)
    assert harness.tf[0].batch.children == ("left_a_link",)
    assert await harness.set(publisher, frame_prefix="right/") == [(True, "")]
    assert harness.tf_static[1].batch.children == ("right/f_link",)
    await harness.clock.advance(0.1)
    await harness.move({"a": 0.5})
    assert harness.tf[1].batch.children == ("right/a_link",)


class TestMimic:
    async def test_mimic_joint_follows_master_in_message(self, harness):
        harness.robot_state_publisher(MIMICS)
        await harness.move({"master": 0.25})
        # `second` mimics a joint that is not in the message: robot_state_publisher does not follow chains.
        assert harness.moved_frames() == [["follower_link", "master_link"]]
        turned = 2 * np.arcsin(harness.buffer.lookup("base", "follower_link")[5])
        assert turned == pytest.approx(-2 * 0.25 + 0.5)

    async def test_own_position_of_mimic_joint_wins(self, harness):
        harness.robot_state_publisher(MIMICS)
        await harness.move({"follower": 1.0, "master": 0.25})
        assert harness.moved_frames() == [["follower_link", "master_link", "second_link"]]
        for frame in ("follower_link", "second_link"):
            assert 2 * np.arcsin(harness.buffer.lookup("base", frame)[5]) == pytest.approx(1.0)

    async def test_mimic_joint_without_master_is_not_published(self, harness):
        harness.robot_state_publisher(MIMICS)
        await harness.move({"other": 1.0})
        assert harness.tf == []


class TestBadMessages:
    async def test_message_without_positions_is_ignored(self, harness, logged):
        harness.robot_state_publisher(TWO_JOINTS)
        await harness.send(JointState(name=["a", "b"]))
        upstream_text = 'about joint(s) "a"(,...) whose position member was empty.'
        assert logged("WARN") == [f"Robot state publisher ignored a JointState message {upstream_text}"]
        assert harness.tf == []

    async def test_message_with_more_positions_than_names_is_ignored(self, harness, logged):
        harness.robot_state_publisher(TWO_JOINTS)
        await harness.send(JointState(name=["a"], position=[1.0, 2.0]))
        assert logged("ERROR") == ["Robot state publisher ignored an invalid JointState message"]

    async def test_empty_message_is_ignored_silently(self, harness, logged):
        harness.robot_state_publisher(TWO_JOINTS)
        await harness.send(JointState())
        assert logged("WARN") == logged("ERROR") == []

    async def test_message_without_stamp_is_ignored(self, harness, logged):
        harness.robot_state_publisher(TWO_JOINTS)
        for _ in range(3):
            await harness.move({"a": 0.5}, stamp_ns=0)
        assert harness.tf == []
        assert logged("WARN") == [
            "Ignoring JointState messages without a time stamp: set header.stamp, or the parameter ignore_timestamp"
        ]

    async def test_first_of_duplicate_names_wins(self, harness, clock):
        harness.robot_state_publisher(TWO_JOINTS)
        stamp = Time.from_nanoseconds(clock.now_ns())
        await harness.send(JointState(header=Header(stamp=stamp), name=["a", "a"], position=[0.0, 1.0]))
        assert harness.buffer.lookup("base", "a_link")[6] == 1.0


class TestThrottle:
    async def moves(self, harness, times):
        """Move joint a at these milliseconds.

        The x of a prismatic joint identifies each published move.
        """
        now = 0
        for number, milliseconds in enumerate(times, 1):
            await harness.clock.advance((milliseconds - now) / 1000)
            now = milliseconds
            await harness.move({"a": float(number)})
        await harness.clock.advance(0.2)
        return [int(message.batch.poses[0, 0]) for message in harness.tf]

    @pytest.fixture
    def slide(self, harness):
        text = robot(joint("a", "prismatic", axis="1 0 0"), joint("b", "prismatic", axis="1 0 0"))
        return lambda **parameters: harness.robot_state_publisher(text, **parameters)

    async def test_messages_one_interval_apart_are_published(self, harness, slide):
        slide()
        assert await self.moves(harness, [0, 50, 100, 151]) == [1, 2, 3, 4]

    async def test_last_message_within_interval_is_published_at_its_end(self, harness, slide, clock):
        slide()
        start = clock.now_ns()
        arrivals = []
        harness.node.create_subscription(
            TFMessage,
            "/tf",
            lambda message: arrivals.append(((clock.now_ns() - start) / 1e6, message.batch.stamp_ns - start)),
            10,
        )
        assert await self.moves(harness, [0, 10, 20, 30]) == [1, 4]
        assert arrivals == [(0.0, 0), (50.0, 30_000_000)]

    async def test_slightly_too_fast_source_is_throttled_to_limit(self, harness, slide):
        slide()
        published = await self.moves(harness, range(0, 1000, 40))
        assert 19 <= len(published) <= 22
        assert published[-1] == 25

    async def test_repeated_message_does_not_delay_next_move(self, harness, slide):
        slide()
        await harness.move({"a": 1.0})
        for _ in range(3):
            await harness.clock.advance(0.1)
            await harness.move({"a": 1.0})
        assert len(harness.tf) == 4
        await harness.clock.advance(0.01)
        await harness.move({"a": 2.0})
        assert len(harness.tf) == 5

    async def test_fast_repeated_messages_are_throttled(self, harness, slide):
        slide()
        for _ in range(10):
            await harness.move({"a": 1.0})
            await harness.clock.advance(0.01)
        await harness.clock.advance(1.0)
        assert len(harness.tf) == 2

    async def test_returning_to_published_position_drops_pending_message(self, harness, slide):
        slide()
        for position in (1.0, 2.0, 1.0):
            await harness.move({"a": position})
            await harness.clock.advance(0.01)
        await harness.clock.advance(0.1)
        assert [message.batch.poses[0, 0] for message in harness.tf] == [1.0, 1.0]

    async def test_publish_frequency_sets_interval(self, harness, slide):
        publisher = slide(publish_frequency=100.0)
        assert await self.moves(harness, [0, 10, 20]) == [1, 2, 3]
        harness.tf.clear()
        assert await harness.set(publisher, publish_frequency=4.0) == [(True, "")]
        assert await self.moves(harness, [0, 100, 249]) == [1, 3]

    async def test_joint_that_waited_longest_decides(self, harness, slide):
        slide()
        await harness.move({"a": 1.0})
        await harness.clock.advance(0.01)
        await harness.move({"a": 2.0, "b": 2.0})
        assert harness.moved_frames() == [["a_link"], ["a_link", "b_link"]]

    async def test_ignore_timestamp_publishes_all_messages(self, harness, slide):
        slide(ignore_timestamp=True)
        for number in range(3):
            await harness.move({"a": float(number)}, stamp_ns=0)
        assert len(harness.tf) == 3

    async def test_older_messages_are_dropped(self, harness, slide, clock):
        slide()
        await harness.move({"a": 1.0})
        await harness.move({"a": 2.0}, stamp_ns=clock.now_ns() - 10_000_000)
        await clock.advance(1.0)
        assert len(harness.tf) == 1

    async def test_pending_message_is_replaced_by_newer_positions(self, harness, slide, clock):
        slide()
        await harness.move({"a": 1.0})
        await clock.advance(0.01)
        await harness.move({"a": 2.0})
        await clock.advance(0.01)
        await harness.move({"a": 3.0, "b": 3.0})
        await clock.advance(1.0)
        assert [message.batch.poses[0, 0] for message in harness.tf] == [1.0, 3.0]

    async def test_time_jump_backwards_resets_throttle(self, harness, slide, clock, logged):
        slide()
        await harness.move({"a": 1.0})
        await clock.advance(0.01)
        await harness.move({"a": 2.0})
        clock.jump(-100.0)
        await harness.move({"a": 3.0})
        assert logged("WARN") == ["Moved backwards in time, re-publishing joint transforms!"]
        await clock.advance(1.0)
        assert [message.batch.poses[0, 0] for message in harness.tf] == [1.0, 3.0]

    async def test_close_drops_pending_message(self, harness, slide, clock):
        publisher = slide()
        await harness.move({"a": 1.0})
        await harness.move({"a": 2.0})
        publisher.close()
        await clock.advance(1.0)
        assert len(harness.tf) == 1


class TestStart:
    @pytest.mark.parametrize("parameters", [{}, {"robot_description": ""}])
    async def test_missing_description_is_rejected(self, harness, logged, parameters):
        with pytest.raises(LinkwrightError) as caught:
            RobotStatePublisher(harness.graph, NodeOptions(parameters=parameters))
        assert caught.value.diagnostics[0].code == "NODE101"
        assert logged("FATAL") == ["robot_description parameter must not be empty"]
        assert harness.graph.node_names() == ["/test_node"]

    async def test_unreadable_description_is_rejected(self, harness, logged):
        with pytest.raises(LinkwrightError) as caught:
            harness.robot_state_publisher(robot(joint("a", parent="nowhere")))
        first, *other_diagnostics = caught.value.diagnostics
        assert (first.code, first.message) == (
            "NODE102",
            "Unable to initialize urdf::model from robot description",
        )
        assert other_diagnostics[0].code.startswith("URDF")
        assert other_diagnostics[0].span is not None

    async def test_file_name_as_description_is_rejected(self, harness):
        with pytest.raises(LinkwrightError) as caught:
            harness.robot_state_publisher("/robots/mbot.urdf")
        assert "'/robots/mbot.urdf' is not URDF" in caught.value.diagnostics[0].hint

    @pytest.mark.parametrize("frequency", [-1.0, 0.0, 1000.5, float("nan")])
    async def test_frequency_out_of_range_is_rejected(self, harness, frequency):
        with pytest.raises(LinkwrightError, match="publish_frequency must be between 0 and 1000"):
            harness.robot_state_publisher(TWO_JOINTS, publish_frequency=frequency)

    async def test_parameter_of_wrong_type_is_rejected(self, harness):
        with pytest.raises(LinkwrightError) as caught:
            harness.robot_state_publisher(TWO_JOINTS, publish_frequency=30)
        assert caught.value.diagnostics[0].hint == "write 30.0"

    async def test_description_file_argument_is_accepted(self, harness, logged, tmp_path):
        path = tmp_path / "robot.urdf"
        path.write_text(TWO_JOINTS, encoding="utf-8")
        RobotStatePublisher(harness.graph, NodeOptions(arguments=[str(path)]))
        await harness.graph.settle()
        assert harness.descriptions == [TWO_JOINTS]
        assert logged("WARN")[0].startswith("No robot_description parameter, but command-line argument available.")
        with pytest.raises(LinkwrightError, match=r"URDF file 'missing.urdf' cannot be read: No such file"):
            RobotStatePublisher(harness.graph, NodeOptions(arguments=["missing.urdf"]))

    async def test_ros_arguments_are_applied(self, harness):
        arguments = ["--ros-args", "-r", "__node:=left", "-r", "/tf:=tf", "-p", "frame_prefix:=l_"]
        publisher = RobotStatePublisher(
            harness.graph,
            NodeOptions(namespace="/arm", parameters={"robot_description": TWO_JOINTS}, arguments=arguments),
        )
        assert publisher.node.get_fully_qualified_name() == "/arm/left"
        assert publisher.node.get_parameter("frame_prefix").value == "l_"
        assert harness.graph.count_publishers("/arm/tf") == 1
        assert harness.graph.count_publishers("/arm/robot_description") == 1


class TestUpdate:
    async def test_new_description_replaces_old(self, harness, clock):
        publisher = harness.robot_state_publisher(robot(joint("a"), joint("f", "fixed")))
        await harness.move({"a": 1.0})
        text = robot(joint("a", xyz="0 0 7"), joint("g", "fixed"))
        assert await harness.set(publisher, robot_description=text) == [(True, "")]
        assert harness.descriptions[-1] == text
        assert harness.tf_static[-1].batch.children == ("g_link",)
        # The next message moves the new joint, although the rate is limited.
        await harness.move({"a": 1.0})
        assert harness.buffer.lookup("base", "a_link")[2] == 7.0

    async def test_old_static_transforms_are_not_replayed(self, harness):
        publisher = harness.robot_state_publisher(robot(joint("f", "fixed")))
        await harness.set(publisher, robot_description=robot(joint("a")))
        assert len(harness.tf_static[-1].batch) == 0

    @pytest.mark.parametrize(
        ("text", "reason"),
        [
            ("", "Empty URDF is not allowed"),
            ("not XML", "Unable to initialize urdf::model from robot description"),
            ("<robot name='r'/>", "Unable to initialize urdf::model from robot description"),
        ],
    )
    async def test_invalid_description_is_rejected_and_last_one_stays(self, harness, text, reason):
        publisher = harness.robot_state_publisher(TWO_JOINTS)
        assert await harness.set(publisher, robot_description=text) == [(False, reason)]
        assert publisher.node.get_parameter("robot_description").value == TWO_JOINTS
        assert harness.descriptions == [TWO_JOINTS]
        await harness.move({"a": 0.0})
        assert harness.moved_frames() == [["a_link"]]

    async def test_invalid_frequency_is_rejected(self, harness):
        publisher = harness.robot_state_publisher(TWO_JOINTS)
        reason = "publish_frequency must be between 0 and 1000"
        assert await harness.set(publisher, publish_frequency=2000.0) == [(False, reason)]
        assert await harness.set(publisher, publish_frequency=0.0) == [(False, reason)]

    async def test_description_of_wrong_type_is_rejected(self, harness):
        publisher = harness.robot_state_publisher(TWO_JOINTS)
        ((successful, reason),) = await harness.set(publisher, robot_description=3)
        assert not successful
        assert reason == "Wrong parameter type, expected 'Type.STRING' got 'Type.INTEGER'"

    async def test_ignore_timestamp_can_be_enabled_at_runtime(self, harness):
        publisher = harness.robot_state_publisher(TWO_JOINTS)
        await harness.set(publisher, ignore_timestamp=True)
        await harness.move({"a": 0.0}, stamp_ns=0)
        assert len(harness.tf) == 1


@pytest.mark.parametrize("package", TUTORIAL_PACKAGES, ids=lambda package: package.parent.name)
async def test_tutorial_robot_matches_forward_kinematics(harness, package):
    text = (package / "urdf" / "mbot_base.urdf").read_text(encoding="utf-8")
    harness.robot_state_publisher(text)
    model = DescriptionLibrary().read(text).robot
    tree = KinematicTree(model)
    turned = {name: 0.3 * number for number, name in enumerate(tree.joint_names, 1)}
    await harness.move(turned)
    poses = tree.forward(np.array(list(turned.values())))
    snapshot = harness.buffer.snapshot(model.root, 0)
    assert set(snapshot.names) == set(model.links)
    for name, pose in zip(tree.link_names, poses, strict=True):
        np.testing.assert_allclose(
            snapshot.poses[snapshot.names.index(name), :3], pose[:3, 3], atol=1e-12, err_msg=name
        )
    np.testing.assert_allclose(harness.buffer.lookup("base_link", "left_wheel_link")[:3], [0, 0.19, -0.05])


async def test_qos_overrides_are_applied(harness):
    publisher = harness.robot_state_publisher(
        TWO_JOINTS,
        **{"qos_overrides./tf.publisher.depth": 7, "qos_overrides./joint_states.subscription.reliability": "reliable"},
    )
    (info,) = publisher.node.get_publishers_info_by_topic("/tf")
    assert info.qos_profile.depth == 7
    infos = publisher.node.get_subscriptions_info_by_topic("/joint_states")
    own_info = next(info for info in infos if info.node_name == "robot_state_publisher")
    assert own_info.qos_profile.reliability is ReliabilityPolicy.RELIABLE
    names = [name for name in publisher.node.parameter_names() if name.startswith("qos_overrides")]
    assert sorted(names) == [
        *(f"qos_overrides./joint_states.subscription.{policy}" for policy in ("depth", "history", "reliability")),
        *(f"qos_overrides./tf.publisher.{policy}" for policy in ("depth", "durability", "history", "reliability")),
        *(f"qos_overrides./tf_static.publisher.{policy}" for policy in ("depth", "history", "reliability")),
    ]
