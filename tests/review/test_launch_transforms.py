"""Static transforms that other nodes of a launch file publish, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences, subject

STATIC = '<node pkg="tf" type="static_transform_publisher" name="still" args="0 0 0 0 0 0 /PARENT /CHILD 20"/>'
FAKE = '<node pkg="fake_localization" type="fake_localization" name="fake"/>'
LOADING = '<node pkg="arm" type="place.py" name="place"><rosparam command="load" file="$(find arm)/place.yaml"/></node>'
INLINE = '<node pkg="arm" type="place.py" name="place"><param name="frames" value="hand, tool"/></node>'
CAMERA = '<node pkg="camera" type="camera" name="camera"/>'


@pytest.mark.parametrize(
    ("parent", "child", "node", "publisher"),
    [
        ("map", "odom", FAKE, "fake_localization/fake_localization"),
        ("base", "camera", FAKE, None),
        ("hand", "tool", LOADING, "arm/place.py"),
        ("hand", "tool", INLINE, "arm/place.py"),
        ("hand", "finger", LOADING, None),
        ("map", "odom", CAMERA, None),
        ("map", "odom", "", None),
    ],
)
def test_static_transform_that_an_added_node_may_publish_is_not_missing(
    repository, compare, parent, child, node, publisher
):
    static = STATIC.replace("PARENT", parent).replace("CHILD", child)
    files = {
        "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
        "arm/place.yaml": "parent: hand\nchild: tool\n",
    }
    repository.commit({**files, "arm/launch/arm.launch": f"<launch>{static}</launch>"})
    repository.write({"arm/launch/arm.launch": f"<launch>{node}</launch>"})
    changes = subject(compare(repository), "arm/launch/arm.launch").changes
    (removed,) = [change for change in changes if "'tf/static_transform_publisher'" in str(change.sentence)]
    if publisher is None:
        assert str(removed.reason) == f"the transform of the frame '/{child}' is missing"
    else:
        assert removed.reason is None
        assert str(removed.sentence).endswith(f"; node '{publisher}' may publish its transform")


@pytest.mark.parametrize(("link", "is_breaking"), [("camera", False), ("lens", True)])
def test_static_transform_that_the_description_of_a_newly_started_robot_has(repository, compare, link, is_breaking):
    static = STATIC.replace("PARENT", "base").replace("CHILD", "camera")
    robot = f'<robot name="a"><link name="base"/><link name="{link}"/></robot>'
    state = '<node pkg="robot_state_publisher" type="robot_state_publisher" name="state"/>'
    files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/urdf/arm.urdf": robot}
    repository.commit({**files, "arm/launch/map.launch": f"<launch>{static}</launch>",
                       "arm/launch/arm.launch": "<launch></launch>"})  # fmt: skip
    repository.write(
        {"arm/launch/map.launch": "<launch></launch>", "arm/launch/arm.launch": f"<launch>{state}</launch>"}
    )
    (removed,) = subject(compare(repository), "arm/launch/map.launch").changes
    assert (removed.reason is not None) is is_breaking


@pytest.mark.parametrize(
    ("link", "includes", "program", "is_breaking"),
    [
        ("camera", True, "robot_state_publisher", False),
        ("camera", True, "joint_state_publisher", False),
        ("camera", True, "driver", True),
        ("camera", False, "robot_state_publisher", True),
        ("lens", True, "robot_state_publisher", True),
    ],
)
def test_frame_that_is_a_link_of_a_robot_started_together_is_not_missing(
    repository, compare, link, includes, program, is_breaking
):
    static = STATIC.replace("PARENT", "base").replace("CHILD", "camera")
    robot = f'<robot name="a"><link name="base"/><link name="{link}"/></robot>'
    include = '<include file="$(find arm)/launch/map.launch"/>' if includes else ""
    all_text = f'<launch><node pkg="{program}" type="{program}" name="state"/>{include}</launch>'
    repository.commit(
        {
            "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
            "arm/urdf/arm.urdf": robot,
            "arm/launch/map.launch": f"<launch>{static}</launch>",
            "arm/launch/all.launch": all_text,
        }
    )
    repository.write({"arm/launch/map.launch": "<launch></launch>"})
    (removed,) = subject(compare(repository), "arm/launch/map.launch").changes
    assert (removed.reason is not None) is is_breaking
    assert str(removed.sentence).endswith("; the robot has the frame as a link") is not is_breaking


@pytest.mark.parametrize(("link", "is_breaking"), [("base_link", False), ("trunk", True)])
def test_a_frame_that_a_parameter_no_longer_names_is_there_as_a_link(repository, compare, link, is_breaking):
    driver = '<node pkg="arm" type="driver" name="driver"><param name="laser_frame_id" value="base_link"/></node>'
    state = '<node pkg="robot_state_publisher" type="robot_state_publisher" name="state"/>'
    robot = f'<robot name="a"><link name="{link}"/><link name="other"/></robot>'
    path = "arm/launch/arm.launch"
    files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/urdf/arm.urdf": robot}
    repository.commit({**files, path: f"<launch>{state}{driver}</launch>"})
    repository.write({path: f"<launch>{state}{driver}</launch>".replace('"base_link"', '"other"')})
    (change,) = subject(compare(repository), path).changes
    assert (change.reason is not None) is is_breaking


@pytest.mark.parametrize(
    ("frames", "file", "argument", "may_publish"),
    [
        ("map odom", "nav_stack)/launch/mapping.launch", "", True),
        ("map odom", "camera)/launch/driver.launch", "", False),
        ("base tool", "nav_stack)/launch/mapping.launch", "", False),
        ("base tool", "camera)/launch/driver.launch", '<arg name="frame" value="tool"/>', True),
        ("map odom", "arm)/launch/mapping.launch", "", False),
    ],
)
def test_included_file_of_another_repository_may_publish_a_transform(
    repository, compare, frames, file, argument, may_publish
):
    parent, child = frames.split()
    static = STATIC.replace("/PARENT", parent).replace("/CHILD", child)
    package = PACKAGE_XML.replace("arm_description", "arm")
    included = {"arm/launch/mapping.launch": "<launch/>"}
    repository.commit({"arm/package.xml": package, "arm/launch/arm.launch": f"<launch>{static}</launch>", **included})
    text = f'<launch><include file="$(find {file}">{argument}</include></launch>'
    repository.write({"arm/launch/arm.launch": text})
    (removed,) = [
        change
        for change in subject(compare(repository), "arm/launch/arm.launch").changes
        if "static_transform_publisher" in str(change.sentence)
    ]
    assert (removed.reason is None) == may_publish
    assert ("may publish its transform" in str(removed.sentence)) == may_publish


DRIVER = '<node pkg="arm" type="driver" name="driver"><param name="frame_id" value="FRAME"/></node>'
STATE = '<node pkg="robot_state_publisher" type="robot_state_publisher" name="state"/>'
CAMERA_STATIC = STATIC.replace("PARENT", "base").replace("CHILD", "camera")


@pytest.mark.parametrize(
    ("first", "second", "other", "is_breaking"),
    [
        ("lens", "camera", "", False),
        ("lens", "other", "", True),
        ("camera", "lens", "", True),
        ("lens", "camera", '<include file="$(find other_arm)/launch/state.launch"/>', True),
        ("link", "camera", "", False),
    ],
)
def test_sensor_that_gets_the_frame_of_a_static_transform_is_repaired(
    repository, compare, first, second, other, is_breaking
):
    path, text = "arm/launch/arm.launch", f"<launch>{CAMERA_STATIC}{DRIVER}{other}</launch>"
    files = {
        "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
        "arm/urdf/arm.urdf": '<robot name="a"><link name="link"/></robot>',
        "arm/launch/all.launch": f"<launch>{STATE}{DRIVER.replace('FRAME', 'link')}</launch>",
    }
    repository.commit({**files, path: text.replace("FRAME", first)})
    repository.write({path: text.replace("FRAME", second)})
    (change,) = subject(compare(repository), path).changes
    assert (change.reason is not None) is is_breaking


def test_robot_of_another_launch_file_may_have_the_frame_of_a_sensor(repository, compare):
    path, text = "arm/launch/arm.launch", f"<launch>{CAMERA_STATIC}{DRIVER}</launch>"
    files = {
        "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
        "arm/urdf/arm.urdf": '<robot name="a"><link name="link"/></robot>',
        "arm/launch/all.launch": f"<launch>{STATE}</launch>",
    }
    repository.commit({**files, path: text.replace("FRAME", "link")})
    repository.write({path: text.replace("FRAME", "camera")})
    (change,) = subject(compare(repository), path).changes
    assert str(change.reason) == "programs that use the name 'link' do not find it"


def test_a_transform_that_moves_to_two_files_has_its_new_values(repository, compare):
    text = "<launch>{}</launch>\n"
    node = "<node pkg='tf2_ros' exec='static_transform_publisher' args='--x {} --frame-id gps --child-frame-id base'/>"
    paths = [f"arm/launch/{name}.launch.xml" for name in ("all", "left", "right")]
    repository.commit({paths[0]: text.format(node.format(1)), paths[1]: text.format(""), paths[2]: text.format("")})
    repository.write({path: text.format(node.format(x)) for path, x in zip(paths[1:], (1, 3), strict=True)})
    repository.write({paths[0]: text.format("")})
    result = compare(repository)
    title = "node 'tf2_ros/static_transform_publisher' of 'base' moved"
    (lost,) = subject(result, paths[0]).changes
    assert str(lost.sentence) == f"{title} to {paths[1]} or {paths[2]}"
    assert str(lost.reason).startswith(f"where the file is started without {paths[1]} or {paths[2]}, the transform")
    assert sentences(subject(result, paths[1])) == [f"{title} from {paths[0]}"]
    assert sentences(subject(result, paths[2])) == [f"{title} from {paths[0]}; x 1 -> 3"]


BROADCASTER = """import rclpy
from geometry_msgs.msg import TransformStamped
from tf2_ros import TransformBroadcaster


