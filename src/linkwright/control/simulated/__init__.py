"""ros2_control in a simulated world: hardware that is a part of it, and the plugin that updates controllers."""
