"""The commands of ROS 2 under their own names, as the shell of Linkwright offers them."""
