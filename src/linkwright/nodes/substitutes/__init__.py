"""The substitutes for turtlesim and urdf_launch, the packages of the nodes of this room that have launch files."""
