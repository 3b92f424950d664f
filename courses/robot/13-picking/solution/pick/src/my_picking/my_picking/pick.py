import numpy as np
import rclpy
from geometry_msgs.msg import Pose
from moveit_msgs.msg import CollisionObject
from my_picking.arm import Arm
from my_picking.seeing import find_pixels, find_square, to_plane
from rclpy.executors import ExternalShutdownException
from rclpy.time import Time
from sensor_msgs.msg import CameraInfo, Image
from shape_msgs.msg import SolidPrimitive
from tf2_ros import Buffer, TransformException, TransformListener

TABLE = 0.3
CUBE = 0.04
OPEN, CLOSED = 0.035, 0.0
GRASP = TABLE + 0.032
ABOVE = TABLE + 0.12


class Picker(Arm):
    def __init__(self):
        super().__init__('pick')
        self.color = self.declare_parameter('color', 'red').value
        self.place_x = self.declare_parameter('place_x', 0.62).value
        self.place_y = self.declare_parameter('place_y', 0.3).value
        self.objects = self.create_publisher(CollisionObject, 'collision_object', 10)
        self.frames = Buffer()
        self.listener = TransformListener(self.frames, self)
        self.image = self.lens = None
        self.create_subscription(CameraInfo, 'camera/camera_info', self.on_lens, 10)
        self.create_subscription(Image, 'camera/image_raw', self.on_image, 10)

    def on_lens(self, message):
        self.lens = np.array(message.k).reshape(3, 3)

    def on_image(self, message):
        self.image = message

    def add_table(self):
        """Tell move_group where the table is, so that no motion goes through it."""
        table = CollisionObject(id='table', operation=CollisionObject.ADD)
        table.header.frame_id = 'base_footprint'
        pose = Pose()
        pose.position.x, pose.position.z = 0.75, TABLE / 2
        table.primitives = [SolidPrimitive(type=SolidPrimitive.BOX, dimensions=[0.5, 1.1, TABLE])]
        table.primitive_poses = [pose]
        self.objects.publish(table)

    def camera_pose(self, stamp):
        """Return the position and the rotation matrix of the camera."""
        while True:
            try:
                found = self.frames.lookup_transform(
                    'base_footprint', 'camera_optical_frame', stamp).transform
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

    def see(self):
        """Return the place and the turn of the cube, or None if the next image does not show it."""
        self.image = None
        while self.image is None or self.lens is None:
            rclpy.spin_once(self)
        image = self.image
        position, rotation = self.camera_pose(Time.from_msg(image.header.stamp))
        picture = np.frombuffer(image.data, np.uint8).reshape(image.height, image.width, 3)
        pixels = find_pixels(picture, self.color)
        points = to_plane(pixels, self.lens, position, rotation, TABLE + CUBE)
        x, y = points.T
        points = points[(abs(x - 0.75) < 0.25) & (abs(y) < 0.55)]  # on the table, not on the robot
        return find_square(points, position[:2], CUBE) if len(points) >= 60 else None

    def go(self):
        self.motions.wait_for_server()
        self.add_table()
        self.look()
        found = self.see()
        if found is None:
            return f'the camera sees nothing that is {self.color}'
        (x, y), yaw = found
        self.grip(OPEN)
        self.reach(x, y, ABOVE, yaw)
        self.reach(x, y, GRASP, yaw, straight=True)
        held = self.grip(CLOSED)
        self.reach(x, y, ABOVE, yaw, straight=True)
        if not held:
            return 'the gripper holds nothing'
        self.reach(self.place_x, self.place_y, ABOVE)
        self.reach(self.place_x, self.place_y, GRASP + 0.004, straight=True)
        self.grip(OPEN)
        self.reach(self.place_x, self.place_y, ABOVE, straight=True)
        return f'the {self.color} cube is placed'


def main():
    rclpy.init()
    try:
        picker = Picker()
        picker.get_logger().info(picker.go())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
