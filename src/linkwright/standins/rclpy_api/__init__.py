"""The API of the Python package ``rclpy``, on the nodes and executors of `linkwright.graph`."""
