# SPDX-License-Identifier: Apache-2.0
"""Pick up the cube of a color that the camera sees, and put it where the parameters say."""

import math

import numpy as np
import rclpy
from control_msgs.action import GripperCommand
from geometry_msgs.msg import Pose
from moveit_msgs.action import MoveGroup
from moveit_msgs.msg import (
    CollisionObject,
    Constraints,
    JointConstraint,
    MoveItErrorCodes,
    OrientationConstraint,
    PositionConstraint,
)
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time
from sensor_msgs.msg import CameraInfo, Image
from shape_msgs.msg import SolidPrimitive
from tf2_ros import Buffer, TransformException, TransformListener

from my_robot_arm.seeing import FEWEST_PIXELS, find_pixels, find_square, to_table

BASE = 'base_footprint'
TIP = 'grasp_link'
LOOK = {
    'shoulder_pan_joint': 0.0,
    'shoulder_lift_joint': 0.25,
    'elbow_joint': 1.05,
    'wrist_1_joint': 0.0,
    'wrist_2_joint': 1.8416,
    'wrist_3_joint': 0.0,
}
TABLE = (0.75, 0.0, 0.5, 1.1, 0.3)  # m: x and y of its middle, length, width and height
CUBE = 0.04  # m
GRASP = 0.032  # m above the table: the fingers reach 2 cm farther
ABOVE = 0.12  # m above the table
OPEN, CLOSED = 0.035, 0.0  # m


class ArmError(Exception):
    """What the arm was told to do, and why it did not."""


