import numpy as np
import rclpy
from audio_common_msgs.msg import AudioDataStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float32

RATE = 16000
LOUD = 0.02


def level(data):
    """Return the root mean square of 16-bit samples, as a share of the greatest one."""
    samples = np.frombuffer(bytes(data), np.int16).astype(float)
    return float(np.sqrt(np.mean(samples * samples))) / 32768


class LevelMeter(Node):
    def __init__(self):
        super().__init__('level_meter')
        self.seconds = 0.0
        self.is_loud = False
        self.publisher = self.create_publisher(Float32, 'level', 10)
        self.create_subscription(AudioDataStamped, 'audio/audio_stamped', self.on_audio, 10)

    def on_audio(self, message):
        loudness = level(message.audio.data)
        self.publisher.publish(Float32(data=loudness))
        if loudness > LOUD and not self.is_loud:
            self.get_logger().info(f'a word begins at {self.seconds:.1f} s')
        self.is_loud = loudness > LOUD
        self.seconds += len(message.audio.data) / 2 / RATE


def main():
    rclpy.init()
    try:
        rclpy.spin(LevelMeter())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
