import rclpy
from my_picking.arm import Arm
from rclpy.executors import ExternalShutdownException


def main():
    rclpy.init()
    try:
        arm = Arm('grip')
        position = arm.declare_parameter('position', 0.0).value
        held = arm.grip(position)
        arm.get_logger().info('it holds something' if held else 'it holds nothing')
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
