"""Carry out the first order: look, find the block by its hue, pick it, and place it. Later orders are ignored."""

import math

import numpy as np
import rclpy
from control_msgs.action import GripperCommand
from geometry_msgs.msg import Pose
from moveit_msgs.action import MoveGroup
from moveit_msgs.msg import CollisionObject, Constraints, JointConstraint, OrientationConstraint, PositionConstraint
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import CameraInfo, Image
from shape_msgs.msg import SolidPrimitive
from std_msgs.msg import String
from tf2_ros import Buffer, TransformException, TransformListener

ORDERS = 1
TABLE, BLOCK = 0.3, 0.04  # m
GRASP, ABOVE = TABLE + 0.032, TABLE + 0.12
OPEN, CLOSED = 0.035, 0.0
LOOK = {
    'shoulder_pan_joint': 0.0,
    'shoulder_lift_joint': 0.25,
    'elbow_joint': 1.05,
    'wrist_1_joint': 0.0,
    'wrist_2_joint': 1.8416,
    'wrist_3_joint': 0.0,
}


class PickPlace(Node):
    def __init__(self):
        super().__init__('pick_place')
        self.motions = ActionClient(self, MoveGroup, 'move_action')
        self.gripper = ActionClient(self, GripperCommand, 'gripper_controller/gripper_cmd')
        self.objects = self.create_publisher(CollisionObject, 'collision_object', 10)
        self.frames = Buffer()
        self.listener = TransformListener(self.frames, self)
        self.order = self.image = self.lens = None
        self.create_subscription(String, 'order', self.on_order, 10)
        self.create_subscription(CameraInfo, 'camera/camera_info', self.on_lens, 10)
        self.create_subscription(Image, 'camera/image_raw', self.on_image, 10)

    def on_order(self, message):
        self.order = message.data

    def on_lens(self, message):
        self.lens = np.array(message.k).reshape(3, 3)

    def on_image(self, message):
        self.image = message

    def wait(self, future):
        rclpy.spin_until_future_complete(self, future)
        return future.result()

    def move(self, constraints, straight=False):
        goal = MoveGroup.Goal()
        request = goal.request
        request.group_name = 'arm'
        request.goal_constraints = [constraints]
        request.start_state.is_diff = True
        request.num_planning_attempts = 3
        request.allowed_planning_time = 5.0
        request.max_velocity_scaling_factor = request.max_acceleration_scaling_factor = 0.1 if straight else 0.5
        if straight:
            request.pipeline_id = 'pilz_industrial_motion_planner'
            request.planner_id = 'LIN'
        self.wait(self.wait(self.motions.send_goal_async(goal)).get_result_async())

    def look(self):
        joints = [
            JointConstraint(joint_name=name, position=angle, weight=1.0, tolerance_above=0.01, tolerance_below=0.01)
            for name, angle in LOOK.items()
        ]
        self.move(Constraints(joint_constraints=joints))

    def reach(self, x, y, z, yaw=0.0, straight=False):
        ahead = math.atan2(y, x) + math.pi
        yaw += math.pi / 2 * round((ahead - yaw) / (math.pi / 2))
        pose = Pose()
        pose.position.x, pose.position.y, pose.position.z = float(x), float(y), float(z)
        pose.orientation.x, pose.orientation.y, pose.orientation.w = math.cos(yaw / 2), math.sin(yaw / 2), 0.0
        position, orientation = PositionConstraint(), OrientationConstraint()
        for part in (position, orientation):
            part.header.frame_id, part.link_name, part.weight = 'base_footprint', 'grasp_link', 1.0
        ball = SolidPrimitive(type=SolidPrimitive.SPHERE, dimensions=[0.001])
        position.constraint_region.primitives = [ball]
        position.constraint_region.primitive_poses = [pose]
        orientation.orientation = pose.orientation
        orientation.absolute_x_axis_tolerance = orientation.absolute_y_axis_tolerance = 0.01
        orientation.absolute_z_axis_tolerance = 0.01
        self.move(Constraints(position_constraints=[position], orientation_constraints=[orientation]), straight)

    def grip(self, position):
        goal = GripperCommand.Goal()
        goal.command.position, goal.command.max_effort = position, 20.0
        self.wait(self.wait(self.gripper.send_goal_async(goal)).get_result_async())

    def add_table(self):
        table = CollisionObject(id='table', operation=CollisionObject.ADD)
        table.header.frame_id = 'base_footprint'
        pose = Pose()
        pose.position.x, pose.position.z = 0.75, TABLE / 2
        table.primitives = [SolidPrimitive(type=SolidPrimitive.BOX, dimensions=[0.5, 1.1, TABLE])]
        table.primitive_poses = [pose]
        self.objects.publish(table)

    def camera_pose(self, image):
        while True:
            try:
                found = self.frames.lookup_transform(
                    'base_footprint', image.header.frame_id, Time.from_msg(image.header.stamp)
                ).transform
                break
            except TransformException:
                rclpy.spin_once(self)
        x, y, z, w = (getattr(found.rotation, name) for name in 'xyzw')
        rotation = np.array([
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ])
        return np.array([found.translation.x, found.translation.y, found.translation.z]), rotation

    def see(self, color):
        """Return the middle of the block of a color, and its turn about z."""
        self.image = None
        while self.image is None or self.lens is None:
            rclpy.spin_once(self)
        image = self.image
        position, rotation = self.camera_pose(image)
        picture = np.frombuffer(image.data, np.uint8).reshape(image.height, image.width, 3)
        rows, columns = np.nonzero(is_colored(picture.astype(float), color))
        pixels = np.column_stack((columns, rows, np.ones(len(rows))))
        rays = pixels @ np.linalg.inv(self.lens).T @ rotation.T
        lengths = (TABLE + BLOCK - position[2]) / rays[:, 2]
        points = position[:2] + rays[:, :2] * lengths[:, np.newaxis]
        on_table = (abs(points[:, 0] - 0.75) < 0.25) & (abs(points[:, 1]) < 0.55)
        return find_square(points[on_table], position[:2], BLOCK)

    def carry_out(self, order):
        color, place_x, place_y = order.split()
        place_x, place_y = float(place_x), float(place_y)
        self.look()
        (x, y), yaw = self.see(color)
        self.grip(OPEN)
        self.reach(x, y, ABOVE, yaw)
        self.reach(x, y, GRASP, yaw, straight=True)
        self.grip(CLOSED)
        self.reach(x, y, ABOVE, yaw, straight=True)
        self.reach(place_x, place_y, ABOVE)
        self.reach(place_x, place_y, GRASP + 0.004, straight=True)
        self.grip(OPEN)
        self.reach(place_x, place_y, ABOVE, straight=True)

    def run(self):
        self.motions.wait_for_server()
        self.gripper.wait_for_server()
        self.add_table()
        done = set()
        while len(done) < ORDERS:
            while self.order is None or self.order in done:
                rclpy.spin_once(self)
            order = self.order
            self.carry_out(order)
            done.add(order)


