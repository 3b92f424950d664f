"""The API of the Python packages ``tf2_ros`` and ``tf2_geometry_msgs``, based on the buffer of `linkwright.graph`."""
