import rclpy
from my_picking.arm import Arm
from rclpy.executors import ExternalShutdownException


def main():
    rclpy.init()
    try:
        arm = Arm('look')
        done = arm.look()
        arm.get_logger().info('the camera looks down' if done else 'the motion failed')
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
