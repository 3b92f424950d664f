"""What a robot does when it is stuck: spin, back up, wait."""
