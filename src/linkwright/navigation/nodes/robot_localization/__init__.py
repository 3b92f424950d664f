"""The nodes of robot_localization, which estimate poses from several sensors."""
