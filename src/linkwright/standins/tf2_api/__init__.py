"""The API of ``tf2_ros`` and ``tf2_geometry_msgs``, based on `linkwright.graph`."""
