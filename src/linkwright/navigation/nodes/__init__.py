"""Navigation nodes, under the names that nav2 and slam_toolbox give them."""
