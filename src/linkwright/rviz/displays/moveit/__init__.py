"""The displays of MoveIt (moveit_rviz_plugin)."""
