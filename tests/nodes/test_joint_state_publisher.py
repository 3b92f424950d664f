"""`joint_state_publisher`: rates, defaults, sources and mimic joints."""

from math import inf, pi

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.messages import Header, JointState
from linkwright.nodes import NodeOptions
from linkwright.nodes.joint_layout import JointSettings, make_layout
from linkwright.nodes.joint_state_publisher import JointStatePublisher
from linkwright.urdf import Joint, Limit, Link, Robot
from tests.nodes.harness import joint, mimic, robot

SAFETY = "<safety_controller k_velocity='1' soft_lower_limit='-0.5' soft_upper_limit='0.5'/>"
CHAIN = robot(
    joint("c", content=mimic("b", "multiplier='3' offset='0.1'")),
    joint("b", content=mimic("a", "multiplier='2' offset='0.5'")),
    joint("a"),
)


async def test_node_waits_for_description_and_publishes_at_rate(harness, clock, logged):
    harness.joint_state_publisher()
    await clock.advance(1.0)
    assert harness.joint_states == []
    assert logged("INFO") == ["Waiting for robot_description to be published on the robot_description topic..."]
    await harness.describe(robot(joint("a")))
    assert len(harness.joint_states) == 1
    assert harness.joint_states[0].header.stamp.nanoseconds == clock.now_ns()
    await clock.advance(1.0)
    assert len(harness.joint_states) == 11
    assert harness.joint_states[-1].name == ["a"]
    assert list(harness.joint_states[-1].position) == [0.0]
    assert list(harness.joint_states[-1].velocity) == list(harness.joint_states[-1].effort) == []


async def test_rate_and_default_quantities_are_configurable(harness, clock):
    harness.joint_state_publisher(
        rate=2.5,
        publish_default_positions=False,
        publish_default_velocities=True,
        publish_default_efforts=True,
    )
    await harness.describe(robot(joint("a")))
    await clock.advance(2.0)
    assert len(harness.joint_states) == 1 + 5
    message = harness.joint_states[-1]
    assert (list(message.position), list(message.velocity), list(message.effort)) == ([], [0.0], [0.0])


async def test_joints_keep_file_order_and_fixed_ones_are_omitted(harness):
    harness.joint_state_publisher()
    await harness.describe(
        robot(
            joint("z", "continuous"),
            joint("f", "fixed"),
            joint("m", content=mimic("a")),
            joint("p", "planar"),
            joint("l", "floating"),
            joint("a", "prismatic"),
        )
    )
    assert harness.joint_states[-1].name == ["z", "m", "a"]


async def test_robot_without_joints_publishes_nothing(harness, clock):
    harness.joint_state_publisher()
    await harness.describe(robot(joint("f", "fixed")))
    await clock.advance(1.0)
    assert harness.joint_states == []


@pytest.mark.parametrize(
    ("text", "parameters", "expected"),
    [
        (joint("j", limit="lower='-1' upper='3'"), {}, 0.0),
        (joint("j", limit="lower='1' upper='3'"), {}, 2.0),
        (joint("j", limit="lower='-3' upper='-1'"), {}, -2.0),
        (joint("j", limit="lower='0' upper='3'"), {}, 0.0),
        (joint("j", "continuous"), {}, 0.0),
        (joint("j"), {"zeros": {"j": 1.5}}, 1.5),
        (joint("j"), {"zeros": {"j": 1}}, 1.0),
        (joint("j"), {"zeros.j": 9.0}, 9.0),
        (joint("j", content=SAFETY, limit="lower='0.25' upper='3'"), {}, 0.375),
        (
            joint("j", content=SAFETY, limit="lower='0.25' upper='3'"),
            {"use_smallest_joint_limits": False},
            1.625,
        ),
    ],
)
async def test_initial_positions_respect_limits_and_zeros(harness, text, parameters, expected):
    harness.joint_state_publisher(**parameters)
    await harness.describe(robot(text))
    assert harness.positions() == {"j": pytest.approx(expected)}