class PickAndPlace(Node):
    """Plans with move_group, and closes the gripper; each method returns when the motion is done."""

    def __init__(self):
        super().__init__('pick_and_place')
        self.color = self.declare_parameter('color', 'red').value
        self.place = [self.declare_parameter(f'place_{axis}', value).value for axis, value in (('x', 0.62), ('y', 0.3))]
        self.motions = ActionClient(self, MoveGroup, 'move_action')
        self.gripper = ActionClient(self, GripperCommand, 'gripper_controller/gripper_cmd')
        self.objects = self.create_publisher(CollisionObject, 'collision_object', 10)
        self.frames = Buffer()
        self.listener = TransformListener(self.frames, self)
        self.image = self.info = None
        self.create_subscription(Image, 'camera/image_raw', self.on_image, qos_profile_sensor_data)
        self.create_subscription(CameraInfo, 'camera/camera_info', self.on_info, qos_profile_sensor_data)

    def on_image(self, image):
        """Keep the last picture."""
        self.image = image

    def on_info(self, info):
        """Keep what turns pixels into rays."""
        self.info = info

    # --- motions -------------------------------------------------------------------------------------------------

    def wait(self, future):
        """Return the result of a future."""
        rclpy.spin_until_future_complete(self, future)
        return future.result()

    def move(self, constraints, pipeline='ompl', planner='', speed=0.5):
        """Move the arm until it meets constraints."""
        goal = MoveGroup.Goal()
        request = goal.request
        request.group_name, request.goal_constraints = 'arm', [constraints]
        request.pipeline_id, request.planner_id = pipeline, planner
        request.num_planning_attempts, request.allowed_planning_time = 3, 5.0
        request.max_velocity_scaling_factor = request.max_acceleration_scaling_factor = speed
        request.start_state.is_diff = True
        handle = self.wait(self.motions.send_goal_async(goal))
        code = self.wait(handle.get_result_async()).result.error_code.val
        if code == MoveItErrorCodes.NO_IK_SOLUTION:
            raise ArmError('the arm does not reach there')
        if code != MoveItErrorCodes.SUCCESS:
            raise ArmError(f'the motion failed with error {code}')

    def look(self):
        """Turn the camera to the table."""
        joints = [
            JointConstraint(joint_name=name, position=value, tolerance_above=0.01, tolerance_below=0.01, weight=1.0)
            for name, value in LOOK.items()
        ]
        self.move(Constraints(joint_constraints=joints))

    def reach(self, place, height, yaw, straight=False):
        """Move the gripper, which points down, to a place at a height above the table, on a straight line or not.

        A cube can be gripped in four ways: the one that turns the wrist least is chosen.
        """
        ahead = math.atan2(place[1], place[0]) + math.pi
        yaw += math.pi / 2 * round((ahead - yaw) / (math.pi / 2))
        pose = Pose()
        pose.position.x, pose.position.y, pose.position.z = float(place[0]), float(place[1]), TABLE[4] + height
        pose.orientation.x, pose.orientation.y = math.cos(yaw / 2), math.sin(yaw / 2)
        pose.orientation.w = 0.0
        position, orientation = PositionConstraint(), OrientationConstraint()
        for part in (position, orientation):
            part.header.frame_id, part.link_name, part.weight = BASE, TIP, 1.0
        position.constraint_region.primitives = [SolidPrimitive(type=SolidPrimitive.SPHERE, dimensions=[0.001])]
        position.constraint_region.primitive_poses = [pose]
        orientation.orientation = pose.orientation
        orientation.absolute_x_axis_tolerance = orientation.absolute_y_axis_tolerance = 0.01
        orientation.absolute_z_axis_tolerance = 0.01
        constraints = Constraints(position_constraints=[position], orientation_constraints=[orientation])
        if straight:
            self.move(constraints, 'pilz_industrial_motion_planner', 'LIN', 0.1)
        else:
            self.move(constraints)

    def grip(self, position):
        """Move the fingers, and return whether something is between them."""
        goal = GripperCommand.Goal()
        goal.command.position, goal.command.max_effort = position, 20.0
        handle = self.wait(self.gripper.send_goal_async(goal))
        return self.wait(handle.get_result_async()).result.position > position + 0.25 * CUBE

    # --- what it sees, and what it does -----------------------------------------------------------------------------

    def add_table(self):
        """Tell move_group where the table is, so that no motion goes through it."""
        x, y, length, width, height = TABLE
        table = CollisionObject(id='table', operation=CollisionObject.ADD)
        table.header.frame_id = BASE
        pose = Pose()
        pose.position.x, pose.position.y, pose.position.z = x, y, height / 2
        table.primitives = [SolidPrimitive(type=SolidPrimitive.BOX, dimensions=[length, width, height])]
        table.primitive_poses = [pose]
        self.objects.publish(table)

    def see(self):
        """Return where the cube is, and its turn about z, from the next picture."""
        self.image = None
        while self.image is None or self.info is None:
            rclpy.spin_once(self)
        stamp = Time.from_msg(self.image.header.stamp)
        frame = self.image.header.frame_id
        for _ in range(50):
            try:
                transform = self.frames.lookup_transform(BASE, frame, stamp).transform
                break
            except TransformException:
                rclpy.spin_once(self)
        else:
            raise ArmError(f'there is no transform from {frame} to {BASE}')
        picture = np.frombuffer(self.image.data, np.uint8).reshape(self.image.height, self.image.width, 3)
        position = np.array([transform.translation.x, transform.translation.y, transform.translation.z])
        matrix = np.array(self.info.k).reshape(3, 3)
        pixels = find_pixels(picture, self.color)
        points = to_table(pixels, matrix, position, rotation(transform.rotation), TABLE[4] + CUBE)
        points = points[np.all(np.abs(points - TABLE[:2]) < np.array(TABLE[2:4]) / 2, axis=1)]
        if len(points) < FEWEST_PIXELS:
            raise ArmError(f'the camera sees nothing on the table that is {self.color}')
        return find_square(points, position[:2], CUBE)

    def run(self):
        """Look, pick and place."""
        self.get_logger().info('waiting for move_group and the gripper')
        self.motions.wait_for_server()
        self.gripper.wait_for_server()
        self.add_table()
        self.look()
        place, yaw = self.see()
        self.get_logger().info(f'the {self.color} cube is at {place[0]:.3f}, {place[1]:.3f}')
        self.grip(OPEN)
        self.reach(place, ABOVE, yaw)
        self.reach(place, GRASP, yaw, straight=True)
        is_held = self.grip(CLOSED)
        self.reach(place, ABOVE, yaw, straight=True)
        if not is_held:
            raise ArmError('the gripper closed without holding anything')
        self.get_logger().info(f'going to {self.place[0]:.3f}, {self.place[1]:.3f}')
        self.reach(self.place, ABOVE, 0.0)
        self.reach(self.place, GRASP + 0.004, 0.0, straight=True)
        self.grip(OPEN)
        self.reach(self.place, ABOVE, 0.0, straight=True)
        self.look()
        self.get_logger().info(f'the {self.color} cube is placed')


def rotation(quaternion):
    """Return the rotation matrix of a quaternion."""
    x, y, z, w = quaternion.x, quaternion.y, quaternion.z, quaternion.w
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])


def main():
    """Run the node until the cube is placed."""
    rclpy.init()
    node = PickAndPlace()
    try:
        node.run()
    except ArmError as error:
        node.get_logger().error(str(error))
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
