"""Commands that are spoken: from sound to words, and from words to what a robot is to do; without ROS."""
