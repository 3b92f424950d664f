"""What the Python package ``rclpy`` offers, on the nodes and executors of `linkwright.graph`."""