def main():
    node = rclpy.create_node("place")
    transform = TransformStamped()
    transform.header.frame_id = "hand"
    transform.child_frame_id = "tool"
    TransformBroadcaster(node).sendTransform(transform)
"""
SILENT = "def main():\n    pass\n"


@pytest.mark.parametrize(
    ("node", "old", "new", "may_publish"),
    [
        ("place.py", SILENT, BROADCASTER, True),
        ("place.py", SILENT, BROADCASTER.replace("tool", "finger"), False),
        ("place.py", SILENT, BROADCASTER.replace("TransformBroadcaster", "OdometryPublisher"), False),
        ("place.py", SILENT, f'{BROADCASTER}    node.declare_parameter("publish_tf", False)\n', False),
        ("place.py", BROADCASTER, f"{BROADCASTER}    rclpy.spin(node)\n", False),
        ("other.py", SILENT, BROADCASTER, False),
    ],
)
def test_node_whose_source_newly_broadcasts_a_frame_may_publish_its_transform(
    repository, compare, node, old, new, may_publish
):
    started = f'<node pkg="arm" type="{node}" name="place"/>'
    static = STATIC.replace("PARENT", "hand").replace("CHILD", "tool")
    files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/scripts/other.py": SILENT}
    launch = {"arm/launch/arm.launch": f"<launch>{static}{started}</launch>"}
    repository.commit({**files, **launch, "arm/scripts/place.py": old})
    repository.write({"arm/launch/arm.launch": f"<launch>{started}</launch>", "arm/scripts/place.py": new})
    (removed,) = subject(compare(repository), "arm/launch/arm.launch").changes
    assert (removed.reason is None) is may_publish
    assert str(removed.sentence).endswith(f"; node 'arm/{node}' may publish its transform") is may_publish


@pytest.mark.parametrize(
    ("old", "new", "may_publish"),
    [("false", "true", True), ("true", "true", False), ("true", "false", False), (None, "true", True)],
)
@pytest.mark.parametrize("is_file", [True, False])
def test_node_whose_parameters_newly_turn_a_transform_on_may_publish_it(
    repository, compare, old, new, may_publish, is_file
):
    static = STATIC.replace("PARENT", "hand").replace("CHILD", "tool")
    frames = {"parent": "hand", "child": "tool"}

    def make_files(value: str | None, transform: str) -> dict[str, str]:
        values = {**frames, **({} if value is None else {"publish_tf": value})}
        parameters = "".join(f'<param name="{key}" value="{text}"/>' for key, text in values.items())
        load = '<rosparam command="load" file="$(find arm)/place.yaml"/>'
        node = f'<node pkg="drive" type="drive" name="drive">{load if is_file else parameters}</node>'
        yaml = "".join(f"{key}: {text}\n" for key, text in values.items())
        return {"arm/launch/arm.launch": f"<launch>{transform}{node}</launch>", "arm/place.yaml": yaml}

    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), **make_files(old, static)})
    repository.write(make_files(new, ""))
    changes = subject(compare(repository), "arm/launch/arm.launch").changes
    (removed,) = [change for change in changes if "static_transform_publisher" in str(change.sentence)]
    assert (removed.reason is None) is may_publish