class TestLimits:
    def ranges(self, publisher):
        return {name: (limits.lower, limits.upper) for name, limits in publisher.joints.layout.ranges.items()}

    async def test_limits_by_joint_type(self, harness):
        publisher = harness.joint_state_publisher()
        await harness.describe(
            robot(
                joint("revolute"),
                joint("continuous", "continuous", content="<limit lower='-9' upper='9' effort='1' velocity='1'/>"),
                joint("soft", content=SAFETY),
                joint("half", content="<safety_controller k_velocity='1' soft_upper_limit='0.5'/>"),
            )
        )
        assert self.ranges(publisher) == {
            "revolute": (-1.0, 2.0),
            "continuous": (-pi, pi),
            "soft": (-0.5, 0.5),
            "half": (-1.0, 0.5),
        }

    def test_infinite_limits_have_finite_range(self):
        limits = {"wide": (-inf, inf), "up": (1.0, inf), "down": (-inf, 1.0)}
        joints = {
            name: Joint(name, "revolute" if name == "wide" else "prismatic", "base", name, limit=Limit(*pair))
            for name, pair in limits.items()
        }
        links = {name: Link(name) for name in ("base", *joints)}
        layout = make_layout(Robot("robot", "base", links, joints, {}), JointSettings())
        ranges = {name: (limits.lower, limits.upper) for name, limits in layout.ranges.items()}
        assert ranges == {"wide": (-pi, pi), "up": (1.0, 3.0), "down": (-1.0, 1.0)}
        assert [joint.zero for joint in layout.free] == [0.0, 2.0, 0.0]

    async def test_joints_with_missing_limits_are_skipped(self, harness, logged):
        harness.joint_state_publisher()
        await harness.describe(robot(joint("j", limit="upper='1'"), joint("k", limit="lower='1'"), joint("a")))
        assert harness.joint_states[-1].name == ["a"]
        assert logged("WARN") == [
            '"lower" limit must be specified for joint "j" of type "revolute"',
            '"upper" limit must be specified for joint "k" of type "revolute"',
        ]


class TestDependentJoints:
    async def test_mimic_chains_are_followed(self, harness):
        harness.joint_state_publisher(zeros={"a": 1.0})
        await harness.describe(CHAIN)
        positions = harness.positions()
        assert list(positions) == ["c", "b", "a"]
        assert positions["a"] == 1.0
        assert positions["b"] == pytest.approx(2 * 1.0 + 0.5)
        assert positions["c"] == pytest.approx(3 * positions["b"] + 0.1)

    async def test_mimic_velocity_is_scaled_and_effort_copied(self, harness, clock):
        harness.joint_state_publisher(source_list=["measured"])
        await harness.describe(CHAIN)
        source = harness.node.create_publisher(JointState, "measured", 10)
        source.publish(JointState(name=["a", "b"], position=[1.0, 9.0], velocity=[0.5, 9.0], effort=[4.0, 9.0]))
        await clock.advance(0.1)
        message = harness.joint_states[-1]
        assert list(message.velocity) == pytest.approx([3.0, 1.0, 0.5])
        assert list(message.effort) == [4.0, 4.0, 4.0]
        assert harness.positions()["b"] == pytest.approx(2.5)

    async def test_mimic_tags_can_be_disabled(self, harness):
        harness.joint_state_publisher(use_mimic_tags=False)
        await harness.describe(CHAIN)
        assert harness.positions() == {"c": 0.0, "b": 0.0, "a": 0.0}

    async def test_dependent_joints_override_mimic_tags(self, harness):
        """In joint_state_publisher 2.4, the description's tag overrides the parameter."""
        dependent = {"b": {"parent": "a", "factor": 5.0}, "dotted.name": {"parent": "a", "offset": 1}}
        harness.joint_state_publisher(zeros={"a": 1.0}, dependent_joints=dependent)
        for _ in range(2):
            await harness.describe(CHAIN.replace("</robot>", joint("dotted.name", child="d") + "</robot>"))
            positions = harness.positions()
            assert positions["b"] == pytest.approx(5.0)
            assert positions["c"] == pytest.approx(15.1)
            assert positions["dotted.name"] == pytest.approx(2.0)

    async def test_mimic_cycle_is_rejected_and_last_robot_stays(self, harness, logged):
        publisher = harness.joint_state_publisher()
        await harness.describe(robot(joint("a")))
        await harness.describe(robot(joint("a", content=mimic("b")), joint("b", content=mimic("a"))))
        assert logged("ERROR") == ["Found an infinite recursive mimic chain: ['a', 'b', 'a']"]
        assert list(publisher.joints.layout.ranges) == ["a"]

    async def test_mimic_of_fixed_joint_is_reported(self, harness, logged):
        harness.joint_state_publisher()
        await harness.describe(robot(joint("f", "fixed"), joint("a", content=mimic("f", "offset='0.25'")), joint("b")))
        assert logged("WARN") == ["joint 'a' follows joint 'f', which does not move"]
        assert harness.positions() == {"a": 0.25, "b": 0.0}


