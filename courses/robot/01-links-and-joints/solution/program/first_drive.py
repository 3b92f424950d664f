import time

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node('first_drive')
publisher = node.create_publisher(Twist, '/cmd_vel', 10)

message = Twist()
message.linear.x = 0.2
for _ in range(40):
    publisher.publish(message)
    time.sleep(0.1)

publisher.publish(Twist())
rclpy.shutdown()
