"""Motion planning for arms: kinematics of groups, collisions, planners, and the nodes of MoveIt."""