class TestSources:
    async def test_source_positions_are_not_clamped(self, harness, clock):
        harness.joint_state_publisher(source_list=["left", "right"])
        await harness.describe(robot(joint("a"), joint("b")))
        for topic, name, position in (("left", "a", 99.0), ("right", "b", 1.0), ("right", "unknown", 1.0)):
            source = harness.node.create_publisher(JointState, topic, 10)
            source.publish(JointState(header=Header(), name=[name], position=[position]))
        await harness.graph.settle()
        assert len(harness.joint_states) == 1
        await clock.advance(0.1)
        assert harness.positions() == {"a": 99.0, "b": 1.0}

    async def test_joint_without_source_data_is_zero(self, harness, clock):
        harness.joint_state_publisher(source_list=["source"], publish_default_positions=False)
        await harness.describe(robot(joint("a"), joint("b")))
        assert list(harness.joint_states[-1].position) == []
        source = harness.node.create_publisher(JointState, "source", 10)
        source.publish(JointState(header=Header(), name=["b"], position=np.array([1.0])))
        await clock.advance(0.1)
        assert harness.positions() == {"a": 0.0, "b": 1.0}


async def test_sweep_reverses_at_limits_and_wraps_continuous_joints(harness, clock):
    harness.joint_state_publisher(delta=1.0, rate=1)
    await harness.describe(robot(joint("r", limit="lower='-0.5' upper='1.5'"), joint("c", "continuous")))
    positions = []
    for _ in range(8):
        await clock.advance(1.0)
        positions.append(tuple(harness.positions().values()))
    revolute, continuous = zip(*positions, strict=True)
    assert revolute == (1.0, 1.5, 0.5, -0.5, -0.5, 0.5, 1.5, 1.5)
    assert continuous == pytest.approx((1.0, 2.0, 3.0, -pi, 1 - pi, 2 - pi, 3 - pi, 4 - pi))


class TestNewDescription:
    async def test_remaining_joints_keep_positions(self, harness, clock):
        publisher = harness.joint_state_publisher(source_list=["source"])
        await harness.describe(robot(joint("a"), joint("b"), joint("gone")))
        publisher.joints.set_position("a", 1.5)
        publisher.joints.set_position("b", 0.5)
        await harness.describe(robot(joint("new"), joint("b"), joint("a", limit="lower='-1' upper='1'")))
        assert harness.positions() == {"new": 0.0, "b": 0.5, "a": 1.0}

    async def test_unmoved_joint_takes_its_new_zero(self, harness):
        harness.joint_state_publisher()
        await harness.describe(robot(joint("a")))
        await harness.describe(robot(joint("a", limit="lower='1' upper='3'")))
        assert harness.positions() == {"a": 2.0}

    async def test_malformed_description_is_ignored(self, harness, clock, logged):
        harness.joint_state_publisher()
        await harness.describe(robot(joint("a")))
        await harness.describe("<robot")
        assert logged("WARN") == ["Invalid robot_description given, ignoring"]
        await clock.advance(0.1)
        assert list(harness.positions()) == ["a"]

    async def test_new_description_is_published_without_delay(self, harness, clock):
        """A new description arrives without a tick of the clock.

        So do joint states and transforms of a saved file.
        """
        publisher = harness.robot_state_publisher(robot(joint("a")))
        harness.joint_state_publisher()
        await harness.graph.settle()
        await harness.set(publisher, robot_description=robot(joint("a", xyz="0 0 5"), joint("b")))
        assert harness.buffer.lookup("base", "a_link")[2] == 5.0
        assert harness.moved_frames()[-1] == ["a_link", "b_link"]


