"""Recovery behaviours, and zones around the robot that limit its velocity."""
