"""Rules about frames with standard names and meanings: REP 103, 105 and 120."""

from __future__ import annotations

import re
from collections.abc import Iterator
from math import radians

from linkwright.diagnostics import Diagnostic, Note, Severity, phrase
from linkwright.geometry.shapes import Matrix, angle_between, rotation
from linkwright.lint.rule import Rule
from linkwright.lint.rules.meshes_addresses import read_source_value
from linkwright.lint.subject import Subject
from linkwright.loading.deferred import lazy_pattern
from linkwright.urdf import Box, Geometry, Joint, Mesh, parent_joints

_OPTICAL_NAME = lazy_pattern(r"(?P<stem>.*?)_?optical(_(frame|link|joint))?$")
_OPTICAL_ROTATION: Matrix = ((0.0, 0.0, 1.0), (-1.0, 0.0, 0.0), (0.0, -1.0, 0.0))
_CAMERA_NAME = lazy_pattern(
    "cam|rgb|depth|colou?r|infra|stereo|eye|kinect|realsense|zed|oak|sensor|image", re.IGNORECASE
)
_ANGLE_TOLERANCE = radians(2.0)
_MAX_MARKER_SIZE_M = 0.05
_HUMANOID_FRAMES = ("base_link", "torso", "l_wrist", "r_wrist", "l_gripper", "r_gripper", "l_sole", "r_sole", "gaze")


class BaseLinkMissing(Rule):
    """A robot on wheels has no link ``base_link``.

    ## Why

    According to REP 105, the frame that is attached to a mobile robot is called `base_link`. Navigation, localization
    and teleoperation expect this name.

    ## Example

    ```xml
    <link name="chassis"/>
    <joint name="left_wheel_joint" type="continuous">
    ```

    ## Use instead

    ```xml
    <link name="base_link"/>
    ```
    """

    code = "LW620"
    name = "base-link-missing"

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        robot = subject.robot
        if robot is None or any(
            re.search(r"(^|[_/])base_?(link|footprint)", name, re.IGNORECASE) for name in robot.links
        ):
            return
        wheels = [
            joint for joint in robot.joints.values() if joint.type == "continuous" and "wheel" in joint.name.lower()
        ]
        root = robot.links[robot.root]
        if len(wheels) < 2 or root.element is None:
            return
        notes = [
            Note(phrase("'{name}' is a wheel", name=joint.name), joint.element.span() if joint.element else None)
            for joint in wheels[:2]
        ]
        message = phrase("this wheeled robot has no link 'base_link', which REP 105 requires")
        yield self.report(
            message,
            root.element,
            "name",
            notes=notes,
            hint=phrase("rename '{name}' to base_link, or add a link with that name", name=root.name),
        )


class BaseLinkNotAtTheTop(Rule):
    """``base_link`` has a parent other than ``base_footprint`` or a world.

    ## Why

    In REP 105, `odom` is the parent of `base_link`. A frame has only one parent, so a link of the robot above
    `base_link` either replaces `odom` as the parent or is disconnected. Pedantic: everything works if the odometry
    refers to the root of the tree.

    ## Example

    ```xml
    <joint name="base_joint" type="fixed">
      <parent link="chassis"/>
      <child link="base_link"/>
    </joint>
    ```

    ## Use instead

    ```xml
    <joint name="chassis_joint" type="fixed">
      <parent link="base_link"/>
      <child link="chassis"/>
    </joint>
    ```
    """

    code = "LW621"
    name = "base-link-not-at-the-top"
    default = False

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        if subject.robot is None:
            return
        for joint in subject.robot.joints.values():
            if joint.child != "base_link" or joint.element is None:
                continue
            if not re.search("footprint|world|map|odom|dummy|stand|pedestal|table|mount", joint.parent):
                message = phrase(
                    "'base_link' is a child of '{parent}'; in REP 105 it is the topmost link of a robot",
                    parent=joint.parent,
                )
                yield self.report(
                    message, joint.element, hint=phrase("exchange parent and child, and invert the origin")
                )