class TestFile:
    async def test_file_is_read_instead_of_topic(self, harness, tmp_path):
        path = tmp_path / "robot.urdf"
        path.write_text(robot(joint("from_file")), encoding="utf-8")
        JointStatePublisher(harness.graph, NodeOptions(arguments=[str(path)]))
        await harness.describe(robot(joint("from_topic")))
        assert list(harness.positions()) == ["from_file"]

    async def test_invalid_files_and_arguments_are_rejected(self, harness, tmp_path, logged):
        invalid_file = tmp_path / "bad.urdf"
        invalid_file.write_text("<robot", encoding="utf-8")
        for arguments, message in (
            (["nowhere.urdf"], "URDF file 'nowhere.urdf' cannot be read: No such file or directory"),
            ([str(invalid_file)], ""),
            (["a.urdf", "b.urdf"], "unrecognized arguments: b.urdf"),
        ):
            with pytest.raises(LinkwrightError) as caught:
                JointStatePublisher(harness.graph, NodeOptions(arguments=arguments))
            assert message in str(caught.value)
        assert len(logged("FATAL")) == 3
        assert harness.graph.node_names() == ["/test_node"]


class TestParameters:
    @pytest.mark.parametrize(
        ("parameters", "messages"),
        [
            ({"rate": 0}, ["parameter 'rate' must be a positive number, but it is 0"]),
            ({"rate": "fast"}, ["parameter 'rate' must be a positive number, but it is 'fast'"]),
            ({"delta": True}, ["parameter 'delta' must be a number, but it is True"]),
            (
                {"use_mimic_tags": "yes", "source_list": [1]},
                [
                    "parameter 'use_mimic_tags' must be true or false, but it is 'yes'",
                    "parameter 'source_list' must be a list of topic names, but it is [1]",
                ],
            ),
            ({"zeros": {"a": "up"}}, ["parameter 'zeros.a' must be a number, but it is 'up'"]),
            (
                {"dependent_joints": {"a": {"factor": 2.0}}},
                ["parameter 'dependent_joints.a.parent' must be the name of a joint, but it is not given"],
            ),
            (
                {"dependent_joints": {"a": {"parent": "b", "faktor": 2.0}}},
                ["invalid dependent_joint name 'a.faktor': write JOINT.parent, JOINT.factor or JOINT.offset"],
            ),
        ],
    )
    async def test_invalid_parameters_are_all_reported(self, harness, parameters, messages):
        with pytest.raises(LinkwrightError) as caught:
            harness.joint_state_publisher(**parameters)
        assert [diagnostic.message for diagnostic in caught.value.diagnostics] == messages
        assert {diagnostic.code for diagnostic in caught.value.diagnostics} == {"NODE201"}

    async def test_parameter_changes_take_effect(self, harness, clock):
        publisher = harness.joint_state_publisher(zeros={"b": 0.5})
        await harness.describe(CHAIN)
        assert await harness.set(publisher, rate=100) == [(True, "")]
        harness.joint_states.clear()
        await clock.advance(0.1)
        assert len(harness.joint_states) == 10
        assert await harness.set(publisher, use_mimic_tags=False) == [(True, "")]
        assert harness.positions() == {"c": 0.0, "b": 0.5, "a": 0.0}
        await harness.set(publisher, source_list=["source"])
        assert harness.graph.count_subscribers("/source") == 1
        await harness.set(publisher, source_list=["other"])
        assert harness.graph.count_subscribers("/source") == 0

    async def test_invalid_parameter_changes_are_rejected(self, harness):
        publisher = harness.joint_state_publisher(dependent_joints={"b": {"parent": "c"}}, use_mimic_tags=False)
        await harness.describe(CHAIN)
        ((successful, reason),) = await harness.set(publisher, use_mimic_tags=True)
        assert not successful
        assert reason == "Found an infinite recursive mimic chain: ['c', 'b', 'c']"
        assert await harness.set(publisher, rate=-1) == [
            (False, "parameter 'rate' must be a positive number, but it is -1")
        ]


async def test_other_formats_are_named_in_warning(harness, logged, tmp_path):
    harness.joint_state_publisher()
    await harness.describe("<?xml version='1.0'?><sdf version='1.7'><model name='a'/></sdf>")
    await harness.describe("<COLLADA/>")
    await harness.describe("nothing")
    assert logged("WARN") == [
        "Invalid robot_description given, ignoring: it is SDF, and this node reads URDF",
        "Invalid robot_description given, ignoring: it is COLLADA, and this node reads URDF",
        "Invalid robot_description given, ignoring",
    ]
    (tmp_path / "robot.sdf").write_text("<sdf/>")
    with pytest.raises(LinkwrightError) as caught:
        JointStatePublisher(harness.graph, harness.options({}, arguments=[str(tmp_path / "robot.sdf")]))
    assert caught.value.diagnostics[0].code == "NODE205"
