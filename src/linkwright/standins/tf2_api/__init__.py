"""What the Python packages ``tf2_ros`` and ``tf2_geometry_msgs`` offer, on the buffer of `linkwright.graph`."""