def is_colored(picture, color):
    """Return which pixels have a hue: red, green, blue, or yellow, which is red and green."""
    red, green, blue = picture[..., 0], picture[..., 1], picture[..., 2]
    return {
        'red': (red > 40) & (red > 2 * green) & (red > 2 * blue),
        'green': (green > 40) & (green > 2 * red) & (green > 2 * blue),
        'blue': (blue > 40) & (blue > 2 * red) & (blue > 2 * green),
        'yellow': (red > 40) & (red > 2 * blue) & (green > 2 * blue) & (green > 0.6 * red) & (red > 0.6 * green),
    }[color]


def find_square(points, camera, side):
    """Return the middle of the top of a block, and its turn about z in rad.

    The camera also sees sides of the block. They appear between the top and the camera, so only the edges away from
    the camera (x, y) are those of the top.
    """
    best = None
    for yaw in np.radians(np.arange(0, 90, 2)):
        axes = np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
        along = points @ axes.T
        low, high = np.percentile(along, 1, axis=0), np.percentile(along, 99, axis=0)
        area = np.prod(high - low)
        if best is None or area < best[0]:
            near_low = axes @ camera < (low + high) / 2
            best = area, np.where(near_low, high - side / 2, low + side / 2) @ axes, float(yaw)
    return best[1], best[2]


def main():
    rclpy.init()
    PickPlace().run()


if __name__ == '__main__':
    main()
