"""What is wrong with a launch file, and where: the places in it, and the exceptions that programs expect from ROS."""