class FootprintBelowBase(Rule):
    """``base_footprint`` is a child of ``base_link``.

    ## Why

    `base_footprint` is the position of the robot on the ground. The transform from `base_footprint` to `base_link`
    contains the height and tilt of the robot (REP 120). Pedantic: the reverse order is also common, and works if no
    node publishes odometry for `base_footprint`.

    ## Example

    ```xml
    <joint name="footprint_joint" type="fixed">
      <parent link="base_link"/>
      <child link="base_footprint"/>
    </joint>
    ```

    ## Use instead

    ```xml
    <joint name="base_joint" type="fixed">
      <parent link="base_footprint"/>
      <child link="base_link"/>
    </joint>
    ```
    """

    code = "LW622"
    name = "footprint-below-base"
    default = False

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        if subject.robot is None:
            return
        for joint in subject.robot.joints.values():
            is_inverted = joint.child.endswith("base_footprint") and joint.parent.endswith("base_link")
            if is_inverted and joint.element is not None:
                message = phrase(
                    "'{child}' is a child of '{parent}'; in REP 120, '{parent}' is a child of '{child}'",
                    child=joint.child,
                    parent=joint.parent,
                )
                yield self.report(
                    message, joint.element, hint=phrase("exchange parent and child, and invert the origin")
                )


class FootprintHasBody(Rule):
    """``base_footprint`` has a collision shape or a mass.

    ## Why

    `base_footprint` is a position on the ground, not a body. In simulation, a body there rubs on the floor, and its
    mass is counted twice. If the link also has a visual, it is the body of the robot under another name, and the
    finding is only informational.

    ## Example

    ```xml
    <link name="base_footprint">
      <collision><geometry><box size="0.3 0.3 0.1"/></geometry></collision>
    </link>
    ```

    ## Use instead

    ```xml
    <link name="base_footprint"/>
    ```
    """

    code = "LW623"
    name = "footprint-has-body"

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        for link in subject.links:
            if not link.name.endswith("base_footprint") or link.element is None:
                continue
            collision_shape = next(
                (collision for collision in link.collisions if not _is_tiny(collision.geometry)), None
            )
            element = None if collision_shape is None else collision_shape.element
            is_root = subject.robot is None or subject.robot.root == link.name
            # RootInertia reports the mass of a root link.
            if element is None and not is_root and link.inertial is not None and link.inertial.mass > 0.1:
                element = link.element.first("inertial")
            if element is not None:
                message = phrase(
                    "'{name}' is a position on the ground, but has a <{tag}>", name=link.name, tag=element.tag
                )
                hint = phrase("move it to the link of the body, such as 'base_link'")
                severity = Severity.INFO if link.visuals else None
                yield self.report(message, element, hint=hint, severity=severity)


class FixedFrameInRobot(Rule):
    """A link is called ``map`` or ``odom``.

    ## Why

    REP 105 gives these names to frames that localization and odometry publish. A frame has only one parent. If both the
    description and a node publish the frame, its transform jumps between the two. A name from an argument or a property
    is the choice of the caller, and is not reported.

    ## Example

    ```xml
    <link name="odom"/>
    <joint name="odom_joint" type="fixed">
    ```

    ## Use instead

    Leave the link out. If a frame without odometry is intended, publish it with static_transform_publisher.
    """

    code = "LW624"
    name = "fixed-frame-in-robot"

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        for link in subject.links:
            frame = link.name.rpartition("/")[2]
            if (
                frame in ("map", "odom")
                and link.element is not None
                and frame in read_source_value(link.element, "name")
            ):
                message = phrase(
                    "'{name}' is a frame that localization publishes (REP 105), not a link",
                    name=link.name,
                )
                yield self.report(
                    message,
                    link.element,
                    "name",
                    hint=phrase("remove the link, because localization and odometry publish this frame"),
                )


class OpticalFrameRotation(Rule):
    """The rotation between an optical frame and its camera frame does not follow REP 103.

    ## Why

    In the body frame of a camera, x points forward and z up. In its optical frame, z points forward and y down, as in
    images. Point clouds and detections are given in the optical frame, so they appear rotated if the rotation is
    missing.

    ## Example

    ```xml
    <joint name="camera_optical_joint" type="fixed">
      <parent link="camera_link"/>
      <child link="camera_optical_frame"/>
    </joint>
    ```

    ## Use instead

    ```xml
    <joint name="camera_optical_joint" type="fixed">
      <origin xyz="0 0 0" rpy="-1.5708 0 -1.5708"/>
      <parent link="camera_link"/>
      <child link="camera_optical_frame"/>
    </joint>
    ```
    """

    code = "LW630"
    name = "optical-frame-rotation"

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        robot = subject.robot
        if robot is None:
            return
        parents = parent_joints(robot)
        for joint in robot.joints.values():
            match = _OPTICAL_NAME.fullmatch(joint.child)
            if match is None or joint.type != "fixed" or joint.element is None:
                continue
            parent = joint.parent
            if "optical" in parent or not _same_camera(match["stem"], parent) or _is_optical(parents.get(parent)):
                continue
            rotation_matrix = rotation(joint.origin)
            if _is_optical(joint) or not _has_only_right_angles(rotation_matrix):
                continue
            rpy = " ".join(f"{angle:g}" for angle in joint.origin.rpy)
            message = phrase(
                "'{child}' is rotated from '{parent}' by rpy '{rpy}', not as REP 103 defines optical frames",
                child=joint.child,
                parent=parent,
                rpy=rpy,
            )
            origin = joint.element.first("origin")
            attribute = "rpy" if origin is not None and "rpy" in origin.attributes else None
            element = origin if origin is not None else joint.element
            hint = phrase('write rpy="-1.5708 0 -1.5708" (in xacro rpy="${-pi/2} 0 ${-pi/2}"): z forward, y down')
            yield self.report(message, element, attribute, hint=hint)


