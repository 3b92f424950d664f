import math

import rclpy
from geometry_msgs.msg import Pose
from moveit_msgs.action import MoveGroup
from moveit_msgs.msg import (
    Constraints,
    JointConstraint,
    MoveItErrorCodes,
    OrientationConstraint,
    PositionConstraint,
)
from rclpy.action import ActionClient
from rclpy.node import Node
from shape_msgs.msg import SolidPrimitive

LOOK = {
    'shoulder_pan_joint': 0.0,
    'shoulder_lift_joint': 0.25,
    'elbow_joint': 1.05,
    'wrist_1_joint': 0.0,
    'wrist_2_joint': 1.8416,
    'wrist_3_joint': 0.0,
}


class Arm(Node):
    def __init__(self, name):
        super().__init__(name)
        self.motions = ActionClient(self, MoveGroup, 'move_action')

    def wait(self, future):
        rclpy.spin_until_future_complete(self, future)
        return future.result()

    def move(self, constraints, straight=False):
        self.motions.wait_for_server()
        goal = MoveGroup.Goal()
        request = goal.request
        request.group_name = 'arm'
        request.goal_constraints = [constraints]
        request.start_state.is_diff = True
        request.num_planning_attempts = 3
        request.allowed_planning_time = 5.0
        speed = 0.1 if straight else 0.5
        request.max_velocity_scaling_factor = speed
        request.max_acceleration_scaling_factor = speed
        if straight:
            request.pipeline_id = 'pilz_industrial_motion_planner'
            request.planner_id = 'LIN'
        handle = self.wait(self.motions.send_goal_async(goal))
        code = self.wait(handle.get_result_async()).result.error_code.val
        return code == MoveItErrorCodes.SUCCESS

    def look(self):
        joints = [
            JointConstraint(joint_name=name, position=angle, weight=1.0,
                            tolerance_above=0.01, tolerance_below=0.01)
            for name, angle in LOOK.items()
        ]
        return self.move(Constraints(joint_constraints=joints))

    def reach(self, x, y, z, yaw=0.0, straight=False):
        pose = down(x, y, z, yaw)
        position, orientation = PositionConstraint(), OrientationConstraint()
        for part in (position, orientation):
            part.header.frame_id = 'base_footprint'
            part.link_name = 'grasp_link'
            part.weight = 1.0
        ball = SolidPrimitive(type=SolidPrimitive.SPHERE, dimensions=[0.001])
        position.constraint_region.primitives = [ball]
        position.constraint_region.primitive_poses = [pose]
        orientation.orientation = pose.orientation
        orientation.absolute_x_axis_tolerance = 0.01
        orientation.absolute_y_axis_tolerance = 0.01
        orientation.absolute_z_axis_tolerance = 0.01
        return self.move(Constraints(position_constraints=[position],
                                     orientation_constraints=[orientation]), straight)


def down(x, y, z, yaw):
    """Return the pose of a gripper that points down, with the turn that the wrist reaches easily."""
    ahead = math.atan2(y, x) + math.pi
    yaw += math.pi / 2 * round((ahead - yaw) / (math.pi / 2))
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = float(x), float(y), float(z)
    pose.orientation.x = math.cos(yaw / 2)
    pose.orientation.y = math.sin(yaw / 2)
    pose.orientation.w = 0.0
    return pose
