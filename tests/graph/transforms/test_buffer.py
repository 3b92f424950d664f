"""The transform buffer: the forest of frames, snapshots and ages."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.geometry.arrays import compose, invert, quaternion_from_rpy
from linkwright.graph import (
    STATIC_TF_PUBLISHER_QOS,
    TF_QOS,
    ConnectivityException,
    InvalidArgumentException,
    LookupException,
    TransformBuffer,
    TransformException,
    TransformListener,
)
from linkwright.messages import TFMessage, TransformBatch

SECOND_NS = 1_000_000_000


def make_message(*transforms):
    """Return transforms (parent, child, pose), or (parent, child, x) for a translation along x."""
    rows = [[pose, 0, 0, 0, 0, 0, 1] if np.isscalar(pose) else pose for _, _, pose in transforms]
    parents, children = tuple(parent for parent, _, _ in transforms), tuple(child for _, child, _ in transforms)
    return TFMessage(batch=TransformBatch(parents, children, 0, np.array(rows, dtype=float).reshape(-1, 7)))


def make_pose(xyz, rpy):
    return np.array([*xyz, *quaternion_from_rpy(rpy)])


def make_buffer(*transforms, on_problem=None):
    buffer = TransformBuffer(on_problem)
    buffer.update(make_message(*transforms), static=False, now_ns=0)
    return buffer


angles = st.floats(-3.0, 3.0)
poses = st.builds(
    make_pose,
    st.tuples(*[st.floats(-2.0, 2.0)] * 3),
    st.tuples(angles, angles, angles),
)


@st.composite
def forests(draw):
    """Draw parents and local poses of up to 24 frames, in any order of arrival.

    A parent is an earlier frame, or -1.
    """
    count = draw(st.integers(1, 24))
    parents = [draw(st.integers(-1, number - 1)) for number in range(count)]
    local = [draw(poses) for _ in range(count)]
    return parents, local, draw(st.permutations(range(count))), draw(st.integers(0, count - 1))


@given(forests())
def test_snapshots_match_step_by_step_composition(forest):
    parents, local, order, fixed = forest
    attached = [number for number in order if parents[number] >= 0]
    buffer = TransformBuffer()
    for number in attached:
        transform = (f"f{parents[number]}", f"f{number}", local[number])
        buffer.update(make_message(transform), static=False, now_ns=0)

    def in_root(number):
        if parents[number] < 0:
            return np.array([0, 0, 0, 0, 0, 0, 1.0]), number
        above, root = in_root(parents[number])
        return compose(above, local[number]), root

    fixed_in_root, root = in_root(fixed)
    snapshot = buffer.snapshot(f"f{fixed}", 0)
    assert set(snapshot.names) == {f"f{number}" for number in attached} | {f"f{parents[number]}" for number in attached}
    for row, name in enumerate(snapshot.names):
        number = int(name[1:])
        parent = snapshot.parents[row]
        assert (snapshot.names[parent] if parent >= 0 else "f-1") == f"f{parents[number]}"
        own_in_root, own_root = in_root(number)
        if own_root == root:
            expected = compose(invert(fixed_in_root), own_in_root)
            np.testing.assert_allclose(snapshot.poses[row], expected, atol=1e-9)
            np.testing.assert_allclose(buffer.lookup(f"f{fixed}", name), expected, atol=1e-9)
        else:
            assert np.isnan(snapshot.poses[row]).all()
            if f"f{fixed}" in snapshot.names:
                with pytest.raises(ConnectivityException):
                    buffer.lookup(f"f{fixed}", name)


def test_long_chain_is_composed_completely():
    buffer = make_buffer(*((f"f{number}", f"f{number + 1}", 1.0) for number in range(700)))
    snapshot = buffer.snapshot("f0", 0)
    np.testing.assert_allclose(snapshot.poses[:, 0], [int(name[1:]) for name in snapshot.names])
    assert buffer.lookup("f700", "f100")[0] == pytest.approx(-600.0)


def test_revision_changes_only_with_names_and_parents():
    buffer = make_buffer(("world", "base", 1.0), ("base", "arm", 1.0))
    first = buffer.snapshot("world", 0)
    buffer.update(make_message(("world", "base", 2.0), ("base", "arm", 3.0)), static=False, now_ns=1)
    second = buffer.snapshot("arm", 1)
    assert (first.revision, first.names, first.parents) == (second.revision, second.names, second.parents)
    assert first.names == ("world", "base", "arm")
    assert first.parents == (-1, 0, 1)
    buffer.update(make_message(("arm", "hand", 1.0)), static=False, now_ns=2)
    third = buffer.snapshot("world", 2)
    assert third.revision != second.revision
    buffer.update(make_message(("base", "hand", 1.0)), static=False, now_ns=3)
    fourth = buffer.snapshot("world", 3)
    assert fourth.revision != third.revision
    assert fourth.names == third.names
    assert fourth.parents == (-1, 0, 1, 1)


def test_two_publishers_of_frame_alternate():
    buffer = TransformBuffer()
    first_message, second_message = make_message(("world", "base", 1.0)), make_message(("odom", "base", 5.0))
    for _ in range(2):
        buffer.update(first_message, static=False, now_ns=0)
        assert buffer.lookup("world", "base")[0] == 1.0
        buffer.update(second_message, static=False, now_ns=0)
        assert buffer.lookup("odom", "base")[0] == 5.0
        with pytest.raises(ConnectivityException):
            buffer.lookup("world", "base")


def test_last_duplicate_in_message_applies():
    buffer = make_buffer(("world", "base", 1.0), ("world", "base", 2.0))
    assert buffer.lookup("world", "base")[0] == 2.0


def test_ages_count_from_last_update_of_dynamic_frames():
    buffer = TransformBuffer()
    buffer.update(make_message(("world", "base", 1.0)), static=True, now_ns=0)
    buffer.update(make_message(("base", "arm", 1.0)), static=False, now_ns=SECOND_NS)
    snapshot = buffer.snapshot("world", 3 * SECOND_NS)
    assert dict(zip(snapshot.names, snapshot.ages.tolist(), strict=True)) == {"world": 0, "base": 0, "arm": 2.0}
    assert buffer.snapshot("world", 0).ages.tolist() == [0.0, 0.0, 0.0]
    buffer.update(make_message(("base", "arm", 1.0)), static=True, now_ns=SECOND_NS)
    assert buffer.snapshot("world", 3 * SECOND_NS).ages.max() == 0.0


def test_unknown_fixed_frame_has_no_poses():
    snapshot = make_buffer(("world", "base", 1.0)).snapshot("map", 0)
    assert snapshot.names == ("world", "base")
    assert np.isnan(snapshot.poses).all()
    empty = TransformBuffer().snapshot("map", 0)
    assert (empty.names, empty.parents, empty.poses.shape, empty.ages.shape) == ((), (), (0, 7), (0,))


@pytest.mark.parametrize(
    ("target", "source", "error", "text"),
    [
        (
            "map",
            "base",
            LookupException,
            '"map" passed to lookupTransform argument target_frame does not exist. ',
        ),
        (
            "base",
            "bas",
            LookupException,
            '"bas" passed to lookupTransform argument source_frame does not exist. ',
        ),
        (
            "base",
            "camera",
            ConnectivityException,
            (
                "Could not find a connection between 'base' and 'camera' because they are not part of the same tree."
                "Tf has two or more unconnected trees."
            ),
        ),
        (
            "",
            "base",
            InvalidArgumentException,
            'Invalid argument "" passed to lookupTransform argument target_frame - in tf2 frame_ids cannot be empty',
        ),
        (
            "base",
            "/base",
            InvalidArgumentException,
            (
                'Invalid argument "/base" passed to lookupTransform argument source_frame - in tf2 frame_ids cannot '
                "start with a '/'"
            ),
        ),
    ],
)
def test_lookup_errors_match_tf2(target, source, error, text):
    buffer = make_buffer(("world", "base", 1.0), ("stand", "camera", 1.0))
    with pytest.raises(error) as caught:
        buffer.lookup(target, source)
    assert isinstance(caught.value, TransformException)
    assert caught.value.diagnostics[0].message == text


def test_frames_in_loop_have_no_poses():
    buffer = make_buffer(("a", "b", 1.0), ("b", "c", 1.0), ("c", "a", 1.0), ("c", "below", 1.0), ("w", "x", 1.0))
    snapshot = buffer.snapshot("w", 0)
    assert [name for name, row in zip(snapshot.names, snapshot.poses, strict=True) if not np.isnan(row).any()] == [
        "w",
        "x",
    ]
    assert np.isnan(buffer.snapshot("a", 0).poses).all()
    with pytest.raises(LookupException, match="The tf tree is invalid because it contains a loop"):
        buffer.lookup("w", "below")
    buffer.update(make_message(("w", "a", 1.0)), static=False, now_ns=0)
    assert buffer.lookup("w", "below")[0] == 4.0


def test_invalid_transforms_are_ignored_and_reported_once():
    problems = []
    invalid = make_message(
        ("world", "nan", [np.nan, 0, 0, 0, 0, 0, 1]),
        ("world", "long", [0, 0, 0, 0, 0, 0, 1.1]),
        ("same", "same", 1.0),
        ("world", "", 1.0),
        ("", "orphan", 1.0),
        ("/world", "/good", 1.0),
    )
    buffer = TransformBuffer(problems.append)
    for _ in range(3):
        buffer.update(invalid, static=False, now_ns=0)
    assert buffer.lookup("world", "good")[0] == 1.0
    for name in ("nan", "long"):
        with pytest.raises(ConnectivityException):
            buffer.lookup("world", name)
    assert "orphan" not in buffer.frames()
    assert sorted(problem.partition(":")[0] for problem in problems) == [
        "TF_DENORMALIZED_QUATERNION",
        "TF_NAN_INPUT",
        "TF_NO_CHILD_FRAME_ID",
        "TF_NO_FRAME_ID",
        "TF_SELF_TRANSFORM",
    ]
    buffer.update(make_message(("world", "nan", 3.0)), static=False, now_ns=0)
    assert buffer.lookup("world", "nan")[0] == 3.0


def test_frame_is_connected_after_invalid_transform_becomes_valid():
    """The parents in a message count only after its transforms were accepted."""
    buffer = TransformBuffer()
    children, parents = ("base",), ("world",)
    for x in (np.nan, 1.0):
        rows = np.array([[x, 0, 0, 0, 0, 0, 1]])
        batch = TFMessage(batch=TransformBatch(parents, children, 0, rows))
        buffer.update(batch, static=False, now_ns=0)
    assert buffer.lookup("world", "base")[0] == 1.0


def test_removed_frames_disappear_unless_they_have_children():
    buffer = make_buffer(("world", "base", 1.0), ("base", "arm", 1.0), ("arm", "hand", 1.0), ("arm", "camera", 1.0))
    before = buffer.snapshot("world", 0).revision
    buffer.remove(["arm", "hand", "never heard of"])
    assert buffer.frames() == ("world", "base", "arm", "camera")
    snapshot = buffer.snapshot("world", 0)
    assert snapshot.revision != before
    assert snapshot.parents == (-1, 0, -1, 2)
    assert buffer.lookup("world", "base")[0] == 1.0
    assert buffer.lookup("arm", "camera")[0] == 1.0
    buffer.update(make_message(("base", "arm", 4.0)), static=False, now_ns=0)
    assert buffer.lookup("world", "camera")[0] == 6.0
    buffer.remove(buffer.frames())
    assert buffer.frames() == ()


def test_many_different_frame_lists_are_accepted():
    buffer = TransformBuffer()
    for number in range(200):
        buffer.update(make_message((f"f{number}", f"f{number + 1}", 1.0)), static=False, now_ns=0)
    assert buffer.lookup("f0", "f200")[0] == pytest.approx(200.0)


async def test_transform_listener_fills_buffer(graph, clock):
    buffer = TransformBuffer()
    robot, viewer = graph.create_node("robot", namespace="/mbot"), graph.create_node("viewer")
    static = robot.create_publisher(TFMessage, "/tf_static", STATIC_TF_PUBLISHER_QOS)
    static.publish(make_message(("base", "camera", 2.0)))
    TransformListener(buffer, viewer)
    robot.create_publisher(TFMessage, "/tf", TF_QOS).publish(make_message(("world", "base", 1.0)))
    await graph.settle()
    await clock.advance(2.0)
    assert buffer.lookup("world", "camera")[0] == 3.0
    snapshot = buffer.snapshot("world", clock.now_ns())
    assert dict(zip(snapshot.names, snapshot.ages.tolist(), strict=True)) == {"base": 2.0, "camera": 0, "world": 0}
