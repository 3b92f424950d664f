"""The API of the Python package ``rclpy``, based on `linkwright.graph`."""
