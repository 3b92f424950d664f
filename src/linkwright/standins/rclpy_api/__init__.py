"""The API of the Python package ``rclpy``, based on the nodes and executors of `linkwright.graph`."""
