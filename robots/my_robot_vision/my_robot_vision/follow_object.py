# SPDX-License-Identifier: Apache-2.0
"""Follow a thing that a detector finds in the pictures of the camera: keep it in the middle, and at its size.

There is no geometry in it: a box left of the middle means turn left, a narrow one means drive on, a wide one means that
the thing is near.
"""

from my_robot_control.driving_node import DrivingNode, limited, run
from vision_msgs.msg import Detection2DArray


class FollowObject(DrivingNode):
    """Parameters: thing (class), picture_width (pixels), share (of it that the thing is to fill), speed, turn_speed."""

    def __init__(self):
        super().__init__('follow_object')
        self.thing = self.declare_parameter('thing', 'red').value
        self.picture_width = self.declare_parameter('picture_width', 640).value
        self.share = self.declare_parameter('share', 0.25).value
        self.speed = self.declare_parameter('speed', 0.3).value  # m/s at most
        self.turn_speed = self.declare_parameter('turn_speed', 1.0).value  # rad/s at most
        self.create_subscription(Detection2DArray, '/yolo/detections', self.on_detections, 10)

    def on_detections(self, message):
        """Drive by the widest box of the thing, which is the nearest; look round when there is none."""
        boxes = [each.bbox for each in message.detections if class_of(each) == self.thing]
        if not boxes:
            self.drive(0.0, self.turn_speed / 2)
            return
        box = max(boxes, key=lambda each: each.size_x)
        self.drive(*velocity(box, self.picture_width, self.share, self.speed, self.turn_speed))


def class_of(detection):
    """Return the name of the most likely class of a detection."""
    best = max(detection.results, key=lambda each: each.hypothesis.score, default=None)
    return best.hypothesis.class_id if best else ''


def velocity(box, picture_width, share, speed, turn_speed):
    """Return how fast to drive (m/s) and to turn (rad/s to the left) for a box."""
    offset = 1.0 - 2.0 * box.center.position.x / picture_width  # 1 at the left edge, -1 at the right one
    missing = 1.0 - box.size_x / (share * picture_width)  # 0 when it is as wide as it should be
    forward = limited(1.5 * speed * missing, speed) * (1.0 - min(abs(offset), 1.0))
    return max(forward, 0.0), limited(2.0 * turn_speed * offset, turn_speed)


def main():
    """Run the node."""
    run(FollowObject)


if __name__ == '__main__':
    main()
