import rclpy
from my_picking.arm import Arm
from rclpy.executors import ExternalShutdownException


def main():
    rclpy.init()
    try:
        arm = Arm('reach')
        x, y, z = (arm.declare_parameter(axis, value).value
                   for axis, value in (('x', 0.6), ('y', 0.0), ('z', 0.5)))
        done = arm.reach(x, y, z)
        arm.get_logger().info('the gripper is there' if done else 'the arm does not reach there')
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
