"""ros2_control in a simulated world: hardware of simulated joints, and the plugin that runs the controllers."""