def _is_optical(joint: Joint | None) -> bool:
    """Return whether a joint has the rotation of an optical frame (REP 103).

    The name of its child is not checked.
    """
    return joint is not None and angle_between(rotation(joint.origin), _OPTICAL_ROTATION) <= _ANGLE_TOLERANCE


def _is_tiny(shape: Geometry) -> bool:
    """Return whether a shape is so small that it is only a marker.

    Some simulators require a shape on every link.
    """
    if isinstance(shape, Box):
        return max(shape.size) <= _MAX_MARKER_SIZE_M
    return not isinstance(shape, Mesh) and 2.0 * shape.radius <= _MAX_MARKER_SIZE_M


def _same_camera(stem: str, parent: str) -> bool:
    """Return whether the names suggest that a parent link is the body frame of the camera."""
    base = re.sub(r"_(link|frame)$", "", parent)
    return bool(stem) and (base == stem or (stem.startswith(f"{base}_") and bool(_CAMERA_NAME.search(base))))


def _has_only_right_angles(rotation_matrix: Matrix) -> bool:
    """Return whether a rotation has only right angles, and is therefore probably a mistake.

    A camera that looks in another direction has other angles.
    """
    return all(min(abs(value), abs(abs(value) - 1.0)) < 0.02 for row in rotation_matrix for value in row)


class CameraWithoutOpticalFrame(Rule):
    """A camera in Gazebo has no optical frame.

    ## Why

    The headers of images and point clouds name a frame, in which z must point forward (REP 103). Pedantic: a camera
    that is only for viewing does not need an optical frame.

    ## Example

    ```xml
    <gazebo reference="camera_link">
      <sensor name="camera" type="camera"/>
    </gazebo>
    ```

    ## Use instead

    Add a link `camera_optical_frame` with a fixed joint that has `rpy="-1.5708 0 -1.5708"`, and name the link in the
    sensor.
    """

    code = "LW631"
    name = "camera-without-optical-frame"
    default = False
    severity = Severity.INFO

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        if any("optical" in link.name for link in subject.links):
            return
        for element in subject.elements("gazebo"):
            for sensor in element.elements("sensor"):
                if re.search("camera|depth|rgbd", sensor.attributes.get("type", "")):
                    reference = element.attributes.get("reference", "")
                    message = phrase("the camera on '{reference}' has no optical frame", reference=reference)
                    hint = phrase('add a link with a fixed joint of rpy="-1.5708 0 -1.5708" below it')
                    yield self.report(message, sensor, hint=hint)


class HumanoidFrames(Rule):
    """A humanoid robot lacks frames that REP 120 names.

    ## Why

    REP 120 defines a common set of frames for humanoids, so that walking and grasping software finds wrists and soles
    by name. Pedantic: few robots follow REP 120.

    ## Example

    ```xml
    <link name="LeftFoot"/>
    <link name="RightFoot"/>
    ```

    ## Use instead

    ```xml
    <link name="l_sole"/>
    <link name="r_sole"/>
    ```
    """

    code = "LW632"
    name = "humanoid-frames"
    default = False
    severity = Severity.INFO

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        names = {link.name.lower() for link in subject.links}
        has_feet = sum(bool(re.search(r"(foot|ankle|sole)(?!print)", name)) for name in names) >= 2
        has_hands = sum(bool(re.search("hand|wrist|gripper", name)) for name in names) >= 2
        missing_frames = [name for name in _HUMANOID_FRAMES if name not in names]
        if has_feet and has_hands and missing_frames:
            names_text = ", ".join(f"'{name}'" for name in missing_frames)
            yield self.report(
                phrase("this humanoid robot lacks frames that REP 120 names: {frames}", frames=names_text),
                subject.root,
                "name",
            )
