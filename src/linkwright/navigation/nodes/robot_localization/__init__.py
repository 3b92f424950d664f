"""The nodes of robot_localization: pose estimation from several sensors."""
