import sys

from rclpy.serialization import deserialize_message
from rosbag2_py import ConverterOptions, SequentialReader, StorageOptions
from rosidl_runtime_py.utilities import get_message

reader = SequentialReader()
reader.open(StorageOptions(uri=sys.argv[1], storage_id='mcap'), ConverterOptions('', ''))
types = {topic.name: topic.type for topic in reader.get_all_topics_and_types()}
last = None
while reader.has_next():
    topic, data, time = reader.read_next()
    if topic in ('/command', '/state'):
        text = deserialize_message(data, get_message(types[topic])).data
        if text != last:
            print(f'{time * 1e-9:.2f} {topic} {text}')
        last = text
